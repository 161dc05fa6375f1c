//! Checks of an existing store before anything in it is written or removed.

use std::collections::HashMap;
use std::io;
use std::path::Path;
use std::thread;
use std::time::Duration;

use serde_json::Value as Json;

use super::failures::{another, complaint, unwritable};
use super::folder::{EntryType, Folder};
use super::identity;
use super::layout::{self, StoreLayout};
use super::names::{IDENTITY, LONGEST, METADATA, OWN};
use crate::complaint::Failure;

/// Number of attempts to read an incomplete identity, and the time between them.
const PATIENCE: u32 = 20;
const MOMENT: Duration = Duration::from_millis(50);

/// Checks an existing store before anything in it is written or removed: every entry must be of the expected type, and the
/// store must be that of this map.
pub(super) fn examined(path: &Path, layout: &StoreLayout, identity: &Json) -> Result<(), Failure> {
    let root = Folder::open(path).map_err(|error| unwritable(path, &error))?;
    // A store of another map is reported first, because its folders may differ for that reason.
    if matches!(root.entry(OWN), Ok(EntryType::Folder)) {
        let own = root.folder(OWN).map_err(|error| unwritable(path, &error))?;
        if matches!(own.entry(IDENTITY), Ok(EntryType::File))
            && let Some(there) = known(path, &own)?
        {
            compared(path, &there, identity)?;
        }
    }
    // Depth of folders below that of an array: c, and one per axis except the last, which is in the names of the chunks.
    let arrays = layout.arrays().map(|array| (layout::name(array), array.dimensionality()));
    let expected: HashMap<&str, usize> = arrays.chain([(OWN, 1)]).collect();
    let entries = root.entries().map_err(|error| unwritable(path, &error))?;
    for (name, entry) in entries {
        match expected.get(name.as_str()) {
            Some(&depth) => check_entry(path, &root, (&name, entry), (&name, depth + 1))?,
            None if name == METADATA => check_entry(path, &root, (&name, entry), (&name, 0))?,
            // Not part of a store, and left alone.
            None => {}
        }
    }
    Ok(())
}

/// Rejects links, pipes and anything else that is neither a file nor a folder, and folders nested deeper than those of a
/// store. The entry is in `folder`; its key is relative to the store.
fn check_entry(
    path: &Path,
    folder: &Folder,
    (name, entry): (&str, EntryType),
    (key, depth): (&str, usize),
) -> Result<(), Failure> {
    match entry {
        EntryType::File => Ok(()),
        EntryType::Folder if depth > 0 => {
            let inside = folder.folder(name).map_err(|error| unwritable(path, &error))?;
            let entries = inside.entries().map_err(|error| unwritable(path, &error))?;
            entries.into_iter().try_for_each(|(name, entry)| {
                let key = format!("{key}/{name}");
                check_entry(path, &inside, (&name, entry), (&key, depth - 1))
            })
        }
        entry => Err(complaint(
            path,
            format!(
                "contains {} at {key}, where a store has only {}; Quell does not follow, write or remove it: \
                 remove it yourself, or choose another name",
                entry.words(),
                if depth > 0 { "folders and files" } else { "files" },
            ),
        )),
    }
}

/// Identity of the map of a store; `None` if it does not exist yet. An incomplete one is read again after a moment: on a file
/// system without hard links, the process that created it may still be writing.
pub(super) fn known(path: &Path, own: &Folder) -> Result<Option<Json>, Failure> {
    for _ in 0..PATIENCE {
        match own.read(IDENTITY, LONGEST) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(unwritable(path, &error)),
            Ok(bytes) => {
                if let Ok(there) = serde_json::from_slice(&bytes) {
                    return Ok(Some(there));
                }
            }
        }
        thread::sleep(MOMENT);
    }
    Ok(Some(Json::Null))
}

/// Rejects the store of another map.
pub(super) fn compared(path: &Path, there: &Json, identity: &Json) -> Result<(), Failure> {
    let differences = identity::differences(there, identity);
    if differences.is_empty() { Ok(()) } else { Err(another(path, &differences)) }
}
