//! Studies of systems: what they read, the paths of their numbers, and complaints that name the place.

use std::f64::consts::TAU;

use quell_model::System;
use quell_model::system::{InputTarget, Structure};
use quell_model::units::Quantity;
use quell_study::study::{Change, SystemStart, SystemStudy, UnitSystem};
use quell_study::{Complaints, Fault, Study};

/// Mode coupling with dither, every key that is common.
const TEXT: &str = r#"title = "two coordinates"
[system]
coordinates = ["x", "y"]
mass = [1.0, 2.0]
damping = [[0.1, 0.2], [-0.2, 0.3]]
stiffness = [[2.0, 1.0], [1.0, 0.7]]
force = { y = -0.5 }
[system.initial]
displacements = { x = 0.25 }
velocities = [0.0, -1.0]
[[contact]]
name = "pad"
tangent = { x = 1.0 }
normal = { y = 1.0 }
normal_load = 1.5
normal_stiffness = 1.25
belt_velocity = 0.05
[contact.friction]
law = "coulomb"
coefficient = 0.5
[[contact]]
name = "rail"
tangent = [0.0, -1.0]
normal_load = 2.0
belt_velocity = -0.3
[contact.friction]
law = "stribeck"
static_coefficient = 0.4
minimum_coefficient = 0.3
reference_velocity = 0.2
[[dither]]
at = { x = 1.0, y = -1.0 }
waveform = "sine"
amplitude = 0.1
frequency = 10.0
[[dither]]
contact = "rail"
direction = "normal"
waveform = "square"
amplitude = 0.4
frequency = 12.0
phase = 0.5
"#;

fn study(text: &str) -> SystemStudy {
    match Study::parse(text, &[]) {
        Ok(study) => study.system(),
        Err(complaints) => panic!("{complaints}\n{text}"),
    }
}

fn refused(text: &str) -> Complaints {
    Study::parse(text, &[]).expect_err(text)
}

/// The text with one part replaced, which must exist.
fn with(from: &str, to: &str) -> String {
    assert!(TEXT.contains(from), "{from}");
    TEXT.replacen(from, to, 1)
}

/// The system of other numbers, given by their paths.
fn system_at(study: &SystemStudy, numbers: &[(&str, f64)]) -> System {
    let model = study.model();
    let numbers = model.numbers(numbers).expect("numbers of the study");
    model.at(&numbers).expect("valid values")
}

#[test]
fn a_mechanical_system_is_read_as_written() {
    let study = study(TEXT);
    let system = study.system();
    let Structure::Mechanical(mechanical) = &system.structure else { panic!("mechanical") };
    assert_eq!(mechanical.coordinates(), ["x", "y"]);
    assert_eq!(mechanical.mass().matrix().as_slice(), [1.0, 0.0, 0.0, 2.0]);
    assert_eq!(mechanical.damping().as_slice(), [0.1, 0.2, -0.2, 0.3]);
    assert_eq!(mechanical.force(), [0.0, -0.5]);
    let [pad, rail] = system.contacts.as_slice() else { panic!("two contacts") };
    assert_eq!((pad.name.as_str(), pad.normal_load, pad.normal_stiffness), ("pad", 1.5, 1.25));
    assert_eq!(rail.tangent.as_deref(), Some(&[0.0, -1.0][..]));
    assert_eq!(rail.surface_velocity.mean(), -0.3);
    assert_eq!(system.inputs[0].target, InputTarget::Force(vec![1.0, -1.0]));
    let load = InputTarget::NormalLoad { contact: 1, reaction: false };
    assert_eq!(system.inputs[1].target, load);
    assert_eq!(system.inputs[1].profile.waves()[0].phase, 0.5);
    assert_eq!(study.observe(), [1.0, 0.0]);
    assert_eq!(*study.initial(), SystemStart::Values(vec![0.25, 0.0, 0.0, -1.0]));
    assert_eq!(study.units(), UnitSystem::None);
    assert!(study.warnings().is_empty());
}

