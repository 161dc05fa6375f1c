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

/// The error of a command for belts given a study of a disc.
pub(super) fn not_of_a_belt(origin: Origin) -> Complaint {
    let allowed = "this command requires a study of a belt ([belt], [friction]), but the study is of a disc, which \
                   supports check, cite, modes, stability, resonances and map";
    Complaint::new(Fault::Conflict, "disc", origin, Json::Null, allowed)
}

/// The error of a command for belts given a study of a system.
pub(super) fn not_of_a_belt_but_system(origin: Origin) -> Complaint {
    let allowed = "this command requires a study of a belt ([belt], [friction]), but the study is of a system";
    Complaint::new(Fault::Conflict, "system", origin, Json::Null, allowed)
}
