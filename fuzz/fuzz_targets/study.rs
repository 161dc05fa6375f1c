//! Any text is either rejected with complaints, or is a study that remains the same when it is rebuilt from its document.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use quell::Study;

fuzz_target!(|text: &str| {
    match Study::parse(text, &[], Path::new("")) {
        Ok(study) => {
            let again = study.at([]).expect("valid without its axes");
            assert_eq!(again.settings(), study.settings());
        }
        Err(complaints) => {
            for complaint in complaints {
                assert!(!complaint.allowed.is_empty());
                assert_ne!(complaint.suggestion.as_ref(), Some(&complaint.key));
            }
        }
    }
});