#[test]
fn first_order_equations_have_columns_for_friction() {
    let text = "[system]\nstates = ['e', 'x', 'v']\nmatrix = [[0, 1, 0], [0, 0, 1], [-1, -2, -2]]\n\
                force = {v = 0.5}\n[system.initial]\nvalues = {x = -1}\n[contact]\ntangent = {v = 1}\n\
                force = {v = 0.8}\nnormal_load = 1\nbelt_velocity = 0\n[friction]\nlaw = 'coulomb'\ncoefficient = 0.3\n";
    let study = study(text);
    let Structure::StateSpace(states) = &study.system().structure else { panic!("states") };
    assert_eq!((states.names().len(), states.force()[2]), (3, 0.5));
    let contact = &study.system().contacts[0];
    assert_eq!(
        (contact.name.as_str(), contact.force.as_deref()),
        ("contact 1", Some(&[0.0, 0.0, 0.8][..]))
    );
    assert_eq!(*study.initial(), SystemStart::Values(vec![0.0, -1.0, 0.0]));
    assert_eq!(study.number("contact.friction.coefficient"), Some(0.3));
    let wrong = refused(&text.replace("force = {v = 0.8}\n", ""));
    assert_eq!((wrong[0].key.as_str(), wrong[0].fault), ("contact.force", Fault::Missing));
    let wrong = refused(&text.replace("tangent =", "normal = {x = 1}\ntangent ="));
    assert_eq!((wrong[0].key.as_str(), wrong[0].origin.line()), ("contact.normal", Some(8)));
}

#[test]
fn units_and_twins_give_the_numbers_of_the_file() {
    let text = "[system]\nunits = 'mm-t-s'\ncoordinates = ['x']\nmass_kg = [2]\nstiffness = ['1e6 N/m']\n[contact]\n\
                tangent = {x = 1}\nnormal_load = '1.5kN'\nbelt_velocity_m_per_s = 0.25\n[contact.friction]\n\
                law = 'stribeck'\nstatic_coefficient = 0.4\nminimum_coefficient = 0.3\nreference_velocity_m_per_s = 0.5\n\
                [dither]\nat = {x = 1}\nwaveform = 'sine'\namplitude_n_rms = 10\nfrequency_hz = 20\n";
    let study = study(text);
    let system = study.system();
    let mechanical = system.structure.mechanical().expect("mechanical");
    assert_eq!(mechanical.mass().matrix().as_slice(), [0.002]);
    assert_eq!(mechanical.stiffness().as_slice(), [1000.0]);
    let contact = &system.contacts[0];
    assert_eq!((contact.normal_load, contact.surface_velocity.mean()), (1500.0, 250.0));
    assert_eq!(contact.friction.velocity_scale(), 500.0);
    let wave = system.inputs[0].profile.waves()[0].clone();
    assert_eq!(wave.frequency, TAU * 20.0);
    assert!((wave.amplitude / (10.0 * 2f64.sqrt()) - 1.0).abs() < 1e-15);
    assert_eq!(study.units().si_per_unit(Quantity::Velocity), Some(1e-3));
    assert_eq!(study.number("contact.belt_velocity"), Some(250.0));
    assert_eq!(study.number("contact.belt_velocity_m_per_s"), Some(0.25));
    assert_eq!(study.number("dither.frequency_hz"), Some(20.0));
    let faster = system_at(&study, &[("contact.belt_velocity", 100.0)]);
    assert_eq!(faster.contacts[0].surface_velocity.mean(), 100.0);
    let both = refused(&text.replace("frequency_hz = 20", "frequency_hz = 20\nfrequency = 3"));
    assert_eq!((both[0].key.as_str(), both[0].fault), ("dither.frequency_hz", Fault::Conflict));
    let none = refused(&text.replace("'mm-t-s'", "'none'"));
    let keys: Vec<&str> = none.iter().map(|complaint| complaint.key.as_str()).collect();
    for key in ["system.mass_kg", "contact.belt_velocity_m_per_s", "contact.normal_load"] {
        assert!(keys.contains(&key), "{key}: {none}");
    }
}

