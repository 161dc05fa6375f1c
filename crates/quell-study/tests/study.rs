//! Valid and invalid studies: the values that are read, and the errors that are reported.

use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;

use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;
use quell_study::study::{Axis, SystemStart};
use quell_study::{BeltStudy, Change, Complaints, DiscStudy, Fault, Study};

const GOOD: &str = r#"schema = 1
title = "Stribeck belt"
[belt]
damping_ratio = 0.005
normal_load = 1.0
belt_velocity = 0.05
[friction]
law = "stribeck"
static_coefficient = 0.4
minimum_coefficient = 0.2857
reference_velocity = 0.2
[dither]
direction = "tangential"
waveform = "sine"
amplitude = 0.4
frequency_ratio = 10
"#;

const SI: &str = r#"schema = 1
[belt]
mass_kg = 2.5
stiffness_n_per_m = 1.0e6
damping_n_s_per_m = 15.8
normal_force_n = 350.0
belt_velocity_m_per_s = 0.02
[friction]
law = "decreasing"
static_coefficient = 0.4
minimum_coefficient = 0.2857
reference_velocity_m_per_s = 0.03
[[dither]]
direction = "normal"
waveform = "triangle"
amplitude_n_rms = 60.0
frequency_hz = 2000.0
[[dither]]
direction = "tangential"
waveform = "square"
amplitude_n = 40.0
frequency_hz = 3000.0
phase = 0.5
"#;

fn set(changes: &[&str]) -> Vec<Change> {
    changes.iter().map(|text| Change::parse(text, "--set").expect("path=value")).collect()
}

fn good(changes: &[&str]) -> BeltStudy {
    BeltStudy::parse(GOOD, &set(changes)).unwrap_or_else(|errors| panic!("{errors:?}"))
}

fn complaints(text: &str, changes: &[&str]) -> Complaints {
    BeltStudy::parse(text, &set(changes)).expect_err(text)
}

