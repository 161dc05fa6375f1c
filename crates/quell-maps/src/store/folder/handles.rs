//! [`HandleFolder`] on Unix: an open folder, and access to its entries relative to it.

use std::ffi::OsString;
use std::fs::File;
use std::io;
use std::os::fd::OwnedFd;
use std::os::unix::ffi::OsStringExt;
use std::path::Path;
use std::time::SystemTime;

use rustix::fs::{
    AtFlags, CWD, Dir, FileType, Mode, OFlags, fstat, linkat, mkdirat, openat, renameat, statat,
    unlinkat,
};

use super::{EntryType, read_at_most};

/// Permissions of a new folder and of a new file, before the umask of the process is applied.
const FOLDER_MODE: Mode = Mode::from_bits_retain(0o777);
const FILE_MODE: Mode = Mode::from_bits_retain(0o666);

/// A folder that is held open.
#[derive(Debug)]
pub(in crate::store) struct HandleFolder {
    handle: OwnedFd,
}

impl From<FileType> for EntryType {
    fn from(kind: FileType) -> Self {
        match kind {
            FileType::RegularFile => Self::File,
            FileType::Directory => Self::Folder,
            FileType::Symlink => Self::Link,
            _ => Self::Special,
        }
    }
}

impl HandleFolder {
    /// Opens the folder given by the user.
    pub(in crate::store) fn open(path: &Path) -> io::Result<Self> {
        let flags = OFlags::RDONLY | OFlags::DIRECTORY | OFlags::CLOEXEC;
        Ok(Self { handle: openat(CWD, path, flags, Mode::empty())? })
    }

    /// A second handle of the same folder.
    pub(super) fn same(&self) -> io::Result<Self> {
        Ok(Self { handle: self.handle.try_clone()? })
    }

    /// Opens a folder inside.
    pub(in crate::store) fn folder(&self, name: &str) -> io::Result<Self> {
        let flags = OFlags::RDONLY | OFlags::DIRECTORY | OFlags::NOFOLLOW | OFlags::CLOEXEC;
        match openat(&self.handle, name, flags, Mode::empty()) {
            Ok(handle) => Ok(Self { handle }),
            Err(error) => {
                // Report the type of the entry if it is not a folder.
                self.entry(name)?.expected(EntryType::Folder, name)?;
                Err(error.into())
            }
        }
    }

    /// Opens a folder inside, and creates it if it is missing.
    pub(in crate::store) fn made(&self, name: &str) -> io::Result<Self> {
        match mkdirat(&self.handle, name, FOLDER_MODE) {
            Ok(()) | Err(rustix::io::Errno::EXIST) => self.folder(name),
            // An existing folder may be readable even if no folder can be created.
            Err(error) => self.folder(name).map_err(|_| error.into()),
        }
    }

    /// Type of an entry.
    pub(in crate::store) fn entry(&self, name: &str) -> io::Result<EntryType> {
        let found = statat(&self.handle, name, AtFlags::SYMLINK_NOFOLLOW)?;
        Ok(FileType::from_raw_mode(found.st_mode).into())
    }

    /// Every entry with a name in UTF-8; all entries of a store have such names.
    pub(in crate::store) fn entries(&self) -> io::Result<Vec<(String, EntryType)>> {
        let mut found = Vec::new();
        for entry in Dir::read_from(&self.handle)? {
            let entry = entry?;
            let name = OsString::from_vec(entry.file_name().to_bytes().to_vec());
            let Ok(name) = name.into_string() else { continue };
            if name == "." || name == ".." {
                continue;
            }
            let kind = match entry.file_type() {
                FileType::Unknown => match self.entry(&name) {
                    Ok(kind) => kind,
                    // Removed in the meantime.
                    Err(error) if error.kind() == io::ErrorKind::NotFound => continue,
                    Err(error) => return Err(error),
                },
                kind => kind.into(),
            };
            found.push((name, kind));
        }
        Ok(found)
    }

    /// Reads a regular file of at most `most` bytes.
    pub(in crate::store) fn read(&self, name: &str, most: u64) -> io::Result<Vec<u8>> {
        let file = self.regular(name, OFlags::RDONLY)?;
        read_at_most(file, most, name)
    }

    /// Opens a lock file for reading and writing, and creates it if it is missing; it is never written.
    pub(in crate::store) fn lockable(&self, name: &str) -> io::Result<File> {
        self.regular(name, OFlags::RDWR | OFlags::CREATE)
    }

    /// Opens a regular file; fails for any other type.
    fn regular(&self, name: &str, flags: OFlags) -> io::Result<File> {
        match self.entry(name) {
            Ok(entry) => entry.expected(EntryType::File, name)?,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            Err(error) => return Err(error),
        }
        let flags = flags | OFlags::NOFOLLOW | OFlags::NONBLOCK | OFlags::NOCTTY | OFlags::CLOEXEC;
        let handle = openat(&self.handle, name, flags, FILE_MODE)?;
        let found = fstat(&handle)?;
        EntryType::from(FileType::from_raw_mode(found.st_mode)).expected(EntryType::File, name)?;
        Ok(handle.into())
    }

    /// Creates a new file for writing.
    pub(in crate::store) fn create(&self, name: &str) -> io::Result<File> {
        let flags = OFlags::WRONLY | OFlags::CREATE | OFlags::EXCL | OFlags::CLOEXEC;
        Ok(openat(&self.handle, name, flags, FILE_MODE)?.into())
    }

    /// Time of the last modification of an entry.
    pub(in crate::store) fn modified(&self, name: &str) -> io::Result<SystemTime> {
        File::from(openat(
            &self.handle,
            name,
            OFlags::RDONLY | OFlags::NOFOLLOW | OFlags::NONBLOCK | OFlags::CLOEXEC,
            Mode::empty(),
        )?)
        .metadata()?
        .modified()
    }

    /// Removes a name, and the file itself with its last name.
    pub(in crate::store) fn remove(&self, name: &str) -> io::Result<()> {
        Ok(unlinkat(&self.handle, name, AtFlags::empty())?)
    }

    /// Moves a file into another folder under a new name, and replaces a file of that name.
    pub(in crate::store) fn rename(&self, name: &str, to: &Self, new: &str) -> io::Result<()> {
        Ok(renameat(&self.handle, name, &to.handle, new)?)
    }

    /// Adds a hard link to a file in another folder; fails if an entry of that name exists.
    pub(in crate::store) fn link(&self, name: &str, to: &Self, new: &str) -> io::Result<()> {
        Ok(linkat(&self.handle, name, &to.handle, new, AtFlags::empty())?)
    }
}
