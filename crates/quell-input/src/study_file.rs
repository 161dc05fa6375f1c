//! Reads the text of a study file and rejects what is not text.

use std::fs::File;
use std::io::{self, Read};
use std::path::{self, Path, PathBuf};

use serde_json::Value as Json;

use crate::complaint::{Complaint, Fault, Origin};

/// The largest study file that is read; larger files are not studies, and some files never end.
const LARGEST: u64 = 16 << 20;

/// The absolute path of a study file, which stays valid if the working directory changes; `-` is standard input.
pub fn place(path: &Path) -> PathBuf {
    let here = if path == Path::new("-") { None } else { path::absolute(path).ok() };
    here.unwrap_or_else(|| path.to_owned())
}

/// Reads a study file; `-` is standard input.
///
/// # Errors
/// A complaint about a file that is missing, unreadable, a directory, too large, empty, or
/// not text.
pub fn text(path: &Path) -> Result<String, Box<Complaint>> {
    let complaint = |allowed: String| {
        let given = Json::String(path.display().to_string());
        Box::new(Complaint::new(Fault::Path, "study file", Origin::Whole, given, allowed))
    };
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("csv")) {
        let allowed =
            "is a data file; expected a study (TOML). `fit` and `compare` take measurements";
        return Err(complaint(allowed.into()));
    }
    let mut bytes = Vec::new();
    let read = if path == Path::new("-") {
        io::stdin().lock().take(LARGEST + 1).read_to_end(&mut bytes)
    } else {
        if path.is_dir() {
            return Err(complaint("is a directory; expected a study file".into()));
        }
        File::open(path).and_then(|file| file.take(LARGEST + 1).read_to_end(&mut bytes))
    };
    match read {
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            return Err(complaint("no such file".into()));
        }
        Err(error) => return Err(complaint(format!("cannot be read: {error}"))),
        Ok(_) => {}
    }
    if bytes.len() as u64 > LARGEST {
        return Err(complaint("is larger than 16 MiB, the limit for a study file".into()));
    }
    let text = String::from_utf8(bytes).map_err(|error| {
        complaint(format!(
            "is not text: invalid UTF-8 at byte {}; expected a TOML file",
            error.utf8_error().valid_up_to()
        ))
    })?;
    if text.contains('\0') {
        return Err(complaint("is not text: it contains null bytes; expected a TOML file".into()));
    }
    if text.trim_start_matches('\u{feff}').trim().is_empty() {
        return Err(complaint(
            "is empty; a study needs at least [belt] and [friction], [disc], or [system] (`quell new` prints examples)".into(),
        ));
    }
    Ok(text)
}
