//! What a kind of study is to the reader of study files.

use std::path::Path;

use serde_json::Value as Json;

use super::document::Table;
use super::reader::Reader;
use crate::complaint::{Complaint, Fault, Origin};

/// What a kind of study reads in addition to what all kinds share.
pub trait StudyKind: Clone {
    /// A reader for the units of the document.
    fn reader(document: &Table) -> Reader;

    /// Names of the tables and keys outside any table that such a study has.
    fn tables(document: &Table) -> &'static [&'static str];

    /// Reads the tables of this kind; `None` if something is invalid, which has then been reported to the reader.
    fn read(reader: &mut Reader, document: &Table, given: Given<'_, Self>) -> Option<Self>;

    /// The data files that the study names and that have been read.
    fn data_files(&self) -> Vec<&Path>;

    /// What such files contribute to the settings, as `path = value`.
    fn file_settings(&self) -> Vec<(String, String)>;
}

/// What is known before a document is read.
#[derive(Clone, Copy, Debug)]
pub struct Given<'a, K> {
    /// The folder of the files that the study names.
    pub folder: &'a Path,
    /// The same study before a change: its files are not read again, and unchanged parts are kept.
    pub known: Option<&'a K>,
}

/// The error of a verb or command that studies of this kind do not have.
pub fn not_available(what: &str, kind: &str, origin: Origin) -> Complaint {
    let allowed = format!("{what} is not available for a {kind} study");
    Complaint::new(Fault::Conflict, kind, origin, Json::Null, allowed)
}

/// The error of a command that requires a study of one kind and is given one of another kind.
pub(super) fn wrong_kind(required: &str, given: &str, origin: Origin) -> Complaint {
    not_available(&format!("a command for a {required} study"), given, origin)
}
