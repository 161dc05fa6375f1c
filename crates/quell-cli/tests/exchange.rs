//! Files of other programs: matrices in, tables of MATLAB and NetCDF and friction models of Abaqus, Simscape and Modelica out.

use std::f64::consts::FRAC_PI_2;
use std::fs;

use crate::place::Place;

/// Coulomb friction under a tangential sine, whose average is (2/π) μ asin(v/α) below α and μ above.
const SINE: &str = "[belt]\nmass_kg = 2.0\nstiffness_n_per_m = 200.0\ndamping_ratio = 0.01\nnormal_force_n = 20.0\n\
    belt_velocity_m_per_s = 0.05\n[friction]\nlaw = \"coulomb\"\ncoefficient = 0.3\n[dither]\ndirection = \"tangential\"\n\
    waveform = \"sine\"\namplitude_n = 40.0\nfrequency_hz = 31.830988618379067\n";

/// A law that falls exponentially, without dither.
const FALLING: &str = "title = \"falling\"\n[belt]\ndamping_ratio = 0.01\nnormal_load = 1.0\nbelt_velocity = 0.2\n[friction]\n\
    law = \"expression\"\ncoefficient = \"0.2 + 0.3*exp(-7*abs(v))\"\n";

/// Data lines of the active table of an input file of Abaqus: coefficient and slip rate.
fn table(text: &str) -> Vec<(f64, f64)> {
    let after = text.split_once("\n*FRICTION\n").expect("a table").1;
    let lines = after.lines().take_while(|line| !line.starts_with('*'));
    let row = |line: &str| {
        let numbers: Vec<f64> =
            line.split(',').map(|word| word.trim().parse().expect("a number")).collect();
        assert!(numbers.len() == 2 && line.len() <= 256, "{line}");
        (numbers[0], numbers[1])
    };
    lines.map(row).collect()
}

/// Linear interpolation with the last value beyond the table, as Abaqus does.
fn interpolated(table: &[(f64, f64)], rate: f64) -> f64 {
    let next = table.partition_point(|row| row.1 < rate);
    if next == 0 || next == table.len() {
        return table[next.min(table.len() - 1)].0;
    }
    let (a, b) = (table[next - 1], table[next]);
    a.0 + (b.0 - a.0) * (rate - a.1) / (b.1 - a.1)
}

/// A number of a line such as `friction.name = 1.5; % N`.
fn parameter(text: &str, name: &str) -> f64 {
    let line = text.lines().find_map(|line| line.strip_prefix(&format!("friction.{name} = ")));
    let number = line.unwrap_or_else(|| panic!("{name}: {text}")).split(';').next();
    number.expect("a number").parse().expect("a number")
}

#[test]
fn a_table_of_abaqus_is_the_averaged_friction() {
    let place = Place::with("exchange-abaqus", &[("sine.toml", SINE)]);
    place.good(&["friction", "sine.toml", "--save", "sine.inp"]);
    let text = fs::read_to_string(place.folder.join("sine.inp")).expect("written");
    assert!(text.contains("*SURFACE INTERACTION, NAME=QUELL_AVERAGED\n1.,\n*FRICTION\n"), "{text}");
    assert!(text.lines().all(|line| line.starts_with('*') || !line.contains('[')), "{text}");
    let table = table(&text);
    // A fast velocity of F/(mΩ), larger by 1/(1 − 1/R²) at R = 20.
    let fast = 40.0 / (2.0 * 200.0) / (1.0 - 1.0 / 400.0);
    let exact = |v: f64| if v < fast { 0.3 * (v / fast).asin() / FRAC_PI_2 } else { 0.3 };
    assert_eq!(table[0], (0.0, 0.0));
    assert!(table.windows(2).all(|rows| rows[0].1 < rows[1].1), "{table:?}");
    assert!((10..60).contains(&table.len()), "{}", table.len());
    let stated = text.lines().find_map(|line| line.split_once("points of the table: "));
    let stated: f64 = stated.expect("an error").1.parse().expect("a number");
    let end = table.last().expect("rows").1;
    let off = (0..=3000).map(|k| {
        let v = end * f64::from(k) / 3000.0;
        (interpolated(&table, v) - exact(v)).abs()
    });
    let off = off.fold(0.0, f64::max);
    // The stated error is at points of the curve; between them lies a little more.
    assert!(stated <= 3e-4 && off <= 1.5 * stated, "{off} {stated}");
    assert!(
        text.contains("** 3.000000000E-1, 1.503759398E2\n") && text.contains("slip rate in mm/s"),
        "{text}"
    );
    assert!(
        text.contains("EXPONENTIAL DECAY") && text.contains("**   law = \"coulomb\""),
        "{text}"
    );
}

