//! Tests of the binary with untrusted files: inputs are never outputs, no content of other files is printed, permissions are
//! kept, and limits and signals leave no partial files.
#![cfg(unix)]

use std::fs;
use std::io::Read;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::place::Place;

const MEASURED: &str = "schema = 1\n[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = 0.1\n\
    [friction]\nlaw = \"samples\"\nfile = \"data.csv\"\n\
    [dither]\ndirection = \"tangential\"\nwaveform = \"sine\"\namplitude = 0.3\nfrequency_ratio = 10\n\
    [solver]\nsettle = 5\nrecord_periods = 4\n\
    [[sweep]]\nparameter = \"dither.amplitude\"\nfrom = 0.1\nto = 0.9\npoints = 3\n";

const SAMPLES: &str = "slip_velocity,coefficient\n0,0.4\n0.1,0.35\n0.2,0.31\n0.3,0.29\n0.4,0.28\n0.5,0.275\n\
    0.6,0.273\n0.8,0.272\n";

const DISC: &str = "schema = 1\n[disc]\nmodes_file = \"data.csv\"\n[disc.load]\nmass = 0.1\n\
    damping = 0.1\nstiffness = 0.1\nfriction = 0.05\nspeed = 0.3\n";

const MODES: &str = "diameters,ratio,shape_at_load\n1,1.0,1.0\n2,1.3,0.9\n3,1.9,0.8\n";

/// Every verb of a belt that writes files.
const BELT_VERBS: &[&[&str]] = &[
    &["friction"],
    &["stability"],
    &["simulate", "--until", "5"],
    &["response"],
    &["orbit"],
    &["thresholds", "--parameter", "dither.amplitude", "--from", "0.5", "--to", "1"],
    &[
        "bifurcation",
        "--parameter",
        "dither.amplitude",
        "--from",
        "0.5",
        "--to",
        "1",
        "--points",
        "2",
    ],
    &["basins", "--grid", "2x2"],
    &["map", "--quantity", "growth"],
];

const DISC_VERBS: &[&[&str]] = &[&["modes"], &["stability"], &["resonances"]];

/// Names that are the study or its data.
fn disguise(place: &Place) -> Vec<&'static str> {
    let folder = &place.folder;
    fs::create_dir(folder.join("sub")).expect("a folder");
    for (target, link) in [
        ("data.csv", "link.csv"),
        ("study.toml", "study.csv"),
        ("data.csv", "link.svg"),
        ("study.toml", "study.svg"),
    ] {
        symlink(target, folder.join(link)).expect("a link");
    }
    fs::hard_link(folder.join("data.csv"), folder.join("hard.csv")).expect("a link");
    fs::hard_link(folder.join("study.toml"), folder.join("hard.svg")).expect("a link");
    vec![
        "data.csv",
        "./sub/../data.csv",
        "link.csv",
        "study.csv",
        "hard.csv",
        "link.svg",
        "study.svg",
        "hard.svg",
    ]
}

#[test]
fn inputs_are_never_outputs() {
    for (name, study, data, verbs) in
        [("belt", MEASURED, SAMPLES, BELT_VERBS), ("disc", DISC, MODES, DISC_VERBS)]
    {
        let files = [("study.toml", study), ("data.csv", data)];
        let place = Place::with(&format!("inputs/{name}"), &files);
        let names = disguise(&place);
        for (number, verb) in verbs.iter().enumerate() {
            for output in &names {
                // Every name with the first verb, two with each other.
                if number > 0 && !["link.csv", "study.svg"].contains(output) {
                    continue;
                }
                let option = if output.ends_with("svg") { "--plot" } else { "--save" };
                let arguments =
                    [&verb[..1], &["study.toml"], &verb[1..], &[option, output]].concat();
                if option == "--save" && ["stability", "orbit"].contains(&verb[0]) {
                    continue;
                }
                let errors = place.refused(&arguments);
                let printed = errors[0]["message"].as_str().unwrap_or_default();
                assert!(
                    printed.contains("which the study is read from"),
                    "{arguments:?}: {printed}"
                );
                for (file, text) in files {
                    let there = fs::read_to_string(place.folder.join(file)).expect("there");
                    assert_eq!(there, text, "{arguments:?}");
                }
            }
        }
    }
}

