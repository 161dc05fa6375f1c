//! The examples of the front door run, and the assertions in them hold.

#[path = "../examples/disc.rs"]
mod disc;
#[path = "../examples/map.rs"]
mod map;
#[path = "../examples/own_law.rs"]
mod own_law;
#[path = "../examples/response.rs"]
mod response;
#[path = "../examples/thresholds.rs"]
mod thresholds;

/// Every file of the folder is among the tests.
#[test]
fn every_example_is_run() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let mut names: Vec<String> = folder
        .read_dir()
        .expect("a folder of examples")
        .map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    assert_eq!(names, ["disc.rs", "map.rs", "own_law.rs", "response.rs", "thresholds.rs"]);
    for main in [disc::main, map::main, own_law::main, response::main, thresholds::main] {
        main().expect("the example answers its question");
    }
}
