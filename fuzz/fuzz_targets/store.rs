//! If one file of a store is replaced by arbitrary bytes, the store is rejected, the chunk is found damaged, or it is read
//! with its original values.
#![no_main]

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use std::sync::atomic::AtomicBool;

use libfuzzer_sys::fuzz_target;
use quell::BeltStudy;
use quell::map::run;
use quell::store::{ChunkState, Store};
use quell::running::Running;
use quell::sweep::{MapQuantity, Plan};

const MAP: &str = "schema = 1\n[belt]\ndamping_ratio = 0.005\nnormal_load = 1\nbelt_velocity = 0.05\n\
    [friction]\nlaw = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n\
    [dither]\ndirection = \"tangential\"\nwaveform = \"sine\"\namplitude = 0.4\nfrequency_ratio = 10\n\
    [[sweep]]\nparameter = \"dither.amplitude\"\nfrom = 0.1\nto = 0.9\npoints = 3\n";

struct Whole {
    _folder: tempfile::TempDir,
    path: PathBuf,
    plan: Plan,
    known: ChunkState,
    files: Vec<PathBuf>,
}

static WHOLE: LazyLock<Whole> = LazyLock::new(|| {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("whole.zarr");
    let study = BeltStudy::parse(MAP, &[]).expect("valid");
    let quantity = MapQuantity::named("verdict", "fuzz").expect("known");
    let plan = Plan::new(&study, &[quantity]).expect("a plan");
    let store = Store::open(&path, &plan, false).expect("made");
    let never = AtomicBool::new(false);
    let running = Running { threads: Some(1), stop: &never, progress: &() };
    run(plan.clone(), Some(&store), running).expect("computed");
    let known = store.read(&plan, 0);
    drop(store);
    let mut files = Vec::new();
    gather(&path, &path, &mut files);
    files.sort();
    Whole { _folder: folder, path, plan, known, files }
});

fn gather(root: &Path, folder: &Path, files: &mut Vec<PathBuf>) {
    for file in fs::read_dir(folder).expect("a folder") {
        let path = file.expect("a file").path();
        if path.is_dir() {
            gather(root, &path, files);
        } else {
            files.push(path.strip_prefix(root).expect("inside").to_owned());
        }
    }
}

fuzz_target!(|input: (u8, &[u8])| {
    let whole = &*WHOLE;
    let (which, bytes) = input;
    let chosen = usize::from(which) % whole.files.len();
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("damaged.zarr");
    for (number, name) in whole.files.iter().enumerate() {
        let place = path.join(name);
        fs::create_dir_all(place.parent().expect("a folder")).expect("made");
        if number == chosen {
            fs::write(place, bytes).expect("written");
        } else {
            fs::copy(whole.path.join(name), place).expect("copied");
        }
    }
    if let Ok(store) = Store::open(&path, &whole.plan, true) {
        if let ChunkState::Whole(values) = store.read(&whole.plan, 0) {
            assert_eq!(ChunkState::Whole(values), whole.known);
        }
    }
});