#[test]
fn a_study_on_standard_input_is_an_input_and_a_store_must_not_contain_one() {
    let place = Place::with("inputs/stdin", &[("study.toml", MEASURED), ("data.csv", SAMPLES)]);
    symlink("study.toml", place.folder.join("out.csv")).expect("a link");
    let file = fs::File::open(place.folder.join("study.toml")).expect("there");
    let mut command = place.command(&["friction", "-", "--save", "out.csv"]);
    let output = command.stdin(file).output().expect("quell runs");
    let printed = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{printed}");
    assert!(printed.contains("standard input"), "{printed}");
    assert_eq!(fs::read_to_string(place.folder.join("study.toml")).expect("there"), MEASURED);
    // The data inside a store, and the store around the study.
    fs::create_dir_all(place.folder.join("m.zarr/.quell")).expect("a folder");
    fs::rename(place.folder.join("data.csv"), place.folder.join("m.zarr/data.csv")).expect("moved");
    place.write("study.toml", MEASURED.replace("data.csv", "m.zarr/data.csv"));
    let ask = ["map", "study.toml", "--quantity", "growth", "--save", "m.zarr", "--resume"];
    let errors = place.refused(&ask);
    assert!(
        errors[0]["message"].as_str().is_some_and(|item| item.contains("read from")),
        "{errors:?}"
    );
}

/// The second table of a response has a name that the user has not given.
#[test]
fn existing_special_files_are_not_replaced_by_a_second_output() {
    let place = Place::with(
        "second",
        &[("study.toml", MEASURED), ("data.csv", SAMPLES), ("theirs", "theirs")],
    );
    let second = place.folder.join("out_spectrum.csv");
    symlink("theirs", &second).expect("a link");
    let ask = ["response", "study.toml", "--save", "out.csv"];
    let printed = format!("{:?}", place.refused(&ask));
    assert!(
        printed.contains("out_spectrum.csv") && printed.contains("not a regular file"),
        "{printed}"
    );
    assert_eq!(fs::read_to_string(place.folder.join("theirs")).expect("there"), "theirs");
    fs::remove_file(&second).expect("removed");
    assert!(Command::new("mkfifo").arg(&second).status().expect("mkfifo").success());
    let printed = format!("{:?}", place.refused(&ask));
    assert!(printed.contains("not a regular file"), "{printed}");
}

#[test]
fn the_content_of_files_that_are_not_data_is_not_printed() {
    let secret = "root:x:0:0:hunter2:/root:/bin/sh\ndaemon:x:1:1:hunter3:/usr\n";
    for (name, study) in [("belt", MEASURED), ("disc", DISC)] {
        let place =
            Place::with(&format!("secret/{name}"), &[("study.toml", study), ("data.csv", secret)]);
        let long = "9".repeat(100) + "hunter2";
        for text in [
            secret.to_owned(),
            secret.replace(':', ","),
            format!("slip_velocity,hunter2\n{secret}"),
            format!("diameters,hunter2\n{secret}"),
            // A data file with one invalid line: only a part of the cell is printed.
            format!(
                "slip_velocity,coefficient,diameters,ratio,shape_at_load\n{long},hunter2,{long},1,hunter2\n"
            ),
        ] {
            place.write("data.csv", &text);
            let errors = place.refused(&["check", "study.toml"]);
            let printed = format!("{errors:?}");
            assert!(!printed.contains("hunter") && !printed.contains("root"), "{printed}");
            assert!(printed.contains("a CSV file with") || printed.contains("line 2"), "{printed}");
        }
        // Paths that are not regular files are reported, and do not block.
        fs::remove_file(place.folder.join("data.csv")).expect("removed");
        let made = Command::new("mkfifo").arg(place.folder.join("data.csv")).status();
        assert!(made.expect("mkfifo").success());
        let printed = format!("{:?}", place.refused(&["check", "study.toml"]));
        assert!(printed.contains("not a regular file"), "{printed}");
    }
}

