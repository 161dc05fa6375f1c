//! Faults that stores survive: after any of them, a resumed store has the bytes of an uninterrupted one.

use std::collections::BTreeMap;
use std::fs::{self, OpenOptions};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;
use std::thread::sleep;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use crate::place::{Place, ProcessOutput, STUDY, files, same};

/// The store of an uninterrupted run, and its duration; computed once for all tests.
pub(crate) fn undisturbed() -> &'static (BTreeMap<String, Vec<u8>>, Duration) {
    static STORE: OnceLock<(BTreeMap<String, Vec<u8>>, Duration)> = OnceLock::new();
    STORE.get_or_init(|| {
        let place = large("undisturbed");
        let begun = Instant::now();
        place.good(&ask("undisturbed.zarr", &[]));
        (place.store("undisturbed.zarr"), begun.elapsed())
    })
}

/// Axes of a map that takes some seconds on one thread.
const LARGE: &str = "[[sweep]]\nparameter = \"dither.amplitude\"\nfrom = 0.05\nto = 1.0\n\
    points = 20\n[[sweep]]\nparameter = \"belt.belt_velocity\"\nfrom = 0.02\nto = 0.15\npoints = 20\n";

/// Arguments of the large map.
const ASK: &[&str] =
    &["map", "large.toml", "--quantity", "residual-vibration,verdict", "--threads", "1", "--save"];

pub(crate) fn large(name: &str) -> Place {
    let place = Place::new(name);
    let study = STUDY.replace("settle = 5", "settle = 100").replace("periods = 4", "periods = 10");
    place.write("large.toml", format!("{study}{LARGE}"));
    place
}

pub(crate) fn ask<'a>(save: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [ASK, &[save], more].concat()
}

impl Place {
    /// Starts the large map and does not wait for it.
    fn begin(&self, save: &str) -> Child {
        let arguments = ask(save, &["--resume"]);
        let mut command = self.command(&arguments);
        command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("quell runs")
    }

    /// Completion records of a store.
    pub(crate) fn records(&self, save: &str) -> usize {
        fs::read_dir(self.folder.join(save).join(".quell/done")).map_or(0, Iterator::count)
    }
}

#[test]
fn a_run_killed_at_ten_random_moments_resumes_to_the_same_bytes() {
    let place = large("killed");
    let (reference, duration) = undisturbed();
    let now = SystemTime::now().duration_since(UNIX_EPOCH).expect("after 1970");
    let mut random = u64::from(now.subsec_nanos()) | 1;
    println!("seed {random}");
    let (mut before, mut grew) = (0, 0);
    for _ in 0..10 {
        let mut child = place.begin("killed.zarr");
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        // Ten such intervals together are about as long as the whole run.
        sleep(duration.mul_f64(0.25 * (random >> 33) as f64 / f64::from(u32::MAX >> 1)));
        child.kill().expect("it is ours");
        child.wait().expect("it ends");
        let records = place.records("killed.zarr");
        assert!(records >= before, "a finished chunk is never lost");
        grew += usize::from(records > before);
        before = records;
    }
    // On a busy machine all ten may come before the first chunk: the next waits for one.
    if grew == 0 {
        let mut child = place.begin("killed.zarr");
        while place.records("killed.zarr") == 0 && child.try_wait().expect("it is ours").is_none() {
            sleep(duration.mul_f64(0.01));
        }
        child.kill().expect("it is ours");
        child.wait().expect("it ends");
        before = place.records("killed.zarr");
        grew = before;
    }
    let map = place.good(&ask("killed.zarr", &["--resume"]));
    if before > 0 {
        assert!(map["resumed_points"].as_u64().is_some_and(|points| points > 0));
    }
    assert!(grew > 0, "every kill came before the first chunk");
    assert_eq!(
        map["warnings"].as_array().map_or(0, Vec::len),
        warnings_of_points(&map),
        "{}",
        map["warnings"]
    );
    same(&place.store("killed.zarr"), reference);
}

