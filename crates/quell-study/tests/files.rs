//! The files that a study names are read once: later studies are made from the same contents when the files change or are gone.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use quell_study::study::Files;
use quell_study::{Change, Study};

/// A law whose slip velocities are in metres per second, in a study in millimetres: only its header says so.
const LAW: &str = "[contact.friction]\nlaw = 'samples'\nfile = 'law.csv'\n";

const SYSTEM: &str = "[system]\nunits = 'mm-t-s'\ncoordinates = ['x']\nmass = {file = 'M.mtx'}\nstiffness = [400]\n\
    [[contact]]\nname = 'pad'\ntangent = {x = 1}\nnormal_load = 100\nbelt_velocity = 50\n";

const DITHER: &str = "[[dither]]\nat = {x = 1}\nwaveform = 'samples'\nfile = 'wave.txt'\namplitude = 3\nfrequency_hz = 300\n\
    [dither.envelope]\nfile = 'envelope.csv'\n";

const BELT: &str = "[belt]\nmass_kg = 1\nstiffness_n_per_m = 100\ndamping_ratio = 0.01\nnormal_force_n = 2\n\
    belt_velocity_m_per_s = 0.1\n[friction]\nlaw = 'samples'\nfile = 'law.csv'\n[dither]\ndirection = 'tangential'\n\
    waveform = 'samples'\nfile = 'wave.txt'\namplitude_n = 1\nfrequency_hz = 20\n";

const DISC: &str = "[disc]\nmodes_file = 'modes.csv'\nmodal_damping = 1e-3\n[disc.load]\nfriction = 0.1\nspeed = 0.5\n";

/// A folder with every file that the studies name.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let mut law = "slip_velocity_m_per_s,coefficient\n".to_owned();
    for step in 0..41 {
        let speed = 0.02 * f64::from(step);
        writeln!(law, "{speed},{:.6}", 0.3 + 0.1 * (-speed / 0.1).exp()).expect("a string");
    }
    for (name, text) in [
        ("law.csv", law.as_str()),
        ("M.mtx", "%%MatrixMarket matrix array real general\n1 1\n0.001\n"),
        ("wave.txt", "0\n1\n0\n-1\n"),
        ("envelope.csv", "time,share\n0,0\n1,1\n"),
        ("modes.csv", "diameters,ratio,shape_at_load\n2,0.9,1\n3,1.1,1\n"),
    ] {
        fs::write(folder.path().join(name), text).expect("written");
    }
    folder
}

fn studies(folder: &Path) -> Vec<(Study, &'static str)> {
    let system = format!("{SYSTEM}{LAW}{DITHER}");
    let read = |text: &str| {
        Study::parse_in(text, &[], folder).unwrap_or_else(|wrong| panic!("{text}\n{wrong}"))
    };
    vec![
        (read(&system), "contact.pad.normal_load"),
        (read(BELT), "belt.damping_ratio"),
        (read(DISC), "disc.load.friction"),
    ]
}

fn held(study: &Study) -> Vec<(PathBuf, String)> {
    study.files().held().map(|(path, text)| (path.to_owned(), text.to_owned())).collect()
}

#[test]
fn a_study_does_not_change_when_its_files_do() {
    let folder = folder();
    for (study, path) in studies(folder.path()) {
        let change = Change::parse(&format!("{path}=0.07"), "--set").expect("a change");
        let before = [
            study.with(path, 0.07).expect("valid"),
            study.changed(std::slice::from_ref(&change)).expect("valid"),
        ];
        let names: Vec<PathBuf> = held(&study).into_iter().map(|(path, _)| path).collect();
        let texts: Vec<String> =
            names.iter().map(|path| fs::read_to_string(path).expect("text")).collect();
        assert!(!names.is_empty(), "{}", study.text());
        for lost in [false, true] {
            for path in &names {
                if lost {
                    fs::remove_file(path).expect("removed");
                } else {
                    fs::write(path, "overwritten\n").expect("written");
                }
            }
            assert_eq!(study.with(path, 0.07).expect("valid"), before[0]);
            assert_eq!(study.changed(std::slice::from_ref(&change)).expect("valid"), before[1]);
            let files = Files::holding(folder.path(), held(&study));
            let again = Study::parse_with(study.text(), &[], &files).expect("valid");
            assert_eq!(again, study, "in another process");
            assert!(
                Study::parse_in(study.text(), &[], folder.path()).is_err(),
                "a new study reads"
            );
        }
        for (path, text) in names.iter().zip(texts) {
            fs::write(path, text).expect("written");
        }
    }
}

/// Slip velocities of a file are in the unit that its header gives, also when the file is gone.
#[test]
fn the_unit_of_samples_is_that_of_their_file() {
    let folder = folder();
    let system = Study::parse_in(&format!("{SYSTEM}{LAW}"), &[], folder.path()).expect("valid");
    let coefficient = |study: &Study| {
        let study = study.system();
        study.system().contacts[0].friction.coefficient(100.0)
    };
    let right = 0.3 + 0.1 * (-1.0f64).exp();
    assert!((coefficient(&system) - right).abs() < 1e-3, "100 mm/s are 0.1 m/s");
    fs::remove_file(folder.path().join("law.csv")).expect("removed");
    let changed = system.with("contact.pad.normal_load", 120.0).expect("valid");
    assert_eq!(coefficient(&changed).to_bits(), coefficient(&system).to_bits());
}

/// Outputs must not overwrite any file that a study names, and contents are part of what identifies it.
#[test]
fn every_file_is_an_input_and_a_setting() {
    let folder = folder();
    for (study, _) in studies(folder.path()) {
        let held = held(&study);
        for (path, text) in &held {
            assert!(study.inputs().at(path).is_some(), "{}", path.display());
            fs::write(path, format!("{text}\n")).expect("written");
            let other = Study::parse_in(study.text(), &[], folder.path()).expect("valid");
            assert_ne!(other.settings(), study.settings(), "{}", path.display());
            assert_ne!(other, study);
            fs::write(path, text).expect("written");
        }
        let contents =
            study.settings().iter().filter(|(key, _)| key.ends_with(".contents")).count();
        assert_eq!(contents, held.len());
    }
}