#[test]
fn parameters_are_used_in_formulas_everywhere() {
    let text = "[parameters]\nmu = 0.5\nkappa = 'k/4'\nk = 2\n[system]\ncoordinates = ['x', 'y']\nmass = [1, 'k/2']\n\
                stiffness = [['k', '1 - kappa*mu'], [1, 2]]\n[contact]\ntangent = {x = 'cos(0)'}\nnormal_load = 1\n\
                belt_velocity = 1\n[contact.friction]\nlaw = 'expression'\ncoefficient = 'mu - a*exp(-abs(v))'\n\
                constants = {a = 'mu/10'}\n";
    let study = study(text);
    let stiffness = study.system().structure.mechanical().expect("mechanical").stiffness().clone();
    assert_eq!(stiffness.as_slice(), [2.0, 0.75, 1.0, 2.0]);
    assert_eq!(study.number("parameters.kappa"), Some(0.5));
    assert!((study.system().contacts[0].friction.static_coefficient() - 0.45).abs() < 1e-15);
    let changed = system_at(&study, &[("parameters.mu", 0.25), ("system.stiffness[1][0]", 3.0)]);
    let stiffness = changed.structure.mechanical().expect("mechanical").stiffness().clone();
    assert_eq!(stiffness.as_slice(), [2.0, 0.875, 3.0, 2.0]);
    let set = study.with("parameters.kappa", 1.0).expect("a formula is replaced");
    assert_eq!(set.number("system.stiffness[0][1]"), Some(0.5));
    for (from, to, key, part) in [
        ("'k/4'", "'kappa + 1'", "parameters.kappa", "kappa → kappa"),
        ("k = 2", "k = 'kappa'", "parameters.kappa", "kappa → k → kappa"),
        ("'k/4'", "'q/4'", "parameters.kappa", "q is unknown"),
        ("mu = 0.5", "exp = 0.5", "parameters.exp", "no function"),
        ("mu = 0.5", "v = 0.5", "parameters.v", "v is the slip velocity"),
        ("'k/2'", "'v/2'", "system.mass[1]", "v is unknown"),
        ("'k/2'", "'k/0'", "system.mass[1]", "inf"),
        ("k = 2", "k = nan", "parameters.k", "finite"),
    ] {
        let wrong = refused(&text.replacen(from, to, 1));
        let found = wrong.iter().find(|complaint| complaint.key == key);
        let found = found.unwrap_or_else(|| panic!("{to}: {wrong}"));
        assert!(found.to_string().contains(part) && found.origin.line().is_some(), "{to}: {wrong}");
    }
}

