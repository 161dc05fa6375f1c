//! `quell receptance` against closed forms, as the file of a study with `frequency_response`, and refusals; surfaces of many contacts.

use std::fmt::Write as _;
use std::fs;

use num_complex::Complex64;
use serde_json::Value as Json;

use crate::place::Place;

/// Mode coupling (Hoffmann et al. 2002) with the friction of a pad on a spring.
const COUPLED: &str = r#"
[system]
coordinates = ["x", "y"]
mass = [1.0, 1.0]
stiffness = [[2.0, 1.0], [1.0, 0.6666666666666667]]
damping = [0.05, 0.05]

[[contact]]
name = "pad"
tangent = { x = 1.0 }
normal = { y = 1.0 }
normal_load = 1.0
normal_stiffness = 1.3333333333333333
belt_velocity = 1.0

[contact.friction]
law = "coulomb"
coefficient = 0.6
"#;

/// The rows of a CSV file by output and input: frequency and value.
fn rows(place: &Place, file: &str, pair: [&str; 2]) -> Vec<(f64, Complex64)> {
    let text = fs::read_to_string(place.folder.join(file)).expect("a file");
    let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    let fields = lines.map(|line| line.split(',').collect::<Vec<_>>());
    let number = |text: &str| text.parse::<f64>().expect("a number");
    fields
        .filter(|row| row[..2] == pair)
        .map(|row| (number(row[2]), Complex64::new(number(row[3]), number(row[4]))))
        .collect()
}

/// The dynamic stiffness of [`COUPLED`] is 2 × 2, its inverse known: friction pulls along x with μ k₃ y.
#[test]
fn two_coordinates_have_their_closed_form() {
    let place = Place::with("receptance", &[("pad.toml", COUPLED)]);
    for (contacts, spring, coefficient) in
        [("sliding", 4.0 / 3.0, 0.6), ("springs", 4.0 / 3.0, 0.0), ("none", 0.0, 0.0)]
    {
        let arguments = [
            "receptance",
            "pad.toml",
            "--outputs",
            "x,pad.normal",
            "--inputs",
            "y,pad.tangent",
            "--contacts",
            contacts,
            "--save",
            "frf.csv",
        ];
        let found = place.good(&arguments);
        assert_eq!(found["contacts"], contacts);
        let points = found["points"].as_u64().expect("a count");
        for (output, input, entry) in
            [("x", "y", 0), ("x", "pad.tangent", 1), ("pad.normal", "y", 2)]
        {
            let rows = rows(&place, "frf.csv", [output, input]);
            assert_eq!(rows.len() as u64, points);
            for (frequency, value) in rows {
                let own = |stiffness: f64| {
                    Complex64::new(stiffness - frequency * frequency, 0.05 * frequency)
                };
                let (a, d) = (own(2.0), own(2.0 / 3.0 + spring));
                let (b, c) = (1.0 - coefficient * spring, 1.0);
                let exact = [Complex64::from(-b), d, a][entry] / (a * d - b * c);
                let far = (value - exact).norm() / exact.norm();
                assert!(far < 1e-12, "{contacts} {output}/{input} at {frequency}: {value} {exact}");
            }
        }
        place.files().iter().filter(|name| name.ends_with("csv")).for_each(|name| {
            fs::remove_file(place.folder.join(name)).expect("removed");
        });
    }
}

/// What a test of the structure alone measures is a study, with the verdict and the critical friction of the equations.
#[test]
fn the_file_is_that_of_a_measured_structure() {
    let place = Place::with("receptance-again", &[("pad.toml", COUPLED)]);
    place.good(&["receptance", "pad.toml", "--contacts", "none", "--save", "frf.csv"]);
    let (_, contact) = COUPLED.split_once("[[contact]]").expect("a contact");
    let contact: String = contact
        .lines()
        .filter(|line| !line.starts_with("tangent") && !line.starts_with("normal ="))
        .fold(String::new(), |text, line| text + line + "\n");
    let measured = format!("[system]\nfrequency_response = 'frf.csv'\n\n[[contact]]{contact}");
    place.write("measured.toml", &measured);
    for coefficient in ["0.7", "0.8"] {
        let set = format!("contact.pad.friction.coefficient={coefficient}");
        let verdict = |file| place.good(&["stability", file, "--set", &set])["verdict"].clone();
        assert_eq!(verdict("measured.toml"), verdict("pad.toml"), "{coefficient}");
    }
}

#[test]
fn unstable_sliding_is_warned_of_and_an_undamped_resonance_has_no_value() {
    let free = COUPLED.replace("[[2.0, 1.0], [1.0, 0.6666666666666667]]", "[[1, 0], [0, 0]]");
    let free = free.replace("damping = [0.05, 0.05]\n", "");
    let place = Place::with("receptance-unstable", &[("pad.toml", COUPLED), ("free.toml", &free)]);
    let unstable =
        place.good(&["receptance", "pad.toml", "--set", "contact.pad.friction.coefficient=0.9"]);
    assert_eq!(unstable["verdict"], "unstable");
    assert!(unstable["warnings"].to_string().contains("no measurement shows"), "{unstable}");
    let undamped = [
        "receptance",
        "free.toml",
        "--outputs",
        "x",
        "--inputs",
        "x",
        "--contacts",
        "none",
        "--at",
        "0.5,1,2",
    ];
    let found = place.good(&undamped);
    assert!(found["notes"].to_string().contains("1 frequency has no value"), "{found}");
    assert_eq!(found["receptances"][0]["largest"], 4.0 / 3.0);
    // The other coordinate is free: it has no receptance at rest.
    let free = place.good(&["receptance", "free.toml", "--contacts", "none"]);
    assert!(free["from"].as_f64().is_some_and(|from| from > 0.0), "{free}");
}

