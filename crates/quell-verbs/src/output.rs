//! Output files: checked before the computation starts, and either complete or absent afterwards.
//!
//! [`Output::prepare`] verifies that the path can be written by creating and removing a temporary file in its folder.
//! [`Output::write`] writes a complete temporary file and renames it, so that no reader ever sees a partial file. Devices and
//! pipes, which cannot be replaced, are written directly.
//!
//! A replaced file keeps its permissions; a new one has the default permissions of the process. Files from which the study is
//! read are rejected as outputs ([`Inputs`]).

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{PoisonError, RwLock, RwLockReadGuard, TryLockError};
use std::thread;
use std::time::{Duration, Instant};

use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::input::Inputs;

/// Held for reading by every thread while one of its files is partially written.
static WRITING: RwLock<()> = RwLock::new(());

/// Marks a file as partially written until the guard is dropped.
pub fn writing() -> RwLockReadGuard<'static, ()> {
    WRITING.read().unwrap_or_else(PoisonError::into_inner)
}

/// Waits at most `patience` until no file is partially written, and prevents new files from being started: for a process that
/// is about to exit. Returns whether that succeeded.
pub fn close(patience: Duration) -> bool {
    let begun = Instant::now();
    loop {
        match WRITING.try_write() {
            Ok(guard) => {
                // Any thread that writes from now on blocks until the process exits.
                std::mem::forget(guard);
                return true;
            }
            Err(TryLockError::Poisoned(_)) => return true,
            Err(TryLockError::WouldBlock) if begun.elapsed() > patience => return false,
            Err(TryLockError::WouldBlock) => thread::sleep(Duration::from_millis(5)),
        }
    }
}

/// A path at which a file can be written.
#[derive(Debug)]
pub struct Output {
    /// The path as given by the user.
    given: PathBuf,
    /// The path with links resolved.
    path: PathBuf,
    /// A device or pipe, opened only once: the reader of a pipe sees its end when it is closed.
    special: Option<File>,
}

