//! [`PathFolder`] on platforms where folders cannot be held open: a path; every entry is checked immediately before it is used.

use std::fs::{self, File, FileType, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use super::{EntryType, read_at_most};

/// A folder.
#[derive(Debug)]
pub(in crate::store) struct PathFolder {
    path: PathBuf,
}

impl From<FileType> for EntryType {
    fn from(kind: FileType) -> Self {
        if kind.is_symlink() {
            Self::Link
        } else if kind.is_dir() {
            Self::Folder
        } else if kind.is_file() {
            Self::File
        } else {
            Self::Special
        }
    }
}

impl PathFolder {
    /// Opens the folder given by the user.
    pub(in crate::store) fn open(path: &Path) -> io::Result<Self> {
        Ok(Self { path: path.canonicalize()? })
    }

    /// A second handle of the same folder.
    #[cfg(not(unix))]
    pub(super) fn same(&self) -> io::Result<Self> {
        self.itself()?;
        Ok(Self { path: self.path.clone() })
    }

    /// Opens a folder inside.
    pub(in crate::store) fn folder(&self, name: &str) -> io::Result<Self> {
        self.entry(name)?.expected(EntryType::Folder, name)?;
        Ok(Self { path: self.path.join(name) })
    }

    /// Opens a folder inside, and creates it if it is missing.
    pub(in crate::store) fn made(&self, name: &str) -> io::Result<Self> {
        match fs::create_dir(self.path.join(name)) {
            Ok(()) => self.folder(name),
            Err(error) => self.folder(name).map_err(|why| match error.kind() {
                io::ErrorKind::AlreadyExists => why,
                _ => error,
            }),
        }
    }

    /// Type of an entry.
    pub(in crate::store) fn entry(&self, name: &str) -> io::Result<EntryType> {
        self.itself()?;
        Ok(fs::symlink_metadata(self.path.join(name))?.file_type().into())
    }

    /// Every entry with a name in UTF-8; all entries of a store have such names.
    pub(in crate::store) fn entries(&self) -> io::Result<Vec<(String, EntryType)>> {
        self.itself()?;
        let mut found = Vec::new();
        for entry in fs::read_dir(&self.path)? {
            let entry = entry?;
            let Ok(name) = entry.file_name().into_string() else { continue };
            match entry.file_type() {
                Ok(kind) => found.push((name, kind.into())),
                // Removed in the meantime.
                Err(error) if error.kind() == io::ErrorKind::NotFound => {}
                Err(error) => return Err(error),
            }
        }
        Ok(found)
    }

    /// Reads a regular file of at most `most` bytes.
    pub(in crate::store) fn read(&self, name: &str, most: u64) -> io::Result<Vec<u8>> {
        self.entry(name)?.expected(EntryType::File, name)?;
        read_at_most(File::open(self.path.join(name))?, most, name)
    }

    /// Opens a lock file for reading and writing, and creates it if it is missing; it is never written.
    pub(in crate::store) fn lockable(&self, name: &str) -> io::Result<File> {
        match self.entry(name) {
            Ok(entry) => entry.expected(EntryType::File, name)?,
            Err(error) if error.kind() == io::ErrorKind::NotFound => match self.create(name) {
                Err(error) if error.kind() != io::ErrorKind::AlreadyExists => return Err(error),
                _ => {}
            },
            Err(error) => return Err(error),
        }
        OpenOptions::new().read(true).write(true).open(self.path.join(name))
    }

    /// Creates a new file for writing.
    pub(in crate::store) fn create(&self, name: &str) -> io::Result<File> {
        self.itself()?;
        OpenOptions::new().write(true).create_new(true).open(self.path.join(name))
    }

    /// Time of the last modification of an entry.
    pub(in crate::store) fn modified(&self, name: &str) -> io::Result<SystemTime> {
        self.itself()?;
        fs::symlink_metadata(self.path.join(name))?.modified()
    }

    /// Removes a name, and the file itself with its last name.
    pub(in crate::store) fn remove(&self, name: &str) -> io::Result<()> {
        self.itself()?;
        fs::remove_file(self.path.join(name))
    }

    /// Moves a file into another folder under a new name, and replaces a file of that name.
    pub(in crate::store) fn rename(&self, name: &str, to: &Self, new: &str) -> io::Result<()> {
        self.itself()?;
        to.itself()?;
        fs::rename(self.path.join(name), to.path.join(new))
    }

    /// Adds a hard link to a file in another folder; fails if an entry of that name exists.
    pub(in crate::store) fn link(&self, name: &str, to: &Self, new: &str) -> io::Result<()> {
        self.itself()?;
        to.itself()?;
        fs::hard_link(self.path.join(name), to.path.join(new))
    }

    /// Fails unless the path is still a folder: it may have been replaced by a link.
    fn itself(&self) -> io::Result<()> {
        let entry = EntryType::from(fs::symlink_metadata(&self.path)?.file_type());
        entry.expected(EntryType::Folder, &self.path.display().to_string())
    }
}
