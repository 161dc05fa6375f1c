//! Stores of maps: Zarr v3 folders that stay consistent if the process is killed at any moment.
//!
//! ```text
//! map.zarr/zarr.json                    group: study, sources, consolidated metadata; written last of the frame
//!          dither_amplitude/…           coordinates, one array per axis
//!          residual_vibration/c/0/1             values, chunk by chunk
//!          residual_vibration_status/c/0/1      status codes of these values
//!          .quell/map.json              identity of the map; written first
//!          .quell/done/0.1.json         completion record of a chunk; written after the chunk's files
//!          .quell/unfinished/           files that are not complete yet
//!          .quell/lock                  held while a process writes, exclusively or shared
//! ```
//!
//! Invariants that hold even if processes are killed: a file is complete or does not exist; a record exists only after its
//! chunk is complete; the content of a record is verified before it is used. A resumed run therefore recomputes only the
//! chunks that cannot be verified, and ends with the same bytes as an uninterrupted one. Metadata and coordinates are
//! compared with the bytes that they must have, which follow from the study and from `map.json`; a store in which they differ
//! is rejected.
//!
//! A store may come from an untrusted source. Nothing outside its folder is read, written or removed: no symbolic link inside
//! is followed (`folder`). A store that contains a link, or a pipe in place of a file, is rejected before anything in it is
//! written or removed, and so is the store of another map.
//!
//! One process writes alone ([`Store::open`]), or several processes on any number of machines share the store
//! ([`Store::open_shared`]). Sharing needs no communication between them: the first complete `map.json` determines the map
//! of the store, and every other process compares its own map with that. Everything else has the same bytes regardless of
//! the process that writes it, and is renamed into place when it is complete. If two processes compute the same chunk, the
//! only loss is the time. Locks of the operating system prevent exclusive and shared writers from running at the same time,
//! but correctness does not depend on them.

mod codec;
mod examine;
mod failures;
mod folder;
mod identity;
mod layout;
mod lock;
mod names;
mod record;
mod whole;

use std::collections::HashSet;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use serde_json::Value as Json;

use crate::complaint::Failure;
use crate::sweep::{Content, Data, MISSING, MapArray, Plan};
use examine::{compared, examined, known};
use failures::{changed, complaint, exists, failed, unwritable};
use folder::Folder;
use identity::StudyTexts;
use layout::{Described, StoreLayout};
use lock::{Refused, Writers, lock};
use names::{DONE, IDENTITY, LONGEST, METADATA, OWN, UNFINISHED};
use record::{Record, Seal};
use whole::Unfinished;

/// A store that is open for writing.
#[derive(Debug)]
pub struct Store {
    path: PathBuf,
    /// The folder itself, held open if the platform allows it.
    root: Folder,
    own: Folder,
    layout: StoreLayout,
    unfinished: Unfinished,
    /// Held while the store is open, exclusively or shared.
    _lock: File,
}

/// State of a chunk in the store.
#[derive(Clone, Debug, PartialEq)]
pub enum ChunkState {
    /// The values of the chunk, verified to be complete.
    Whole(Vec<Data>),
    /// A chunk that was finished, but is now truncated, changed or missing.
    Damaged,
    /// No chunk, or an unfinished one.
    Nothing,
}