/// What one complaint must say: fault, key, line, a part of what is allowed, suggestion.
type Said = (Fault, &'static str, Option<usize>, &'static str, Option<&'static str>);

fn check(text: &str, expected: &[Said]) {
    let reported = complaints(text, &[]);
    let reported: Vec<_> = reported.iter().collect();
    for (fault, key, line, allowed, suggestion) in expected {
        let found =
            reported.iter().find(|complaint| complaint.fault == *fault && complaint.key == *key);
        let Some(found) = found else {
            panic!("no complaint {fault:?} about {key} in {reported:#?}\n{text}");
        };
        assert_eq!(found.origin.line(), *line, "{found}");
        assert!(found.allowed.contains(allowed), "{found}: wants {allowed:?}");
        assert_eq!(found.suggestion.as_deref(), *suggestion, "{found}");
    }
    assert_eq!(reported.len(), expected.len(), "{reported:#?}");
}

#[test]
fn a_good_study_is_read() {
    let study = good(&[]);
    assert_eq!(study.title(), Some("Stribeck belt"));
    assert_eq!(study.number("dither.frequency_ratio"), Some(10.0));
    assert_eq!(study.number("friction.minimum_coefficient"), Some(0.2857));
    assert_eq!(study.kind().system().initial(), &SystemStart::Rest);
    assert_eq!((study.solver().tolerance, study.solver().record_periods), (1e-12, 60));
    assert_eq!(study.solver().settle, 1200.0);
    assert!(study.scales().is_none() && study.sweeps().is_empty());
}

/// Replacements in the good study, and what must be said about each.
const WRONG: &[(&str, &str, Said)] = &[
    ("= 0.005", "= -0.1", (Fault::Value, "belt.damping_ratio", Some(4), "≥ 0", None)),
    ("= 0.005", "= nan", (Fault::Value, "belt.damping_ratio", Some(4), "≥ 0", None)),
    ("= 0.005", "= inf", (Fault::Value, "belt.damping_ratio", Some(4), "finite", None)),
    ("= 0.005", "= 1e999", (Fault::Value, "belt.damping_ratio", Some(4), "finite", None)),
    ("= 0.005", "= \"0.1\"", (Fault::Value, "belt.damping_ratio", Some(4), "without quotes", None)),
    ("= 0.005", "= true", (Fault::Value, "belt.damping_ratio", Some(4), "number", None)),
    ("= 0.005", "= [1]", (Fault::Value, "belt.damping_ratio", Some(4), "an array", None)),
    ("= 0.005", "= 1979-05-27", (Fault::Value, "belt.damping_ratio", Some(4), "a date", None)),
    (
        "normal_load = 1.0",
        "normal_load = 0",
        (Fault::Value, "belt.normal_load", Some(5), "> 0", None),
    ),
    ("normal_load = 1.0\n", "", (Fault::Missing, "belt.normal_load", Some(3), "> 0", None)),
    (
        "frequency_ratio = 10",
        "frequency_ratio = 0",
        (Fault::Value, "dither.frequency_ratio", Some(16), "(0, 100000]", None),
    ),
    (
        "amplitude = 0.4",
        "amplitude = -1",
        (Fault::Value, "dither.amplitude", Some(15), "≥ 0", None),
    ),
    (
        "0.2857",
        "0.5",
        (Fault::Value, "friction.minimum_coefficient", Some(10), "static_coefficient = 0.4", None),
    ),
    (
        "\"stribeck\"",
        "\"stribek\"",
        (Fault::Value, "friction.law", Some(8), "\"decreasing\"", Some("\"stribeck\"")),
    ),
    ("\"stribeck\"", "3", (Fault::Value, "friction.law", Some(8), "\"decreasing\"", None)),
    ("law = \"stribeck\"\n", "", (Fault::Missing, "friction.law", Some(7), "\"decreasing\"", None)),
    (
        "\"sine\"",
        "\"sin\"",
        (Fault::Value, "dither.waveform", Some(14), "\"square\"", Some("\"sine\"")),
    ),
    (
        "\"tangential\"",
        "\"sideways\"",
        (Fault::Value, "dither.direction", Some(13), "\"normal\"", None),
    ),
    ("schema = 1", "schema = 2", (Fault::Value, "schema", Some(1), "1", None)),
    ("title = \"Stribeck belt\"", "title = 3", (Fault::Value, "title", Some(2), "a string", None)),
    ("title", "titel", (Fault::Unknown, "titel", Some(2), "title", Some("title"))),
    ("[friction]", "[frction]", (Fault::Unknown, "frction", Some(7), "friction", Some("friction"))),
    (
        "damping_ratio = 0.005",
        "dampng_ratio = 0.005",
        (Fault::Unknown, "belt.dampng_ratio", Some(4), "damping_ratio", Some("belt.damping_ratio")),
    ),
    (
        "[dither]",
        "[solver]\ntolerance = 0.5\n[dither]",
        (Fault::Value, "solver.tolerance", Some(13), "0.001", None),
    ),
    (
        "[dither]",
        "[solver]\nrecord_periods = 2.5\n[dither]",
        (Fault::Value, "solver.record_periods", Some(13), "whole", None),
    ),
    (
        "[dither]",
        "[solver]\nsettle = -1\n[dither]",
        (Fault::Value, "solver.settle", Some(13), "[0", None),
    ),
    (
        "[dither]",
        "[solver]\nsteps = 1\n[dither]",
        (Fault::Unknown, "solver.steps", Some(13), "tolerance", None),
    ),
    (
        "[dither]",
        "solver = 1\n[dither]",
        (Fault::Unknown, "friction.solver", Some(12), "law", None),
    ),
    (
        "[friction]",
        "initial = 3\n[friction]",
        (Fault::Value, "belt.initial", Some(7), "a table", None),
    ),
    (
        "[friction]",
        "[belt.initial]\nstate = \"resting\"\n[friction]",
        (Fault::Value, "belt.initial.state", Some(8), "\"sliding\"", Some("\"rest\"")),
    ),
    (
        "[friction]",
        "[belt.initial]\nstate = \"rest\"\nvelocity = 1\n[friction]",
        (Fault::Conflict, "belt.initial.state", Some(8), "not both", None),
    ),
    (
        "[friction]",
        "[belt.initial]\ndisplacement = nan\n[friction]",
        (Fault::Value, "belt.initial.displacement", Some(8), "finite", None),
    ),
    (
        "amplitude = 0.4",
        "amplitude_n = 0.4",
        (
            Fault::Mixed,
            "dither.amplitude_n",
            Some(15),
            "dither.amplitude",
            Some("dither.amplitude"),
        ),
    ),
    (
        "[dither]",
        "[sample]\n[dither]",
        (Fault::NotBuilt, "sample", Some(12), "not implemented yet", None),
    ),
    ("schema = 1", "schema = 1\nschema = 1", (Fault::Syntax, "study", Some(2), "duplicate", None)),
    ("schema = 1", "schema == 1", (Fault::Syntax, "study", Some(1), "", None)),
];

#[test]
fn one_wrong_value_gives_one_complaint() {
    let wrong = |from: &str, to: &str| GOOD.replace(from, to);
    for (from, to, said) in WRONG {
        check(&wrong(from, to), &[*said]);
    }
}

#[test]
fn normal_dither_beyond_the_load_is_refused() {
    let text =
        GOOD.replace("\"tangential\"", "\"normal\"").replace("amplitude = 0.4", "amplitude = 1.5");
    check(&text, &[(Fault::Value, "dither.amplitude", Some(15), "pull the contact apart", None)]);
    let text = SI.replace("amplitude_n_rms = 60.0", "amplitude_n_rms = 300.0");
    let reported = complaints(&text, &[]);
    assert_eq!((reported.len(), reported[0].key.as_str()), (1, "dither[0].amplitude_n_rms"));
    assert!(reported[0].allowed.contains("normal_load = 350 N"), "{}", reported[0]);
    let given = reported[0].value.as_f64().expect("a number");
    assert!((given - 300.0).abs() < 1e-10, "{given}");
}

#[test]
fn all_complaints_come_at_once_in_the_order_of_the_text() {
    let text = r#"schema = 1
colour = "red"
[belt]
dampng_ratio = 0.1
damping_ratio = -1
normal_load = 1
belt_velocity = "fast"
[friction]
law = "stribeck"
static_coefficient = 0.1
minimum_coefficient = 0.2
reference_velocity = 0
[[dither]]
direction = "normal"
waveform = "sine"
amplitude = 2
frequency_ratio = 10
[[dither]]
direction = "tangential"
waveform = "sine"
amplitude = nan
frequency_ratio = 0
phse = 1
"#;
    check(
        text,
        &[
            (Fault::Unknown, "colour", Some(2), "title", None),
            (
                Fault::Unknown,
                "belt.dampng_ratio",
                Some(4),
                "damping_ratio",
                Some("belt.damping_ratio"),
            ),
            (Fault::Value, "belt.damping_ratio", Some(5), "≥ 0", None),
            (Fault::Value, "belt.belt_velocity", Some(7), "number", None),
            (Fault::Value, "friction.minimum_coefficient", Some(11), "at most", None),
            (Fault::Value, "friction.reference_velocity", Some(12), "> 0", None),
            (Fault::Value, "dither[1].amplitude", Some(21), "≥ 0", None),
            (Fault::Value, "dither[1].frequency_ratio", Some(22), "(0, 100000]", None),
            (Fault::Unknown, "dither[1].phse", Some(23), "phase", Some("dither[1].phase")),
        ],
    );
    // With a valid second dither, the separation by the first one is reported with the other errors.
    let text =
        text.replace("= nan", "= 1").replace("frequency_ratio = 0\n", "frequency_ratio = 3\n");
    let reported = complaints(&text, &[]);
    assert!(
        reported.iter().any(|complaint| complaint.allowed.contains("pull the contact apart")),
        "{reported:#?}"
    );
    let lines: Vec<_> = reported.iter().filter_map(|complaint| complaint.origin.line()).collect();
    assert!(lines.is_sorted() && lines.len() == reported.len(), "{lines:?}");
}

#[test]
fn a_disc_is_no_study_of_a_belt() {
    check(
        "schema = 1\n[disc]\ninner_radius_ratio = 0.5\n[disc.load]\nmass = 0.1\n",
        &[(Fault::Conflict, "disc", Some(2), "is not available for a disc study", None)],
    );
}

#[test]
fn bare_numbers_of_a_disc_in_si_are_those_of_its_keys_in_si() {
    let body = "inner_radius_ratio = 0.5\npoisson_ratio = 0.3\nradial_modes = 1\nnodal_diameters = 2\n\
        youngs_modulus_pa = 2.1e11\ndensity_kg_per_m3 = 7800\nthickness_m = 0.01\nouter_radius_m = 0.15\n";
    let twins = format!(
        "schema = 1\n[disc]\n{body}[disc.load]\nradius_ratio = 0.75\nmass_kg = 0.1\n\
         damping_n_s_per_m = 10\nstiffness_n_per_m = 1e6\nfriction_n = 2e4\nspeed_hz = 50\n\
         [dither]\ndirection = \"normal\"\namplitude = 0.5\nfrequency_hz = 5000\n"
    );
    let bare = format!(
        "schema = 1\n[disc]\nunits = \"SI\"\n{body}[disc.load]\nradius_ratio = 0.75\nmass = 0.1\n\
         damping = 10\nstiffness = \"1000 N/mm\"\nfriction = 2e4\nspeed = {:?}\n\
         [dither]\ndirection = \"normal\"\namplitude = 0.5\nfrequency = \"5 kHz\"\n",
        TAU * 50.0
    );
    let read = |text: &str| DiscStudy::parse(text, &[]).unwrap_or_else(|wrong| panic!("{wrong:?}"));
    let (twins, bare) = (read(&twins), read(&bare));
    assert_eq!(bare.disc(), twins.disc());
    for (path, twin, value, in_twin) in [
        ("disc.load.friction", "disc.load.friction_n", 3e4, 3e4),
        ("disc.load.speed", "disc.load.speed_hz", TAU * 60.0, 60.0),
        ("dither.frequency", "dither.frequency_hz", TAU * 7000.0, 7000.0),
        ("dither.amplitude", "dither.amplitude", 0.25, 0.25),
    ] {
        let at = |study: &DiscStudy, number| {
            let numbers = study.model().numbers(&[number]).expect(path);
            study.setup_at(&numbers).expect(path).disc().clone()
        };
        assert_eq!(at(&bare, (path, value)), at(&twins, (twin, in_twin)), "{path}");
    }
}

#[test]
fn loads_of_listed_modes_may_be_given_in_si() {
    let load = "[disc.load]\nradius_ratio = 0.75\nmass_kg = 0.1\ndamping_n_s_per_m = 10\n\
        stiffness = \"1 kN/mm\"\nfriction_n = 2e4\nspeed_rpm = 3000\n";
    let computed = format!(
        "schema = 1\n[disc]\ninner_radius_ratio = 0.5\npoisson_ratio = 0.3\nradial_modes = 1\n\
         nodal_diameters = 2\nyoungs_modulus_pa = 2.1e11\ndensity_kg_per_m3 = 7800\n\
         thickness_m = 0.01\nouter_radius_m = 0.15\n{load}"
    );
    let read = |text: &str| DiscStudy::parse(text, &[]).unwrap_or_else(|wrong| panic!("{wrong:?}"));
    let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-13, "{a} {b}");
    let computed = read(&computed);
    let hertz = computed.reference_hz().expect("a material");
    let mut modes = String::new();
    for mode in computed.disc().modes() {
        let (diameters, hertz, shape) = (mode.diameters, mode.ratio * hertz, mode.shape_at_load);
        let _ = writeln!(
            modes,
            "[[disc.mode]]\ndiameters = {diameters}\nfrequency_hz = {hertz:?}\nshape_at_load = {shape:?}"
        );
    }
    // M_p = ρhπ(a² − b²).
    let mass = 7800.0 * 0.01 * PI * 0.15 * 0.15 * (1.0 - 0.25);
    let plate = format!("plate_mass_kg = {mass:?}\nouter_radius_m = \"150 mm\"\n");
    let listed = read(&format!("schema = 1\n[disc]\n{plate}{load}{modes}"));
    close(listed.disc().plate_mass_kg().expect("given"), mass);
    let numbers = |study: &DiscStudy| {
        let load = &study.disc().loads()[0];
        [load.mass, load.damping, load.stiffness, load.friction, study.disc().speed()]
    };
    for (of_list, of_plate) in numbers(&listed).into_iter().zip(numbers(&computed)) {
        close(of_list, of_plate);
    }
    let wrong = |text: &str| DiscStudy::parse(text, &[]).expect_err(text);
    let without = wrong(&format!("schema = 1\n[disc]\nouter_radius_m = 0.15\n{load}{modes}"));
    let told = without.iter().find(|complaint| complaint.key == "disc.load.mass_kg");
    assert!(told.is_some_and(|told| told.allowed.contains("disc.plate_mass_kg")), "{without:?}");
    let both = wrong("schema = 1\n[disc]\ninner_radius_ratio = 0.5\nplate_mass_kg = 3\n");
    assert!(both.iter().any(|one| one.key == "disc.plate_mass_kg" && one.origin.line() == Some(4)));
}

