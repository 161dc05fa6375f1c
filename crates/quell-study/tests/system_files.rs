//! Systems given by modes or by a measured frequency response, in the study or in files.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use quell_model::System;
use quell_study::study::{Study, SystemStudy};
use quell_study::{Complaints, Fault};

/// A contact between a rotor and a pad, each given by its modes.
const COMPONENTS: &str = "[system]\nunits = 'SI'\n[[system.component]]\nname = 'rotor'\nmodes = 'rotor.csv'\n\
    [[system.component]]\nname = 'pad'\nnormalisation = 'max'\nmode = [{frequency = 3, damping_ratio = 0.1, modal_mass = 4, \
    shape = {x = 1}}]\n[contact]\ntangent = {rotor.x = 1, 'pad.x' = -1}\nnormal = {rotor.y = 1}\nnormal_load = 2\n\
    belt_velocity = 1\n[friction]\nlaw = 'coulomb'\ncoefficient = 0.3\n[dither]\nat = {pad.x = 2}\nwaveform = 'sine'\n\
    amplitude = 1\nfrequency_hz = 5\n";

/// Two modes of a rotor.
const ROTOR: &str = "# rotor\nfrequency_hz,damping_ratio,x,y\n10,0.01,0.5,1\n20,0.02,-1,0\n";

fn read(folder: &Path, text: &str) -> Result<SystemStudy, Complaints> {
    Study::parse_in(text, &[], folder).map(|study| study.system())
}

fn folder_with(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in files {
        fs::write(folder.path().join(name), text).expect("written");
    }
    folder
}

/// The system of other numbers, given by their paths.
fn system_at(study: &SystemStudy, numbers: &[(&str, f64)]) -> System {
    let model = study.model();
    let numbers = model.numbers(numbers).expect("numbers of the study");
    model.at(&numbers).expect("valid values")
}

#[test]
fn modes_of_components_become_modal_coordinates() {
    let folder = folder_with(&[("rotor.csv", ROTOR)]);
    let study = read(folder.path(), COMPONENTS).expect("valid");
    let system = study.system();
    let mechanical = system.structure.mechanical().expect("mechanical");
    assert_eq!(mechanical.coordinates(), ["rotor.1", "rotor.2", "pad.1"]);
    let omega = [TAU * 10.0, TAU * 20.0, 3.0];
    for (i, (omega, ratio)) in omega.into_iter().zip([0.01, 0.02, 0.1]).enumerate() {
        assert_eq!(mechanical.stiffness()[(i, i)], omega * omega);
        assert_eq!(mechanical.damping()[(i, i)], 2.0 * ratio * omega);
    }
    assert_eq!(mechanical.mass().matrix().as_slice(), [1., 0., 0., 0., 1., 0., 0., 0., 1.]);
    let contact = &system.contacts[0];
    assert_eq!(contact.tangent.as_deref(), Some(&[0.5, -1.0, -0.5][..]));
    assert_eq!(contact.normal.as_deref(), Some(&[1.0, 0.0, 0.0][..]));
    assert_eq!(study.observe(), [0.5, -1.0, -0.5]);
    assert_eq!(study.number("system.component.pad.mode.frequency"), Some(3.0));
    // The file is not read again.
    fs::remove_file(folder.path().join("rotor.csv")).expect("removed");
    let changed = system_at(&study, &[("system.component.pad.mode.frequency", 4.0)]);
    assert_eq!(changed.structure.mechanical().expect("mechanical").stiffness()[(2, 2)], 16.0);
    assert!(study.with("contact.tangent.rotor.x", 2.0).is_ok());
}

