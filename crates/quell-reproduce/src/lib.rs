//! `reproduce`: reproduction of every figure and table of the dissertation with its data, and a table of its claims.
//!
//! Each entry of [`ENTRIES`] is one figure or table: a name, a study file with its parameters, and a function that
//! computes a [`Product`] from them. Another figure needs one more line in `figures.rs`.
//!
//! | file | content |
//! |---|---|
//! | `entry`, `figures`, `written` | an entry, the list of the figures, and an entry with its files |
//! | `source`, `axis` | study files of the entries, and the values of their axes |
//! | `amplitude_columns`, `shared` | measurements needed by several entries, made once |
//! | `product`, `write` | figures, data tables, and their files |
//! | `laws`, `waveforms`, `effective_friction`, `stability_map` | figures of friction laws, waveforms and averaging |
//! | `responses`, `sections`, `residual_map`, `measured_friction` | figures of simulated responses |
//! | `caption` | names and numbers in captions |
//! | `disc` | tables and figures of chapter 5 |
//! | `printed_formulas` | formulas as printed in the dissertation, correct or not |
//! | `claim` | a claim, its verdict and its expected verdict |
//! | `claims` | measurement of the claims, and the verdict on record of each of them |
//! | `report` | the page with all results, and a summary table |

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Instant;

use serde_json::{Value as Json, json};

use quell::complaint::{Complaint, Complaints, Failure};
use quell::nearest;
use quell::study::Change;

mod amplitude_columns;
mod axis;
mod caption;
mod claim;
pub mod claims;
mod disc;
mod effective_friction;
mod entry;
mod failure;
mod figures;
mod laws;
mod measured_friction;
mod printed_formulas;
mod product;
mod report;
mod residual_map;
mod responses;
mod sections;
mod shared;
mod source;
mod stability_map;
mod start;
mod waveforms;
mod write;
mod written;

use figures::FIGURES;
use shared::SharedMeasurements;

pub use entry::{CatalogueEntry, ReproductionOptions, Resolution};
pub use product::{Cell, DataColumn, DataTable, Product};
pub use source::EntrySource;
pub use written::WrittenEntry;

/// The table of claims.
const CLAIMS: CatalogueEntry = CatalogueEntry {
    name: "claims",
    about: "numerical claims and formulas: printed, measured, verdict",
    study: "",
    families: &[],
    make: claims::product,
};

/// All figures and tables that can be reproduced, in the order of the dissertation, followed by the table of claims.
pub const ENTRIES: &[CatalogueEntry] = &with_claims();

const fn with_claims() -> [CatalogueEntry; FIGURES.len() + 1] {
    let mut entries = [CLAIMS; FIGURES.len() + 1];
    let mut index = 0;
    while index < FIGURES.len() {
        entries[index] = FIGURES[index];
        index += 1;
    }
    entries
}

/// The entries with these names, in the order of [`ENTRIES`]; all entries where no name is given.
///
/// # Errors
/// A complaint for each unknown name, listing the known names.
pub fn find(names: &[String]) -> Result<Vec<CatalogueEntry>, Complaints> {
    use quell::complaint::{Fault, Origin};
    let known = || ENTRIES.iter().map(|entry| entry.name);
    let complaints: Vec<Complaint> = names
        .iter()
        .filter(|name| !known().any(|entry| entry == bare(name)))
        .map(|name| {
            let list: Vec<&str> = known().collect();
            Complaint::new(
                Fault::Value,
                "NAME",
                Origin::Whole,
                name.as_str(),
                format!("one of {}", list.join(", ")),
            )
            .suggesting(nearest::word(bare(name), known()))
        })
        .collect();
    if !complaints.is_empty() {
        return Err(complaints.into());
    }
    let selected = |entry: &&CatalogueEntry| {
        names.is_empty() || names.iter().any(|name| bare(name) == entry.name)
    };
    Ok(ENTRIES.iter().filter(selected).copied().collect())
}

/// `figure-2.3` means 2.3.
fn bare(name: &str) -> &str {
    name.strip_prefix("figure-").unwrap_or(name)
}