#[test]
fn si_and_the_numbers_of_the_equations_give_the_same_belt() {
    let si = BeltStudy::parse(SI, &[]).unwrap_or_else(|errors| panic!("{errors:?}"));
    let (mass, stiffness) = (2.5_f64, 1.0e6_f64);
    let omega = (stiffness / mass).sqrt();
    let plain = format!(
        "schema = 1\n[belt]\ndamping_ratio = {:e}\nnormal_load = {:e}\nbelt_velocity = {:e}\n\
         [friction]\nlaw = \"decreasing\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2857\n\
         reference_velocity = {:e}\n[[dither]]\ndirection = \"normal\"\nwaveform = \"triangle\"\n\
         amplitude = {:e}\nfrequency_ratio = {:e}\n[[dither]]\ndirection = \"tangential\"\n\
         waveform = \"square\"\namplitude = {:e}\nfrequency_ratio = {:e}\nphase = 0.5\n",
        15.8 / (2.0 * mass * omega),
        350.0 / stiffness,
        0.02 / omega,
        0.03 / omega,
        60.0 * 3f64.sqrt() / stiffness,
        TAU * 2000.0 / omega,
        40.0 / stiffness,
        2.0 * PI * 3000.0 / omega,
    );
    let plain = BeltStudy::parse(&plain, &[]).unwrap_or_else(|errors| panic!("{errors:?}"));
    let numbers = |study: &BeltStudy| {
        let belt = study.belt();
        let mut numbers = vec![belt.damping_ratio(), belt.normal_load(), belt.belt_velocity()];
        for name in ["static_coefficient", "minimum_coefficient", "reference_velocity"] {
            numbers.extend(belt.friction().get(&format!("friction.{name}")));
        }
        for dither in belt.dithers() {
            numbers.extend([dither.amplitude, dither.frequency_ratio, dither.phase]);
        }
        numbers
    };
    let (of_si, of_plain) = (numbers(&si), numbers(&plain));
    assert_eq!((of_si.len(), of_plain.len()), (12, 12));
    for (a, b) in of_si.into_iter().zip(of_plain) {
        assert!((a - b).abs() <= 1e-15 * b.abs(), "{a} {b}");
    }
    assert_eq!(si.scales().map(|scales| scales.mass()), Some(2.5));
}

