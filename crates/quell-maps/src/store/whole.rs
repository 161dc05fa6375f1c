//! Files that are either complete or absent.
//!
//! A file is written under a unique name in a folder for unfinished files, synced to disk, and renamed to its final path. At
//! any moment a reader sees the old file, the new file, or no file. A killed process leaves at most an unfinished file in that
//! folder, which a later process removes.
//!
//! Names contain a random number in addition to the process identifier, so that processes on several machines that share the
//! folder never write the same unfinished file.

use std::hash::{BuildHasher, RandomState};
use std::io;
use std::process;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use super::folder::{EntryType, Folder};
use crate::output::{fill, writing};

/// Age above which an unfinished file counts as abandoned: no file takes minutes to write. If its writer was only suspended,
/// it writes the file again.
const ABANDONED: Duration = Duration::from_hours(1);

/// Number of attempts to write a file while other processes remove its unfinished form.
const ATTEMPTS: u32 = 5;

/// The folder of unfinished files.
#[derive(Debug)]
pub(super) struct Unfinished {
    folder: Folder,
    /// Random number that identifies this process among those of all machines.
    writer: u64,
    count: AtomicU64,
}

impl Unfinished {
    /// Unfinished files in this folder.
    pub(super) fn new(folder: Folder) -> Self {
        // Hash keys are the only source of randomness in the standard library.
        let writer = RandomState::new().hash_one(process::id());
        Self { folder, writer, count: AtomicU64::new(0) }
    }

    /// Removes all unfinished files; only for a process that writes alone.
    pub(super) fn clear(&self) -> io::Result<()> {
        for name in self.left()? {
            self.folder.remove(&name)?;
        }
        Ok(())
    }

    /// Removes abandoned unfinished files while other processes may be writing.
    pub(super) fn clear_abandoned(&self) -> io::Result<()> {
        // The age is measured by the clock of the file system, which all machines share.
        let probe = self.temporary();
        self.folder.create(&probe)?;
        let now = self.folder.modified(&probe);
        self.folder.remove(&probe)?;
        let now = now?;
        for name in self.left()? {
            // A file that has disappeared in the meantime was renamed or removed by another process.
            let Ok(written) = self.folder.modified(&name) else { continue };
            if now.duration_since(written).is_ok_and(|age| age > ABANDONED) {
                let _ = self.folder.remove(&name);
            }
        }
        Ok(())
    }

    /// Names of the files in the folder.
    fn left(&self) -> io::Result<impl Iterator<Item = String>> {
        let entries = self.folder.entries()?;
        Ok(entries.into_iter().filter(|(_, entry)| *entry == EntryType::File).map(|(name, _)| name))
    }

    /// Writes the complete file of a key in `root`, and creates missing folders.
    pub(super) fn write(&self, root: &Folder, key: &str, bytes: &[u8]) -> io::Result<()> {
        self.settle_again(bytes, |temporary| {
            let (folder, name) = root.made_for(key)?;
            self.folder.rename(temporary, &folder, name)
        })
    }

    /// Writes an unfinished file and moves it to its final path, again where another process considered it abandoned and
    /// removed it.
    fn settle_again(&self, bytes: &[u8], place: impl Fn(&str) -> io::Result<()>) -> io::Result<()> {
        for _ in 1..ATTEMPTS {
            match self.settle(bytes, &place) {
                Err(error) if error.kind() == io::ErrorKind::NotFound => {}
                written => return written,
            }
        }
        self.settle(bytes, &place)
    }

    /// Writes a complete file in a folder unless a file of that name exists; returns whether it was written. Of several
    /// concurrent processes on any machines exactly one writes it.
    pub(super) fn write_first(
        &self,
        folder: &Folder,
        name: &str,
        bytes: &[u8],
    ) -> io::Result<bool> {
        let put = |temporary: &str| self.put_first(temporary, folder, name, bytes);
        match self.settle(bytes, put) {
            Ok(()) => Ok(true),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => Ok(false),
            Err(error) => Err(error),
        }
    }

