//! Any text is a study or has complaints.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use quell::Subject;

fuzz_target!(|text: &str| {
    if let Err(complaints) = Subject::parse(text, &[], Path::new("")) {
        assert!(complaints.iter().all(|complaint| !complaint.allowed.is_empty()));
    }
});