#[test]
fn wrong_modes_are_complained_about_at_their_place() {
    let many = "frequency,damping_ratio,x,y\n".to_owned() + &"1,0,1,1\n".repeat(100_000);
    let files = [
        ("rotor.csv", ROTOR),
        ("two.csv", "frequency,frequency_hz,damping_ratio,x,y\n1,1,0,1,1\n"),
        ("nan.csv", "frequency,damping_ratio,x,y\n1,0,1,1\n2,0,nan,1\n"),
        ("many.csv", &many),
    ];
    let folder = folder_with(&files);
    let file = "system.component[0].modes";
    for (from, to, key, part) in [
        ("rotor.csv", "two.csv", file, "both"),
        ("rotor.csv", "nan.csv", file, "line 3, x"),
        ("rotor.csv", "many.csv", file, "100000"),
        ("rotor.csv", "none.csv", file, "cannot be read"),
        ("'SI'", "'none'", file, "frequency_hz"),
        ("modal_mass = 4, ", "", "system.component[1].normalisation", "needs modal_mass"),
        ("'max'", "'mass'", "system.component[1].normalisation", "mass-normalised"),
        ("frequency = 3", "frequency = -3", "system.component[1].mode.frequency", "≥ 0"),
        ("damping_ratio = 0.1, ", "", "system.component[1].mode.damping_ratio", "damping"),
        ("name = 'pad'", "name = 'rotor'", "system.component[1].name", "different"),
        ("pad.x = 2", "pad.y = 2", "dither.at.pad.y", "pad.x"),
        ("units = 'SI'", "units = 'SI'\nmass = [1]", "system.mass", "does not belong"),
    ] {
        assert!(COMPONENTS.contains(from), "{from}");
        let wrong = read(folder.path(), &COMPONENTS.replacen(from, to, 1)).expect_err(to);
        let found = wrong.iter().find(|complaint| complaint.key == key);
        let found = found.unwrap_or_else(|| panic!("{to}: {wrong}"));
        assert!(found.to_string().contains(part), "{to}: {found}");
        assert!(found.origin.line().is_some(), "{to}: {found}");
    }
    let mode = "[[system.mode]]\nfrequency = 1\ndamping_ratio = 0\nshape = {x = 1}\n";
    let wrong = read(folder.path(), &mode.repeat(100_000)).expect_err("too many");
    let found = wrong.iter().find(|complaint| complaint.key == "system.mode").expect("the list");
    assert!(found.allowed.contains("2000"), "{found}");
}

#[test]
fn a_measured_response_stands_for_matrices() {
    let mut rows = "frequency_hz,output,input,re,im\n".to_owned();
    for (output, input) in
        [("pad.tangent", "pad.tangent"), ("pad.tangent", "x"), ("x", "pad.tangent"), ("x", "x")]
    {
        for frequency in [0.0, 10.0, 20.0] {
            let value = 1.0 + frequency;
            writeln!(rows, "{frequency},{output},{input},{value},-0.5").expect("a string");
        }
    }
    let folder = folder_with(&[("frf.csv", &rows)]);
    let text = "[system]\nunits = 'SI'\nfrequency_response = 'frf.csv'\n[[contact]]\nname = 'pad'\nnormal_load = 1\n\
                belt_velocity = 1\n[friction]\nlaw = 'coulomb'\ncoefficient = 0.3\n[dither]\nat = {x = 2}\n\
                waveform = 'sine'\namplitude = 1\nfrequency_hz = 5\n";
    let study = read(folder.path(), text).expect("valid");
    let response = study.frequency_response().expect("measured");
    assert_eq!(response.frequencies, [0.0, TAU * 10.0, TAU * 20.0]);
    assert_eq!(response.names, ["pad.tangent", "x"]);
    assert_eq!(response.receptance(0, 1).expect("a series")[2], [21.0, -0.5]);
    assert_eq!(study.system().contacts[0].tangent.as_deref(), Some(&[1.0, 0.0][..]));
    let contents = "system.frequency_response.contents";
    assert_eq!(study.settings().iter().filter(|(key, _)| key == contents).count(), 1);
    for (from, to, key, fault) in [
        ("x = 2", "y = 2", "dither.at.y", Fault::Unknown),
        ("'SI'", "'none'", "system.frequency_response", Fault::Path),
        ("'pad'", "'shoe'\ntangent = {x = 1}\nnormal = {'pad.tangent' = 1}", "", Fault::Path),
    ] {
        let changed = text.replacen(from, to, 1);
        match read(folder.path(), &changed) {
            Ok(_) => assert!(key.is_empty(), "{to}"),
            Err(wrong) => {
                assert_eq!((wrong[0].key.as_str(), wrong[0].fault), (key, fault), "{wrong}");
            }
        }
    }
    fs::write(folder.path().join("frf.csv"), rows.replace("x,pad.tangent", "y,pad.tangent"))
        .expect("written");
    let forces = read(folder.path(), text).expect("the pad's response to x is there");
    assert!(forces.frequency_response().is_some());
    fs::write(folder.path().join("frf.csv"), rows.replace("pad.tangent,x,", "y,x,"))
        .expect("written");
    let wrong = read(folder.path(), text).expect_err("no response of the pad to x");
    assert!(wrong[0].allowed.contains("response of pad.tangent to a force at x"), "{wrong}");
}