#[test]
fn wrong_input_is_complained_about_at_its_place() {
    for (from, to, key, part) in [
        (
            "mass = [1.0, 2.0]",
            "mass = [[1.0, 1.0], [1.0, 1.0]]",
            "system.mass[1][1]",
            "positive definite",
        ),
        ("mass = [1.0, 2.0]", "mass = [[1.0, 0.5], [0.4, 1.0]]", "system.mass[1][0]", "symmetric"),
        ("mass = [1.0, 2.0]", "mass = [1.0, 0.0]", "system.mass[1]", "above 0"),
        ("mass = [1.0, 2.0]", "mass = [1.0]", "system.mass", "2 numbers"),
        ("mass = [1.0, 2.0]", "mass = [1.0, nan]", "system.mass[1]", "finite"),
        ("[-0.2, 0.3]", "[-0.2, inf]", "system.damping[1][1]", "finite"),
        ("[-0.2, 0.3]", "[-0.2]", "system.damping[1]", "2 numbers"),
        ("tangent = { x = 1.0 }", "tangent = { x = 0.0 }", "contact[0].tangent", "not 0"),
        ("tangent = { x = 1.0 }", "tangent = {}", "contact[0].tangent", "not 0"),
        ("tangent = { x = 1.0 }", "tangent = { z = 1.0 }", "contact[0].tangent.z", "x, y"),
        ("tangent = [0.0, -1.0]", "tangent = [0.0]", "contact[1].tangent", "one for each"),
        ("normal_load = 1.5", "normal_load = 0", "contact[0].normal_load", "> 0"),
        ("normal_load = 1.5", "normal_load = -3", "contact[0].normal_load", "> 0"),
        ("normal_stiffness = 1.25", "normal_stiffness = -1", "contact[0].normal_stiffness", "≥ 0"),
        (
            "normal_stiffness = 1.25",
            "normal_stifness = 1",
            "contact[0].normal_stifness",
            "normal_stiffness",
        ),
        ("name = \"rail\"", "name = \"pad\"", "contact[1].name", "no other contact"),
        ("coefficient = 0.5", "coefficient = -0.5", "contact[0].friction.coefficient", "≥ 0"),
        (
            "reference_velocity = 0.2",
            "reference_velocity = 0",
            "contact[1].friction.reference_velocity",
            "> 0",
        ),
        ("law = \"stribeck\"", "law = \"stribek\"", "contact[1].friction.law", "stribeck"),
        ("contact = \"rail\"", "contact = \"rial\"", "dither[1].contact", "rail"),
        (
            "contact = \"rail\"",
            "at = { x = 1 }\ncontact = \"rail\"",
            "dither[1].contact",
            "not both",
        ),
        ("amplitude = 0.4", "amplitude = 2.0", "dither[1].amplitude", "prescribed"),
        ("phase = 0.5", "reaction = true", "dither[1].reaction", "prescribed"),
        ("frequency = 10.0", "frequency = 0", "dither[0].frequency", "> 0"),
        (
            "displacements = {",
            "state = \"sliding\"\ndisplacements = {",
            "system.initial.state",
            "give one of",
        ),
        (
            "coordinates = [\"x\", \"y\"]",
            "coordinates = [\"x\", \"x\"]",
            "system.coordinates[1]",
            "no other",
        ),
        ("force = { y = -0.5 }", "states = [\"x\"]", "system.states", "coordinates"),
        ("force = { y = -0.5 }", "observe = { x = 0 }", "system.observe", "not 0"),
        ("[[dither]]", "[belt]\n[[dither]]", "belt", "exclude"),
    ] {
        let wrong = refused(&with(from, to));
        let found = wrong.iter().find(|complaint| complaint.key == key);
        let found = found.unwrap_or_else(|| panic!("{to}: {wrong}"));
        assert!(found.to_string().contains(part), "{to}: {found}");
        assert!(found.origin.line().is_some(), "{to}: {found}");
    }
}

#[test]
fn all_complaints_come_at_once() {
    let text = with("normal_load = 1.5", "normal_load = -1").replace("[1.0, 2.0]", "[1.0, -2.0]");
    let wrong = refused(&text.replace("amplitude = 0.1", "amplitude = -0.1"));
    let keys: Vec<&str> = wrong.iter().map(|complaint| complaint.key.as_str()).collect();
    assert_eq!(keys, ["system.mass[1]", "contact[0].normal_load", "dither[0].amplitude"]);
}

#[test]
fn equal_rows_are_two_pads_on_one_body() {
    study(&with("tangent = [0.0, -1.0]", "tangent = [1.0, 0.0]"));
}

#[test]
fn every_number_has_a_path() {
    let study = study(TEXT);
    for (path, value) in [
        ("system.stiffness[0][1]", 1.0),
        ("system.mass[1]", 2.0),
        ("system.mass[1][1]", 2.0),
        ("system.force.y", -0.5),
        ("system.initial.displacements.x", 0.25),
        ("system.initial.velocities.y", -1.0),
        ("contact.pad.normal_load", 1.5),
        ("contact[0].normal_load", 1.5),
        ("contact.pad.normal_damping", 0.0),
        ("contact.rail.tangent.y", -1.0),
        ("contact.rail.tangent[1]", -1.0),
        ("contact.pad.tangent.x", 1.0),
        ("contact.pad.friction.coefficient", 0.5),
        ("contact[1].friction.reference_velocity", 0.2),
        ("dither[0].amplitude", 0.1),
        ("dither[1].phase", 0.5),
        ("dither[0].at.y", -1.0),
    ] {
        assert_eq!(study.number(path), Some(value), "{path}");
        let changed =
            study.with(path, value * 0.5 + 0.125).unwrap_or_else(|why| panic!("{path}: {why}"));
        let system = system_at(&study, &[(path, value * 0.5 + 0.125)]);
        assert_eq!(changed.system(), &system, "{path}");
        assert_eq!(&system == study.system(), path.contains("initial"), "{path}");
        let text = format!(
            "{TEXT}[[sweep]]\nparameter = \"{path}\"\nfrom = {value}\nto = {}\npoints = 3\n",
            value * 0.5 + 0.125
        );
        assert!(Study::parse(&text, &[]).is_ok(), "{path}");
    }
    for (path, nearest) in [
        ("contact.pad.normal_laod", Some("contact.pad.normal_load")),
        ("contact.pda.normal_load", Some("contact.pad.normal_load")),
        ("contact.normal_load", None),
        ("dither.amplitude", None),
        ("dither[2].amplitude", None),
        ("system.stifness[0][1]", Some("system.stiffness[0][1]")),
        ("system.stiffness[0][5]", None),
        ("normal_load", Some("contact.normal_load")),
        ("contact.pad.friction.coeficient", Some("contact.pad.friction.coefficient")),
        ("contact.rail.tangent.z", None),
    ] {
        assert_eq!(study.number(path), None, "{path}");
        let wrong = study.with(path, 1.0).expect_err(path);
        assert_eq!(wrong[0].suggestion.as_deref(), nearest, "{path}: {wrong}");
        assert_eq!(wrong[0].key, path);
    }
}