/// Warnings about points, not about the store.
fn warnings_of_points(map: &serde_json::Value) -> usize {
    let warnings = map["warnings"].as_array().map(Vec::as_slice).unwrap_or_default();
    warnings
        .iter()
        .filter(|text| text.as_str().is_some_and(|text| text.contains("settled")))
        .count()
}

#[test]
fn a_run_stopped_by_ctrl_c_reports_the_remaining_chunks_and_resumes() {
    let place = large("stopped");
    let (reference, _) = undisturbed();
    let child = place.begin("stopped.zarr");
    wait_for("a chunk", || place.records("stopped.zarr") > 0);
    signal(&child, "-INT");
    let printed = ProcessOutput::of(&child.wait_with_output().expect("it ends"));
    assert_eq!(printed.status, Some(130), "{printed:?}");
    assert!(
        printed.errors.contains(" left: ") && printed.errors.contains("--resume"),
        "{}",
        printed.errors
    );
    assert!(printed.output.is_empty());
    let kept = place.records("stopped.zarr");
    place.good(&ask("stopped.zarr", &["--resume"]));
    assert!(kept < place.records("stopped.zarr"));
    same(&place.store("stopped.zarr"), reference);
}

#[test]
fn two_processes_on_one_store_do_no_harm() {
    let place = large("two");
    let (reference, _) = undisturbed();
    let first = place.begin("two.zarr");
    wait_for("a chunk", || place.records("two.zarr") > 0);
    let second = place.printed(&ask("two.zarr", &["--resume"]));
    assert_eq!(second.status, Some(1), "{second:?}");
    assert!(second.errors.contains("another process is writing this store"), "{second:?}");
    let first = ProcessOutput::of(&first.wait_with_output().expect("it ends"));
    assert_eq!(first.status, Some(0), "{first:?}");
    same(&place.store("two.zarr"), reference);
    // Two processes start at once without a store: the later one is rejected, and no file is destroyed.
    let (one, other) = (place.begin("race.zarr"), place.begin("race.zarr"));
    let ends: Vec<Option<i32>> = [one, other]
        .map(|child| ProcessOutput::of(&child.wait_with_output().expect("it ends")).status)
        .to_vec();
    assert!(ends.contains(&Some(0)), "{ends:?}");
    same(&place.store("race.zarr"), reference);
}

#[test]
fn damaged_chunks_are_found_and_recomputed() {
    let place = large("damaged");
    let (reference, _) = undisturbed();
    let at = |name: &str| place.folder.join("damaged.zarr").join(name);
    for (name, bytes) in reference {
        let path = at(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, bytes).expect("a copy");
    }
    let chunk = |array: &str, number: usize| {
        let chunks = reference.keys().filter(|name| name.starts_with(&format!("{array}/c/")));
        at(chunks.clone().nth(number).expect("chunks enough"))
    };
    let cut = chunk("residual_vibration", 0);
    let length = fs::metadata(&cut).expect("a chunk").len();
    let file = OpenOptions::new().write(true).open(&cut).expect("a chunk");
    file.set_len(length - 5).expect("cut short");
    let changed = chunk("residual_vibration_status", 1);
    let mut bytes = fs::read(&changed).expect("a chunk");
    bytes[0] ^= 1;
    fs::write(&changed, bytes).expect("changed");
    fs::remove_file(chunk("verdict", 2)).expect("removed");
    let record = reference.keys().filter(|name| name.starts_with(".quell/done/")).nth(3);
    let record = at(record.expect("records enough"));
    fs::write(&record, "{\"files\":{").expect("a record cut short");
    let printed = place.printed(&ask("damaged.zarr", &["--resume"]));
    assert_eq!(printed.status, Some(0), "{printed:?}");
    assert!(
        printed.errors.contains("recomputed 4 chunks of the store that were truncated or changed"),
        "{printed:?}"
    );
    same(&place.store("damaged.zarr"), reference);
}