#[test]
fn a_belt_in_si_may_give_its_natural_frequency_and_damping_ratio() {
    let plain = BeltStudy::parse(SI, &[]).expect("valid");
    let scales = plain.scales().expect("in SI");
    let hertz = scales.angular_frequency() / TAU;
    let ratio = plain.belt().damping_ratio();
    let stiffness = SI.lines().find(|line| line.starts_with("stiffness_n_per_m")).expect("there");
    let stated = SI
        .replace(stiffness, &format!("natural_frequency_hz = {hertz:?}"))
        .replace("damping_n_s_per_m = 15.8", &format!("damping_ratio = {ratio:?}"));
    let other = BeltStudy::parse(&stated, &[]).expect("valid");
    let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 4e-15, "{a} {b}");
    assert_eq!(other.belt().damping_ratio(), ratio);
    close(other.belt().normal_load(), plain.belt().normal_load());
    close(other.scales().expect("in SI").stiffness(), scales.stiffness());
    // Each may stand alone, and `--set` takes one in the place of the other.
    let half = SI.replace("damping_n_s_per_m = 15.8", "damping_ratio = 0.005");
    assert_eq!(BeltStudy::parse(&half, &[]).expect("valid").belt().damping_ratio(), 0.005);
    let changes = set(&["belt.natural_frequency_hz=0.1kHz", "belt.damping_ratio=2%"]);
    let changed = BeltStudy::parse(SI, &changes).expect("valid");
    close(changed.scales().expect("in SI").angular_frequency(), 200.0 * PI);
    assert_eq!(changed.belt().damping_ratio(), 0.02);
    // Both at once is a contradiction.
    for (line, more, key) in [
        (stiffness, "natural_frequency_hz = 100", "belt.natural_frequency_hz"),
        ("damping_n_s_per_m = 15.8", "damping_ratio = 0.01", "belt.damping_n_s_per_m"),
    ] {
        let both = SI.replace(line, &format!("{line}\n{more}"));
        let complaints = BeltStudy::parse(&both, &[]).expect_err("both are given");
        assert_eq!(complaints.len(), 1, "{complaints:?}");
        assert_eq!((complaints[0].fault, complaints[0].key.as_str()), (Fault::Conflict, key));
        assert!(complaints[0].allowed.contains("not both"), "{}", complaints[0].allowed);
    }
    let missing = SI.replace(&format!("{stiffness}\n"), "");
    let complaints = BeltStudy::parse(&missing, &[]).expect_err("nothing says it");
    assert!(complaints[0].allowed.contains("or belt.natural_frequency_hz"), "{complaints:?}");
}

#[test]
fn numbers_may_have_units() {
    let with = |changes: &[&str]| BeltStudy::parse(SI, &set(changes));
    let (plain, units) = (
        with(&[
            "belt.belt_velocity_m_per_s=0.1",
            "belt.mass_kg=2.5",
            "dither[0].phase=1.5707963267948966",
        ]),
        with(&[
            "belt.belt_velocity_m_per_s=0.36km/h",
            "belt.mass_kg=2500 g",
            "dither[0].phase=90deg",
        ]),
    );
    let (plain, units) = (plain.expect("valid"), units.expect("valid"));
    assert_eq!(plain.belt(), units.belt());
    assert_eq!(plain.settings(), units.settings());
    // In the file as well, and for the ends of an axis.
    let text = SI.replace("normal_force_n = 350.0", "normal_force_n = '0.35 kN'");
    assert_eq!(
        BeltStudy::parse(&text, &[]).expect("valid").belt(),
        with(&[]).expect("valid").belt()
    );
    let axis = "[[sweep]]\nparameter = 'dither[0].frequency_hz'\nfrom = '1kHz'\nto = '4000 Hz'\npoints = 3\n";
    let swept = BeltStudy::parse(&format!("{SI}{axis}"), &[]).expect("valid");
    assert_eq!(swept.sweeps()[0].axis.values().collect::<Vec<_>>(), [1000.0, 2500.0, 4000.0]);
    let listed = with(&["sweep[0].parameter=belt.normal_force_n", "sweep[0].values=[0.3kN, 350]"]);
    let listed = listed.expect("valid");
    assert_eq!(listed.sweeps()[0].axis.values().collect::<Vec<_>>(), [300.0, 350.0]);
    // A unit of another dimension, one that is not a unit, and one in a study without SI.
    for (text, key, part) in [
        ("belt.normal_force_n=5m", "belt.normal_force_n", "in N; m is a unit of another quantity"),
        ("belt.normal_force_n=5kg", "belt.normal_force_n", "kg is a unit of another quantity"),
        ("belt.normal_force_n=5 stone", "belt.normal_force_n", "stone is not a unit"),
        ("solver.record_periods=5s", "solver.record_periods", "no unit is allowed here, got s"),
    ] {
        let complaints = with(&[text]).expect_err(text);
        assert_eq!(complaints[0].key, key);
        assert!(complaints[0].allowed.contains(part), "{text}: {}", complaints[0].allowed);
    }
    let complaints = BeltStudy::parse(GOOD, &set(&["belt.normal_load=5N"])).expect_err("no SI");
    assert!(
        complaints[0].allowed.contains("units require belt.mass and belt.stiffness"),
        "{complaints:?}"
    );
}

