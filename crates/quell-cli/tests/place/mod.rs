//! The binary in a fresh folder, for several test files.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::Mutex;
use std::thread::{self, ThreadId};

use serde_json::Value as Json;

/// A fresh folder.
pub(crate) struct Place {
    pub(crate) folder: PathBuf,
}

impl Place {
    /// A fresh folder with these files.
    pub(crate) fn with(name: &str, files: &[(&str, &str)]) -> Self {
        static USERS: Mutex<BTreeMap<String, ThreadId>> = Mutex::new(BTreeMap::new());
        let test = thread::current().id();
        let user = USERS.lock().map(|mut users| *users.entry(name.to_owned()).or_insert(test));
        assert_eq!(user.ok(), Some(test), "two tests use the folder {name}");
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        // The folder may remain from an earlier run.
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).expect("a folder for tests");
        let place = Self { folder };
        for (name, text) in files {
            place.write(name, text);
        }
        place
    }

    pub(crate) fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        fs::write(self.folder.join(name), bytes).expect("a file for tests");
    }

    pub(crate) fn quell(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().expect("quell runs")
    }

    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_quell"));
        command.current_dir(&self.folder).args(arguments).stdin(Stdio::null());
        command
    }

    /// Runs a verb with `--json` and returns the object and the exit status. Errors are reported in the object, and standard
    /// error is empty then; an answer may be accompanied by warnings.
    pub(crate) fn json(&self, arguments: &[&str]) -> (Json, i32) {
        let mut with = arguments.to_vec();
        with.push("--json");
        let output = self.quell(&with);
        let text = String::from_utf8(output.stdout).expect("UTF-8");
        let object: Json =
            serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}"));
        assert!(object.is_object(), "{text}");
        assert!(output.status.success() || output.stderr.is_empty(), "{arguments:?}");
        (object, output.status.code().expect("an exit status"))
    }

    pub(crate) fn good(&self, arguments: &[&str]) -> Json {
        let (object, status) = self.json(arguments);
        assert_eq!(status, 0, "{arguments:?}: {object}");
        assert_eq!(object["ok"], true);
        object
    }

    /// Runs a verb that must be rejected, with and without `--json`, and returns the complaints.
    pub(crate) fn refused(&self, arguments: &[&str]) -> Vec<Json> {
        let before = self.files();
        let output = self.quell(arguments);
        let printed = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {printed}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
        assert!(printed.contains("error"), "{arguments:?}: {printed}");
        assert!(!printed.contains("panicked"), "{printed}");
        let (object, status) = self.json(arguments);
        assert_eq!((status, &object["ok"]), (2, &Json::Bool(false)), "{arguments:?}");
        assert_eq!(self.files(), before, "{arguments:?}");
        let errors = object["errors"].as_array().expect("errors").clone();
        assert!(!errors.is_empty());
        for error in &errors {
            for field in ["key", "line", "value", "allowed", "suggestion"] {
                assert!(error.get(field).is_some(), "{error}");
            }
        }
        errors
    }

    pub(crate) fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.folder).expect("a folder");
        let mut names: Vec<String> = entries
            .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }
}
