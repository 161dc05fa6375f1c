//! Words of the command line are replaced by those of Python. The file is compiled alone: a test cannot be linked with Python.

#[path = "../src/words.rs"]
mod words;

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
        assert_eq!(in_python(text), expected);
    }
}

#[test]
fn ways_are_those_of_python() {
    for (text, expected) in [
        (
            "already exists: --resume continues it; or choose another name",
            "already exists: resume=True continues it; or choose another name",
        ),
        (
            "stopped; 3 of 4 chunks kept, 1 left: the same command with --resume continues",
            "stopped; 3 of 4 chunks kept, 1 left: the same call with resume=True continues",
        ),
        (
            "stopped; nothing was kept: --save FILE.zarr keeps finished chunks, and --resume continues",
            "stopped; nothing was kept: store=\"FILE.zarr\" keeps finished chunks, and resume=True continues",
        ),
        ("the keys that `quell schema` lists", "the keys that quell.schema() lists"),
        (
            "several loads; `quell stability` and `quell map --quantity growth` take any number of loads",
            "several loads; `stability()` and `map(\"growth\")` take any number of loads",
        ),
    ] {
        assert_eq!(in_python(text), expected);
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
        assert_eq!(in_python(text), text);
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