#[test]
fn replaced_outputs_keep_their_permissions_and_new_ones_have_the_default() {
    let place = Place::with("permissions", &[("study.toml", MEASURED), ("data.csv", SAMPLES)]);
    let mode = |name: &str| {
        fs::metadata(place.folder.join(name)).expect("there").permissions().mode() & 0o7777
    };
    for (name, bits) in [("a.csv", 0o600), ("b.csv", 0o664), ("c.svg", 0o640), ("d.csv", 0o666)] {
        place.write(name, "old");
        let path = place.folder.join(name);
        fs::set_permissions(&path, fs::Permissions::from_mode(bits)).expect("set");
        let option = if name.ends_with("svg") { "--plot" } else { "--save" };
        place.good(&["friction", "study.toml", option, name]);
        assert_ne!(fs::read_to_string(&path).expect("there"), "old");
        assert_eq!(mode(name), bits, "{name}");
    }
    for (mask, bits) in [("027", 0o640), ("077", 0o600), ("002", 0o664)] {
        let line = format!(
            "umask {mask}; exec {} friction study.toml --save new{mask}.csv",
            env!("CARGO_BIN_EXE_quell")
        );
        let done = Command::new("sh").current_dir(&place.folder).args(["-c", &line]).output();
        assert!(done.expect("a shell").status.success());
        assert_eq!(mode(&format!("new{mask}.csv")), bits, "{mask}");
    }
}

#[test]
fn exceeding_a_file_size_limit_is_an_ordinary_error() {
    let place = Place::with("limit", &[("study.toml", MEASURED), ("data.csv", SAMPLES)]);
    place.write("old.csv", "old");
    let before = place.files();
    for output in ["--save old.csv", "--save new.csv", "--plot new.svg"] {
        let line = format!(
            "ulimit -f 1; exec {} simulate study.toml --until 50 {output} --json",
            env!("CARGO_BIN_EXE_quell")
        );
        let done = Command::new("sh").current_dir(&place.folder).args(["-c", &line]).output();
        let done = done.expect("a shell");
        let printed = String::from_utf8_lossy(&done.stdout);
        assert_eq!(done.status.code(), Some(1), "{output}: {done:?}");
        assert!(printed.contains("File too large"), "{printed}");
        assert_eq!(place.files(), before, "{output}");
        assert_eq!(fs::read_to_string(place.folder.join("old.csv")).expect("there"), "old");
    }
}

/// Sends a signal to a child process.
fn signal(child: &Child, name: &str) {
    let sent = Command::new("kill").args([name, &child.id().to_string()]).status();
    assert!(sent.expect("kill").success());
}