#[test]
fn hints_are_keys_that_the_study_has() {
    for (path, wanted) in [
        ("belt.normal_laod", "belt.normal_load"),
        ("belt.initial.displacment", "belt.initial.displacement"),
        ("belt.initial.velocty", "belt.initial.velocity"),
        ("solver.setle", "solver.settle"),
        ("dither[0].amplitud", "dither[0].amplitude"),
    ] {
        for text in [SI, GOOD] {
            let complaints =
                BeltStudy::parse(text, &set(&[&format!("{path}=1")])).expect_err("no such key");
            let hint = complaints.iter().find_map(|complaint| complaint.suggestion.as_deref());
            assert_eq!(hint, Some(wanted), "{path}: {complaints:?}");
        }
    }
}

#[test]
fn a_bare_number_is_in_the_units_of_the_study() {
    let bare = SI
        .replace("normal_force_n", "normal_load")
        .replace("belt_velocity_m_per_s = 0.02", "belt_velocity = '20 mm/s'")
        .replace("damping_n_s_per_m", "damping")
        .replace("amplitude_n = 40.0", "amplitude = '0.04 kN'")
        .replace("frequency_hz = 3000.0", "frequency = '3 kHz'")
        .replace("reference_velocity_m_per_s", "reference_velocity");
    let belt = |text: &str| BeltStudy::parse(text, &[]).expect("valid").belt().clone();
    assert_eq!(belt(&bare), belt(SI));
    let both = SI.replace("amplitude_n = 40.0", "amplitude_n = 40.0\namplitude_n_rms = 40.0");
    check(&both, &[(Fault::Conflict, "dither[1].amplitude_n_rms", Some(22), "not both", None)]);
    let solver = format!("{SI}[solver]\nsettle = 2\n");
    let study = BeltStudy::parse(&solver, &[]).expect("valid");
    let seconds = study.scales().expect("in SI").to_units(Quantity::Time, study.solver().settle);
    assert!((seconds - 2.0).abs() < 1e-15, "{seconds}");
    let no_mass = SI.replace("mass_kg = 2.5\n", "");
    check(&no_mass, &[(Fault::Missing, "belt.mass", Some(2), "kg", None)]);
    let negative = SI.replace("mass_kg = 2.5", "mass_kg = -2.5").replace("= 350.0", "= -3");
    check(
        &negative,
        &[
            (Fault::Value, "belt.mass_kg", Some(3), "> 0", None),
            (Fault::Value, "belt.normal_force_n", Some(6), "> 0", None),
        ],
    );
}

#[test]
fn suggestions_are_keys_of_every_study() {
    let reported = complaints(&SI.replace("damping_n_s_per_m", "dampng_ratio"), &[]);
    let unknown =
        reported.iter().find(|complaint| complaint.fault == Fault::Unknown).expect("unknown");
    // The damping ratio is a key of a study in SI as well.
    assert_eq!(unknown.suggestion.as_deref(), Some("belt.damping_ratio"));
    let reported = complaints(&SI.replace("normal_force_n", "normal_laod"), &[]);
    let unknown =
        reported.iter().find(|complaint| complaint.fault == Fault::Unknown).expect("unknown");
    assert_eq!(unknown.suggestion.as_deref(), Some("belt.normal_load"));
    let reported = complaints(&GOOD.replace("amplitude = 0.4", "amplitud_n = 0.4"), &[]);
    let unknown =
        reported.iter().find(|complaint| complaint.fault == Fault::Unknown).expect("unknown");
    assert_eq!(unknown.suggestion.as_deref(), Some("dither.amplitude_n"));
}

#[test]
fn set_reaches_every_key() {
    let study = good(&[
        "belt.damping_ratio=0.1",
        "friction.law=decreasing",
        "dither.waveform=\"square\"",
        "dither[0].amplitude=0.9",
        "dither.phase=1",
        "belt.initial.state=sliding",
        "solver.tolerance=1e-9",
        "title=another",
    ]);
    assert_eq!(study.belt().damping_ratio(), 0.1);
    assert_eq!(study.belt().friction().kind().name(), "decreasing");
    assert_eq!(study.belt().dithers()[0].waveform.name(), "square");
    assert_eq!(study.belt().dithers()[0].amplitude, 0.9);
    assert_eq!(study.kind().system().initial(), &SystemStart::Sliding);
    assert_eq!((study.solver().tolerance, study.title()), (1e-9, Some("another")));
    let si = BeltStudy::parse(SI, &set(&["dither[0].amplitude_n=100", "belt.normal_force_n=400"]));
    let si = si.unwrap_or_else(|errors| panic!("{errors:?}"));
    assert_eq!(si.belt().normal_load(), 400.0 / 1.0e6);
    assert_eq!(si.belt().dithers()[0].amplitude, 100.0 / 1.0e6);
    // A later state takes the place of an earlier one.
    let study = good(&["belt.initial.state=sliding", "belt.initial.displacement=2"]);
    assert_eq!(study.kind().system().initial(), &SystemStart::Values(vec![2.0, 0.0]));
}

