//! Datasets as files: CSV, MATLAB (level 5) and NetCDF-3.
//!
//! CSV holds one dataset per file; the other formats hold every dataset of an answer, with units and provenance, in one.
//! The extension of a file decides. Files have no date and no name of a machine, so that equal answers are equal files.

mod content;
mod matlab;
mod names;
mod netcdf;

use serde_json::Value as Json;

use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::dataset::Dataset;

/// A format of tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableFormat {
    /// Text with one row per point.
    Csv,
    /// A MAT-file of level 5.
    Matlab,
    /// The classic format of NetCDF with 64-bit offsets.
    NetCdf,
}

/// The largest array of a file in bytes: MATLAB reads arrays of level 5 below 2 GiB, and sizes in NetCDF-3 have 32 bits.
const LARGEST: usize = (1 << 31) - 1024;

impl TableFormat {
    /// The extensions of table files.
    pub const EXTENSIONS: &'static [&'static str] = &["csv", "mat", "nc"];

    /// The format of an extension in lower case; CSV for a device or pipe, whose name has none.
    pub fn of_extension(extension: &str) -> Option<Self> {
        match extension {
            "csv" | "" => Some(Self::Csv),
            "mat" => Some(Self::Matlab),
            "nc" => Some(Self::NetCdf),
            _ => None,
        }
    }

    /// Whether one file holds every dataset of an answer.
    pub fn holds_all(self) -> bool {
        self != Self::Csv
    }

    /// The contents of the files: one for each dataset, or one for all.
    ///
    /// # Errors
    /// A complaint under `key` about an array that is too large for the format.
    pub fn files(
        self,
        datasets: &[(&'static str, Dataset)],
        key: &'static str,
    ) -> Result<Vec<Vec<u8>>, Failure> {
        if datasets.is_empty() {
            return Ok(Vec::new());
        }
        let arrays =
            datasets.iter().flat_map(|(_, dataset)| dataset.axes().iter().chain(dataset.arrays()));
        let longest = arrays.map(|array| array.values.len()).max().unwrap_or_default();
        if self.holds_all() && longest > LARGEST / size_of::<f64>() {
            let allowed = "arrays of less than 2 GiB in this format; save as .csv";
            let complaint =
                Complaint::new(Fault::Value, key, Origin::Argument(key), Json::Null, allowed);
            return Err(complaint.into());
        }
        Ok(match self {
            Self::Csv => datasets.iter().map(|(_, dataset)| dataset.csv().into_bytes()).collect(),
            Self::Matlab => vec![matlab::file(datasets)],
            Self::NetCdf => vec![netcdf::file(datasets)],
        })
    }
}
