//! Files that a study was read from: only regular files are opened, and outputs never overwrite them.

use std::fs::{self, File, Metadata};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// Reads a regular file of at most `most` bytes. Pipes and devices, which may never end or block, are not read: the type of
/// the file is checked before and after it is opened without blocking.
///
/// # Errors
/// File system errors; a file that is not regular or is longer than `most`.
pub fn read_regular(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let regular = |found: &Metadata| {
        let refused = || io::Error::other("it is not a regular file");
        if found.is_file() { Ok(()) } else { Err(refused()) }
    };
    regular(&fs::metadata(path)?)?;
    let file = open_at_once(path)?;
    regular(&file.metadata()?)?;
    let mut bytes = Vec::new();
    file.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        return Err(io::Error::other(format!("it is larger than {} MiB", most >> 20)));
    }
    Ok(bytes)
}

/// Opens a file for reading without blocking on a pipe.
#[cfg(unix)]
fn open_at_once(path: &Path) -> io::Result<File> {
    use rustix::fs::{Mode, OFlags, open};
    let flags = OFlags::RDONLY | OFlags::NONBLOCK | OFlags::NOCTTY | OFlags::CLOEXEC;
    Ok(open(path, flags, Mode::empty())?.into())
}

#[cfg(not(unix))]
fn open_at_once(path: &Path) -> io::Result<File> {
    File::open(path)
}

/// The files that a study was read from.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Inputs {
    files: Vec<PathBuf>,
    /// Whether the study was read from standard input.
    standard_input: bool,
}

/// A file that a study was read from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InputFile {
    name: String,
}

impl InputFile {
    /// Why it must not be used as an output.
    pub fn refusal(&self) -> String {
        format!("would overwrite {}, which the study is read from; choose another name", self.name)
    }
}

impl Inputs {
    /// No file is read.
    pub const NONE: Self = Self { files: Vec::new(), standard_input: false };

    /// These files; `-` is standard input.
    pub fn of<'p>(paths: impl IntoIterator<Item = &'p Path>) -> Self {
        let mut inputs = Self::NONE;
        for path in paths {
            if path == Path::new("-") {
                inputs.standard_input = true;
            } else {
                inputs.files.push(path.to_owned());
            }
        }
        inputs
    }

    /// These files and further ones, such as those of measurements.
    #[must_use]
    pub fn with_files<'p>(mut self, paths: impl IntoIterator<Item = &'p Path>) -> Self {
        self.files.extend(paths.into_iter().map(Path::to_owned));
        self
    }

    /// The input file that `path` refers to, also through links or as a second name of the same file.
    pub fn at(&self, path: &Path) -> Option<InputFile> {
        let found = fs::metadata(path).ok().filter(Metadata::is_file)?;
        if self.standard_input && is_standard_input(&found) {
            return Some(InputFile { name: "the file that is standard input".to_owned() });
        }
        let same = |file: &&PathBuf| is_same(file, path, &found);
        self.files.iter().find(same).map(|file| InputFile { name: file.display().to_string() })
    }

    /// An input file that is in the folder `path`, or is `path` itself.
    pub fn inside(&self, path: &Path) -> Option<InputFile> {
        let folder = path.canonicalize().ok()?;
        let within =
            |file: &&PathBuf| file.canonicalize().is_ok_and(|file| file.starts_with(&folder));
        self.files.iter().find(within).map(|file| InputFile { name: file.display().to_string() })
    }
}

/// Whether a file is the one `found` at `path`.
#[cfg(unix)]
fn is_same(file: &Path, _path: &Path, found: &Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    let identity = |file: &Metadata| (file.dev(), file.ino());
    fs::metadata(file).is_ok_and(|file| identity(&file) == identity(found))
}

#[cfg(not(unix))]
fn is_same(file: &Path, path: &Path, _found: &Metadata) -> bool {
    matches!((file.canonicalize(), path.canonicalize()), (Ok(file), Ok(path)) if file == path)
}

/// Whether the file found is the one connected to standard input.
#[cfg(unix)]
fn is_standard_input(found: &Metadata) -> bool {
    use std::os::fd::AsFd;
    use std::os::unix::fs::MetadataExt;
    let handle = io::stdin().as_fd().try_clone_to_owned();
    let there = handle.and_then(|handle| File::from(handle).metadata());
    there.is_ok_and(|input| (input.dev(), input.ino()) == (found.dev(), found.ino()))
}

#[cfg(not(unix))]
fn is_standard_input(_found: &Metadata) -> bool {
    false
}