#[test]
fn set_complains_about_what_it_cannot_reach() {
    let one = |changes: &[&str]| {
        let reported = complaints(GOOD, changes);
        assert_eq!(reported.len(), 1, "{reported:#?}");
        reported.into_iter().next().expect("one")
    };
    let unknown = one(&["belt.belt_velocty=0.1"]);
    assert_eq!(
        (unknown.fault, unknown.suggestion.as_deref()),
        (Fault::Unknown, Some("belt.belt_velocity"))
    );
    assert_eq!(unknown.origin.line(), None);
    assert_eq!(one(&["dither[1].amplitude=1"]).fault, Fault::Conflict);
    assert_eq!(one(&["disc.inner_radius_ratio=1"]).fault, Fault::Conflict);
    assert_eq!(one(&["belt.normal_load=-1"]).key, "belt.normal_load");
    assert_eq!(one(&["belt.normal_force_n=3"]).fault, Fault::Mixed);
    let reported = complaints(SI, &["dither.phase=1", "belt.belt_velocity=-1"]);
    assert!(
        reported
            .iter()
            .any(|complaint| complaint.fault == Fault::Conflict && complaint.key == "dither.phase")
    );
    assert!(
        reported
            .iter()
            .any(|complaint| complaint.fault == Fault::Value
                && complaint.key == "belt.belt_velocity")
    );
    assert!(Change::parse("belt.belt_velocity", "--set").is_err());
}

#[test]
fn axes_are_read_and_checked() {
    let text = format!(
        "{GOOD}[[sweep]]\nparameter = \"dither.amplitude\"\nfrom = 0.05\nto = 1.0\npoints = 20\n\
         [[sweep]]\nparameter = \"dither.frequency_ratio\"\nvalues = [5, 10.0]\n\
         [[sweep]]\nparameter = \"belt.belt_velocity\"\nfrom = 0.01\nto = 1\npoints = 3\nspacing = \"log\"\n"
    );
    let study = BeltStudy::parse(&text, &[]).unwrap_or_else(|errors| panic!("{errors:?}"));
    assert_eq!(study.sweeps().len(), 3);
    assert_eq!(study.sweeps()[1].axis, Axis::Values(vec![5.0, 10.0]));
    assert!((study.sweeps()[2].axis.value(1) - 0.1).abs() < 1e-16);
    let changed = study.with("dither.amplitude", 0.7).expect("valid");
    assert_eq!(changed.belt().dithers()[0].amplitude, 0.7);

    let axis = |lines: &str| format!("{GOOD}[[sweep]]\n{lines}\n");
    let said =
        |fault, key, line, allowed, suggestion| -> Said { (fault, key, line, allowed, suggestion) };
    for (lines, expected) in [
        (
            "parameter = \"dither.amplitud\"\nvalues = [1]",
            said(Fault::Value, "sweep[0].parameter", Some(18), "path", Some("dither.amplitude")),
        ),
        (
            "parameter = \"friction.law\"\nvalues = [1]",
            said(Fault::Value, "sweep[0].parameter", Some(18), "a number", None),
        ),
        ("values = [1]", said(Fault::Missing, "sweep[0].parameter", Some(17), "path", None)),
        (
            "parameter = \"dither.phase\"\nvalues = []",
            said(Fault::Value, "sweep[0].values", Some(19), "at least one", None),
        ),
        (
            "parameter = \"dither.phase\"\nvalues = [nan]",
            said(Fault::Value, "sweep[0].values[0]", Some(19), "finite", None),
        ),
        (
            "parameter = \"dither.phase\"\nvalues = [1]\npoints = 3",
            said(Fault::Conflict, "sweep[0].points", Some(20), "not both", None),
        ),
        (
            "parameter = \"dither.phase\"\nfrom = 0\nto = 1\npoints = 1",
            said(Fault::Value, "sweep[0].points", Some(21), "[2", None),
        ),
        (
            "parameter = \"dither.phase\"\nfrom = 0\nto = 1\npoints = 3\nspacing = \"log\"",
            said(Fault::Value, "sweep[0].from", Some(19), "> 0", None),
        ),
        (
            "parameter = \"dither.amplitude\"\nvalues = [-1]",
            said(Fault::Value, "sweep[0].parameter", Some(17), "≥ 0", None),
        ),
        (
            "parameter = \"dither[3].amplitude\"\nvalues = [1]",
            said(Fault::Conflict, "sweep[0].parameter", Some(18), "one: dither[0]", None),
        ),
        (
            "parameter = \"dither.amplitude_n\"\nvalues = [1]",
            said(
                Fault::Mixed,
                "sweep[0].parameter",
                Some(17),
                "dimensionless",
                Some("dither.amplitude"),
            ),
        ),
    ] {
        check(&axis(lines), &[expected]);
    }
}

#[test]
fn axes_are_added_one_after_the_other_and_take_the_place_of_others() {
    let axis = |index: usize, path: &str| {
        [format!("sweep[{index}].parameter={path}"), format!("sweep[{index}].values=[0.1, 0.2]")]
    };
    let both: Vec<String> =
        [axis(0, "dither.amplitude"), axis(1, "belt.belt_velocity")].concat().into_iter().collect();
    let study = good(&both.iter().map(String::as_str).collect::<Vec<_>>());
    let paths = |study: &BeltStudy| -> Vec<String> {
        study.sweeps().iter().map(|sweep| sweep.path.clone()).collect()
    };
    assert_eq!(paths(&study), ["dither.amplitude", "belt.belt_velocity"]);
    // An axis beyond the next one is still refused.
    assert!(complaints(GOOD, &["sweep[1].parameter=dither.amplitude"])[0].fault == Fault::Conflict);

    let mut table = quell_input::document::Table::default();
    let value = |text| quell_input::document::Node::from_argument(text, "axes");
    table.set("parameter", value("belt.normal_load"));
    table.set("values", value("[1, 2, 3]"));
    let other = study.sweeping(&[table]).expect("valid");
    assert_eq!(paths(&other), ["belt.normal_load"]);
    let recorded = ["sweep[0].parameter=\"belt.normal_load\"", "sweep[0].values=[1,2,3]"];
    assert_eq!(other.changes(), recorded);
    assert!(study.sweeping(&[]).expect("valid").sweeps().is_empty());
}

