//! Folders of a store with untrusted content: no symbolic link inside is ever followed, and only regular files are opened.
//!
//! The folder given by the user is opened as it is, links included. Everything below it is reached from there, one name at a
//! time. On Unix each folder is held open and its entries are accessed relative to the open folder (`openat` and related
//! calls, without following links), so that replacing a folder by a link in the meantime has no effect. On other platforms
//! the type of every entry is checked immediately before it is used.
//!
//! Opening a named pipe or a device in place of a file would block the process, or worse. The type of an entry is therefore
//! checked before it is opened, it is opened without blocking, and its type is checked again.

#[cfg(unix)]
mod handles;
#[cfg(any(not(unix), test))]
mod paths;

use std::fs::File;
use std::io::{self, Read};

#[cfg(unix)]
pub(super) use handles::HandleFolder as Folder;
#[cfg(not(unix))]
pub(super) use paths::PathFolder as Folder;

/// Type of an entry of a folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum EntryType {
    /// A regular file.
    File,
    /// A folder.
    Folder,
    /// A symbolic link with any target.
    Link,
    /// A named pipe, a socket or a device.
    Special,
}

impl EntryType {
    /// In words.
    pub(super) fn words(self) -> &'static str {
        match self {
            Self::File => "a file",
            Self::Folder => "a folder",
            Self::Link => "a symbolic link",
            Self::Special => "a pipe, a socket or a device",
        }
    }

    /// Fails unless the entry has the expected type.
    fn expected(self, expected: Self, name: &str) -> io::Result<()> {
        if self == expected {
            return Ok(());
        }
        let (is, must) = (self.words(), expected.words());
        Err(io::Error::other(format!("{name} is {is}; expected {must}")))
    }
}

/// Reads a file of at most `most` bytes.
fn read_at_most(file: File, most: u64, name: &str) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    file.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        return Err(io::Error::other(format!("{name} is longer than the {most} bytes expected")));
    }
    Ok(bytes)
}

impl Folder {
    /// The folder and the last name of a key such as `residual_vibration/c/0/1`; missing folders are created.
    pub(super) fn made_for<'k>(&self, key: &'k str) -> io::Result<(Self, &'k str)> {
        self.reached(key, Self::made)
    }

    /// Reads the file of a key, which has at most `most` bytes.
    pub(super) fn read_key(&self, key: &str, most: u64) -> io::Result<Vec<u8>> {
        let (folder, name) = self.reached(key, Self::folder)?;
        folder.read(name, most)
    }

    fn reached<'k>(
        &self,
        key: &'k str,
        next: impl Fn(&Self, &str) -> io::Result<Self>,
    ) -> io::Result<(Self, &'k str)> {
        let mut folder = self.same()?;
        let mut rest = key;
        while let Some((name, below)) = rest.split_once('/') {
            folder = next(&folder, name)?;
            rest = below;
        }
        Ok((folder, rest))
    }
}

#[cfg(all(test, unix))]
mod tests;
