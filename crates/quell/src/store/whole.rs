//! Files that are whole or not there.
//!
//! A file is written under a name of its own in a folder for unfinished ones, brought down to
//! the disk, and renamed into its place: whoever looks, at whatever moment, sees the old file,
//! the new one, or none. A process that is killed leaves at most an unfinished file there, which
//! a later one takes away.
//!
//! Names hold a random number beside the process's: processes of several machines that share the
//! folder never write the same unfinished file.

use std::fs::{self, File, OpenOptions};
use std::hash::{BuildHasher, RandomState};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// Age at which an unfinished file is nobody's any more: none takes minutes to write. Should
/// its writer only have slept, it writes the file again.
const ABANDONED: Duration = Duration::from_hours(1);

/// Times that a file is written when others keep taking its unfinished form away.
const ATTEMPTS: u32 = 5;

/// Where files lie until they are whole.
#[derive(Debug)]
pub(super) struct Unfinished {
    folder: PathBuf,
    /// Random, so that no other process on any machine has the same.
    writer: u64,
    count: AtomicU64,
}

impl Unfinished {
    /// In this folder, which is made where it is not there.
    pub(super) fn new(folder: PathBuf) -> io::Result<Self> {
        fs::create_dir_all(&folder)?;
        // Hash keys are random: the one source of chance in the standard library.
        let writer = RandomState::new().hash_one(process::id());
        Ok(Self { folder, writer, count: AtomicU64::new(0) })
    }

    /// Takes away what killed processes left; only for who writes alone.
    pub(super) fn clear(&self) -> io::Result<()> {
        for entry in fs::read_dir(&self.folder)? {
            fs::remove_file(entry?.path())?;
        }
        Ok(())
    }

    /// Takes away what killed processes left long ago, beside others that write.
    pub(super) fn clear_abandoned(&self) -> io::Result<()> {
        // The age is measured by the clock of the file system, which all machines share.
        let probe = self.temporary();
        File::create_new(&probe)?;
        let now = fs::metadata(&probe).and_then(|probe| probe.modified());
        fs::remove_file(&probe)?;
        let now = now?;
        for entry in fs::read_dir(&self.folder)? {
            let path = entry?.path();
            // A file that is gone meanwhile was another's to take away.
            let Ok(written) = fs::metadata(&path).and_then(|file| file.modified()) else {
                continue;
            };
            if now.duration_since(written).is_ok_and(|age| age > ABANDONED) {
                let _ = fs::remove_file(&path);
            }
        }
        Ok(())
    }

    /// Writes a whole file; its folder is made where it is not there.
    pub(super) fn write(&self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        let mut attempt = 1;
        loop {
            match self.settle(bytes, |temporary| put(temporary, path)) {
                // Another process took the unfinished file for an abandoned one.
                Err(error) if error.kind() == io::ErrorKind::NotFound && attempt < ATTEMPTS => {
                    attempt += 1;
                }
                written => return written,
            }
        }
    }

    /// Writes a whole file where none is; whether it was this one. Of several processes at once,
    /// on whatever machines, one writes it.
    pub(super) fn write_first(&self, path: &Path, bytes: &[u8]) -> io::Result<bool> {
        match self.settle(bytes, |temporary| put_first(temporary, path, bytes)) {
            Ok(()) => Ok(true),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => Ok(false),
            Err(error) => Err(error),
        }
    }

    /// Writes an unfinished file and brings it to its place.
    fn settle(&self, bytes: &[u8], place: impl Fn(&Path) -> io::Result<()>) -> io::Result<()> {
        let temporary = self.temporary();
        let written = fill(&temporary, bytes).and_then(|()| place(&temporary));
        if written.is_err() {
            // Nothing else to do about a file that cannot be removed either.
            let _ = fs::remove_file(&temporary);
        }
        written
    }

    fn temporary(&self) -> PathBuf {
        let number = self.count.fetch_add(1, Ordering::Relaxed);
        self.folder.join(format!("{}.{:016x}.{number}", process::id(), self.writer))
    }
}

fn fill(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file: File = OpenOptions::new().write(true).create_new(true).open(path)?;
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

/// A second name for the file, which is refused where the name is taken, also over a network; then
/// the first name goes.
fn put_first(temporary: &Path, path: &Path, bytes: &[u8]) -> io::Result<()> {
    match fs::hard_link(temporary, path) {
        Ok(()) => {
            let _ = fs::remove_file(temporary);
            Ok(())
        }
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => Err(error),
        // A file system without second names: the name is taken first, and the bytes follow.
        Err(_) => {
            let mut file = File::create_new(path)?;
            file.write_all(bytes)?;
            file.sync_all()?;
            let _ = fs::remove_file(temporary);
            Ok(())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_many_writers_one_is_the_first() {
        let place = tempfile::tempdir().expect("a folder");
        let folder = place.path().join("unfinished");
        let target = place.path().join("first");
        let first: Vec<bool> = std::thread::scope(|scope| {
            let writer = |number: u8| {
                let (folder, target) = (folder.clone(), &target);
                scope.spawn(move || {
                    let unfinished = Unfinished::new(folder).expect("a folder");
                    unfinished.write_first(target, &[number; 4096]).expect("it can be written")
                })
            };
            let writers: Vec<_> = (0..16).map(writer).collect();
            writers.into_iter().map(|writer| writer.join().expect("no panic")).collect()
        });
        assert_eq!(first.iter().filter(|first| **first).count(), 1);
        let winner =
            u8::try_from(first.iter().position(|first| *first).expect("one")).expect("few");
        assert_eq!(fs::read(&target).expect("a file"), [winner; 4096]);
        assert_eq!(fs::read_dir(&folder).expect("a folder").count(), 0, "unfinished files stay");
    }

    #[test]
    fn only_old_unfinished_files_are_abandoned() {
        let place = tempfile::tempdir().expect("a folder");
        let unfinished = Unfinished::new(place.path().to_owned()).expect("a folder");
        let (old, young) = (place.path().join("old"), place.path().join("young"));
        fs::write(&young, b"half").expect("a file");
        let file = File::create(&old).expect("a file");
        let before = std::time::SystemTime::now() - 2 * ABANDONED;
        file.set_modified(before).expect("a time");
        unfinished.clear_abandoned().expect("it can be read");
        assert!(young.exists() && !old.exists());
        assert_eq!(fs::read_dir(place.path()).expect("a folder").count(), 1);
    }

    #[test]
    fn a_writer_survives_that_its_unfinished_file_is_taken_away() {
        let place = tempfile::tempdir().expect("a folder");
        let unfinished = Unfinished::new(place.path().join("unfinished")).expect("a folder");
        let target = place.path().join("target");
        let stop = std::sync::atomic::AtomicBool::new(false);
        std::thread::scope(|scope| {
            scope.spawn(|| {
                while !stop.load(Ordering::Relaxed) {
                    if let Ok(entries) = fs::read_dir(&unfinished.folder) {
                        for entry in entries.flatten().take(1) {
                            let _ = fs::remove_file(entry.path());
                        }
                    }
                    std::thread::sleep(Duration::from_millis(1));
                }
            });
            let written: Vec<io::Result<()>> =
                (0..50).map(|number| unfinished.write(&target, &vec![number; 1 << 16])).collect();
            stop.store(true, Ordering::Relaxed);
            assert!(written.iter().filter(|written| written.is_ok()).count() > 40, "{written:?}");
        });
        assert_eq!(fs::read(&target).expect("a file").len(), 1 << 16);
    }
}
