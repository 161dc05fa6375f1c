//! A fresh folder with a study in it, and stores compared byte by byte.

#[path = "../place/mod.rs"]
mod folder;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Output;

pub(crate) use folder::Place;

/// A study whose response is short.
pub(crate) const STUDY: &str = r#"schema = 1
title = "Stribeck belt"
[belt]
damping_ratio = 0.005
normal_load = 1.0
belt_velocity = 0.05
[friction]
law = "stribeck"
static_coefficient = 0.4
minimum_coefficient = 0.2857
reference_velocity = 0.2
[dither]
direction = "tangential"
waveform = "sine"
amplitude = 0.4
frequency_ratio = 10.0
[solver]
settle = 5
record_periods = 4
"#;

/// Axes of a small map.
pub(crate) const SMALL: &str = "[[sweep]]\nparameter = \"dither.amplitude\"\nfrom = 0.1\nto = 0.9\n\
    points = 3\n[[sweep]]\nparameter = \"belt.belt_velocity\"\nvalues = [0.05, 0.1, 0.15, 0.5]\n";

impl Place {
    /// With the study, and with the study and its axes.
    pub(crate) fn new(name: &str) -> Self {
        let small = format!("{STUDY}{SMALL}");
        Self::with(&format!("map/{name}"), &[("study.toml", STUDY), ("small.toml", &small)])
    }

    /// Runs a verb and returns its text output.
    pub(crate) fn printed(&self, arguments: &[&str]) -> ProcessOutput {
        ProcessOutput::of(&self.quell(arguments))
    }

    /// Every file of a store except its lock.
    pub(crate) fn store(&self, name: &str) -> BTreeMap<String, Vec<u8>> {
        files(&self.folder.join(name))
    }
}

/// Every file below a folder except the lock of a store.
pub(crate) fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    fn walk(folder: &Path, top: &Path, files: &mut BTreeMap<String, Vec<u8>>) {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                walk(&path, top, files);
            } else {
                let name = path.strip_prefix(top).expect("below").display().to_string();
                if name != ".quell/lock" {
                    files.insert(name, fs::read(&path).expect("a file"));
                }
            }
        }
    }
    let mut found = BTreeMap::new();
    walk(folder, folder, &mut found);
    found
}

/// Reports which files differ, without printing their bytes.
#[track_caller]
pub(crate) fn same(one: &BTreeMap<String, Vec<u8>>, other: &BTreeMap<String, Vec<u8>>) {
    let names = |files: &BTreeMap<String, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(one), names(other));
    let differ: Vec<&String> = one.keys().filter(|name| one[*name] != other[*name]).collect();
    assert!(differ.is_empty(), "{differ:?}");
}

/// The output of a process.
#[derive(Debug)]
pub(crate) struct ProcessOutput {
    pub(crate) status: Option<i32>,
    pub(crate) output: String,
    pub(crate) errors: String,
}

impl ProcessOutput {
    pub(crate) fn of(output: &Output) -> Self {
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        let printed = Self {
            status: output.status.code(),
            output: text(&output.stdout),
            errors: text(&output.stderr),
        };
        assert!(!printed.errors.contains("panicked"), "{printed:?}");
        printed
    }
}
