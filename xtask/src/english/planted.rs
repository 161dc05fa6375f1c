//! Tests of the check, on texts planted here.

use std::path::Path;

use super::words::{Exception, word};
use super::*;

/// Lines and forms of what is found in a file of this name.
fn found(name: &str, text: &str) -> Vec<(usize, &'static str)> {
    find(Path::new(name), text).into_iter().map(|finding| (finding.line, finding.form)).collect()
}

#[test]
fn comments_and_literals_of_rust_are_read_and_code_is_not() {
    let text = "//! What is told here.\nfn tell(told: u8) -> u8 { told }\n/* It\n hears */\n\
                const A: &str = \"the answer tells all\";\nconst KEY: &str = \"stretch\"; // \"told\", (Beside)\n";
    assert_eq!(
        found("a.rs", text),
        [(1, "told"), (4, "hears"), (5, "tells"), (6, "told"), (6, "beside")]
    );
}

#[test]
fn phrases_reach_over_lines_and_stop_at_punctuation() {
    assert_eq!(found("a.rs", "/// where there is\n/// none of it\n"), [(1, "there is none")]);
    assert_eq!(
        found("a.md", "where there is\nnone. For\never"),
        [(1, "there is none"), (2, "for ever")]
    );
    for text in [
        "there is. None",
        "there is, none",
        "there is\n\nnone",
        "there is `x` none",
        "there is (none)",
    ] {
        assert_eq!(found("a.md", text), [], "{text}");
    }
    assert_eq!(found("a.rs", "/// there is\nfn f() {}\n/// none\n"), []);
    assert_eq!(found("a.rs", "let a = \"there is \\\n         none\";"), [(1, "there is none")]);
}

#[test]
fn names_code_links_and_paths_are_not_prose() {
    for text in [
        "`told` and [x](told.md), a/beside/b, told_apart, --tell, untold",
        "```toml\nstretch = 1 # told\n```",
    ] {
        assert_eq!(found("a.md", text), [], "{text}");
    }
    assert_eq!(found("a.rs", "let a = format!(\"of {told} and {told:?} x\");"), []);
    assert_eq!(
        found("a.rs", "/// ```\n/// let told = 1; // told\n/// ```\n/// told\n"),
        [(4, "told")]
    );
}

#[test]
fn other_files_are_read() {
    assert_eq!(
        found("a.py", "def tell():\n    \"\"\"Is told\n\n    >>> tell told\n    \"\"\"  # minds\n"),
        [(2, "told"), (5, "minds")]
    );
    assert_eq!(found("a.toml", "told = \"a b told\" # whatever\n"), [(1, "told"), (1, "whatever")]);
    let notebook = "{\"cells\": [{\n \"source\": [\n  \"It is told,\\n\",\n  \"for ever\"\n ],\n \"outputs\": [\n  \"told\"\n ]}";
    assert_eq!(found("a.ipynb", notebook), [(3, "told"), (4, "for ever")]);
    assert_eq!(found("a.csv", "told"), []);
}

#[test]
fn a_release_of_the_past_is_not_changed() {
    let text = "## [Unreleased]\ntold\n## [0.2.0]\ntold\n## [0.1.0] - 2026\n### Added\ntold\n## Older\ntold\n";
    assert_eq!(found("CHANGELOG.md", text), [(2, "told"), (4, "told"), (9, "told")]);
}

#[test]
fn closures_that_name_nothing_are_found() {
    let text = "a.map(|it| it + 1);\nlet f = |a, it: u8| a | it | b;\nx.map(move |&it| it);\nb.map(|(_, it)| it);\n\
                let c = it || it;\nmatch d { A | B => |item| item, it | e => it }\n// |it|\n";
    assert_eq!(found("a.rs", text), [(1, "|it|"), (2, "|it|"), (3, "|it|"), (4, "|it|")]);
}

#[test]
fn an_exception_holds_for_its_file_and_its_number() {
    let exceptions = &[Exception { file: "a.md", count: 2, reason: "planted" }];
    let entries = [AvoidedWord { exceptions, ..word(&["tell", "told"], "say") }];
    let left = |file: &str, text: &str| {
        let mut complaints = Vec::new();
        let found = find(Path::new(file), text);
        let left = without_exceptions(file, found, &entries, &mut complaints);
        (left.len(), complaints.len())
    };
    assert_eq!(left("a.md", "Told, and tell, beside"), (1, 0));
    assert_eq!(left("a.md", "Told"), (1, 1));
    assert_eq!(left("a.md", "Told, tell, told"), (3, 1));
    assert_eq!(left("b.md", "Told and tell"), (2, 0));
}

#[test]
fn every_form_is_found() {
    for entry in WORDS {
        assert!(!entry.instead.is_empty());
        for form in entry.forms {
            assert_eq!(found("a.md", &format!("Then {form} it")), [(1, *form)]);
            let mut first = form.chars();
            let capital: String = first.next().into_iter().flat_map(char::to_uppercase).collect();
            let capital = capital + first.as_str();
            assert_eq!(found("a.rs", &format!("// {capital}.")), [(1, *form)]);
        }
    }
}

#[test]
fn files_count_for_their_crate_or_folder() {
    assert_eq!(folder("crates/quell/src/a.rs"), "crates/quell");
    assert_eq!(folder("docs/book/src/a.md"), "docs");
    assert_eq!(folder("README.md"), "README.md");
}