/// Waits for the end of a process; returns its status and the time.
fn ended(mut child: Child) -> (Option<i32>, Duration) {
    let begun = Instant::now();
    loop {
        if let Some(status) = child.try_wait().expect("it is ours") {
            return (status.code(), begun.elapsed());
        }
        if begun.elapsed() > Duration::from_secs(30) {
            child.kill().expect("it is ours");
            panic!("it did not end");
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// The binary with the default action of every signal, where the shell of the tests ignores some (`nohup`).
fn with_signals(place: &Place, arguments: &[&str]) -> Command {
    if cfg!(not(target_os = "linux")) {
        return place.command(arguments);
    }
    let mut command = Command::new("env");
    command.args(["--default-signal", env!("CARGO_BIN_EXE_quell")]).args(arguments);
    command.current_dir(&place.folder).stdin(Stdio::null());
    command
}

#[test]
fn signals_end_every_verb() {
    let place = Place::with("signals", &[("study.toml", MEASURED), ("data.csv", SAMPLES)]);
    let begin = |arguments: &[&str]| {
        let mut command = with_signals(&place, arguments);
        let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
        let child = child.expect("quell runs");
        std::thread::sleep(Duration::from_millis(700));
        child
    };
    // A verb that cannot stop by itself is ended immediately.
    for (name, arguments) in [
        ("-INT", &["simulate", "study.toml", "--until", "1e8", "--save", "s.csv"][..]),
        ("-TERM", &["response", "study.toml", "--set", "solver.settle=1e8"]),
    ] {
        let child = begin(arguments);
        signal(&child, name);
        let (status, after) = ended(child);
        assert_eq!(status, Some(130), "{arguments:?}");
        assert!(after < Duration::from_secs(3), "{arguments:?}: {after:?}");
    }
    assert_eq!(place.files(), ["data.csv", "study.toml"]);
    // A verb that can is asked to stop first, and is ended at its deadline or by the second signal.
    for signals in [1, 2] {
        let store = format!("m{signals}.zarr");
        let mut child = begin(&[ENDLESS_MAP, &["--save", &store]].concat());
        for _ in 0..signals {
            signal(&child, "-INT");
            std::thread::sleep(Duration::from_millis(200));
        }
        let mut errors = child.stderr.take().expect("piped");
        let (status, after) = ended(child);
        assert_eq!(status, Some(130));
        assert!(after < Duration::from_secs(3), "{after:?}");
        let mut printed = String::new();
        errors.read_to_string(&mut printed).expect("UTF-8");
        let kept = format!("stopped; 0 of 3 points kept in {store}, 3 left: the same command");
        assert!(printed.contains(&kept), "{printed}");
    }
}

/// A map whose first point takes hours.
const ENDLESS_MAP: &[&str] =
    &["map", "study.toml", "--quantity", "residual-vibration", "--set", "solver.settle=1e8"];

/// Under `nohup` only the hang-up is ignored: the signal by which a scheduler ends a job ends a map with its message.
#[test]
fn under_nohup_a_map_ends_with_its_message() {
    let place = Place::with("nohup", &[("study.toml", MEASURED), ("data.csv", SAMPLES)]);
    let mut command = Command::new("nohup");
    command.arg(env!("CARGO_BIN_EXE_quell")).args(ENDLESS_MAP).args(["--save", "m.zarr"]);
    command.current_dir(&place.folder).stdin(Stdio::null());
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
    let mut child = child.expect("nohup runs");
    std::thread::sleep(Duration::from_millis(700));
    signal(&child, "-HUP");
    std::thread::sleep(Duration::from_millis(300));
    assert!(child.try_wait().expect("it is ours").is_none(), "a hang-up is ignored");
    signal(&child, "-TERM");
    let mut errors = child.stderr.take().expect("piped");
    let (status, after) = ended(child);
    assert_eq!(status, Some(130));
    assert!(after < Duration::from_secs(3), "{after:?}");
    let mut printed = String::new();
    errors.read_to_string(&mut printed).expect("UTF-8");
    assert!(printed.contains("points kept in m.zarr") && printed.contains("--resume"), "{printed}");
}

/// A name that ends in a slash names a folder, regardless of its extension.
#[test]
fn an_output_that_names_a_folder_is_rejected_before_the_work() {
    let place = Place::with("folder", &[("study.toml", MEASURED), ("data.csv", SAMPLES)]);
    for (verb, option, name) in [
        (&["friction"][..], "--plot", "x.svg/"),
        (&["friction"], "--save", "x.csv/"),
        (&["friction"], "--save", "x.csv/."),
        (&["map", "--quantity", "growth"], "--save", "x.csv/"),
        (&["sketch"], "--out", "x.svg/"),
        (&["report"], "--out", "x.html//"),
    ] {
        let ask = [&verb[..1], &["study.toml"], &verb[1..], &[option, name]].concat();
        let errors = place.refused(&ask);
        assert!(
            errors[0]["message"].as_str().is_some_and(|why| why.contains("folder")),
            "{errors:?}"
        );
    }
}

/// `script` of util-linux gives a process a terminal; where it is missing, nothing is tested.
#[test]
fn a_verb_of_more_than_two_seconds_shows_the_elapsed_time_on_a_terminal() {
    let place = Place::with("elapsed", &[("study.toml", MEASURED), ("data.csv", SAMPLES)]);
    let quell = env!("CARGO_BIN_EXE_quell");
    let line = format!(
        "timeout --foreground -s INT 4 {quell} response study.toml --set solver.settle=1e8"
    );
    let mut command = Command::new("script");
    command.args(["-qec", &line, "/dev/null"]).env("TERM", "xterm");
    let done = command.current_dir(&place.folder).stdin(Stdio::null()).output();
    let Ok(done) = done else { return };
    let printed = String::from_utf8_lossy(&done.stdout);
    assert!(printed.contains("response") && printed.contains("elapsed"), "{printed}");
    assert!(printed.contains("stopped; no results were kept"), "{printed}");
}