#[test]
fn models_are_fitted_with_their_errors() {
    let place = Place::with("exchange-fits", &[("falling.toml", FALLING), ("sine.toml", SINE)]);
    place.good(&["friction", "falling.toml", "--save", "falling.inp"]);
    let text = fs::read_to_string(place.folder.join("falling.inp")).expect("written");
    let decay = text.split_once("*FRICTION, EXPONENTIAL DECAY\n** ").expect("a fit").1;
    let numbers: Vec<f64> = decay
        .lines()
        .next()
        .expect("a line")
        .split(',')
        .map(|word| word.trim().parse().expect("a number"))
        .collect();
    for (found, planted) in numbers.iter().zip([0.5, 0.2, 7.0]) {
        assert!((found / planted - 1.0).abs() < 1e-4, "{numbers:?}");
    }
    assert!(text.contains("the study has no dither") && !text.contains("mm/s"), "{text}");

    place.good(&["friction", "sine.toml", "--save", "sine.m"]);
    let text = fs::read_to_string(place.folder.join("sine.m")).expect("written");
    let get = |name: &str| parameter(&text, name);
    assert!((get("normal_force") - 20.0).abs() < 1e-12);
    let (breakaway, coulomb) = (get("breakaway_friction_force"), get("coulomb_friction_force"));
    let (viscous, velocity) =
        (get("viscous_friction_coefficient"), get("breakaway_friction_velocity"));
    assert!(breakaway >= coulomb && coulomb >= 0.0 && viscous >= 0.0 && velocity > 0.0, "{text}");
    // The equations of the block, and the stated error.
    let error = get("largest_error");
    let fast = 0.1;
    for k in 1..=150 {
        let v = 0.001 * f64::from(k);
        let (stribeck, smooth) = (v / (velocity * 2f64.sqrt()), v / (velocity / 10.0));
        let height = (2.0 * std::f64::consts::E).sqrt() * (breakaway - coulomb);
        let block = height * (-stribeck * stribeck).exp() * stribeck
            + coulomb * smooth.tanh()
            + viscous * v;
        let exact = 6.0 * if v < fast { (v / fast).asin() / FRAC_PI_2 } else { 1.0 };
        assert!((block - exact).abs() <= 1.02 * error, "{v}: {block} {exact} {error}");
    }
    // A smooth block has no corner: the best of 400 breakaway velocities by another program is off by 0.214 of the force.
    assert!((error / 6.0 - 0.214).abs() < 0.01, "{error}");
    assert!(text.contains("friction.kinetic_coefficient = [ ... % 1"), "{text}");
}

