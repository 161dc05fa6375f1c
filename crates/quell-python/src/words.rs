//! Translation of messages from the command line to the Python API.
//!
//! What a message mentions by a type is spelled as in Python; an option in its text is replaced by the name of the corresponding
//! argument. Code between backticks and dashes within a word or a path are left unchanged.

use quell::said::{Mention, Said};

/// A text in terms of the Python API.
pub(crate) fn in_python(said: &Said) -> String {
    said.spelled(spelled, outside_code)
}

/// What the doors spell differently, in Python.
fn spelled(mention: &Mention) -> String {
    let text = match mention {
        Mention::Verb(name) => return called(name),
        Mention::SameRequest => "the same call",
        Mention::Resume => "resume=True",
        Mention::Store => "store=\"FILE.zarr\"",
        Mention::ValuesOfAmplitude => "axes={\"dither.amplitude\": [0.1, 0.2]}",
        Mention::Schema => "quell.schema()",
        Mention::Stability => "`stability()`",
        Mention::MapOfGrowth => "`map(\"growth\")`",
    };
    text.to_owned()
}

/// A verb with an option, as a call.
fn called(verb: &str) -> String {
    match verb {
        "stability --parameter" => "stability(parameter=…)".to_owned(),
        "stability --exact" => "stability(exact=True)".to_owned(),
        verb => outside_code(verb),
    }
}

/// A text with names of arguments in place of options, except in code between backticks.
fn outside_code(text: &str) -> String {
    let parts = text.split('`').enumerate();
    // Every second part is code.
    let translated: Vec<String> = parts
        .map(|(number, part)| if number % 2 == 0 { without_options(part) } else { part.to_owned() })
        .collect();
    translated.join("`")
}

/// The name of the argument if a key is an option, else the key itself.
pub(crate) fn key_in_python(key: &str) -> String {
    match key.strip_prefix("--") {
        Some(name) if !name.is_empty() && name_length(name) == name.len() => argument(name),
        _ => key.to_owned(),
    }
}

/// The name of the argument for an option without its dashes.
fn argument(option: &str) -> String {
    match option {
        "from" => "from_".to_owned(),
        "save" => "store".to_owned(),
        _ => option.replace('-', "_"),
    }
}

/// A text without code, with names of arguments in place of options.
fn without_options(text: &str) -> String {
    let (mut translated, mut rest) = (String::new(), text);
    while let Some(place) = rest.find("--") {
        let (before, behind) = (&rest[..place], &rest[place + 2..]);
        translated.push_str(before);
        let within = translated
            .ends_with(|letter: char| letter.is_alphanumeric() || "-_./\\".contains(letter));
        let (name, further) = behind.split_at(name_length(behind));
        if name.is_empty() || within {
            translated.push_str("--");
            translated.push_str(name);
        } else {
            translated.push_str(&argument(name));
        }
        rest = further;
    }
    translated + rest
}

/// Length of the name of an option at the beginning of a text: words in lower case, separated by dashes.
fn name_length(text: &str) -> usize {
    let word =
        |text: &str| text.find(|letter: char| !letter.is_ascii_lowercase()).unwrap_or(text.len());
    let mut length = word(text);
    while length > 0 && text[length..].starts_with('-') {
        let next = word(&text[length + 1..]);
        if next == 0 {
            break;
        }
        length += 1 + next;
    }
    length
}
