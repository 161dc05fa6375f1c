//! Stores of maps: Zarr v3 folders that survive whatever happens to the process.
//!
//! ```text
//! map.zarr/zarr.json                    group: study, sources, consolidated metadata
//!          dither_amplitude/…           coordinates, one an axis
//!          efficiency/c/0/1             values, chunk by chunk
//!          efficiency_status/c/0/1      what is known about them
//!          .quell/map.json              what the store was begun with; written last of the frame
//!          .quell/done/0.1.json         completion record of a chunk; written last of the chunk
//!          .quell/unfinished/           files until they are whole
//!          .quell/lock                  held while a process writes
//! ```
//!
//! What holds at every moment, whoever is killed: a file is whole or not there; a record is
//! there only after its chunk; what a record says is checked before it is believed. So a run
//! resumes with the chunks that are not proven, and ends with the same bytes as one that was
//! never disturbed.
//!
//! One process writes at a time: it holds a lock of the operating system, which goes away with
//! the process however that ends, so that no lock is ever stale. Should a file system have no
//! locks, two processes waste work but do no harm: a chunk is renamed into place, whole, and
//! either process would write the same bytes.

mod codec;
mod identity;
mod layout;
mod record;
mod whole;

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use serde_json::Value as Json;

use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::sweep::{Content, Data, Field, MISSING, Plan};
use layout::{Described, Layout};
use record::{Record, Seal};
use whole::Unfinished;

/// Folder of what a reader of Zarr need not know.
const OWN: &str = ".quell";

/// Folder of completion records inside.
const DONE: &str = "done";

/// The option that names a store.
const OPTION: &str = "--save";

/// A store that is open for writing.
#[derive(Debug)]
pub struct Store {
    path: PathBuf,
    layout: Layout,
    unfinished: Unfinished,
    /// Held while the store is open.
    _lock: File,
}

/// What the store has of a chunk.
#[derive(Clone, Debug, PartialEq)]
pub enum Found {
    /// The chunk, proven whole.
    Whole(Vec<Data>),
    /// A finished chunk that is not what it was: cut short, changed, or gone.
    Damaged,
    /// Nothing, or nothing finished.
    Nothing,
}

impl Store {
    /// Opens the store of a plan at `path`: a new one, or with `resume` one that was begun
    /// before, if there is one.
    ///
    /// # Errors
    /// [`Failure::Wrong`] where the path cannot be written, where something else is there, where
    /// a store is there and `resume` is not asked for, or where it is a store of another map
    /// (which names what differs). [`Failure::Failed`] where another process writes it or the
    /// disk is full; a store that was begun just now is taken away then.
    pub fn open(path: &Path, plan: &Plan, resume: bool) -> Result<Self, Failure> {
        let layout = Layout::new(plan).map_err(|error| failed(path, error.to_string()))?;
        let made = prepare(path, resume)?;
        let locked = Self::locked(path, layout);
        let fresh = made && !matches!(locked, Err(Refused::Busy));
        let opened = locked
            .map_err(|refused| refused.told(path))
            .and_then(|store| store.begin(plan, resume).map(|()| store));
        if opened.is_err() && fresh {
            // Nothing half-made stays; if it cannot be removed, the first error is still the one.
            let _ = fs::remove_dir_all(path);
        }
        opened
    }

    /// Takes the lock of the store, which is the first thing that is in it.
    fn locked(path: &Path, layout: Layout) -> Result<Self, Refused> {
        let own = path.join(OWN);
        fs::create_dir_all(own.join(DONE))?;
        let (lock, alone) = lock(&own.join("lock"))?;
        let unfinished = Unfinished::new(own.join("unfinished"))?;
        if alone {
            unfinished.clear()?;
        }
        Ok(Self { path: path.to_owned(), layout, unfinished, _lock: lock })
    }