#[test]
fn changes_and_axes_reach_words_and_units() {
    let set = |text: &str, change: &str| {
        let change = Change::parse(change, "--set").expect("a change");
        Study::parse(text, &[change]).map(|study| study.system())
    };
    let started = set(TEXT, "system.initial.state=sliding").expect("valid");
    assert_eq!(*started.initial(), SystemStart::Sliding);
    let other = set(TEXT, "contact.pad.friction.coefficient=2*0.15").expect("valid");
    assert_eq!(other.number("contact.pad.friction.coefficient"), Some(0.3));
    let single = "[system]\ncoordinates = ['x']\nmass = [1]\nstiffness = [1]\n[contact]\nname = 'guide'\n\
                  tangent = {x = 1}\nnormal_load = 1\nbelt_velocity = 1\n[friction]\nlaw = 'coulomb'\ncoefficient = 0.3\n";
    let wrong = set(single, "contact.gide.normal_load=3").expect_err("another name");
    assert_eq!(wrong[0].suggestion.as_deref(), Some("contact.guide.normal_load"));
    let wrong = set(TEXT, "contact.pad=1").expect_err("a table");
    assert!(wrong[0].allowed.contains("is a table"), "{wrong}");
    let text = TEXT.replace("coordinates =", "units = \"SI\"\ncoordinates =")
        + "[[sweep]]\nparameter = \"dither[0].frequency_hz\"\nfrom = \"1kHz\"\nto = 2000\npoints = 2\n";
    let study = study(&text);
    assert_eq!(study.sweeps()[0].axis.value(0), 1000.0);
    assert_eq!(study.sweeps()[0].target.unit, "Hz");
    let same = text
        + "[[sweep]]\nparameter = \"dither[0].amplitude\"\nvalues = [1]\n[[sweep]]\nparameter = \
                       \"dither[0].amplitude\"\nvalues = [2]\n";
    assert!(refused(&same).to_string().contains("already varies"));
}

#[test]
fn negative_friction_is_a_surface_that_moves_the_other_way() {
    let text = "[system]\ncoordinates = ['x']\nmass = [1]\nstiffness = [1]\n[contact]\nnormal = {x = 1}\nslope = {x = 2}\n\
                normal_load = 1\nnormal_stiffness = 1\nbelt_velocity = 1.5\n[friction]\nlaw = 'coulomb'\ncoefficient = -0.4\n";
    let study = study(text);
    let contact = &study.system().contacts[0];
    assert_eq!(contact.surface_velocity.mean(), -1.5);
    assert_eq!(contact.friction.static_coefficient(), 0.4);
    assert_eq!(study.number("friction.coefficient"), Some(-0.4));
}

#[test]
fn unlikely_units_cause_a_warning() {
    let text = "[system]\nunits = 'SI'\ncoordinates = ['x']\nmass = [3e-4]\nstiffness = [1e5]\n[contact]\n\
                tangent = {x = 1}\nnormal_load = 5e3\nbelt_velocity = 1e3\n[friction]\nlaw = 'coulomb'\ncoefficient = 0.3\n";
    assert_eq!(study(text).warnings().len(), 2, "{:?}", study(text).warnings());
    assert!(study(&text.replace("'SI'", "'none'")).warnings().is_empty());
    assert!(study(&text.replace("'SI'", "'mm-t-s'")).warnings().is_empty());
}

