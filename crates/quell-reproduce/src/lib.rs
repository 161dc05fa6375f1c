//! `reproduce`: reproduction of every figure and table of the dissertation with its data, and a table of its claims.
//!
//! Each entry of [`ENTRIES`] is one figure or table: a name, a study file with its parameters, and a function that
//! computes a [`Product`] from them. Another figure needs one more line there.
//!
//! | file | content |
//! |---|---|
//! | `source`, `axis` | study files of the entries, and the values of their axes |
//! | `amplitude_columns`, `shared` | measurements needed by several entries, made once |
//! | `product`, `write` | figures, data tables, and their files |
//! | `laws`, `waveforms`, `effective_friction`, `stability_map` | figures of friction laws, waveforms and averaging |
//! | `responses`, `sections`, `efficiency_map`, `measured_friction` | figures of simulated responses |
//! | `caption` | names and numbers in captions |
//! | `disc` | tables and figures of chapter 5 |
//! | `printed_formulas` | formulas as printed in the dissertation, correct or not |
//! | `claim` | a claim, its verdict and its expected verdict |
//! | `claims` | measurement of the claims, and the verdict on record of each of them |
//! | `report` | the page with all results, and a summary table |

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::{Value as Json, json};

use quell::complaint::{Complaint, Complaints, Failure};
use quell::study::suggest;

mod amplitude_columns;
mod axis;
mod caption;
mod claim;
pub mod claims;
mod disc;
mod effective_friction;
mod efficiency_map;
mod failure;
mod laws;
mod measured_friction;
mod printed_formulas;
mod product;
mod report;
mod responses;
mod sections;
mod shared;
mod source;
mod stability_map;
mod waveforms;
mod write;

use shared::SharedMeasurements;

pub use product::{Cell, DataColumn, DataTable, Product};
pub use source::EntrySource;

/// One figure or table of the dissertation.
#[derive(Clone, Copy)]
pub struct CatalogueEntry {
    /// Name on the command line: `2.3`, `claims`.
    pub name: &'static str,
    /// Its content in one line.
    pub about: &'static str,
    /// Text of its study file; empty for the table of claims, which has none.
    study: &'static str,
    make: fn(&EntrySource) -> Result<Product, Failure>,
}

/// A figure with its parameters in `studies/figure-NAME.toml`.
macro_rules! figure {
    ($name:literal, $about:literal, $make:path) => {
        CatalogueEntry {
            name: $name,
            about: $about,
            study: include_str!(concat!("../studies/figure-", $name, ".toml")),
            make: $make,
        }
    };
}

/// A table with its parameters in `studies/NAME.toml`.
macro_rules! table {
    ($name:literal, $about:literal, $make:path) => {
        CatalogueEntry {
            name: $name,
            about: $about,
            study: include_str!(concat!("../studies/", $name, ".toml")),
            make: $make,
        }
    };
}

