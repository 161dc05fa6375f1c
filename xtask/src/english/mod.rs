//! `cargo xtask english`: counts the words of [`words`] in comments, string literals and Markdown, and the closure argument `it`
//! in code. A count may only fall.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use crate::ratchet::{Counts, Ratchet, RatchetMode};
use crate::source;

#[cfg(test)]
mod planted;
mod prose;
mod words;

use prose::Word;
use words::{AvoidedWord, CLOSURE_IT, EXCLUDED, WORDS};

/// Words by crate or folder.
const RATCHET: Ratchet = Ratchet {
    check: "english",
    file: "xtask/english.toml",
    counted: "Words of xtask/src/english/words.rs by crate, folder or file of the root.",
};

/// A word in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Finding {
    line: usize,
    form: &'static str,
    instead: &'static str,
}

/// Checks all texts of the workspace at `root`.
///
/// # Errors
/// Folders whose counts differ from those allowed; an exception whose count is wrong; a file that cannot be read.
pub(crate) fn run(root: &Path, mode: RatchetMode) -> Result<(), String> {
    let mut findings: BTreeMap<String, Vec<Finding>> = BTreeMap::new();
    let mut exceptions = Vec::new();
    for path in source::files(root)? {
        let file = source::relative(&path, root);
        let is_read = ["md", "rs", "py", "pyi", "toml", "ipynb"]
            .iter()
            .any(|extension| source::has_extension(&path, extension));
        if !is_read || EXCLUDED.iter().any(|(excluded, _)| file.starts_with(excluded)) {
            continue;
        }
        let found = find(&path, &source::read(&path)?);
        let left = without_exceptions(&file, found, WORDS, &mut exceptions);
        findings.insert(file, left);
    }
    exceptions.extend(missing_files(|file| findings.contains_key(file)));
    let mut counts = Counts::new();
    for (file, found) in findings.iter().filter(|(_, found)| !found.is_empty()) {
        *counts.entry(folder(file)).or_default() += found.len();
    }
    let compared = RATCHET.check(root, &counts, mode, |key| {
        let files = findings.iter().filter(|(file, _)| folder(file) == key);
        files.map(|(file, found)| shown(file, found)).collect()
    });
    if !exceptions.is_empty() {
        return Err(format!("english: {}", exceptions.join("\nenglish: ")));
    }
    compared?;
    eprintln!("english: {} words to replace, all of them known", counts.values().sum::<usize>());
    Ok(())
}

/// The words of a file.
fn find(path: &Path, text: &str) -> Vec<Finding> {
    let prose = prose::words(path, text);
    let mut found = Vec::new();
    for at in 0..prose.len() {
        for entry in WORDS {
            let form = entry.forms.iter().find(|form| begins_with(&prose[at..], form));
            found.extend(form.map(|form| finding(entry, form, prose[at].line)));
        }
    }
    if source::has_extension(path, "rs") {
        let code = source::code(text);
        let closures = closures_of_it(&code).into_iter();
        found.extend(
            closures.map(|at| finding(&CLOSURE_IT, CLOSURE_IT.forms[0], source::line(&code, at))),
        );
        found.sort_by_key(|finding| finding.line);
    }
    found
}

fn finding(entry: &AvoidedWord, form: &'static str, line: usize) -> Finding {
    Finding { line, form, instead: entry.instead }
}

/// Whether prose begins with a word or phrase.
fn begins_with(prose: &[Word], phrase: &str) -> bool {
    let count = phrase.split(' ').count();
    let Some(words) = prose.get(..count) else { return false };
    let equal = words.iter().zip(phrase.split(' ')).all(|(word, wanted)| word.text == wanted);
    equal && words[..count - 1].iter().all(|word| word.continues)
}

/// The offsets of closures with an argument named `it`, in code without comments and literals.
fn closures_of_it(code: &str) -> Vec<usize> {
    let mut found = Vec::new();
    let mut from = 0;
    while let Some(open) = code[from..].find('|').map(|at| from + at) {
        from = open + 1;
        let before = code[..open].trim_end();
        let begins = before.ends_with(['(', ',', '=', '{', ';', '>', '['])
            || ["move", "return", "else"].iter().any(|word| before.ends_with(word));
        let Some(close) = code[from..].find('|').map(|at| from + at) else { break };
        if !begins {
            continue;
        }
        let is_word = |letter: char| letter.is_alphanumeric() || letter == '_';
        if code[from..close].split(|letter| !is_word(letter)).any(|word| word == "it") {
            found.push(open);
        }
        from = close + 1;
    }
    found
}

/// The findings that no exception covers. Exceptions with a wrong count cover nothing and are added to `complaints`.
fn without_exceptions(
    file: &str,
    mut found: Vec<Finding>,
    entries: &[AvoidedWord],
    complaints: &mut Vec<String>,
) -> Vec<Finding> {
    for entry in entries {
        for exception in entry.exceptions.iter().filter(|exception| exception.file == file) {
            let is_entry = |finding: &Finding| entry.forms.contains(&finding.form);
            let count = found.iter().filter(|finding| is_entry(finding)).count();
            if count == exception.count {
                found.retain(|finding| !is_entry(finding));
            } else {
                complaints.push(format!(
                    "{file}: {:?} is expected {} times as an exception, and occurs {count} times",
                    entry.forms[0], exception.count
                ));
            }
        }
    }
    found
}

/// Complaints about exceptions for files that do not exist.
fn missing_files(exists: impl Fn(&str) -> bool) -> Vec<String> {
    let exceptions = WORDS.iter().flat_map(|entry| entry.exceptions);
    let missing = exceptions.filter(|exception| !exists(exception.file));
    missing
        .map(|exception| format!("{}: has an exception, but does not exist", exception.file))
        .collect()
}

/// The crate, folder or file of the root to which a file is counted.
fn folder(file: &str) -> String {
    let mut parts = file.split('/');
    match (parts.next(), parts.next()) {
        (Some("crates"), Some(name)) => format!("crates/{name}"),
        (Some(first), _) => first.to_owned(),
        (None, _) => String::new(),
    }
}

fn shown(file: &str, found: &[Finding]) -> String {
    let mut text = String::new();
    for Finding { line, form, instead } in found {
        let _ = writeln!(text, "    {file}:{line}: `{form}`: {instead}");
    }
    text
}