#[test]
fn a_store_of_another_study_is_rejected_and_left_unchanged() {
    let place = Place::new("another");
    let small = fs::read_to_string(place.folder.join("small.toml")).expect("a study");
    let ask = |quantity, more: &[&'static str]| {
        [&["map", "small.toml", "--quantity", quantity, "--save", "m.zarr"], more].concat()
    };
    place.good(&ask("residual-vibration", &[]));
    let reference = place.store("m.zarr");
    let refused = |arguments: &[&str], word: &str| {
        let printed = place.printed(arguments);
        assert_eq!(printed.status, Some(2), "{arguments:?}: {printed:?}");
        assert!(printed.errors.contains(word), "{arguments:?}: {printed:?}");
        same(&place.store("m.zarr"), &reference);
    };
    refused(&ask("residual-vibration", &[]), "already exists");
    refused(&ask("verdict", &["--resume"]), "the quantities are verdict");
    for (from, to, word) in [
        ("= 0.005", "= 0.0051", "belt.damping_ratio is 0.0051 here and 0.005 in the store"),
        ("settle = 5", "settle = 6", "solver.settle"),
        ("points = 3", "points = 4", "dither.amplitude has the values"),
        ("\"sine\"", "\"square\"", "dither.waveform"),
        ("values = [0.05", "values = [0.0500000000000001", "belt.belt_velocity has the values"),
    ] {
        assert!(small.contains(from));
        place.write("small.toml", small.replace(from, to));
        refused(&ask("residual-vibration", &["--resume"]), word);
    }
    // Changes that do not affect any number are allowed: comments, the title, a value that an axis replaces.
    let edited = small
        .replace("Stribeck belt", "The same belt")
        .replace("amplitude = 0.4\n", "amplitude = 0.7 # an axis\n");
    place.write("small.toml", edited);
    assert_eq!(place.good(&ask("residual-vibration", &["--resume"]))["resumed_points"], 12);
    same(&place.store("m.zarr"), &reference);
    // Another version of Quell may give other bits.
    let identity = place.folder.join("m.zarr/.quell/map.json");
    let text = fs::read_to_string(&identity).expect("what the store is of");
    let version = concat!("\"", env!("CARGO_PKG_VERSION"), "\"");
    fs::write(&identity, text.replacen(version, "\"0.0.9\"", 1)).expect("another version");
    let printed = place.printed(&ask("residual-vibration", &["--resume"]));
    assert_eq!(printed.status, Some(2));
    assert!(printed.errors.contains("bits may differ"), "{printed:?}");
}

#[test]
fn a_full_disk_is_reported_and_survived() {
    let place = large("full");
    let (reference, _) = undisturbed();
    let Some(disk) = Disk::mount(&place.folder.join("disk"), "size=256k") else {
        return limited(&place, reference);
    };
    // Space for the metadata and some chunks.
    let printed = place.printed(&ask("disk/full.zarr", &[]));
    assert_eq!(printed.status, Some(1), "{printed:?}");
    assert!(printed.errors.contains("No space left on device"), "{printed:?}");
    assert!(printed.errors.contains("--resume"), "{printed:?}");
    let kept = place.records("disk/full.zarr");
    assert!(kept > 0, "no room for a single chunk: {printed:?}");
    let left = files(&disk.path.join("full.zarr"));
    assert!(!left.keys().any(|name| name.starts_with(".quell/unfinished/")), "half a file is left");
    for (name, bytes) in &left {
        assert_eq!(reference.get(name), Some(bytes), "{name}");
    }
    disk.remount("size=16m");
    let map = place.good(&ask("disk/full.zarr", &["--resume"]));
    assert!(map["resumed_points"].as_u64().is_some_and(|points| points > 0));
    same(&files(&disk.path.join("full.zarr")), reference);
    // Not enough space to create the store: no file remains.
    let tiny = Disk::mount(&place.folder.join("tiny"), "size=8k").expect("mounted before");
    let printed = place.printed(&ask("tiny/full.zarr", &[]));
    assert_eq!(printed.status, Some(1), "{printed:?}");
    assert!(printed.errors.contains("No space left on device"), "{printed:?}");
    assert_eq!(fs::read_dir(&tiny.path).expect("a disk").count(), 0, "something half-made is left");
}

