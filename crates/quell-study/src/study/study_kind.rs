//! What a kind of study is to the reader of study files.

use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::document::Table;
use quell_input::said::Said;
use serde_json::Value as Json;

use super::reader::Reader;

/// What a kind of study reads in addition to what all kinds share.
pub trait StudyKind: Clone {
    /// A reader for the units of the document.
    fn reader(document: &Table) -> Reader;

    /// Reads the tables of this kind; `None` if something is invalid, which has then been reported to the reader.
    fn read(reader: &mut Reader, document: &Table) -> Option<Self>;
}

/// The error of a verb or command that studies of this kind do not have.
pub fn not_available(what: Said, kind: &str, origin: Origin) -> Complaint {
    let allowed = what.text(format!(" is not available for a {kind} study"));
    Complaint::new(Fault::Conflict, kind, origin, Json::Null, allowed)
}

/// The error of a command that requires a study of one kind and is given one of another kind.
pub(super) fn wrong_kind(required: &str, given: &str, origin: Origin) -> Complaint {
    not_available(format!("a command for a {required} study").into(), given, origin)
}
