//! Stores of maps: Zarr v3 folders that survive whatever happens to the process.
//!
//! ```text
//! map.zarr/zarr.json                    group: study, sources, consolidated metadata; written last of the frame
//!          dither_amplitude/…           coordinates, one an axis
//!          efficiency/c/0/1             values, chunk by chunk
//!          efficiency_status/c/0/1      what is known about them
//!          .quell/map.json              what the store was begun with; written first
//!          .quell/done/0.1.json         completion record of a chunk; written last of the chunk
//!          .quell/unfinished/           files until they are whole
//!          .quell/lock                  held while a process writes, alone or with others
//! ```
//!
//! What holds at every moment, whoever is killed: a file is whole or not there; a record is
//! there only after its chunk; what a record says is checked before it is believed. So a run
//! resumes with the chunks that are not proven, and ends with the same bytes as one that was
//! never disturbed. Metadata and coordinates are compared with the bytes that they must have,
//! which follow from the study and from `map.json`: a store in which they differ is refused.
//!
//! A store may come from a stranger. Nothing outside its folder is read, written or removed: no
//! symbolic link inside is followed (`folder`), and a store that holds one, or a pipe in place of a
//! file, is refused before anything in it is written or removed; so is the store of another map.
//!
//! One process writes alone ([`Store::open`]), or several on any number of machines share the
//! store ([`Store::open_shared`]). Sharing needs no word between them: which map the store is of
//! is decided by the one whose `map.json` comes first, whole, and every other compares; what they
//! write besides is the same bytes whoever writes it, and is renamed into place, whole. A chunk
//! that two of them compute is computed twice, no more. Locks of the operating system keep one
//! that writes alone from those that share; nothing depends on them.

mod codec;
mod examine;
mod folder;
mod identity;
mod layout;
mod lock;
mod record;
mod whole;

use std::collections::HashSet;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use serde_json::Value as Json;

use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::sweep::{Content, Data, Field, MISSING, Plan};
use examine::{compared, examined, known};
use folder::Folder;
use identity::Provenance;
use layout::{Described, Layout};
use lock::{Refused, Writers, lock};
use record::{Record, Seal};
use whole::Unfinished;

/// Folder of what a reader of Zarr need not know.
const OWN: &str = ".quell";

/// Folder of completion records inside.
const DONE: &str = "done";

/// Folder of unfinished files inside.
const UNFINISHED: &str = "unfinished";

/// What the store was begun with, inside.
const IDENTITY: &str = "map.json";

/// Metadata of the group, and of an array in its folder.
const METADATA: &str = "zarr.json";

/// The longest record or identity that is read: the text of a study has at most 16 MiB, more than ten times as much as
/// anything else in them.
const LONGEST: u64 = 64 << 20;

/// The option that names a store.
const OPTION: &str = "--save";

