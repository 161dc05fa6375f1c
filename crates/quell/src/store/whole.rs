//! Files that are whole or not there.
//!
//! A file is written under a name of its own in a folder for unfinished ones, brought down to
//! the disk, and renamed into its place: whoever looks, at whatever moment, sees the old file,
//! the new one, or none. A process that is killed leaves at most an unfinished file there, which
//! the next one takes away.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU64, Ordering};

/// Where files lie until they are whole.
#[derive(Debug)]
pub(super) struct Unfinished {
    folder: PathBuf,
    count: AtomicU64,
}

impl Unfinished {
    /// In this folder, which is made where it is not there.
    pub(super) fn new(folder: PathBuf) -> io::Result<Self> {
        fs::create_dir_all(&folder)?;
        Ok(Self { folder, count: AtomicU64::new(0) })
    }

    /// Takes away what a killed process left; only for who holds the lock.
    pub(super) fn clear(&self) -> io::Result<()> {
        for entry in fs::read_dir(&self.folder)? {
            fs::remove_file(entry?.path())?;
        }
        Ok(())
    }

    /// Writes a whole file; its folder is made where it is not there.
    pub(super) fn write(&self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        let number = self.count.fetch_add(1, Ordering::Relaxed);
        let temporary = self.folder.join(format!("{}.{number}", process::id()));
        let written = fill(&temporary, bytes).and_then(|()| put(&temporary, path));
        if written.is_err() {
            // Nothing else to do about a file that cannot be removed either.
            let _ = fs::remove_file(&temporary);
        }
        written
    }
}

fn fill(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file: File = OpenOptions::new().write(true).create(true).truncate(true).open(path)?;
    file.write_all(bytes)?;
    file.sync_all()
}

fn put(temporary: &Path, path: &Path) -> io::Result<()> {
    match fs::rename(temporary, path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            if let Some(folder) = path.parent() {
                fs::create_dir_all(folder)?;
            }
            fs::rename(temporary, path)
        }
        renamed => renamed,
    }
}