/// A body with a contact, its matrices in files.
const MATRICES: &str = "[system]\nunits = 'mm-t-s'\ncoordinates = ['x', 'y']\nmass = { file = 'M.mtx' }\n\
    stiffness_n_per_m = { file = 'K.mtx' }\n[contact]\ntangent = {x = 1}\nnormal_load = 2\nbelt_velocity = 1\n[friction]\n\
    law = 'coulomb'\ncoefficient = 0.3\n";

const MASS: &str =
    "%%MatrixMarket matrix coordinate real symmetric\n2 2 3\n1 1 2\n2 1 0.5\n2 2 1\n";

const STIFFNESS: &str = "%%MatrixMarket matrix array real general\n2 2\n3000\n1000\n2000\n4000\n";

#[test]
fn matrices_of_files_are_in_the_unit_of_their_key() {
    let folder = folder_with(&[("M.mtx", MASS), ("K.mtx", STIFFNESS)]);
    let study = read(folder.path(), MATRICES).expect("valid");
    let mechanical = study.system().structure.mechanical().expect("mechanical");
    assert_eq!(mechanical.mass().matrix().as_slice(), [2.0, 0.5, 0.5, 1.0]);
    // Columns one after the other, and N/m in N/mm.
    assert_eq!(mechanical.stiffness().as_slice(), [3.0, 2.0, 1.0, 4.0]);
    let files = study.inputs();
    for name in ["M.mtx", "K.mtx"] {
        assert!(files.at(&folder.path().join(name)).is_some(), "{name} is an input");
    }
    let before = study.settings();
    // The files are not read again; another study with other entries has other settings.
    fs::write(folder.path().join("K.mtx"), STIFFNESS.replace("4000", "4001")).expect("written");
    let changed = system_at(&study, &[("contact[0].normal_load", 3.0)]);
    assert_eq!(changed.structure.mechanical().expect("mechanical").stiffness()[(1, 1)], 4.0);
    let other = read(folder.path(), MATRICES).expect("valid");
    assert_ne!(other.settings(), before);
    assert!(study.with("system.stiffness_n_per_m[0][0]", 2.0).is_err());
}

#[test]
fn wrong_matrix_files_are_complained_about_at_their_key() {
    let indefinite = MASS.replace("0.5", "2.5");
    let files = [
        ("M.mtx", MASS),
        ("K.mtx", STIFFNESS),
        ("indefinite.mtx", &indefinite),
        ("abaqus.mtx", "1,1, 1,1, 2.0\n"),
    ];
    let folder = folder_with(&files);
    for (from, to, key, part) in [
        ("'M.mtx'", "'none.mtx'", "system.mass.file", "cannot be read"),
        ("'M.mtx'", "'indefinite.mtx'", "system.mass", "positive definite"),
        ("'M.mtx'", "'abaqus.mtx'", "system.mass.file", "%%MatrixMarket"),
        ("'M.mtx'", "3", "system.mass.file", "a string"),
        ("{ file = 'M.mtx' }", "{ file = 'M.mtx', also = 1 }", "system.mass", "file alone"),
        ("{ file = 'M.mtx' }", "{}", "system.mass", "file alone"),
        ("{ file = 'M.mtx' }", "'M.mtx'", "system.mass", "{ file ="),
        ("['x', 'y']", "['x', 'y', 'z']", "system.mass.file", "3 rows and 3 columns"),
    ] {
        assert!(MATRICES.contains(from), "{from}");
        let wrong = read(folder.path(), &MATRICES.replacen(from, to, 1)).expect_err(to);
        let found = wrong.iter().find(|complaint| complaint.key == key);
        let found = found.unwrap_or_else(|| panic!("{to}: {wrong}"));
        assert!(found.to_string().contains(part), "{to}: {found}");
        assert!(found.origin.line().is_some(), "{to}: {found}");
    }
}