/// A store that is open for writing.
#[derive(Debug)]
pub struct Store {
    path: PathBuf,
    /// The folder itself, held open where the platform can.
    root: Folder,
    own: Folder,
    layout: Layout,
    unfinished: Unfinished,
    /// Held while the store is open, exclusively or with others.
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
        let made = prepare(path, plan, resume)?;
        let identity = identity::identity(plan);
        if !made {
            examined(path, &layout, &identity)?;
        }
        let (store, alone) = match Self::locked(path, layout, Writers::One) {
            Ok(locked) => locked,
            Err(refused) => {
                if made && !matches!(refused, Refused::Busy) {
                    discard(path);
                }
                return Err(refused.told(path));
            }
        };
        let begun = store.begin(plan, &identity, resume).and_then(|()| store.tidy(alone));
        if begun.is_err() && made && alone {
            discard(path);
        }
        begun.map(|()| store)
    }

    /// Opens the store of a plan at `path` to write it together with other processes, on this or
    /// other machines: a new one, or the one that is there.
    ///
    /// # Errors
    /// As [`Store::open`] with `resume`; [`Failure::Failed`] while a process writes it alone.
    pub fn open_shared(path: &Path, plan: &Plan) -> Result<Self, Failure> {
        let layout = Layout::new(plan).map_err(|error| failed(path, error.to_string()))?;
        let made = prepare(path, plan, true)?;
        let identity = identity::identity(plan);
        if !made {
            examined(path, &layout, &identity)?;
        }
        let locked = Self::locked(path, layout, Writers::Several);
        let (store, alone) = locked.map_err(|refused| refused.told(path))?;
        store.begin(plan, &identity, true)?;
        store.tidy(alone)?;
        Ok(store)
    }

    /// Takes the lock of the store, which is the first thing that is in it; and whether nobody
    /// else writes.
    fn locked(path: &Path, layout: Layout, writers: Writers) -> Result<(Self, bool), Refused> {
        let root = Folder::open(path)?;
        let own = root.made(OWN)?;
        own.made(DONE)?;
        let (lock, alone) = lock(&own, writers)?;
        let unfinished = Unfinished::new(own.made(UNFINISHED)?);
        Ok((Self { path: path.to_owned(), root, own, layout, unfinished, _lock: lock }, alone))
    }

    /// Removes what killed processes left.
    fn tidy(&self, alone: bool) -> Result<(), Failure> {
        let tidied =
            if alone { self.unfinished.clear() } else { self.unfinished.clear_abandoned() };
        tidied.map_err(|error| unwritable(&self.path, &error))
    }

    /// Compares what is there with the plan, and writes what is missing of all but the chunks.
    fn begin(&self, plan: &Plan, identity: &Json, resume: bool) -> Result<(), Failure> {
        let text = format!("{identity:#}\n");
        let mut there = known(&self.path, &self.own)?;
        if there.is_none() {
            let first = self.unfinished.write_first(&self.own, IDENTITY, text.as_bytes());
            let first =
                first.map_err(|error| failed(&self.path, format!("cannot be written: {error}")))?;
            if !first {
                there = known(&self.path, &self.own)?;
            }
        }
        let begun = match &there {
            None => Provenance::of(identity),
            Some(_) if !resume => return Err(exists(&self.path)),
            Some(there) => {
                compared(&self.path, there, identity)?;
                Provenance::of(there)
            }
        };
        self.frame(plan, &begun)
    }

    /// Writes what is missing of everything but chunks, and proves the rest: every byte of it is known.
    fn frame(&self, plan: &Plan, begun: &Provenance) -> Result<(), Failure> {
        let mut files = Vec::new();
        for array in self.layout.arrays() {
            let key = format!("{}/{METADATA}", layout::name(array));
            files.push((key, format!("{:#}\n", layout::metadata(array)).into_bytes()));
        }
        for (array, axis) in self.layout.coordinates.iter().zip(plan.grid().axes()) {
            let slots: Vec<usize> = (0..axis.values.len()).collect();
            let bytes = codec::encode(array, &slots, axis.values.iter().copied(), f64::NAN)
                .map_err(|error| failed(&self.path, error.to_string()))?;
            files.push((key(array, &[0]), bytes));
        }
        // The group comes last.
        let group = format!("{:#}\n", self.layout.group(begun)).into_bytes();
        files.push((METADATA.to_owned(), group));
        let mut missing = Vec::new();
        for (key, bytes) in &files {
            match self.root.read_key(key, bytes.len() as u64) {
                Ok(there) if there == *bytes => {}
                Err(error) if error.kind() == io::ErrorKind::NotFound => missing.push((key, bytes)),
                Ok(_) | Err(_) => return Err(changed(&self.path, key)),
            }
        }
        missing.into_iter().try_for_each(|(key, bytes)| self.put(key, bytes))
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
            self.put(&key, &bytes)?;
        }
        self.put(&record_key(&place), record.text().as_bytes())
    }

    /// Reads a chunk back, if it is proven whole.
    pub fn read(&self, plan: &Plan, chunk: usize) -> Found {
        let place = plan.chunks().place(chunk);
        let bytes = match self.root.read_key(&record_key(&place), LONGEST) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Found::Nothing,
            Err(_) => return Found::Damaged,
        };
        let record = std::str::from_utf8(&bytes).ok().and_then(Record::parse);
        match record.and_then(|record| self.proven(plan, chunk, &record)) {
            Some(values) => Found::Whole(values),
            None => Found::Damaged,
        }
    }

    fn proven(&self, plan: &Plan, chunk: usize, record: &Record) -> Option<Vec<Data>> {
        let slots = slots(plan, chunk);
        let place = plan.chunks().place(chunk);
        let read = |(array, field): (&Described, &Field)| {
            let key = key(array, &place);
            let bytes = self.root.read_key(&key, codec::longest(array)).ok()?;
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

    /// Chunks that have no record: unfinished for certain. What is recorded is not read, so that
    /// this is quick, and [`Store::read`] may still find a chunk damaged.
    ///
    /// # Errors
    /// [`Failure::Wrong`] where the records cannot be listed.
    pub fn unrecorded(&self, plan: &Plan) -> Result<Vec<usize>, Failure> {
        let entries = self.own.folder(DONE).and_then(|done| done.entries());
        let entries = entries.map_err(|error| unwritable(&self.path, &error))?;
        let names: HashSet<String> = entries.into_iter().map(|(name, _)| name).collect();
        let recorded = |chunk| names.contains(&record_name(&plan.chunks().place(chunk)));
        Ok((0..plan.chunks().len()).filter(|&chunk| !recorded(chunk)).collect())
    }

    fn put(&self, key: &str, bytes: &[u8]) -> Result<(), Failure> {
        let written = self.unfinished.write(&self.root, key, bytes);
        written.map_err(|error| failed(&self.path, format!("cannot be written: {error}")))
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

/// Name of the completion record of a chunk.
fn record_name(place: &[usize]) -> String {
    let place: Vec<String> = place.iter().map(usize::to_string).collect();
    format!("{}.json", place.join("."))
}

/// Key of the completion record of a chunk.
fn record_key(place: &[usize]) -> String {
    format!("{OWN}/{DONE}/{}", record_name(place))
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
fn prepare(path: &Path, plan: &Plan, resume: bool) -> Result<bool, Failure> {
    if let Some(input) = plan.grid().study().inputs().inside(path) {
        return Err(complaint(path, input.refusal()));
    }
    match fs::create_dir(path) {
        Ok(()) => return Ok(true),
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
        Err(error) => return Err(unwritable(path, &error)),
    }
    if !path.is_dir() {
        return Err(complaint(path, "is a file; expected a folder (a Zarr store)"));
    }
    // One listing: another process may make its store meanwhile, and its folder comes first.
    let entries = fs::read_dir(path).map_err(|error| unwritable(path, &error))?;
    let names: Result<Vec<_>, _> = entries.map(|entry| Ok(entry?.file_name())).collect();
    let names = names.map_err(|error| unwritable(path, &error))?;
    if names.iter().any(|name| name == OWN) {
        return if resume { Ok(false) } else { Err(exists(path)) };
    }
    if names.is_empty() {
        return Ok(false);
    }
    Err(complaint(
        path,
        "is a folder that contains other files and is not a store; choose another name",
    ))
}

/// Takes away what was just made: nothing half-made stays. If it cannot be removed, the first error
/// is still the one.
fn discard(path: &Path) {
    let _ = fs::remove_dir_all(path);
}

impl Refused {
    fn told(self, path: &Path) -> Failure {
        match self {
            Self::Busy => failed(
                path,
                "another process is writing this store; wait until it finishes, or choose another name"
                    .to_owned(),
            ),
            Self::Io(error) => unwritable(path, &error),
        }
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
    complaint(path, "already exists: --resume continues it; or choose another name")
}

fn changed(path: &Path, key: &str) -> Failure {
    complaint(
        path,
        format!(
            "{key} differs from what this map must contain: the file was truncated or changed, and readers of the store \
             would get wrong numbers; remove the file (it is then written again), or choose another name"
        ),
    )
}

fn another(path: &Path, differences: &[String]) -> Failure {
    let list = differences.join("; ");
    complaint(path, format!("is the store of another map ({list}); choose another name"))
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