impl Store {
    /// Opens the store of a plan at `path`. A new store is created; with `resume`, an existing one is continued.
    ///
    /// # Errors
    /// [`Failure::Wrong`] if the path cannot be written, contains something other than a store, contains a store and `resume`
    /// is false, or contains the store of another map (the message names the differences). [`Failure::Failed`] if another
    /// process is writing the store or the disk is full; a store created by this call is removed in that case.
    pub fn open(path: &Path, plan: &Plan, resume: bool) -> Result<Self, Failure> {
        let layout = StoreLayout::new(plan).map_err(|error| failed(path, error.to_string()))?;
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
                return Err(refused.into_failure(path));
            }
        };
        let begun = store.begin(plan, &identity, resume).and_then(|()| store.tidy(alone));
        if begun.is_err() && made && alone {
            discard(path);
        }
        begun.map(|()| store)
    }

    /// Opens the store of a plan at `path` to write it together with other processes, on this or other machines. The store is
    /// created if it does not exist.
    ///
    /// # Errors
    /// As [`Store::open`] with `resume`; [`Failure::Failed`] while another process has opened the store exclusively.
    pub fn open_shared(path: &Path, plan: &Plan) -> Result<Self, Failure> {
        let layout = StoreLayout::new(plan).map_err(|error| failed(path, error.to_string()))?;
        let made = prepare(path, plan, true)?;
        let identity = identity::identity(plan);
        if !made {
            examined(path, &layout, &identity)?;
        }
        let locked = Self::locked(path, layout, Writers::Several);
        let (store, alone) = locked.map_err(|refused| refused.into_failure(path))?;
        store.begin(plan, &identity, true)?;
        store.tidy(alone)?;
        Ok(store)
    }

    /// Acquires the lock of the store, which is the first file in it. Also returns whether no other process can write.
    fn locked(path: &Path, layout: StoreLayout, writers: Writers) -> Result<(Self, bool), Refused> {
        let root = Folder::open(path)?;
        let own = root.made(OWN)?;
        own.made(DONE)?;
        let (lock, alone) = lock(&own, writers)?;
        let unfinished = Unfinished::new(own.made(UNFINISHED)?);
        Ok((Self { path: path.to_owned(), root, own, layout, unfinished, _lock: lock }, alone))
    }

    /// Removes unfinished files of killed processes.
    fn tidy(&self, alone: bool) -> Result<(), Failure> {
        let tidied =
            if alone { self.unfinished.clear() } else { self.unfinished.clear_abandoned() };
        tidied.map_err(|error| unwritable(&self.path, &error))
    }

    /// Compares the store with the plan, and writes all missing files except the chunks.
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
            None => StudyTexts::of(identity),
            Some(_) if !resume => return Err(exists(&self.path)),
            Some(there) => {
                compared(&self.path, there, identity)?;
                StudyTexts::of(there)
            }
        };
        self.frame(plan, &begun)
    }

    /// Writes missing metadata and coordinates, and verifies those that exist byte by byte.
    fn frame(&self, plan: &Plan, begun: &StudyTexts) -> Result<(), Failure> {
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
        // The group is written last.
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

    /// Writes a finished chunk: its files, then its record. Writing a chunk again is harmless.
    ///
    /// # Errors
    /// [`Failure::Failed`] with the reason; the chunk then counts as unfinished.
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

    /// Reads a chunk back and verifies it.
    pub fn read(&self, plan: &Plan, chunk: usize) -> ChunkState {
        let place = plan.chunks().place(chunk);
        let bytes = match self.root.read_key(&record_key(&place), LONGEST) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return ChunkState::Nothing,
            Err(_) => return ChunkState::Damaged,
        };
        let record = std::str::from_utf8(&bytes).ok().and_then(Record::parse);
        match record.and_then(|record| self.proven(plan, chunk, &record)) {
            Some(values) => ChunkState::Whole(values),
            None => ChunkState::Damaged,
        }
    }

    fn proven(&self, plan: &Plan, chunk: usize, record: &Record) -> Option<Vec<Data>> {
        let slots = slots(plan, chunk);
        let place = plan.chunks().place(chunk);
        let read = |(array, field): (&Described, &MapArray)| {
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

    /// Chunks without a record, which are certainly unfinished. This is fast because recorded chunks are not read;
    /// [`Store::read`] may still find one of them damaged.
    ///
    /// # Errors
    /// [`Failure::Wrong`] if the records cannot be listed.
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

    /// Path of the store.
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

/// Positions of the points of a chunk in a chunk of full size.
fn slots(plan: &Plan, chunk: usize) -> Vec<usize> {
    plan.chunks().points(chunk).into_iter().map(|(position, _)| position).collect()
}

/// Creates the folder, or checks an existing one. Returns whether it was created.
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
    // The folder is listed once: another process may be creating its store, and creates its own folder in it first.
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

/// Removes a store that was just created. If that fails, the original error is still the one that is reported.
fn discard(path: &Path) {
    let _ = fs::remove_dir_all(path);
}
