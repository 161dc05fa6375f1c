//! What a kind of study is to the reader of study files.

use std::path::Path;

use serde_json::Value as Json;

use super::document::Table;
use super::reader::Reader;
use crate::complaint::{Complaint, Fault, Origin};

/// What a kind of study reads besides what all kinds share.
pub trait StudyKind: Clone {
    /// A reader that knows the units of the document.
    fn reader(document: &Table) -> Reader;

    /// Names of the tables and keys outside any table that such a study has.
    fn tables(document: &Table) -> &'static [&'static str];

    /// Reads the tables of this kind; `None` where something is wrong, which the reader was told.
    fn read(reader: &mut Reader, document: &Table, given: Given<'_, Self>) -> Option<Self>;

    /// A file that the study names, read already.
    fn data_file(&self) -> Option<&Path>;

    /// What such files contribute to the settings, as `path = value`.
    fn file_settings(&self) -> Vec<(String, String)>;
}

/// What is known before a document is read.
#[derive(Clone, Copy, Debug)]
pub struct Given<'a, K> {
    /// Where files that the study names are looked for.
    pub folder: &'a Path,
    /// The same study before a change: its files are not read again, and what the change leaves as it was is kept.
    pub known: Option<&'a K>,
}

/// What a verb about belts reports of a study of a disc.
pub(super) fn not_of_a_belt(origin: Origin) -> Complaint {
    let allowed = "this verb is about a belt ([belt], [friction]), and the study is of a disc, which has the verbs check, cite, \
                   modes, stability, resonances and map";
    Complaint::new(Fault::Conflict, "disc", origin, Json::Null, allowed)
}
