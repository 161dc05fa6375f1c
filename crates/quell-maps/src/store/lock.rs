//! Locks of a store: one process writes alone, or several share it.
//!
//! The lock is an exclusive or shared lock of the operating system, which is released when the process ends in any way, and so
//! is never stale. On a file system without locks, or with locks that other machines do not see, no chunk is lost: files
//! are written completely, and their bytes do not depend on the process that writes them.

use std::fs::{File, TryLockError};
use std::io;

use super::folder::Folder;

/// Whether a store is written exclusively.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Writers {
    /// By one process alone.
    One,
    /// By several processes, which communicate only through the store.
    Several,
}

/// Why a store cannot be opened for writing.
pub(super) enum Refused {
    /// Another process holds the lock.
    Busy,
    /// A file cannot be read or written.
    Io(io::Error),
}

impl From<io::Error> for Refused {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

/// Acquires the lock in a folder. Also returns whether no other process can write now.
pub(super) fn lock(folder: &Folder, writers: Writers) -> Result<(File, bool), Refused> {
    // On a network file system a shared lock requires a file open for reading, and an exclusive one a file open for writing.
    let lock = folder.lockable("lock")?;
    let taken = match writers {
        Writers::One => lock.try_lock(),
        Writers::Several => lock.try_lock_shared(),
    };
    match taken {
        Err(TryLockError::WouldBlock) => Err(Refused::Busy),
        Err(TryLockError::Error(_)) => Ok((lock, false)),
        Ok(()) => Ok((lock, writers == Writers::One)),
    }
}