    /// Writes an unfinished file and moves it to its final path.
    fn settle(&self, bytes: &[u8], place: impl Fn(&str) -> io::Result<()>) -> io::Result<()> {
        let _writing = writing();
        let temporary = self.temporary();
        let file = self.folder.create(&temporary);
        let written = file.and_then(|file| fill(file, bytes)).and_then(|()| place(&temporary));
        if written.is_err() {
            // If removing the file fails too, nothing else can be done.
            let _ = self.folder.remove(&temporary);
        }
        written
    }

    /// Gives the file a second name by a hard link, which fails if the name exists, also on a network file system; then removes
    /// the first name.
    fn put_first(
        &self,
        temporary: &str,
        folder: &Folder,
        name: &str,
        bytes: &[u8],
    ) -> io::Result<()> {
        match self.folder.link(temporary, folder, name) {
            Ok(()) => {}
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => return Err(error),
            // A file system without hard links: the file is created first, and then filled.
            Err(_) => fill(folder.create(name)?, bytes)?,
        }
        let _ = self.folder.remove(temporary);
        Ok(())
    }

    fn temporary(&self) -> String {
        let number = self.count.fetch_add(1, Ordering::Relaxed);
        format!("{}.{:016x}.{number}", process::id(), self.writer)
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn exactly_one_of_many_writers_is_first() {
        let place = tempfile::tempdir().expect("a folder");
        let target = place.path().join("first");
        let root = Folder::open(place.path()).expect("a folder");
        let first: Vec<bool> = std::thread::scope(|scope| {
            let writer = |number: u8| {
                let root = &root;
                scope.spawn(move || {
                    let unfinished = Unfinished::new(root.made("unfinished").expect("a folder"));
                    let first = unfinished.write_first(root, "first", &[number; 4096]);
                    first.expect("it can be written")
                })
            };
            let writers: Vec<_> = (0..16).map(writer).collect();
            writers.into_iter().map(|writer| writer.join().expect("no panic")).collect()
        });
        assert_eq!(first.iter().filter(|first| **first).count(), 1);
        let winner =
            u8::try_from(first.iter().position(|first| *first).expect("one")).expect("few");
        assert_eq!(fs::read(&target).expect("a file"), [winner; 4096]);
        let left = fs::read_dir(place.path().join("unfinished")).expect("a folder").count();
        assert_eq!(left, 0, "unfinished files remain");
    }

    #[test]
    fn only_old_unfinished_files_are_abandoned() {
        let place = tempfile::tempdir().expect("a folder");
        let unfinished = Unfinished::new(Folder::open(place.path()).expect("a folder"));
        let (old, young) = (place.path().join("old"), place.path().join("young"));
        fs::write(&young, b"half").expect("a file");
        let file = fs::File::create(&old).expect("a file");
        let before = std::time::SystemTime::now() - 2 * ABANDONED;
        file.set_modified(before).expect("a time");
        unfinished.clear_abandoned().expect("it can be read");
        assert!(young.exists() && !old.exists());
        assert_eq!(fs::read_dir(place.path()).expect("a folder").count(), 1);
    }

    /// Writes a file whose unfinished form is removed this number of times; returns the file, if there is one.
    fn written_despite(removals: u64) -> io::Result<Vec<u8>> {
        let place = tempfile::tempdir()?;
        let root = Folder::open(place.path())?;
        let unfinished = Unfinished::new(root.made("unfinished")?);
        let (removed, bytes) = (AtomicU64::new(0), [7; 4096]);
        let written = unfinished.settle_again(&bytes, |temporary| {
            if removed.fetch_add(1, Ordering::Relaxed) < removals {
                unfinished.folder.remove(temporary)?;
            }
            unfinished.folder.rename(temporary, &root, "target")
        });
        assert_eq!(fs::read_dir(place.path().join("unfinished"))?.count(), 0, "files are left");
        written.and_then(|()| fs::read(place.path().join("target")))
    }

    #[test]
    fn a_writer_recovers_when_its_unfinished_file_is_removed() {
        let most = u64::from(ATTEMPTS) - 1;
        for removals in 0..=most {
            assert_eq!(written_despite(removals).expect("it is written again"), [7; 4096]);
        }
        let lost = written_despite(most + 1).expect_err("removed at every attempt");
        assert_eq!(lost.kind(), io::ErrorKind::NotFound);
    }
}