/// The brake of the Modelica Standard Library interpolates its table, goes on along the last two points, and holds `peak` times the
/// first coefficient at rest.
#[test]
fn a_brake_of_modelica_is_the_averaged_friction() {
    let steady = SINE.split("[dither]").next().expect("a belt");
    let level = steady.replace("coefficient = 0.3", "coefficient = 0.3\nstatic_coefficient = 0.45");
    let place = Place::with("exchange-modelica", &[("sine.toml", SINE), ("level.toml", &level)]);
    let model = |study: &str, file: &str| {
        place.good(&["friction", study, "--save", file]);
        let text = fs::read_to_string(place.folder.join(file)).expect("written");
        let (_, inner) = text.split_once("mu_pos=[").expect("a table");
        let (table, rest) = inner.split_once("],").expect("an end");
        let number = |text: &str| text.trim().parse::<f64>().expect("a number");
        let points: Vec<(f64, f64)> = table
            .split(';')
            .map(|row| row.split_once(',').expect("two numbers"))
            .map(|(speed, coefficient)| (number(speed), number(coefficient)))
            .collect();
        let after = |name: &str| {
            let (_, value) = rest.split_once(&format!("{name}=")).expect("a parameter");
            number(value.split([',', ')']).next().expect("a number"))
        };
        (points, after("peak"), after("fn_max"))
    };
    let (points, peak, load) = model("sine.toml", "sine.mo");
    assert_eq!((points[0], peak, load), ((0.0, 0.0), 1.0, 20.0));
    assert!(points.windows(2).all(|pair| pair[0].0 < pair[1].0), "{points:?}");
    let [.., before, last] = points[..] else { panic!("{points:?}") };
    assert_eq!(before.1, last.1, "the coefficient stays beyond the table");
    let fast = 40.0 / (2.0 * 200.0) / (1.0 - 1.0 / 400.0);
    let table: Vec<(f64, f64)> =
        points.into_iter().map(|(speed, friction)| (friction, speed)).collect();
    let middle = interpolated(&table, 0.5 * fast);
    assert!((middle - 0.1).abs() < 5e-4, "{middle}");
    let (points, peak, _) = model("level.toml", "level.mo");
    assert!((peak - 1.5).abs() < 1e-12 && points[0] == (0.0, 0.3), "{peak} {points:?}");
}

#[test]
fn friction_without_such_a_form_is_refused() {
    let uneven = SINE.replace(
        "waveform = \"sine\"",
        "waveform = \"fourier\"\nharmonics = [{ order = 1, sine = 1.0 }, { order = 2, sine = 0.7 }]",
    );
    let system = "[system]\ncoordinates = [\"x\"]\nmass = [1.0]\ndamping = [[0.02]]\nstiffness = [[1.0]]\n[[contact]]\nname = \"pad\"\n\
        tangent = { x = 1.0 }\nnormal_load = 1.0\nbelt_velocity = 0.1\n[contact.friction]\nlaw = \"coulomb\"\ncoefficient = 0.3\n";
    let files = [("sine.toml", SINE), ("uneven.toml", &uneven), ("system.toml", system)];
    let place = Place::with("exchange-refused", &files);
    let (object, status) = place.json(&["friction", "uneven.toml", "--save", "x.inp"]);
    assert_eq!(status, 1, "{object}");
    assert!(
        object["errors"][0]["message"].as_str().expect("text").contains("direction"),
        "{object}"
    );
    for option in [&["--measured"][..], &["--describing", "0.1"]] {
        let ask = [&["friction", "sine.toml", "--save", "x.m"][..], option].concat();
        let errors = place.refused(&ask);
        assert_eq!(errors[0]["key"], option[0], "{errors:?}");
    }
    // A file has the friction of one contact.
    let two = format!(
        "{system}{}",
        &system[system.find("[[contact]]").expect("a contact")..].replace("pad", "rim")
    );
    fs::write(place.folder.join("two.toml"), two).expect("written");
    let (object, status) = place.json(&["friction", "two.toml", "--save", "x.inp"]);
    let said = object["errors"][0]["message"].as_str().expect("text");
    assert!(status == 1 && said.contains("one contact"), "{object}");
    place.refused(&["friction", "sine.toml", "--save", "x.wav"]);
    place.refused(&["response", "sine.toml", "--save", "x.inp"]);
    assert_eq!(place.files(), ["sine.toml", "system.toml", "two.toml", "uneven.toml"]);
    place.good(&["friction", "system.toml", "--save", "x.inp"]);
}

