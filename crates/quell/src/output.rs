//! Output files: tried before the work begins, whole or not there afterwards.
//!
//! [`Output::prepare`] proves that the path can be written by making and removing a file
//! beside it. [`Output::write`] writes such a file in full, then renames it, so that nobody
//! ever sees half a file. Devices and pipes, which cannot be replaced, are written straight.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::complaint::{Complaint, Failure, Fault, Origin};

/// A place where a file can be written.
#[derive(Debug)]
pub struct Output {
    /// The path as it was given.
    given: PathBuf,
    /// The file itself, links followed.
    path: PathBuf,
    /// A device or pipe, opened once: whoever reads a pipe sees its end when it is closed.
    special: Option<File>,
}

impl Output {
    /// Checks that `path` can be written and has one of the `extensions`.
    ///
    /// # Errors
    /// A complaint that names `option` and the path.
    pub fn prepare(
        path: &Path,
        option: &'static str,
        extensions: &[&str],
    ) -> Result<Self, Box<Complaint>> {
        let complaint = |allowed: String| {
            let given = path.display().to_string();
            Box::new(Complaint::new(Fault::Path, option, Origin::Argument(option), given, allowed))
        };
        let special = fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir());
        let extension =
            path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
        if !special && !extensions.contains(&extension.to_ascii_lowercase().as_str()) {
            let list: Vec<String> = extensions.iter().map(|name| format!(".{name}")).collect();
            return Err(complaint(format!("the file name must end in {}", list.join(" or "))));
        }
        let mut output = Self { given: path.to_owned(), path: path.to_owned(), special: None };
        output.probe(special).map_err(|error| complaint(format!("cannot be written: {error}")))?;
        Ok(output)
    }

    /// Another file beside this one: `name.csv` → `name_part.csv`. Beside a device or pipe there is none: it takes both.
    ///
    /// # Errors
    /// A complaint that names `option` and the path.
    pub fn beside(&self, part: &str, option: &'static str) -> Result<Self, Box<Complaint>> {
        if let Some(file) = &self.special {
            let file = file.try_clone().map_err(|error| {
                let given = self.given.display().to_string();
                let allowed = format!("cannot be written: {error}");
                Complaint::new(Fault::Path, option, Origin::Argument(option), given, allowed)
            })?;
            let (given, path) = (self.given.clone(), self.path.clone());
            return Ok(Self { given, path, special: Some(file) });
        }
        let stem = self.given.file_stem().and_then(|stem| stem.to_str()).unwrap_or("quell");
        let extension =
            self.given.extension().and_then(|extension| extension.to_str()).unwrap_or("csv");
        let path = self.given.with_file_name(format!("{stem}_{part}.{extension}"));
        Self::prepare(&path, option, &[extension.to_ascii_lowercase().as_str()])
    }

    /// The extension in lower case.
    pub fn extension(&self) -> String {
        let extension = self.given.extension().and_then(|extension| extension.to_str());
        extension.unwrap_or_default().to_ascii_lowercase()
    }

    /// Writes the whole file.
    ///
    /// # Errors
    /// [`Failure::Failed`] with the path; nothing is left behind then.
    pub fn write(self, bytes: &[u8]) -> Result<PathBuf, Failure> {
        let written = if let Some(mut file) = self.special.as_ref() {
            file.write_all(bytes).and_then(|()| file.flush())
        } else {
            self.temporary().and_then(|(temporary, file)| {
                let written = fill(file, bytes).and_then(|()| fs::rename(&temporary, &self.path));
                if written.is_err() {
                    // Nothing else to do about a file that cannot be removed either.
                    let _ = fs::remove_file(&temporary);
                }
                written
            })
        };
        written.map(|()| self.given.clone()).map_err(|error| Failure::Failed {
            key: self.given.display().to_string(),
            why: format!("cannot be written: {error}"),
        })
    }

    /// Tries what [`Output::write`] will do.
    fn probe(&mut self, special: bool) -> io::Result<()> {
        if special {
            self.special = Some(OpenOptions::new().write(true).open(&self.path)?);
            return Ok(());
        }
        if self.path.is_dir() {
            return Err(io::Error::other("it is a directory"));
        }
        if self.path.exists() {
            self.path = self.path.canonicalize()?;
            OpenOptions::new().append(true).open(&self.path)?;
        }
        fs::remove_file(self.temporary()?.0)
    }

    /// A new file beside the one to be written. No other thread writes it, nor another process, and names that a killed one has
    /// left are passed over.
    fn temporary(&self) -> io::Result<(PathBuf, File)> {
        static FILES: AtomicU64 = AtomicU64::new(0);
        let name = self.path.file_name().map(|name| name.to_string_lossy().into_owned());
        let name = name.unwrap_or_default();
        loop {
            let number = FILES.fetch_add(1, Ordering::Relaxed);
            let path = self.path.with_file_name(format!(".{name}.{}.{number}.part", process::id()));
            match OpenOptions::new().write(true).create_new(true).open(&path) {
                Err(why) if why.kind() == io::ErrorKind::AlreadyExists => {}
                Err(why) => return Err(why),
                Ok(file) => return Ok((path, file)),
            }
        }
    }
}

/// Writes a new file in full, down to the disk.
fn fill(mut file: File, bytes: &[u8]) -> io::Result<()> {
    file.write_all(bytes)?;
    file.sync_all()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Threads that write one path at once do not disturb each other: one of them is last, and its file is whole.
    #[test]
    fn writers_of_one_path_leave_one_whole_file() {
        let folder = tempfile::tempdir().expect("folder");
        let path = folder.path().join("same.csv");
        let texts: Vec<String> = (0..8).map(|it| it.to_string().repeat(100_000)).collect();
        std::thread::scope(|scope| {
            for text in &texts {
                scope.spawn(|| {
                    let output = Output::prepare(&path, "--save", &["csv"]).expect("writable");
                    output.write(text.as_bytes()).expect("written");
                });
            }
        });
        let written = fs::read_to_string(&path).expect("there");
        assert!(texts.contains(&written));
        assert_eq!(folder.path().read_dir().expect("folder").count(), 1);
    }
}