/// A key of another law is reported with the keys of this law, and never suggests itself.
#[test]
fn a_key_of_another_law_is_reported_with_the_keys_of_this_law() {
    let formula = ["friction.law=expression", "friction.coefficient=0.3*exp(-v)"];
    for (changes, key, law) in [
        (&formula[..], "friction.minimum_coefficient", "expression"),
        (&["friction.coefficient=0.3"], "friction.coefficient", "stribeck"),
        (&["friction.terms=2"], "friction.terms", "stribeck"),
        (&["friction.constants.a=1"], "friction.constants", "stribeck"),
    ] {
        let reported = complaints(GOOD, changes);
        let found = reported
            .iter()
            .find(|complaint| complaint.key == key)
            .unwrap_or_else(|| panic!("{reported:?}"));
        assert_eq!((found.fault, &found.suggestion), (Fault::Unknown, &None), "{found}");
        let (keys, whose) = found.allowed.split_once(" for ").expect("whose keys");
        assert_eq!(whose, format!("law = \"{law}\""));
        let name = key.trim_start_matches("friction.");
        assert!(keys.starts_with("law") && keys.split(", ").all(|key| key != name), "{keys}");
    }
    let reported = complaints(GOOD, &["friction.minimum_coeficient=0.3"]);
    assert!(reported[0].suggestion.is_some(), "{reported:?}");
}

#[test]
fn a_table_is_set_key_by_key() {
    for (change, key, example) in [
        ("belt=3", "belt", "belt.damping_ratio"),
        ("friction={}", "friction", "friction.law"),
        ("dither[0]=1", "dither[0]", "dither[0].direction"),
    ] {
        let reported = complaints(GOOD, &[change]);
        assert_eq!(
            (reported.len(), reported[0].fault, reported[0].key.as_str()),
            (1, Fault::Value, key)
        );
        assert!(
            reported[0].allowed.contains(&format!("key by key, such as {example}")),
            "{}",
            reported[0]
        );
    }
}

#[test]
fn bounds_are_printed_without_runs_of_zeros() {
    use quell_model::parameter::Bounds;
    let reported = |lower, upper| Bounds { lower, lower_included: true, upper }.to_string();
    assert_eq!(reported(1e-300, f64::INFINITY), "a finite number ≥ 1e-300");
    assert_eq!(reported(0.0, 1e30), "a number in [0, 1e30]");
    assert_eq!(reported(-0.5, 20000.0), "a number in [-0.5, 20000]");
}

#[test]
fn a_study_without_a_version_has_the_current_one() {
    let study = good(&[]);
    let without = GOOD.replace("schema = 1\n", "");
    let bare = BeltStudy::parse(&without, &[]).expect("valid");
    assert_eq!(bare.settings(), study.settings());
    assert!(bare.settings().iter().any(|(path, value)| path == "schema" && value == "1.0"));
    let set = BeltStudy::parse(&without, &set(&["schema=2"])).expect_err("no such version");
    assert_eq!((set.len(), set[0].key.as_str()), (1, "schema"));
}

/// A table that only studies of another kind have is refused, in the file and by `--set`: nothing is ignored in silence.
#[test]
fn tables_of_another_kind_are_refused() {
    let disc = "[disc]\ninner_radius_ratio = 0.5\npoisson_ratio = 0.3\nradial_modes = 1\nnodal_diameters = 2\n\
                [disc.load]\nradius_ratio = 0.75\n";
    let system = "[system]\ncoordinates = [\"x\"]\nmass = [1]\nstiffness = [1]\n";
    for (text, table, set, whose) in [
        (disc, "[response]\nband = [0, 1]\n", "response.band=[0, 1]", "[belt]"),
        (system, "[response]\nband = [0, 1]\n", "response.band=[0, 1]", "[belt]"),
        (system, "[solver]\nsettle = 3\n", "solver.settle=3", "[belt]"),
        (disc, "[parameters]\na = 1\n", "parameters.a=1", "[system]"),
        (GOOD, "[parameters]\na = 1\n", "parameters.a=1", "[system]"),
        (system, "[disc]\n", "disc.inner_radius_ratio=1", "[system] exclude"),
    ] {
        let name = set.split('.').next().expect("a table");
        for (text, changes, key) in [
            (format!("{text}{table}"), vec![], name),
            (text.to_owned(), vec![set], set.split('=').next().expect("a path")),
        ] {
            // A document with [system] is that of a system.
            let complaints = Study::parse(&text, &self::set(&changes)).expect_err(set);
            let found = complaints.iter().find(|complaint| complaint.key == key);
            let found = found.unwrap_or_else(|| panic!("{set}: {complaints:#?}"));
            assert_eq!(found.fault, Fault::Conflict, "{found}");
            assert!(found.allowed.contains(whose), "{found}");
        }
    }
}