/// One file has every dataset, which the formats begin to say in their first bytes.
#[test]
fn tables_of_matlab_and_netcdf_are_one_file() {
    let place = Place::with("exchange-tables", &[("sine.toml", SINE)]);
    for (name, begins) in [("r.mat", &b"MATLAB 5.0 MAT-file"[..]), ("r.nc", &b"CDF\x02"[..])] {
        let saved = place.good(&["response", "sine.toml", "--save", name]);
        assert_eq!(saved["saved"].as_array().map(Vec::len), Some(1), "{saved}");
        let bytes = fs::read(place.folder.join(name)).expect("written");
        assert!(bytes.starts_with(begins) && bytes.len() > 5000);
        let names = String::from_utf8_lossy(&bytes).into_owned();
        assert!(names.contains("spectrum") && names.contains("amplitude"), "{name}");
        place.good(&["response", "sine.toml", "--save", name]);
        assert_eq!(fs::read(place.folder.join(name)).expect("again"), bytes, "the same bytes");
    }
    assert_eq!(place.files(), ["r.mat", "r.nc", "sine.toml"]);
}

/// A study with matrices in files is the study with the same numbers.
#[test]
fn matrices_in_files_are_matrices() {
    let inline = "[system]\nunits = \"SI\"\ncoordinates = [\"x\", \"y\"]\nmass = [1.0, 1.0]\nstiffness = [[2.0, 1.0], [1.0, 0.75]]\n\
        damping = [[0.02, 0.3], [-0.3, 0.02]]\n[contact]\nname = \"pad\"\ntangent = { x = 1.0 }\nnormal = { y = 1.0 }\nnormal_load = 1.0\n\
        normal_stiffness = 1.3333333333333333\nbelt_velocity = 1.0\n[friction]\nlaw = \"coulomb\"\ncoefficient = 0.5\n";
    let files = inline
        .replace("[1.0, 1.0]", "{ file = \"M.mtx\" }")
        .replace("[[2.0, 1.0], [1.0, 0.75]]", "{ file = \"K.mtx\" }")
        .replace("[[0.02, 0.3], [-0.3, 0.02]]", "{ file = \"C.mtx\" }");
    let place = Place::with(
        "exchange-matrices",
        &[
            ("inline.toml", inline),
            ("files.toml", &files),
            ("M.mtx", "%%MatrixMarket matrix array integer symmetric\n2 2\n1\n0\n1\n"),
            (
                "K.mtx",
                "%%MatrixMarket matrix coordinate real symmetric\n% stiffness\n2 2 3\n1 1 2\n2 1 1\n2 2 0.75\n",
            ),
            (
                "C.mtx",
                "%%MatrixMarket matrix coordinate real general\n2 2 4\n1 1 0.02\n1 2 0.3\n2 1 -0.3\n2 2 0.02\n",
            ),
        ],
    );
    let of = |file: &str| place.good(&["stability", file]);
    assert_eq!(of("files.toml"), of("inline.toml"));
    let over = ["contact.pad.friction.coefficient", "--from", "0.4", "--to", "0.9"];
    let swept = |file: &str| place.good(&[&["stability", file, "--parameter"][..], &over].concat());
    assert_eq!(swept("files.toml")["thresholds"], swept("inline.toml")["thresholds"]);
    place.write("W.mtx", "%%MatrixMarket matrix coordinate real general\n2 2 1\n1 3 5\n");
    let errors = place.refused(&["check", "files.toml", "--set", "system.stiffness.file=W.mtx"]);
    let text = errors[0]["message"].as_str().expect("text");
    assert!(text.contains("system.stiffness.file") && text.contains("line 3"), "{text}");
    let errors = place.refused(&["check", "files.toml", "--set", "system.stiffness[0][1]=3"]);
    assert!(errors[0]["allowed"].as_str().expect("text").contains("is in a file"), "{errors:?}");
    // A file that is an input is no output.
    let errors = place.refused(&["friction", "inline.toml", "--save", "K.mtx"]);
    assert_eq!(errors[0]["key"], "--save");
    place.write("M.mtx", "%%MatrixMarket matrix array real general\n2 2\n1\n2\n2\n1\n");
    let errors = place.refused(&["check", "files.toml"]);
    assert!(errors[0]["allowed"].as_str().expect("text").contains("entry (2, 2)"), "{errors:?}");
}
