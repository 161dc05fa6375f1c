//! Words of the command line in those of Python.
//!
//! What is done in another way in Python is listed; any other option is named as the argument that it is. Code between
//! backticks stays as it is, and so do dashes within a word or a path.

/// Ways of the command line, and what they are in Python.
const WAYS: &[(&str, &str)] = &[
    ("the same command with --resume goes on", "the same call with resume=True goes on"),
    ("the same command with --resume continues", "the same call with resume=True continues"),
    ("--resume goes on", "resume=True goes on"),
    ("--resume continues", "resume=True continues"),
    ("--save FILE.zarr keeps what is done", "store=\"FILE.zarr\" keeps what is done"),
    (
        "or on the command line: --set sweep[0].parameter=dither.amplitude --set 'sweep[0].values=[0.1, 0.2]'",
        "or axes={\"dither.amplitude\": [0.1, 0.2]}",
    ),
    ("the keys that `quell schema` lists", "the keys that quell.schema() lists"),
    ("`quell stability` and `quell map --quantity growth`", "`stability()` and `map(\"growth\")`"),
];

/// A text in the words of Python.
pub(crate) fn in_python(text: &str) -> String {
    let text = WAYS.iter().fold(text.to_owned(), |text, (way, word)| text.replace(way, word));
    let parts = text.split('`').enumerate();
    // Every second part is code.
    let told: Vec<String> = parts
        .map(|(number, part)| if number % 2 == 0 { without_options(part) } else { part.to_owned() })
        .collect();
    told.join("`")
}

/// The argument that a key is where it is an option; else the key itself.
pub(crate) fn key_in_python(key: &str) -> String {
    match key.strip_prefix("--") {
        Some(name) if !name.is_empty() && name_length(name) == name.len() => argument(name),
        _ => key.to_owned(),
    }
}

/// The argument that an option is, without its dashes.
fn argument(option: &str) -> String {
    match option {
        "from" => "from_".to_owned(),
        "save" => "store".to_owned(),
        _ => option.replace('-', "_"),
    }
}

/// A text without code, with arguments in place of options.
fn without_options(text: &str) -> String {
    let (mut told, mut rest) = (String::new(), text);
    while let Some(place) = rest.find("--") {
        let (before, behind) = (&rest[..place], &rest[place + 2..]);
        told.push_str(before);
        let within = told.ends_with(|it: char| it.is_alphanumeric() || "-_./\\".contains(it));
        let (name, further) = behind.split_at(name_length(behind));
        if name.is_empty() || within {
            told.push_str("--");
            told.push_str(name);
        } else {
            told.push_str(&argument(name));
        }
        rest = further;
    }
    told + rest
}

/// Length of the name of an option with which a text begins: words of small letters with a dash between them.
fn name_length(text: &str) -> usize {
    let word = |text: &str| text.find(|it: char| !it.is_ascii_lowercase()).unwrap_or(text.len());
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
