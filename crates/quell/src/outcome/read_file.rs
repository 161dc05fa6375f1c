//! How a measured file was read.

use quell_input::dialect::FileDialect;
use serde_json::{Value as Json, json};

use crate::words::{counted, listed};

/// Most lines that are listed in words.
const LISTED: usize = 12;

/// The object `read`.
pub(super) fn read(file: &FileDialect) -> Json {
    json!({
        "format": file.format,
        "separator": file.separator,
        "decimal": file.decimal,
        "units": file.units,
        "comment_lines": file.comment_lines,
        "header_lines": file.header_lines,
        "left_out_lines": file.left_out_lines,
    })
}

/// What is not as in a plain CSV file, in one sentence; nothing if all is.
pub(super) fn read_in_words(file: &FileDialect) -> Option<String> {
    let mut said = Vec::new();
    match file.separator {
        Some(';') => said.push("semicolons between columns".to_owned()),
        Some('\t') => said.push("tabs between columns".to_owned()),
        Some(' ') => said.push("spaces between columns".to_owned()),
        _ => {}
    }
    if file.decimal == Some(',') {
        said.push("decimal commas".to_owned());
    }
    let units: Vec<String> = file
        .units
        .iter()
        .flatten()
        .map(|unit| match unit.as_str() {
            "1" => "1 (a pure number)".to_owned(),
            unit => unit.to_owned(),
        })
        .collect();
    if !units.is_empty() {
        said.push(format!("the units {}", listed(&units)));
    }
    if file.header_lines > 0 {
        said.push(counted(file.header_lines, "header line"));
    }
    let mut lines: Vec<String> =
        file.left_out_lines.iter().take(LISTED).map(ToString::to_string).collect();
    if let Some(more) = file.left_out_lines.len().checked_sub(LISTED).filter(|more| *more > 0) {
        lines.push(format!("{more} more"));
    }
    if !lines.is_empty() {
        let word = if file.left_out_lines.len() == 1 { "line" } else { "lines" };
        said.push(format!("{word} {} left out for a gap", listed(&lines)));
    }
    // Comments alone are those of a plain file.
    if !said.is_empty() && file.comment_lines > 0 {
        said.push(counted(file.comment_lines, "comment line"));
    }
    let source = match file.format {
        "LabVIEW" => "A LabVIEW measurement file",
        "MATLAB" => "A MATLAB file",
        _ => "The file",
    };
    match (said.is_empty(), file.format) {
        (true, "text") => None,
        (true, _) => Some(format!("{source} was read.")),
        (false, _) => Some(format!("{source} was read with {}.", listed(&said))),
    }
}
