//! Folders of a store, whose content a stranger may have made: no symbolic link inside is ever followed, and nothing but
//! regular files is opened.
//!
//! The folder that the user names is opened as it is, links included. Everything below is reached from there, one name
//! at a time. On Unix each folder is held open and its entries are reached through the open folder (`openat` and its
//! family, without following links), so that a folder that is exchanged for a link meanwhile makes no difference.
//! Elsewhere the kind of every entry is looked up right before it is used.
//!
//! A named pipe or a device in place of a file would block whoever opens it, or do worse: what an entry is, is looked up
//! before it is opened, it is opened without waiting, and looked up again.

#[cfg(unix)]
mod handles;
#[cfg(any(not(unix), test))]
mod paths;

use std::fs::File;
use std::io::{self, Read};

#[cfg(unix)]
pub(super) use handles::Folder;
#[cfg(not(unix))]
pub(super) use paths::Folder;

/// What an entry of a folder is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Entry {
    /// A regular file.
    File,
    /// A folder.
    Folder,
    /// A symbolic link, wherever it leads.
    Link,
    /// A named pipe, a socket or a device.
    Special,
}

impl Entry {
    /// In words.
    pub(super) fn words(self) -> &'static str {
        match self {
            Self::File => "a file",
            Self::Folder => "a folder",
            Self::Link => "a symbolic link",
            Self::Special => "a pipe, a socket or a device",
        }
    }

    /// Whether it is what it must be.
    fn expected(self, expected: Self, name: &str) -> io::Result<()> {
        if self == expected {
            return Ok(());
        }
        let (is, must) = (self.words(), expected.words());
        Err(io::Error::other(format!("{name} is {is}; expected {must}")))
    }
}

/// Reads a file that is at most so long.
fn read_at_most(file: File, most: u64, name: &str) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    file.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        return Err(io::Error::other(format!("{name} is longer than the {most} bytes expected")));
    }
    Ok(bytes)
}

impl Folder {
    /// The folders and the last name of a key such as `efficiency/c/0/1`; the folders are made where they are missing.
    pub(super) fn made_for<'k>(&self, key: &'k str) -> io::Result<(Self, &'k str)> {
        self.reached(key, Self::made)
    }

    /// Reads the file of a key, which is at most so long.
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
