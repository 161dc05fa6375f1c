//! Matrices in files of their own: `mass = { file = "M.mtx" }`.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use quell_numerics::matrix::Matrix;

use super::matrix_market;
use crate::study::data_file;

/// What the file must be.
const WHAT: &str = "a Matrix Market file";

/// The largest file in MiB: a dense matrix of the largest number of coordinates, with some twenty characters an entry.
const LARGEST: u64 = 128;

/// A file of a matrix that has been read.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MatrixFile {
    path: PathBuf,
    matrix: Matrix,
}

impl MatrixFile {
    /// The file.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// What identifies its entries.
    pub(super) fn settings(&self, index: usize) -> (String, String) {
        let entries = self.matrix.as_slice();
        let sum = data_file::checksum(entries);
        (format!("system.file[{index}]"), format!("{} entries, {sum:016x}", entries.len()))
    }
}

/// The files of matrices of a study: those that are known from before a change are not read again.
#[derive(Debug)]
pub(super) struct MatrixFiles<'a> {
    folder: &'a Path,
    known: &'a [Arc<MatrixFile>],
    found: Vec<Arc<MatrixFile>>,
}

impl<'a> MatrixFiles<'a> {
    /// Files in a folder.
    pub(super) fn new(folder: &'a Path, known: &'a [Arc<MatrixFile>]) -> Self {
        Self { folder, known, found: Vec::new() }
    }

    /// The files that the study names.
    pub(super) fn into_found(self) -> Vec<Arc<MatrixFile>> {
        self.found
    }

    /// The matrix of `n` rows and columns in a file.
    ///
    /// # Errors
    /// Why it cannot be read, or the line that is wrong.
    pub(super) fn matrix(&mut self, name: &str, n: usize) -> Result<Matrix, String> {
        let path = self.folder.join(name);
        let is_same = |known: &&Arc<MatrixFile>| known.path == path && known.matrix.rows() == n;
        let known = self.known.iter().chain(&self.found).find(is_same);
        let file = if let Some(known) = known {
            Arc::clone(known)
        } else {
            let text = data_file::text_up_to(&path, WHAT, LARGEST)?;
            let matrix = matrix_market::parse(&text, n)?;
            Arc::new(MatrixFile { path, matrix })
        };
        let matrix = file.matrix.clone();
        self.found.push(file);
        Ok(matrix)
    }
}