    /// Compares what is there with the plan, or writes all but the chunks.
    fn begin(&self, plan: &Plan, resume: bool) -> Result<(), Failure> {
        let map = self.path.join(OWN).join("map.json");
        let identity = identity::identity(plan);
        match fs::read_to_string(&map) {
            Ok(_) if !resume => Err(exists(&self.path)),
            Ok(text) => {
                let there: Json = serde_json::from_str(&text).unwrap_or_default();
                let differences = identity::differences(&there, &identity);
                if !differences.is_empty() {
                    return Err(another(&self.path, &differences));
                }
                Ok(())
            }
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                self.frame(plan)?;
                self.put(&map, format!("{identity:#}\n").as_bytes())
            }
            Err(error) => Err(unwritable(&self.path, &error)),
        }
    }

    /// Writes everything but chunks.
    fn frame(&self, plan: &Plan) -> Result<(), Failure> {
        for array in self.layout.arrays() {
            let path = self.path.join(layout::name(array)).join("zarr.json");
            self.put(&path, format!("{:#}\n", layout::metadata(array)).as_bytes())?;
        }
        for (array, axis) in self.layout.coordinates.iter().zip(plan.grid().axes()) {
            let slots: Vec<usize> = (0..axis.values.len()).collect();
            let bytes = codec::encode(array, &slots, axis.values.iter().copied(), f64::NAN)
                .map_err(|error| failed(&self.path, error.to_string()))?;
            self.put(&self.path.join(key(array, &[0])), &bytes)?;
        }
        self.put(&self.path.join("zarr.json"), format!("{:#}\n", self.layout.group).as_bytes())
    }

    /// Writes a finished chunk: its files, then its record. Again is as good as once.
    ///
    /// # Errors
    /// [`Failure::Failed`] with the reason; the chunk does not count then.
    pub fn write(&self, plan: &Plan, chunk: usize, values: &[Data]) -> Result<(), Failure> {
        let slots = slots(plan, chunk);
        let place = plan.chunks().place(chunk);
        let mut record = Record::default();
        for (array, values) in self.layout.fields.iter().zip(values) {
            let bytes = match values {
                Data::Numbers(values) => {
                    codec::encode(array, &slots, values.iter().copied(), f64::NAN)
                }
                Data::Codes(codes) => codec::encode(array, &slots, codes.iter().copied(), MISSING),
            };
            let bytes = bytes.map_err(|error| failed(&self.path, error.to_string()))?;
            let key = key(array, &place);
            record.add(&key, Seal::of(&bytes));
            self.put(&self.path.join(key), &bytes)?;
        }
        self.put(&self.record_path(&place), record.text().as_bytes())
    }

    /// Reads a chunk back, if it is proven whole.
    pub fn read(&self, plan: &Plan, chunk: usize) -> Found {
        let place = plan.chunks().place(chunk);
        let Ok(text) = fs::read_to_string(self.record_path(&place)) else {
            return Found::Nothing;
        };
        match Record::parse(&text).and_then(|record| self.proven(plan, chunk, &record)) {
            Some(values) => Found::Whole(values),
            None => Found::Damaged,
        }
    }

    fn proven(&self, plan: &Plan, chunk: usize, record: &Record) -> Option<Vec<Data>> {
        let slots = slots(plan, chunk);
        let place = plan.chunks().place(chunk);
        let read = |(array, field): (&Described, &Field)| {
            let key = key(array, &place);
            let bytes = fs::read(self.path.join(&key)).ok()?;
            if record.seal(&key) != Some(Seal::of(&bytes)) {
                return None;
            }
            match field.content {
                Content::Numbers => codec::decode(array, &slots, bytes).ok().map(Data::Numbers),
                Content::Codes(_) => codec::decode(array, &slots, bytes).ok().map(Data::Codes),
            }
        };
        self.layout.fields.iter().zip(plan.sheet().fields()).map(read).collect()
    }

    fn record_path(&self, place: &[usize]) -> PathBuf {
        let name: Vec<String> = place.iter().map(usize::to_string).collect();
        self.path.join(OWN).join(DONE).join(format!("{}.json", name.join(".")))
    }

    fn put(&self, path: &Path, bytes: &[u8]) -> Result<(), Failure> {
        let written = self.unfinished.write(path, bytes);
        written.map_err(|error| failed(&self.path, format!("cannot be written: {error}")))
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

/// Key of a chunk of an array.
fn key(array: &Described, index: &[usize]) -> String {
    let index: Vec<u64> = index.iter().map(|&place| place as u64).collect();
    array.chunk_key(&index).as_str().to_owned()
}

/// Positions of the points of a chunk in a whole chunk.
fn slots(plan: &Plan, chunk: usize) -> Vec<usize> {
    plan.chunks().points(chunk).into_iter().map(|(position, _)| position).collect()
}

/// Makes the folder, or sees what is there; whether it was made.
fn prepare(path: &Path, resume: bool) -> Result<bool, Failure> {
    match fs::create_dir(path) {
        Ok(()) => return Ok(true),
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
        Err(error) => return Err(unwritable(path, &error)),
    }
    if !path.is_dir() {
        return Err(complaint(path, "is a file; a store is a folder"));
    }
    if path.join(OWN).is_dir() {
        return if resume { Ok(false) } else { Err(exists(path)) };
    }
    let mut entries = fs::read_dir(path).map_err(|error| unwritable(path, &error))?;
    if entries.next().is_some() {
        return Err(complaint(path, "is a folder with other things in it; choose another name"));
    }
    Ok(false)
}

/// Why a store cannot be worked on.
enum Refused {
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

impl Refused {
    fn told(self, path: &Path) -> Failure {
        match self {
            Self::Busy => failed(
                path,
                "another process is writing this store; wait for it, or choose another name"
                    .to_owned(),
            ),
            Self::Io(error) => unwritable(path, &error),
        }
    }
}

/// Takes the lock, which the operating system gives back when the process ends; and whether it
/// holds.
fn lock(file: &Path) -> Result<(File, bool), Refused> {
    let lock = OpenOptions::new().create(true).truncate(false).write(true).open(file)?;
    match lock.try_lock() {
        Err(TryLockError::WouldBlock) => Err(Refused::Busy),
        // A file system without locks: chunks are whole and the same whoever writes them.
        Err(TryLockError::Error(_)) => Ok((lock, false)),
        Ok(()) => Ok((lock, true)),
    }
}

fn failed(path: &Path, why: String) -> Failure {
    Failure::Failed { key: path.display().to_string(), why }
}

fn complaint(path: &Path, allowed: impl Into<String>) -> Failure {
    let given = path.display().to_string();
    Complaint::new(Fault::Path, OPTION, Origin::Argument(OPTION), given, allowed).into()
}

fn exists(path: &Path) -> Failure {
    complaint(path, "exists already: --resume goes on with it; or choose another name")
}

fn another(path: &Path, differences: &[String]) -> Failure {
    let list = differences.join("; ");
    complaint(path, format!("is the store of another map: {list}; choose another name"))
}

/// A path that cannot be written: wrong input, unless the disk is full.
fn unwritable(path: &Path, error: &io::Error) -> Failure {
    let why = format!("cannot be written: {error}");
    match error.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded | io::ErrorKind::FileTooLarge => {
            failed(path, why)
        }
        _ => complaint(path, why),
    }
}