/// All figures and tables that can be reproduced, in the order of the dissertation.
pub const ENTRIES: &[CatalogueEntry] = &[
    figure!("2.2", "Stribeck and decreasing friction law", laws::figure),
    figure!("2.3", "responses, Stribeck law, sinusoidal tangential dither", responses::figure),
    figure!("2.4", "effective friction, Stribeck law", effective_friction::figure),
    figure!("2.5", "effective friction, decreasing law", effective_friction::figure),
    figure!("2.6", "stability map, Stribeck law", stability_map::single),
    figure!("2.7", "stability map, decreasing law", stability_map::single),
    figure!(
        "2.8",
        "residual vibration, Stribeck law, four belt velocities",
        efficiency_map::velocities
    ),
    figure!(
        "2.9",
        "residual vibration, decreasing law, four belt velocities",
        efficiency_map::velocities
    ),
    figure!("2.10", "responses and sections, decreasing law, sine, v₀ = 1", sections::figure),
    figure!("2.11", "responses and sections, decreasing law, sine, v₀ = 1.5", sections::figure),
    figure!("3.2", "dither waveforms and their integrals", waveforms::figure),
    figure!("3.3", "effective friction, Stribeck law, three waveforms", effective_friction::three),
    figure!(
        "3.4",
        "effective friction, decreasing law, three waveforms",
        effective_friction::three
    ),
    figure!("3.5", "stability maps, Stribeck law, three waveforms", stability_map::three),
    figure!("3.6", "stability maps, decreasing law, three waveforms", stability_map::three),
    figure!("3.7", "responses, Stribeck law, sinusoidal tangential dither", responses::figure),
    figure!("3.8", "responses, Stribeck law, triangular tangential dither", responses::figure),
    figure!("3.9", "responses, Stribeck law, square tangential dither", responses::figure),
    figure!("3.10", "residual vibration, Stribeck law, three waveforms", efficiency_map::waveforms),
    figure!(
        "3.11",
        "residual vibration, decreasing law, three waveforms",
        efficiency_map::waveforms
    ),
    figure!("3.12", "responses and sections, decreasing law, triangle", sections::figure),
    figure!("3.13", "responses and sections, decreasing law, square", sections::figure),
    figure!("4.2", "Stribeck and decreasing friction law", laws::figure),
    figure!("4.3", "responses, Stribeck law, sinusoidal normal dither", responses::figure),
    figure!("4.4", "responses, decreasing law, sinusoidal normal dither", responses::figure),
    figure!("4.5", "effective friction from simulation, Stribeck law", measured_friction::figure),
    figure!("4.6", "effective friction from simulation, decreasing law", measured_friction::figure),
    figure!("4.7", "stability maps, Stribeck law, normal dither", stability_map::three),
    figure!("4.8", "stability maps, decreasing law, normal dither", stability_map::three),
    figure!("4.9", "residual vibration, Stribeck law, normal dither", efficiency_map::single),
    figure!("4.10", "residual vibration, decreasing law, normal dither", efficiency_map::single),
    figure!(
        "4.11",
        "responses and sections, normal dither, square and sine",
        sections::square_and_sine
    ),
    table!("table-5.1", "speeds at which waves of the disc meet", disc::undithered),
    table!("table-5.2", "speeds at which dither makes waves of the disc meet", disc::induced),
    figure!("5.2", "modes of the annular plate", disc::modes),
    figure!("5.3", "growth of the disc, N = (1, 2), no dither", disc::sizes),
    figure!("5.4", "growth of the disc, N = (1, 5), no dither", disc::sizes),
    figure!("5.5", "growth of the disc, N = (2, 5), no dither", disc::sizes),
    figure!("5.6", "responses that grow, stay, decay", disc::responses),
    figure!("5.7", "growth of the disc, normal dither, ξ = 0", disc::maps),
    figure!("5.8", "growth of the disc, normal dither, ξ = 10⁻³", disc::maps),
    figure!("5.9", "growth of the disc, tangential dither, m = c = k = 0.1", disc::maps),
    figure!("5.10", "growth of the disc, tangential dither, m = c = k = 0.2", disc::maps),
    figure!("5.11", "growth of the disc, tangential dither, m = c = k = 0.3", disc::maps),
    figure!("5.12", "growth of the disc, tangential dither, ξ = 0", disc::maps),
    figure!("5.13", "growth of the disc, tangential dither, ξ = 10⁻⁵", disc::maps),
    figure!("5.14", "growth of the disc, tangential dither, ξ = 10⁻⁴", disc::maps),
    figure!("5.15", "growth of the disc, tangential dither, ξ = 10⁻³", disc::maps),
    CatalogueEntry {
        name: "claims",
        about: "numerical claims and formulas: printed, measured, verdict",
        study: "",
        make: claims::product,
    },
];

impl CatalogueEntry {
    /// Computes the figure or table.
    ///
    /// # Errors
    /// [`Failure`] if a run stops or an average has no value.
    pub fn product(&self) -> Result<Product, Failure> {
        (self.make)(&self.source())
    }

