//! Names of files and folders of a store.

/// Folder of files that readers of Zarr do not need.
pub(super) const OWN: &str = ".quell";

/// Folder of completion records inside [`OWN`].
pub(super) const DONE: &str = "done";

/// Folder of unfinished files inside [`OWN`].
pub(super) const UNFINISHED: &str = "unfinished";

/// File inside [`OWN`] that identifies the map.
pub(super) const IDENTITY: &str = "map.json";

/// Metadata of the group, and of an array in its folder.
pub(super) const METADATA: &str = "zarr.json";

/// The longest record or identity that is read (bytes): the text of a study has at most 16 MiB, more than ten times as much
/// as everything else in them.
pub(super) const LONGEST: u64 = 64 << 20;