/// Progress of a reproduction.
#[derive(Clone, Copy, Debug)]
pub enum EntryProgress<'a> {
    /// Work on an entry has begun.
    Begun(&'a CatalogueEntry),
    /// An entry has been written.
    Done(&'a WrittenEntry),
}

/// Result of a reproduction.
#[derive(Clone, Debug)]
pub struct Reproduction {
    /// The entries, in the order of [`ENTRIES`].
    pub written: Vec<WrittenEntry>,
    /// The report: one self-contained page.
    pub report: PathBuf,
    /// The same as a Markdown table.
    pub table: PathBuf,
}

impl Reproduction {
    /// Claims whose verdict is not the expected one.
    pub fn changed(&self) -> Vec<&claims::Claim> {
        self.claims().filter(|claim| !claim.as_expected()).collect()
    }

    /// A warning for each claim whose verdict is not the expected one.
    pub fn warnings(&self) -> Vec<String> {
        let warning = |claim: &claims::Claim| {
            let expected = claim.expected.map_or("nothing on record", |expected| expected.name());
            format!("{}: {}, expected: {expected}", claim.name, claim.verdict)
        };
        self.changed().into_iter().map(warning).collect()
    }

    /// The claims of the entries that were written.
    fn claims(&self) -> impl Iterator<Item = &claims::Claim> {
        self.written.iter().flat_map(|done| &done.product.claims)
    }

    /// How many statements of the dissertation hold, in one sentence; `None` if no claim was measured.
    pub fn summary(&self) -> Option<String> {
        let statements = claims::statements(self.claims());
        (!statements.is_empty()).then(|| claims::summary(&statements))
    }

    /// As JSON, for files written to `directory`.
    pub fn json(&self, directory: &Path, options: &ReproductionOptions) -> Json {
        let entries: Vec<Json> = self.written.iter().map(WrittenEntry::json).collect();
        let changes: Vec<String> = options.changes.iter().map(Change::to_string).collect();
        json!({
            "ok": true,
            "directory": directory.display().to_string(),
            "report": self.report.display().to_string(),
            "table": self.table.display().to_string(),
            "quick": options.resolution.most_points().is_some(),
            "changes": changes,
            "entries": entries,
            "summary": self.summary(),
            "warnings": self.warnings(),
        })
    }
}

/// Computes `entries`, two at a time, and writes them with a report to `directory`, which is created if it does not exist.
/// `progress` is called at the beginning and end of each entry.
///
/// # Errors
/// A complaint where the directory cannot be written, and about changes that do not suit an entry; otherwise the first failure. Files
/// already written are kept.
pub fn run(
    entries: &[CatalogueEntry],
    directory: &Path,
    options: &ReproductionOptions,
    progress: impl Fn(EntryProgress) + Sync,
) -> Result<Reproduction, Failure> {
    check_changes(entries, &options.changes)?;
    write::prepare(directory)?;
    let shared = SharedMeasurements::default();
    let next = AtomicUsize::new(0);
    let done: Mutex<Vec<(usize, Result<WrittenEntry, Failure>)>> = Mutex::new(Vec::new());
    // The claims take longest, so they are started first.
    let mut order: Vec<usize> = (0..entries.len()).collect();
    order.sort_by_key(|index| entries[*index].name != "claims");
    let work = || {
        while let Some(&index) = order.get(next.fetch_add(1, Ordering::Relaxed)) {
            let entry = &entries[index];
            progress(EntryProgress::Begun(entry));
            let outcome = one(entry, directory, options, &shared);
            match &outcome {
                Ok(written) => progress(EntryProgress::Done(written)),
                Err(_) => next.store(entries.len(), Ordering::Relaxed),
            }
            if let Ok(mut done) = done.lock() {
                done.push((index, outcome));
            }
        }
    };
    thread::scope(|scope| {
        for _ in 0..entries.len().min(2) {
            scope.spawn(work);
        }
    });
    let mut done = done.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    done.sort_by_key(|(index, _)| *index);
    let written: Vec<WrittenEntry> =
        done.into_iter().map(|(_, outcome)| outcome).collect::<Result<_, Failure>>()?;
    let page = report::html(&written, options);
    let table = report::markdown(&written, options);
    let report = write::file(directory, "report.html", page.as_bytes())?;
    let table = write::file(directory, "report.md", table.as_bytes())?;
    Ok(Reproduction { written, report, table })
}

fn one(
    entry: &CatalogueEntry,
    directory: &Path,
    options: &ReproductionOptions,
    shared: &SharedMeasurements,
) -> Result<WrittenEntry, Failure> {
    let began = Instant::now();
    let product = entry.at(options, shared)?;
    let own = !options.changes.is_empty();
    // No file with other numbers has the name of a figure of the dissertation.
    let stem = if own { format!("own-{}", entry.stem()) } else { entry.stem() };
    let files = write::product(&product, &stem, directory, options.page)?;
    Ok(WrittenEntry { entry: *entry, own, files, product, elapsed: began.elapsed() })
}

/// Changes suit every entry that is named, and need names: most numbers belong to some figures only.
fn check_changes(entries: &[CatalogueEntry], changes: &[Change]) -> Result<(), Failure> {
    if changes.is_empty() {
        return Ok(());
    }
    let reject = |allowed: String| {
        let given = changes[0].to_string();
        Failure::from(Complaint::option("--set", given, allowed))
    };
    if entries.len() == ENTRIES.len() {
        return Err(reject("the name of a figure next to it, such as 2.4".to_owned()));
    }
    for entry in entries {
        if !entry.has_numbers() {
            let why = format!("figures with numbers of a study, unlike {}", entry.name);
            return Err(reject(why));
        }
        entry.source().with(changes)?.checked()?;
    }
    Ok(())
}
