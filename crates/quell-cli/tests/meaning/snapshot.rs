//! The answers of every study in `studies/` through every verb that it has, with all digits: a change of a number is seen here, and
//! explained in CHANGELOG.md.
//!
//! `answers/STUDY.txt` has a line for each number, word or list. `cargo xtask snapshot` also asks the verbs that take long, and its `--bless`
//! writes the files again.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use crate::answer::Answer;

/// Verbs without a range, and whether they are among those that every run of the tests asks.
const VERBS: &[(&str, bool)] = &[
    ("actuator", true),
    ("attractor", true),
    ("check", true),
    ("friction", true),
    ("modes", true),
    ("orbit", true),
    ("receptance", true),
    ("resonances", true),
    ("response", true),
    ("stability", true),
    ("simulate", true),
    ("basins", false),
    ("design", false),
    ("waveforms", false),
];

/// Questions that take more than ten minutes, which nobody waits for here.
const TOO_LONG: &[(&str, &str)] = &[("basins", "bowed-string.toml")];

/// The longest list that is written out.
const LONGEST: usize = 4;

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(name)
}

/// The arguments of a verb for a study.
fn arguments<'a>(verb: &'a str, study: &'a str) -> Vec<&'a str> {
    let mut arguments = vec![verb, study];
    match verb {
        "basins" => arguments.extend(["--sample", "2", "--seed", "1"]),
        "simulate" => arguments.push("--events"),
        _ => {}
    }
    arguments
}

/// The lines of an answer.
fn lines(verb: &str, answer: &Answer) -> String {
    let mut text = String::new();
    let mut lists: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for (key, value) in answer.values() {
        match key.split_once('[') {
            None => {
                let _ = writeln!(text, "{verb} {key} = {value}");
            }
            Some((list, rest)) => {
                lists.entry(list).or_default().push(format!("[{rest} = {value}"));
            }
        }
    }
    for (list, entries) in lists {
        if entries.len() <= LONGEST {
            for entry in entries {
                let _ = writeln!(text, "{verb} {list}{entry}");
            }
            continue;
        }
        let bytes = entries.iter().flat_map(|entry| entry.bytes());
        let sum = bytes.fold(0xcbf2_9ce4_8422_2325_u64, |sum, byte| {
            (sum ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
        let _ = writeln!(text, "{verb} {list}[…] = {} values, {sum:016x}", entries.len());
    }
    text
}

/// The lines of a study: all of its verbs, or the quick ones.
fn of_study(study: &str, all: bool) -> String {
    let asked =
        VERBS.iter().filter(|(verb, quick)| (all || *quick) && !TOO_LONG.contains(&(*verb, study)));
    let lines = asked.filter_map(|(verb, _)| {
        let answer = Answer::of(&folder("studies"), &arguments(verb, study));
        (!answer.is_refused()).then(|| lines(verb, &answer))
    });
    lines.collect()
}

/// Whether a line of a file is asked for.
fn is_asked(line: &str, all: bool) -> bool {
    let verb = line.split(' ').next().unwrap_or_default();
    VERBS.iter().any(|(name, quick)| *name == verb && (all || *quick))
}

#[test]
fn no_answer_changes_unnoticed() {
    let all = std::env::var_os("QUELL_SNAPSHOT").is_some_and(|value| value == "all");
    let bless = std::env::var_os("QUELL_BLESS").is_some();
    let mut studies: Vec<String> = fs::read_dir(folder("studies"))
        .expect("the studies")
        .map(|entry| entry.expect("a study").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .filter_map(|path| Some(path.file_name()?.to_str()?.to_owned()))
        .collect();
    studies.sort();
    assert!(studies.len() > 60, "{studies:?}");
    let (next, changed) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = || {
        while let Some(study) = studies.get(next.fetch_add(1, Ordering::Relaxed)) {
            let now = of_study(study, all);
            let path =
                folder("crates/quell-cli/tests/meaning/answers").join(study).with_extension("txt");
            let known = fs::read_to_string(&path).unwrap_or_default();
            if bless {
                // Verbs that take long come last in the list and in the files.
                let kept = known.lines().filter(|line| !is_asked(line, all));
                let lines: Vec<&str> = now.lines().chain(kept).collect();
                fs::write(&path, lines.join("\n") + "\n").expect("written");
                continue;
            }
            let known: Vec<&str> = known.lines().filter(|line| is_asked(line, all)).collect();
            let now: Vec<&str> = now.lines().collect();
            let of = |lines: &[&str], others: &[&str], sign: char| {
                let own = lines.iter().filter(|line| !others.contains(line));
                own.map(|line| format!("{sign} {study}: {line}")).collect::<Vec<_>>()
            };
            let mut changed = changed.lock().expect("no thread fails");
            changed.extend(of(&known, &now, '-'));
            changed.extend(of(&now, &known, '+'));
        }
    };
    let threads = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| (0..threads).for_each(|_| drop(scope.spawn(work))));
    let changed: Vec<String> = changed.into_inner().expect("no thread fails");
    assert!(changed.is_empty(), "{} lines changed:\n{}", changed.len(), changed.join("\n"));
}

/// A sentence of an answer has two sentences at most, and forty words; notes have the rest.
#[test]
fn sentences_are_short() {
    let words = |text: &str| {
        let words = text.split_whitespace();
        words.filter(|word| word.contains(|letter: char| letter.is_alphanumeric())).count()
    };
    let ends = |text: &str| {
        let after = text.match_indices(". ").map(|(at, _)| &text[at + 2..]);
        1 + after.filter(|rest| rest.starts_with(char::is_uppercase)).count()
    };
    let mut long = Vec::new();
    for answers in fs::read_dir(folder("crates/quell-cli/tests/meaning/answers")).expect("answers")
    {
        let path = answers.expect("an answer").path();
        for line in fs::read_to_string(&path).expect("read").lines() {
            let Some((verb, sentence)) = line.split_once(" sentence = ") else { continue };
            let (words, ends) = (words(sentence), ends(sentence));
            if words > 40 || ends > 2 {
                let study = path.file_stem().unwrap_or_default().display();
                long.push(format!(
                    "{verb} of {study}: {words} words, {ends} sentences: {sentence}"
                ));
            }
        }
    }
    assert!(long.is_empty(), "{}", long.join("\n"));
}