    /// The same with at most `most_points` points along each axis of its sweeps.
    ///
    /// # Errors
    /// As [`CatalogueEntry::product`].
    pub fn coarse_product(&self, most_points: usize) -> Result<Product, Failure> {
        (self.make)(&EntrySource { most_points: Some(most_points), ..self.source() })
    }

    /// The product at this resolution, using the shared measurements of the run.
    fn at(&self, resolution: Resolution, shared: &SharedMeasurements) -> Result<Product, Failure> {
        let most_points = match resolution {
            Resolution::Full => None,
            Resolution::Quick => Some(QUICK_POINTS),
        };
        (self.make)(&EntrySource { most_points, shared: shared.clone(), ..self.source() })
    }

    /// Its name and study file.
    pub fn source(&self) -> EntrySource {
        EntrySource {
            name: self.name,
            about: self.about,
            text: self.study,
            most_points: None,
            shared: SharedMeasurements::default(),
        }
    }

    /// Name of its files, without extension.
    pub fn stem(&self) -> String {
        match self.name.chars().next() {
            Some(first) if first.is_ascii_digit() => format!("figure-{}", self.name),
            _ => self.name.to_owned(),
        }
    }
}

impl fmt::Debug for CatalogueEntry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("CatalogueEntry")
            .field("name", &self.name)
            .field("about", &self.about)
            .finish_non_exhaustive()
    }
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
            .suggesting(suggest::word(bare(name), known()))
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

/// An entry that has been written to files.
#[derive(Clone, Debug)]
pub struct WrittenEntry {
    /// The entry.
    pub entry: CatalogueEntry,
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

/// Resolution of the grids of the figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Resolution {
    /// The resolution of the study files.
    #[default]
    Full,
    /// At most a few points along each axis of a map. Claims are still measured in full.
    Quick,
}

/// Largest number of points along an axis of a map at quick resolution.
const QUICK_POINTS: usize = 12;

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
        let claims = self.written.iter().flat_map(|done| &done.product.claims);
        claims.filter(|claim| !claim.as_expected()).collect()
    }

    /// A warning for each claim whose verdict is not the expected one.
    pub fn warnings(&self) -> Vec<String> {
        let warning = |claim: &claims::Claim| {
            let expected = claim.expected.map_or("nothing on record", |expected| expected.name());
            format!("{}: {}, expected: {expected}", claim.name, claim.verdict)
        };
        self.changed().into_iter().map(warning).collect()
    }

    /// As JSON, for files written to `directory`.
    pub fn json(&self, directory: &Path, resolution: Resolution) -> Json {
        let entries: Vec<Json> = self.written.iter().map(WrittenEntry::json).collect();
        json!({
            "ok": true,
            "directory": directory.display().to_string(),
            "report": self.report.display().to_string(),
            "table": self.table.display().to_string(),
            "quick": resolution == Resolution::Quick,
            "entries": entries,
            "warnings": self.warnings(),
        })
    }
}

/// Computes `entries`, two at a time, and writes them with a report to `directory`, which is created if it does not exist.
/// `progress` is called at the beginning and end of each entry.
///
/// # Errors
/// A complaint where the directory cannot be written, otherwise the first failure. Files already written are kept.
pub fn run(
    entries: &[CatalogueEntry],
    directory: &Path,
    resolution: Resolution,
    progress: impl Fn(EntryProgress) + Sync,
) -> Result<Reproduction, Failure> {
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
            let outcome = one(entry, directory, resolution, &shared);
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
    let page = report::html(&written, resolution);
    let table = report::markdown(&written, resolution);
    let report = write::file(directory, "report.html", page.as_bytes())?;
    let table = write::file(directory, "report.md", table.as_bytes())?;
    Ok(Reproduction { written, report, table })
}

fn one(
    entry: &CatalogueEntry,
    directory: &Path,
    resolution: Resolution,
    shared: &SharedMeasurements,
) -> Result<WrittenEntry, Failure> {
    let began = Instant::now();
    let product = entry.at(resolution, shared)?;
    let files = write::product(&product, &entry.stem(), directory)?;
    Ok(WrittenEntry { entry: *entry, files, product, elapsed: began.elapsed() })
}