#[test]
fn rows_ranges_and_points_are_checked() {
    let place = Place::with("receptance-refused", &[("pad.toml", COUPLED)]);
    let cases: [(&[&str], &str, &str); 9] = [
        (&["--outputs", "z"], "--outputs", "pad.tangent, pad.normal, x, y"),
        (&["--inputs", "pad.tangant"], "--inputs", "pad.tangent"),
        (&["--inputs", "x,x"], "--inputs", "differ"),
        (&["--frequency", "3:1"], "--frequency", "the second above the first"),
        (&["--frequency=-1:2"], "--frequency", "at least 0"),
        (&["--points", "1"], "--points", "from 2"),
        (&["--at", "2,1"], "--at", "each above the one before"),
        (&["--at", "1,2", "--points", "5"], "--points", "--at gives"),
        (&["--contacts", "open"], "--contacts", "sliding, springs, none"),
    ];
    for (options, key, words) in cases {
        let arguments = [&["receptance", "pad.toml"], options].concat();
        let errors = place.refused(&arguments);
        assert_eq!(errors[0]["key"], key, "{errors:?}");
        assert!(
            errors[0]["allowed"].as_str().is_some_and(|allowed| allowed.contains(words)),
            "{errors:?}"
        );
    }
    assert_eq!(
        place.refused(&["receptance", "pad.toml", "--inputs", "pad.tangant"])[0]["suggestion"],
        "pad.tangent"
    );
}

/// A pad with a rotation on a surface of many contacts.
fn surface(count: usize) -> String {
    let mut text = "[system]\nunits = 'SI'\ncoordinates = ['x', 'y', 'turn']\nmass = [1, 1, 0.1]\n\
         stiffness = [[2000, 100, 0], [100, 1000, 20], [0, 20, 300]]\ndamping = [0.2, 0.2, 0.02]\n"
        .to_owned();
    for k in 0..count {
        let along = (k as f64 + 0.5) / count as f64 - 0.5;
        let load = 30.0 / count as f64;
        let _ = write!(
            text,
            "[[contact]]\nname = 'p{k}'\ntangent = {{ x = 1, turn = 0.2 }}\nnormal = {{ y = 1, turn = {along} }}\n\
             normal_load = {load}\nnormal_stiffness = '{} N/mm'\nbelt_velocity = 0.05\n",
            4.0 / count as f64 * (1.0 + along)
        );
    }
    text + "[friction]\nlaw = 'stribeck'\nstatic_coefficient = 0.5\nminimum_coefficient = 0.3\nreference_velocity = 0.5\n"
}

/// Of a rigid pad few contacts say all: the growth rates are those of the whole surface.
#[test]
fn few_contacts_stand_for_a_surface() {
    let place = Place::with("fewer-contacts", &[("pad.toml", &surface(60))]);
    let found = place.good(&["convert", "pad.toml", "--contacts", "8", "--save", "few.toml"]);
    assert_eq!(found["contacts_before"], 60);
    assert!(found["contacts"].as_u64().is_some_and(|count| count <= 8), "{found}");
    assert!(found["contacts_error"].as_f64().is_some_and(|error| error <= 1e-6), "{found}");
    assert!(
        found["sentence"].as_str().is_some_and(|words| words.contains("stand for 60")),
        "{found}"
    );
    let motions = |file| -> Vec<Json> {
        let found = place.good(&["stability", file]);
        found["motions"].as_array().expect("motions").clone()
    };
    for (whole, few) in motions("pad.toml").iter().zip(motions("few.toml")) {
        for key in ["growth_rate", "frequency"] {
            let [whole, few] = [whole, &few].map(|motion| motion[key].as_f64().expect("a number"));
            assert!((whole - few).abs() <= 1e-5 * whole.abs().max(1.0), "{key}: {whole} {few}");
        }
    }
    let load = |file: &str| -> f64 {
        let found = place.good(&["check", file]);
        let contacts = found["contacts"].as_array().expect("contacts");
        contacts.iter().map(|contact| contact["normal_load"].as_f64().expect("a load")).sum()
    };
    assert!((load("few.toml") - load("pad.toml")).abs() < 1e-4 * load("pad.toml"));
    let one = place.good(&["convert", "pad.toml", "--contacts", "1"]);
    assert!(one["contacts_error"].as_f64().is_some_and(|error| error > 0.01), "{one}");
    assert!(one["warnings"].to_string().contains("1e-6 was allowed"), "{one}");
    assert_eq!(place.refused(&["convert", "pad.toml", "--contacts", "0"])[0]["key"], "--contacts");
    assert_eq!(
        place.refused(&["convert", "pad.toml", "--contacts", "3", "--error", "2"])[0]["key"],
        "--error"
    );
    // What names a contact that is left out is complained of.
    place.write(
        "axis.toml",
        surface(60)
            + "[[sweep]]\nparameter = 'contact.p17.normal_load'\nfrom = 1\nto = 2\npoints = 3\n",
    );
    let errors = place.refused(&["convert", "axis.toml", "--contacts", "3"]);
    assert!(errors[0]["value"].to_string().contains("p17"), "{errors:?}");
}
