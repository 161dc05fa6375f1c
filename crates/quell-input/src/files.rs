//! The files that a study names. Each is read once, and the study holds it: what is made from the study later, by other numbers, in
//! another process or after the file is gone, is computed from the same contents.

use std::any::Any;
use std::fmt;
use std::path::{self, Path, PathBuf};
use std::sync::Arc;

use crate::data_file;
use crate::wrong_file::UnreadFile;

/// The files of a study, and the folder in which they are.
#[derive(Clone, Default)]
pub struct Files {
    folder: PathBuf,
    held: Vec<HeldFile>,
    /// The keys that name a file, each with the place of its file.
    named: Vec<(String, usize)>,
}

/// A file as it was when it was read.
#[derive(Clone)]
struct HeldFile {
    path: PathBuf,
    text: Arc<str>,
    /// Its contents in the forms in which studies use them, one of each type.
    parsed: Vec<Arc<dyn Any + Send + Sync>>,
}

/// What a file must be.
#[derive(Clone, Copy, Debug)]
pub struct WantedFile {
    /// In words, such as "a CSV file of modes".
    pub what: &'static str,
    /// The largest size in MiB.
    pub largest: u64,
}

impl WantedFile {
    /// A file of the usual size.
    pub const fn of(what: &'static str) -> Self {
        Self { what, largest: data_file::LARGEST }
    }
}

impl Files {
    /// No files yet; those that are named are searched in `folder`, also when the working directory changes.
    pub fn in_folder(folder: &Path) -> Self {
        let empty = folder.as_os_str().is_empty();
        let found = if empty { std::env::current_dir() } else { path::absolute(folder) };
        Self { folder: found.unwrap_or_else(|_| folder.to_owned()), ..Self::default() }
    }

    /// Files of these contents, as [`held`](Self::held) gives them.
    pub fn holding(folder: &Path, held: impl IntoIterator<Item = (PathBuf, String)>) -> Self {
        let held = held.into_iter().map(|(path, text)| HeldFile {
            path,
            text: text.into(),
            parsed: Vec::new(),
        });
        Self { held: held.collect(), ..Self::in_folder(folder) }
    }

    /// The folder in which files are searched.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Path and contents of every file.
    pub fn held(&self) -> impl Iterator<Item = (&Path, &str)> {
        self.held.iter().map(|file| (file.path.as_path(), &*file.text))
    }

    /// The same files for another reading, which names its own.
    #[must_use]
    pub fn to_read_again(&self) -> Self {
        Self { named: Vec::new(), ..self.clone() }
    }

    /// The path of a file by its name in the study.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// The text of the file that `key` names.
    ///
    /// # Errors
    /// Why it cannot be read.
    pub fn text(
        &mut self,
        key: &str,
        name: &str,
        wanted: WantedFile,
    ) -> Result<Arc<str>, UnreadFile> {
        let place = self.place(key, name, wanted)?;
        Ok(Arc::clone(&self.held[place].text))
    }

    /// The contents of the file that `key` names, parsed once for each type.
    ///
    /// # Errors
    /// Why it cannot be read, or the line that is wrong.
    pub fn parsed<C: Send + Sync + 'static, E: From<UnreadFile>>(
        &mut self,
        key: &str,
        name: &str,
        wanted: WantedFile,
        parse: impl FnOnce(&str) -> Result<C, E>,
    ) -> Result<Arc<C>, E> {
        let place = self.place(key, name, wanted)?;
        let file = &mut self.held[place];
        let known = file.parsed.iter().find_map(|known| Arc::clone(known).downcast().ok());
        if let Some(known) = known {
            return Ok(known);
        }
        let made = Arc::new(parse(&file.text)?);
        file.parsed.push(Arc::clone(&made) as Arc<dyn Any + Send + Sync>);
        Ok(made)
    }

    /// The place of a file, which is read if it is not held yet.
    fn place(&mut self, key: &str, name: &str, wanted: WantedFile) -> Result<usize, UnreadFile> {
        let path = self.path(name);
        let known = self.held.iter().position(|file| file.path == path);
        let place = if let Some(place) = known {
            place
        } else {
            let text = data_file::text_up_to(&path, wanted.what, wanted.largest)?.into();
            self.held.push(HeldFile { path, text, parsed: Vec::new() });
            self.held.len() - 1
        };
        let name = (key.to_owned(), place);
        if !self.named.contains(&name) {
            self.named.push(name);
        }
        Ok(place)
    }

    /// The paths of the files that the study names.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        self.named.iter().map(|(_, place)| self.held[*place].path.as_path())
    }

    /// What identifies the contents of the files, as `key.contents = size and checksum`.
    pub fn settings(&self) -> impl Iterator<Item = (String, String)> {
        self.named.iter().map(|(key, place)| {
            let text = &self.held[*place].text;
            let sum = data_file::checksum(text.as_bytes());
            (format!("{key}.contents"), format!("{} bytes, {sum:016x}", text.len()))
        })
    }
}

/// Equal files have equal names and contents; what else is held is no part of the study.
impl PartialEq for Files {
    fn eq(&self, other: &Self) -> bool {
        let named = |files: &Self| -> Vec<(String, Arc<str>)> {
            let text = |place: usize| Arc::clone(&files.held[place].text);
            files.named.iter().map(|(key, place)| (key.clone(), text(*place))).collect()
        };
        named(self) == named(other)
    }
}

/// Contents are not shown: a study may name any file.
impl fmt::Debug for Files {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let paths: Vec<&Path> = self.held().map(|(path, _)| path).collect();
        formatter
            .debug_struct("Files")
            .field("folder", &self.folder)
            .field("held", &paths)
            .finish_non_exhaustive()
    }
}