#[test]
fn other_kinds_refuse_the_tables_of_a_system() {
    let belt = "[belt]\ndamping_ratio = 0.01\nnormal_load = 1\nbelt_velocity = 0.1\n[friction]\nlaw = 'coulomb'\ncoefficient = 0.3\n";
    let wrong = refused(&format!("{belt}[[contact]]\nnormal_load = 1\n"));
    assert_eq!((wrong[0].key.as_str(), wrong[0].fault), ("contact", Fault::Conflict));
    let both =
        refused(&format!("{belt}[system]\ncoordinates = ['x']\nmass = [1]\nstiffness = [1]\n"));
    assert_eq!((both[0].key.as_str(), both[0].fault), ("belt", Fault::Conflict));
    assert!(Study::parse(belt, &[]).expect("a belt").disc().is_err());
}

/// Terminals obey control characters, and no XML contains them: every text and key of a study is without.
#[test]
fn control_characters_are_refused() {
    for (from, to, key) in [
        ("\"two coordinates\"", "\"two \\u001b[31mcoordinates\"", "title"),
        ("\"two coordinates\"", "\"two \\u009bcoordinates\"", "title"),
        ("\"two coordinates\"", "\"two \\uffffcoordinates\"", "title"),
        ("name = \"pad\"", "name = \"pad\\u0007\"", "contact[0].name"),
        ("waveform = \"sine\"", "waveform = \"sine\\u0000\"", "dither[0].waveform"),
    ] {
        let complaints = refused(&with(from, to));
        let own = complaints.iter().find(|own| own.key == key && own.allowed.contains("control"));
        let own = own.unwrap_or_else(|| panic!("{to}: {complaints}"));
        assert!(own.origin.line().is_some(), "{own}");
    }
    // A key that no table has is named with its characters escaped.
    let complaints =
        refused(&with("normal_load = 1.5", "normal_load = 1.5\n\"\\u001b[2J\" = 1")).to_string();
    assert!(complaints.contains("\\u{1b}[2J"), "{complaints}");
    assert!(!complaints.contains(|c: char| c.is_control() && c != '\n'), "{complaints:?}");
    let change = Change::parse("title=\"a\\u001bb\"", "--set").expect("a change");
    assert!(Study::parse(TEXT, &[change]).is_err());
}

/// A contact without a tangent may have a negative coefficient, whose meaning every verb says.
#[test]
fn a_negative_coefficient_is_said() {
    let text = "[system]\ncoordinates = [\"z\"]\nmass = [1]\nstiffness = [[2]]\n[[contact]]\nname = \"load\"\n\
                normal = { z = 1 }\nslope = { z = 0.5 }\nnormal_load = 1\nnormal_stiffness = 1\nbelt_velocity = 1.5\n\
                [contact.friction]\nlaw = \"coulomb\"\ncoefficient = -0.4\n";
    let said = study(text);
    let [warning] = said.warnings() else { panic!("{:?}", said.warnings()) };
    assert!(warning.contains("contact load is negative"), "{warning}");
    assert!(study(&text.replace("-0.4", "0.4")).warnings().is_empty());
}

