//! Failures of stores, with the path of the store.

use quell_input::said::{Mention, Said};
use std::io;
use std::path::Path;

use super::lock::Refused;
use crate::complaint::{Complaint, Failure, Fault, Origin};

/// The option that names a store.
const OPTION: &str = "--save";

impl Refused {
    pub(super) fn into_failure(self, path: &Path) -> Failure {
        match self {
            Self::Busy => failed(
                path,
                "another process is writing this store; wait until it finishes, or choose another name"
                    .to_owned(),
            ),
            Self::Io(error) => unwritable(path, &error),
        }
    }
}

pub(super) fn failed(path: &Path, why: String) -> Failure {
    Failure::Failed { key: path.display().to_string(), why: why.into() }
}

pub(super) fn complaint(path: &Path, allowed: impl Into<Said>) -> Failure {
    let given = path.display().to_string();
    Complaint::new(Fault::Path, OPTION, Origin::Argument(OPTION), given, allowed).into()
}

pub(super) fn exists(path: &Path) -> Failure {
    let said = Said::from("already exists: ").mention(Mention::Resume);
    complaint(path, said.text(" continues it; or choose another name"))
}

pub(super) fn changed(path: &Path, key: &str) -> Failure {
    complaint(
        path,
        format!(
            "{key} differs from what this map must contain: the file was truncated or changed, and readers of the store \
             would get wrong numbers; remove the file (it is then written again), or choose another name"
        ),
    )
}

pub(super) fn another(path: &Path, differences: &[String]) -> Failure {
    let list = differences.join("; ");
    complaint(path, format!("is the store of another map ({list}); choose another name"))
}

/// A failure for a path that cannot be written: invalid input, unless the disk is full.
pub(super) fn unwritable(path: &Path, error: &io::Error) -> Failure {
    let why = format!("cannot be written: {error}");
    match error.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded | io::ErrorKind::FileTooLarge => {
            failed(path, why)
        }
        _ => complaint(path, why),
    }
}
