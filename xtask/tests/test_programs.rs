//! Every file of tests is run: a crate that links its tests into one program names each file in it.

use std::fs;
use std::path::Path;

#[test]
fn every_file_of_tests_belongs_to_a_program() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates");
    let mut seen = 0;
    for folder in fs::read_dir(crates).expect("the crates") {
        let folder = folder.expect("a crate").path();
        let manifest = fs::read_to_string(folder.join("Cargo.toml")).expect("a manifest");
        if !manifest.contains("autotests = false") {
            continue;
        }
        let all =
            fs::read_to_string(folder.join("tests/all.rs")).expect("the program of all tests");
        for file in fs::read_dir(folder.join("tests")).expect("the tests") {
            let path = file.expect("a file").path();
            let name = path.file_stem().and_then(|name| name.to_str()).expect("a name");
            let has_tests =
                path.join("main.rs").exists() || path.extension().is_some_and(|e| e == "rs");
            let is_module = all.lines().any(|line| line == format!("mod {name};"));
            let is_program = manifest.contains(&format!("name = \"{name}\""));
            assert!(!has_tests || is_module || is_program, "{} is not run", path.display());
            seen += usize::from(has_tests);
        }
    }
    assert!(seen > 80, "{seen}");
}
