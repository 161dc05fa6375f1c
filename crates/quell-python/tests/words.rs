//! Words of the command line are replaced by those of Python. The file is compiled alone: a test cannot be linked with Python.

#[path = "../src/words.rs"]
mod words;

use quell::said::{Mention, Said};
use words::{in_python, key_in_python};

#[test]
fn options_are_named_as_arguments() {
    for (text, expected) in [
        ("a number above --from 2", "a number above from_ 2"),
        (
            "requires --from-rest, --from-sliding, --from-squeal or --start: it ramps up",
            "requires from_rest, from_sliding, from_squeal or start: it ramps up",
        ),
        (
            "--clear and --frequency must be given together",
            "clear and frequency must be given together",
        ),
        ("name it by --save", "name it by store"),
        ("(--ramp)", "(ramp)"),
        ("--ramp-", "ramp-"),
        ("", ""),
    ] {
        assert_eq!(in_python(&Said::from(text)), expected);
    }
}

#[test]
fn ways_are_those_of_python() {
    let verb = |name: &str| Mention::Verb(name.to_owned());
    for (mention, command_line, python) in [
        (Mention::Resume, "--resume", "resume=True"),
        (Mention::SameRequest, "the same command", "the same call"),
        (Mention::Store, "--save FILE.zarr", "store=\"FILE.zarr\""),
        (
            Mention::ValuesOfAmplitude,
            "on the command line: --set sweep[0].parameter=dither.amplitude --set 'sweep[0].values=[0.1, 0.2]'",
            "axes={\"dither.amplitude\": [0.1, 0.2]}",
        ),
        (Mention::Schema, "`quell schema`", "quell.schema()"),
        (Mention::Stability, "`quell stability`", "`stability()`"),
        (Mention::MapOfGrowth, "`quell map --quantity growth`", "`map(\"growth\")`"),
        (verb("stability --exact"), "stability --exact", "stability(exact=True)"),
        (verb("stability --parameter"), "stability --parameter", "stability(parameter=…)"),
        (verb("friction --measured"), "friction --measured", "friction measured"),
        (verb("orbit"), "orbit", "orbit"),
    ] {
        let said = Said::from("first --from, ").mention(mention).text(" and --save");
        assert_eq!(said.to_string(), format!("first --from, {command_line} and --save"));
        assert_eq!(in_python(&said), format!("first from_, {python} and store"));
    }
}

#[test]
fn code_paths_and_dashes_stay() {
    for text in [
        "`quell map --quantity verdict` shows it",
        "`a` and `--resume`",
        "folder/--save and well--known",
        "a -- b",
        "---",
        "--Save",
        "x′ ≥ 0 – τ",
    ] {
        assert_eq!(in_python(&Said::from(text)), text);
    }
}

#[test]
fn keys_that_are_options_are_arguments() {
    for (key, expected) in [
        ("--from", "from_"),
        ("--from-rest", "from_rest"),
        ("--threads", "threads"),
        ("--save", "store"),
        ("dither.amplitude", "dither.amplitude"),
        ("sweep[0].values", "sweep[0].values"),
        ("--", "--"),
        ("--m.zarr", "--m.zarr"),
    ] {
        assert_eq!(key_in_python(key), expected);
    }
}