/// A dither with `direction = "friction"` is a factor on the friction of its contact: a share with a mean, and no force.
#[test]
fn a_factor_on_friction_is_a_share() {
    let text = "[system]\nunits = 'SI'\ncoordinates = ['x']\nmass = [1]\nstiffness = [1]\n[[contact]]\nname = 'pad'\n\
                tangent = {x = 1}\nnormal_load = 1\nbelt_velocity = 1\n[friction]\nlaw = 'coulomb'\ncoefficient = 0.3\n\
                [[dither]]\ncontact = 'pad'\ndirection = 'friction'\nwaveform = 'sine'\namplitude = 1.5\nfrequency_hz = 5\n";
    let read = |text: &str| SystemStudy::parse(text, &[]);
    let study = read(text).expect("valid: the factor may change its sign");
    let input = &study.system().inputs[0];
    assert_eq!(input.target, InputTarget::Friction { contact: 0 });
    assert_eq!((input.profile.mean(), input.profile.waves()[0].amplitude), (1.0, 1.5));
    assert_eq!(study.unit_of("dither.amplitude"), Some("1"));
    let other = study.with("dither.amplitude", 0.5).expect("valid");
    assert_eq!(other.system().inputs[0].profile.waves()[0].amplitude, 0.5);
    let mean = read(&format!("{text}mean = 0\n")).expect("valid");
    assert_eq!(mean.system().inputs[0].profile.mean(), 0.0);
    let second = "[[dither]]\ncontact = 'pad'\ndirection = 'friction'\nwaveform = 'sine'\namplitude = 1\nfrequency_hz = 9\n";
    assert!(read(&format!("{text}{second}mean = 0\n")).is_ok());
    for (wrong, key) in [
        (format!("{text}{second}"), "dither[1].mean"),
        (format!("{text}reaction = true\n"), "dither.reaction"),
        (text.replace("amplitude =", "amplitude_n ="), "dither.amplitude_n"),
        (text.replace("amplitude =", "amplitude_rms ="), "dither.amplitude_rms"),
        (
            format!("{}mean = 1\n", text.replace("'friction'\nwave", "'normal'\nwave")),
            "dither.mean",
        ),
    ] {
        let complaints = read(&wrong).expect_err(key);
        assert!(complaints.iter().any(|complaint| complaint.key == key), "{key}: {complaints}");
    }
}

/// Friction as a force has a path, as in the study of a belt; a law that no contact uses is refused.
#[test]
fn friction_as_a_force_has_a_path() {
    let text = TEXT.replace("[system]\n", "[system]\nunits = \"SI\"\n");
    let path = "contact.rail.friction.static_coefficient_n";
    let forces = text
        .replace("static_coefficient = 0.4", "static_coefficient_n = 0.8")
        .replace("minimum_coefficient = 0.3", "minimum_coefficient_n = 0.6");
    let (coefficients, forces) = (study(&text), study(&forces));
    assert_eq!(forces.system(), coefficients.system());
    assert_eq!((forces.number(path), forces.unit_of(path)), (Some(0.8), Some("N")));
    let changed = forces.with(path, 1.2).expect(path);
    let wanted =
        coefficients.with("contact.rail.friction.static_coefficient", 0.6).expect("a coefficient");
    assert_eq!(changed.system(), wanted.system());
    // A coefficient and its force are one number, which two axes cannot both vary.
    let rail = "contact.rail.friction.static_coefficient";
    let number = |path: &str| coefficients.address(path).map(|address| address.number);
    assert_eq!(number(path), number(rail));
    let unused = format!("{TEXT}[friction]\nlaw = \"coulomb\"\ncoefficient = 0.3\n");
    let complaints = Study::parse(&unused, &[]).expect_err("a law for no contact");
    assert_eq!((complaints[0].fault, complaints[0].key.as_str()), (Fault::Conflict, "friction"));
}

/// An entry that a list does not have is refused: no value is dropped in silence.
#[test]
fn entries_are_counted() {
    let system = study(TEXT);
    for (path, allowed) in [
        ("contact.rail.tangent[7]", "2 entries"),
        ("system.initial.velocities[2]", "2 entries"),
        ("contact.pad.friction.coefficient[0]", "no list"),
        ("system.mass[2]", "2 rows"),
    ] {
        let wrong = system.with(path, 0.25).expect_err(path);
        assert!(wrong[0].allowed.contains(allowed), "{path}: {wrong}");
    }
    let samples = TEXT.replace(
        "law = \"coulomb\"\ncoefficient = 0.5",
        "law = \"samples\"\nslip_velocity = [0.0, 0.1, 0.2, 0.4, 0.8, 1.0]\ncoefficient = [0.5, 0.45, 0.42, 0.4, 0.39, 0.39]",
    );
    let samples = study(&samples);
    assert_eq!(samples.number("contact.pad.friction.coefficient[2]"), Some(0.42));
    assert!(samples.with("contact.pad.friction.coefficient[2]", 0.43).is_ok());
    assert!(samples.with("contact.pad.friction.coefficient[6]", 0.4).is_err());
}
