//! An entry with its files.

use std::path::PathBuf;
use std::time::Duration;

use serde_json::{Value as Json, json};

use super::claims;
use super::entry::CatalogueEntry;
use super::product::Product;

/// An entry that has been written to files.
#[derive(Clone, Debug)]
pub struct WrittenEntry {
    /// The entry.
    pub entry: CatalogueEntry,
    /// Whether its numbers are not those of the dissertation.
    pub own: bool,
    /// The files.
    pub files: Vec<PathBuf>,
    /// The product; the rows of its data tables are in the files.
    pub product: Product,
    /// Run time.
    pub elapsed: Duration,
}

impl WrittenEntry {
    /// As JSON.
    pub fn json(&self) -> Json {
        let files: Vec<String> = self.files.iter().map(|file| file.display().to_string()).collect();
        let mut object = json!({
            "name": self.entry.name,
            "about": self.entry.about,
            "own": self.own,
            "files": files,
            "caption": self.product.plain_caption(),
            "seconds": self.elapsed.as_secs_f64(),
        });
        if !self.product.claims.is_empty() {
            object["claims"] = claims::json(&self.product.claims);
        }
        object
    }
}