/// A speed along the surface is that at the radius of the load, which must be known.
#[test]
fn the_speed_of_a_disc_may_be_that_along_its_surface() {
    let text = "[disc]\nunits = \"SI\"\ninner_radius_ratio = 0.5\npoisson_ratio = 0.3\nradial_modes = 1\nnodal_diameters = 2\n\
                youngs_modulus_pa = 2.1e11\ndensity_kg_per_m3 = 7800\nthickness_m = 0.01\nouter_radius_m = 0.15\n\
                [disc.load]\nradius_ratio = 0.75\nspeed = SPEED\n";
    let read = |speed: &str| DiscStudy::parse(&text.replace("SPEED", speed), &[]);
    let speed =
        |given: &str| read(given).unwrap_or_else(|wrong| panic!("{wrong:?}")).disc().speed();
    let wanted = speed(&format!("{:?}", 10.0 / (0.75 * 0.15)));
    for given in ["\"36 km/h\"", "\"10 m/s\""] {
        assert!((speed(given) / wanted - 1.0).abs() < 1e-14, "{given}: {}", speed(given));
    }
    let ratio = "[disc]\ninner_radius_ratio = 0.5\npoisson_ratio = 0.3\nradial_modes = 1\nnodal_diameters = 2\n\
                 [disc.load]\nradius_ratio = 0.75\nspeed = \"36 km/h\"\n";
    let complaints = DiscStudy::parse(ratio, &[]).expect_err("no radius");
    assert_eq!((complaints.len(), complaints[0].key.as_str()), (1, "disc.load.speed"));
    assert!(complaints[0].allowed.contains("outer_radius_m"), "{complaints}");
}

/// Amplitude, frequency and phase of what oscillates have paths in belts, discs and contacts, in every unit, and complaints name them.
#[test]
fn the_numbers_of_an_oscillation_have_paths() {
    let text = SI.replace(
        "[friction]",
        "drive = { oscillation = { amplitude_m_per_s = 0.01, frequency_hz = 5 } }\n[friction]",
    );
    let belt = BeltStudy::parse(&text, &[]).expect("valid");
    let path = "belt.drive.oscillation.amplitude";
    assert_eq!(belt.number(path), Some(0.01));
    let RealInterval { upper: largest, .. } = belt.belt().drive().expect("a drive").bounds();
    let faster = belt.with(path, 0.02).expect("a study");
    let RealInterval { upper: further, .. } = faster.belt().drive().expect("a drive").bounds();
    assert!((further / largest - 0.04 / 0.03).abs() < 1e-14, "{further} {largest}");
    let changed = |change: &str| BeltStudy::parse(&text, &set(&[change]));
    assert_eq!(
        changed("belt.drive.oscillation.amplitude_m_per_s=20mm/s").expect("a study").belt(),
        faster.belt()
    );
    let twice = BeltStudy::parse(&text, &set(&["belt.drive.oscillation.frequency=10Hz"]));
    let hertz = twice.expect("a frequency").number("belt.drive.oscillation.frequency_hz");
    assert!((hertz.expect("a number") / 10.0 - 1.0).abs() < 1e-14, "{hertz:?}");
    let wrong = changed("belt.drive.oscillation.amplitud=1").expect_err("no such key");
    assert_eq!(wrong[0].suggestion.as_deref(), Some(path));
    let wrong = changed("belt.drive.oscillation.amplitude=-1").expect_err("negative");
    assert!(wrong[0].allowed.contains("≥ 0"), "{wrong}");
}

/// Lists take numbers with units as single numbers do, and what is wrong with knots is said in the numbers of the file.
#[test]
fn lists_have_the_units_of_the_file() {
    let law = |speeds: &str| {
        let own = format!(
            "law = \"samples\"\nslip_velocity = {speeds}\ncoefficient = [0.4, 0.35, 0.3, 0.29, 0.28]\n"
        );
        let start = SI.find("law =").expect("a law");
        let end = SI.find("[[dither]]").expect("a dither");
        [&SI[..start], &own, &SI[end..]].concat()
    };
    let plain = BeltStudy::parse(&law("[0, 0.01, 0.02, 0.05, 0.1]"), &[]).expect("plain");
    let quoted = law("[0, \"10 mm/s\", \"0.072 km/h\", \"50 mm/s\", 0.1]");
    let quoted = BeltStudy::parse(&quoted, &[]).expect("with units");
    let at = |study: &BeltStudy| study.belt().friction().coefficient(study.belt().belt_velocity());
    assert!((at(&quoted) / at(&plain) - 1.0).abs() < 1e-12, "{} {}", at(&quoted), at(&plain));
    let falling = SI.replace("belt_velocity_m_per_s = 0.02\n", "").replace(
        "[friction]",
        "[belt.drive]\ntime = [0, 1.5, 0.5]\nvelocity = [0.02, 0.02, 0.03]\n[friction]",
    );
    let wrong = BeltStudy::parse(&falling, &[]).expect_err("times that fall");
    assert_eq!((wrong.len(), wrong[0].key.as_str()), (1, "belt.drive.time[2]"));
    assert!(wrong[0].allowed.contains("1.5"), "{wrong}");
    // A frequency whose scale is wrong shows its sign alone.
    let wrong = SI
        .replace("stiffness_n_per_m = 1.0e6", "stiffness_n_per_m = -1")
        .replace("frequency_hz = ", "frequency_hz = -");
    let wrong = BeltStudy::parse(&wrong, &[]).expect_err("two faults");
    let range =
        wrong.iter().find(|fault| fault.key.ends_with("frequency_hz")).expect("a complaint");
    assert!(range.allowed.contains("> 0") && !range.allowed.contains("100000"), "{wrong}");
}

/// A wrong name of the unit system is one fault, not one for every number with a unit.
#[test]
fn a_wrong_unit_system_is_one_fault() {
    let text = "[system]\nunits = \"si\"\ncoordinates = [\"x\"]\nmass_kg = [2.0]\nstiffness_n_per_m = [2e4]\n[[contact]]\n\
                name = \"guide\"\ntangent = { x = 1.0 }\nnormal_load = \"150 N\"\nbelt_velocity_m_per_s = 0.02\n[contact.friction]\n\
                law = \"coulomb\"\ncoefficient = 0.3\n";
    let wrong = Study::parse(text, &[]).expect_err("a wrong word");
    assert_eq!((wrong.len(), wrong[0].key.as_str()), (1, "system.units"), "{wrong}");
    assert_eq!(wrong[0].suggestion.as_deref(), Some("\"SI\""));
}
