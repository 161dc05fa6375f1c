//! Who may write a store: one process alone, or several that share it.
//!
//! The lock is one of the operating system, exclusive or shared, and goes away with the process
//! however that ends, so that it is never stale. A file system without locks, or one whose locks
//! other machines do not see, loses no chunk: what is written is whole and the same whoever
//! writes it.

use std::fs::{File, TryLockError};
use std::io;

use super::folder::Folder;

/// With whom a store is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Writers {
    /// With nobody.
    One,
    /// With processes that know of each other only by the store.
    Several,
}

/// Why a store cannot be worked on.
pub(super) enum Refused {
    /// Another process holds the lock.
    Busy,
    /// Something cannot be read or written.
    Io(io::Error),
}

impl From<io::Error> for Refused {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

/// Takes the lock in a folder; and whether nobody else can write now.
pub(super) fn lock(folder: &Folder, writers: Writers) -> Result<(File, bool), Refused> {
    // A network file system asks for reading where the lock is shared, for writing where not.
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