impl Output {
    /// Checks that `path` can be written, has one of the `extensions`, and is not one of the `inputs`.
    ///
    /// # Errors
    /// A complaint that names `option` and the path.
    pub fn prepare(
        path: &Path,
        option: &'static str,
        extensions: &[&str],
        inputs: &Inputs,
    ) -> Result<Self, Box<Complaint>> {
        let complaint = |allowed: String| {
            let given = path.display().to_string();
            Box::new(Complaint::new(Fault::Path, option, Origin::Argument(option), given, allowed))
        };
        if names_a_folder(path) {
            return Err(complaint("a file, not a folder: without / at its end".to_owned()));
        }
        let special = fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir());
        let extension =
            path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
        if !special && !extensions.contains(&extension.to_ascii_lowercase().as_str()) {
            let list: Vec<String> = extensions.iter().map(|name| format!(".{name}")).collect();
            return Err(complaint(format!("the file name must end in {}", list.join(" or "))));
        }
        if let Some(input) = inputs.at(path) {
            return Err(complaint(input.refusal()));
        }
        let mut output = Self { given: path.to_owned(), path: path.to_owned(), special: None };
        output.probe(special).map_err(|error| complaint(format!("cannot be written: {error}")))?;
        Ok(output)
    }

    /// As [`Output::prepare`], for a name that the user has not given: a link, a device or a pipe of this name belongs to
    /// someone else, and is not followed, opened or replaced.
    ///
    /// # Errors
    /// A complaint that names `option` and the path.
    pub fn prepare_plain(
        path: &Path,
        option: &'static str,
        extensions: &[&str],
        inputs: &Inputs,
    ) -> Result<Self, Box<Complaint>> {
        if fs::symlink_metadata(path).is_ok_and(|found| !found.is_file()) {
            let (given, origin) = (path.display().to_string(), Origin::Argument(option));
            let allowed =
                "already exists and is not a regular file; remove it, or choose another name";
            return Err(Box::new(Complaint::new(Fault::Path, option, origin, given, allowed)));
        }
        Self::prepare(path, option, extensions, inputs)
    }

    /// A second file in the same folder: `name.csv` → `name_part.csv`. A device or pipe receives both files.
    ///
    /// # Errors
    /// A complaint that names `option` and the path.
    pub fn sibling(
        &self,
        part: &str,
        option: &'static str,
        inputs: &Inputs,
    ) -> Result<Self, Box<Complaint>> {
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
        Self::prepare_plain(&path, option, &[extension.to_ascii_lowercase().as_str()], inputs)
    }

    /// The extension in lower case.
    pub fn extension(&self) -> String {
        let extension = self.given.extension().and_then(|extension| extension.to_str());
        extension.unwrap_or_default().to_ascii_lowercase()
    }

    /// Writes the complete file.
    ///
    /// # Errors
    /// [`Failure::Failed`] with the path; no partial file remains.
    pub fn write(self, bytes: &[u8]) -> Result<PathBuf, Failure> {
        let written = if let Some(mut file) = self.special.as_ref() {
            file.write_all(bytes).and_then(|()| file.flush())
        } else {
            let _writing = writing();
            self.temporary().and_then(|(temporary, file)| {
                let written = keep_permissions(&self.path, &file)
                    .and_then(|()| fill(file, bytes))
                    .and_then(|()| fs::rename(&temporary, &self.path));
                if written.is_err() {
                    // If removing the file fails too, nothing else can be done.
                    let _ = fs::remove_file(&temporary);
                }
                written
            })
        };
        written.map(|()| self.given.clone()).map_err(|error| Failure::Failed {
            key: self.given.display().to_string(),
            why: format!("cannot be written: {error}").into(),
        })
    }

    /// Checks that [`Output::write`] will be able to write.
    fn probe(&mut self, special: bool) -> io::Result<()> {
        if special {
            self.special = Some(OpenOptions::new().write(true).open(&self.path)?);
            return Ok(());
        }
        if self.path.is_dir() {
            return Err(io::Error::other("the path is a directory"));
        }
        if self.path.exists() {
            self.path = self.path.canonicalize()?;
            OpenOptions::new().append(true).open(&self.path)?;
        }
        let _writing = writing();
        fs::remove_file(self.temporary()?.0)
    }

    /// Creates a temporary file in the folder of the output. No other thread or process writes to it; names left by killed
    /// processes are skipped.
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

/// Whether a path can name nothing but a folder: `x.svg/` and `x.svg/.`, whose last part has the extension of a file.
fn names_a_folder(path: &Path) -> bool {
    let text = path.to_string_lossy();
    let text = text.strip_suffix('.').unwrap_or(&text);
    text.ends_with(std::path::is_separator)
}

/// Gives a new, still empty file the permissions of the file that it will replace, if any.
fn keep_permissions(replaced: &Path, file: &File) -> io::Result<()> {
    match fs::metadata(replaced) {
        Ok(found) => file.set_permissions(found.permissions()),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        Err(error) => Err(error),
    }
}

/// Writes a new file completely and syncs it to disk.
///
/// # Errors
/// Those of the file.
pub fn fill(mut file: File, bytes: &[u8]) -> io::Result<()> {
    file.write_all(bytes)?;
    file.sync_all()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Threads that write to the same path do not interfere: the file is a complete one of the last thread.
    #[test]
    fn concurrent_writers_of_a_path_leave_one_complete_file() {
        let folder = tempfile::tempdir().expect("folder");
        let path = folder.path().join("same.csv");
        let texts: Vec<String> = (0..8).map(|number| number.to_string().repeat(100_000)).collect();
        thread::scope(|scope| {
            for text in &texts {
                scope.spawn(|| {
                    let output = Output::prepare(&path, "--save", &["csv"], &Inputs::NONE)
                        .expect("writable");
                    output.write(text.as_bytes()).expect("written");
                });
            }
        });
        let written = fs::read_to_string(&path).expect("there");
        assert!(texts.contains(&written));
        assert_eq!(folder.path().read_dir().expect("folder").count(), 1);
    }
}