/// If no file system can be mounted, a limit on the size of files replaces the full disk.
fn limited(place: &Place, reference: &BTreeMap<String, Vec<u8>>) {
    println!("no file system can be mounted here: files are limited to 512 bytes instead");
    let program = env!("CARGO_BIN_EXE_quell");
    let line =
        format!("trap '' XFSZ; ulimit -f 1; exec {program} {}", ask("full.zarr", &[]).join(" "));
    let output = Command::new("sh").current_dir(&place.folder).args(["-c", &line]).output();
    let printed = ProcessOutput::of(&output.expect("a shell"));
    assert_eq!(printed.status, Some(1), "{printed:?}");
    assert!(printed.errors.contains("cannot be written: File too large"), "{printed:?}");
    place.good(&ask("full.zarr", &["--resume"]));
    same(&place.store("full.zarr"), reference);
}

#[test]
fn an_unwritable_store_is_reported_at_once() {
    let place = large("read_only");
    let below = place.printed(&ask("study.toml/below.zarr", &[]));
    assert_eq!(below.status, Some(2), "{below:?}");
    assert!(below.errors.contains("cannot be written: Not a directory"), "{below:?}");
    let Some(disk) = Disk::mount(&place.folder.join("disk"), "size=16m") else {
        println!("no file system can be mounted here: only a path below a file was tried");
        return;
    };
    let child = place.begin("disk/begun.zarr");
    wait_for("a chunk", || place.records("disk/begun.zarr") > 0);
    signal(&child, "-TERM");
    child.wait_with_output().expect("it ends");
    let before = files(&disk.path);
    disk.remount("ro");
    for save in ["disk/new.zarr", "disk/begun.zarr"] {
        let printed = place.printed(&ask(save, &["--resume"]));
        assert_eq!(printed.status, Some(2), "{printed:?}");
        assert!(printed.errors.contains("Read-only file system"), "{printed:?}");
    }
    same(&files(&disk.path), &before);
    disk.remount("rw");
    place.good(&ask("disk/begun.zarr", &["--resume"]));
}

#[track_caller]
pub(crate) fn wait_for(what: &str, there: impl Fn() -> bool) {
    let begun = Instant::now();
    while !there() {
        assert!(begun.elapsed() < Duration::from_mins(1), "{what} did not come");
        sleep(Duration::from_millis(2));
    }
}

fn signal(child: &Child, name: &str) {
    let printed = Command::new("kill").args([name, &child.id().to_string()]).status();
    assert!(printed.expect("kill").success());
}

/// A small file system that is unmounted when it is dropped.
struct Disk {
    path: PathBuf,
}

impl Disk {
    /// `None` if mounting is not allowed.
    fn mount(path: &Path, options: &str) -> Option<Self> {
        fs::create_dir_all(path).expect("a place for a disk");
        let arguments = ["-t", "tmpfs", "-o", options, "quell-test"];
        let mounted = Command::new("mount").args(arguments).arg(path).output().ok()?;
        mounted.status.success().then(|| Self { path: path.to_owned() })
    }

    fn remount(&self, options: &str) {
        let options = format!("remount,{options}");
        let printed = Command::new("mount").args(["-o", &options]).arg(&self.path).status();
        assert!(printed.expect("mount").success());
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        // A mount that stays is taken away with the machine.
        let _ = Command::new("umount").arg("-l").arg(&self.path).status();
    }
}
