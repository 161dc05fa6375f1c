//! Studies with a user-defined friction law: keys, units, complaints, files, axes of maps.

use std::path::Path;

use quell::study::Change;
use quell::{BeltStudy, Complaints};
use quell_model::Friction;

const BELT: &str =
    "schema = 1\n[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = 0.1\n";

fn study(friction: &str) -> Result<BeltStudy, Complaints> {
    BeltStudy::parse(&format!("{BELT}[friction]\n{friction}"), &[])
}

fn complaints(friction: &str) -> Vec<(String, Option<usize>, String)> {
    let wrong = study(friction).expect_err(friction);
    wrong
        .into_iter()
        .map(|complaint| (complaint.key, complaint.origin.line(), complaint.allowed.into()))
        .collect()
}

#[test]
fn a_formula_with_constants_is_read_and_set() {
    let text = "law = \"expression\"\ncoefficient = \"a + 0.1*exp(-abs(v)/0.2)\"\n[friction.constants]\na = 0.3\n";
    let read = study(text).expect("valid");
    assert_eq!(read.belt().friction().static_coefficient(), 0.4);
    assert_eq!(read.number("friction.constants.a"), Some(0.3));
    let changed = read.with("friction.constants.a", 0.25).expect("valid");
    assert_eq!(changed.belt().friction().coefficient(0.0), 0.35);
    let sets =
        ["friction.constants.a=0.2", "friction.coefficient=a", "friction.static_coefficient=0.5"];
    let sets = sets.map(|text| Change::parse(text, "--set").expect("a change"));
    let whole = format!("{BELT}[friction]\n{text}");
    let set = BeltStudy::parse(&whole, &sets).expect("valid");
    let law = set.belt().friction();
    assert_eq!((law.coefficient(3.0), law.static_coefficient()), (0.2, 0.5));
    let swept = format!(
        "{whole}\n[[sweep]]\nparameter = \"friction.constants.a\"\nfrom = 0.2\nto = 0.4\npoints = 3\n"
    );
    let swept = BeltStudy::parse(&swept, &[]).expect("valid");
    let point = swept.at([("friction.constants.a", 0.2)]).expect("valid");
    assert_eq!(point.belt().friction().coefficient(0.0), 0.2 + 0.1);
    let both = format!(
        "{whole}b = 1.0\n[[sweep]]\nparameter = \"friction.constants.a\"\nvalues = [0.2, 0.3]\n\
         [[sweep]]\nparameter = \"friction.constants.b\"\nvalues = [0.2, 0.3]\n"
    );
    let both = BeltStudy::parse(&both, &[]).expect("two constants are two axes");
    assert_eq!(quell::sweep::Grid::of(&both).expect("a grid").len(), 4);
    let wrong = swept.with("friction.constants.b", 0.2);
    assert!(wrong.is_ok(), "another constant may be given, a formula need not use it");
}

#[test]
fn complaints_name_the_key_and_the_line() {
    // [belt] has lines 2 to 5, [friction] is line 6.
    for (text, key, line, part) in [
        ("law = \"expression\"\n", "friction.coefficient", 6, "formula"),
        (
            "law = \"expression\"\ncoefficient = \"0.3 + \"\n",
            "friction.coefficient",
            8,
            "character 7",
        ),
        ("law = \"expression\"\ncoefficient = [1]\n", "friction.coefficient", 8, "array"),
        (
            "law = \"expression\"\ncoefficient = \"a\"\n[friction.constants]\na = \"x\"\n",
            "friction.constants.a",
            10,
            "number",
        ),
        (
            "law = \"expression\"\ncoefficient = \"0.3\"\n[friction.constants]\nexp = 1\n",
            "friction.constants.exp",
            10,
            "name",
        ),
        (
            "law = \"expression\"\ncoefficient = \"0.3\"\nstatic_coefficient = 0.2\n",
            "friction.static_coefficient",
            9,
            "at least",
        ),
        (
            "law = \"expression\"\ncoefficient = \"0.3\"\nterms = 2\n",
            "friction.terms",
            9,
            "coefficient",
        ),
        (
            "law = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.3\nreference_velocity = 0.2\ncoefficient = \"0.3\"\n",
            "friction.coefficient",
            11,
            "static_coefficient",
        ),
        (
            "law = \"samples\"\nslip_velocity = [0, 1]\ncoefficient = [0.3]\n",
            "friction.coefficient",
            9,
            "2",
        ),
        (
            "law = \"samples\"\nslip_velocity = [0, 1]\ncoefficient = [0.3, 0.2]\n",
            "friction.slip_velocity",
            8,
            "5 distinct",
        ),
        (
            "law = \"samples\"\nslip_velocity = [0, -1]\ncoefficient = [0.3, 0.2]\n",
            "friction.slip_velocity[1]",
            8,
            "≥ 0",
        ),
        ("law = \"samples\"\nfile = \"nowhere.csv\"\n", "friction.file", 8, "cannot be read"),
        (
            "law = \"samples\"\nfile = \"nowhere.csv\"\ncoefficient = [0.3]\n",
            "friction.coefficient",
            9,
            "already",
        ),
        (
            "law = \"samples\"\nslip_velocity_m_per_s = [0]\n",
            "friction.slip_velocity_m_per_s",
            8,
            "units",
        ),
        (
            "law = \"samples\"\nterms = 7\nslip_velocity = [0,1,2,3,4]\ncoefficient = [1,1,1,1,1]\n",
            "friction.terms",
            8,
            "4",
        ),
    ] {
        let complaints = complaints(text);
        let found = complaints
            .iter()
            .any(|(at, on, why)| at == key && *on == Some(line) && why.contains(part));
        assert!(found, "{text}: {complaints:?}");
    }
}

/// The files of `studies/`, with and without SI.
#[test]
fn the_studies_of_own_laws_are_valid() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies");
    let own = BeltStudy::read(&folder.join("own-friction-law.toml"), &[]).expect("valid");
    assert!((own.belt().friction().coefficient(0.0) - 0.4).abs() < 1e-15);
    let measured = BeltStudy::read(&folder.join("measured-friction-law.toml"), &[]).expect("valid");
    let Friction::Samples(law) = measured.belt().friction() else { panic!("another law") };
    assert_eq!(law.fit().samples, 48);
    assert!(law.fit().rms_error < 0.003, "{:?}", law.fit());
    // One metre per second is 1/ω₀ of the equations, ω₀ = 100/s.
    let at_a_tenth = measured.belt().friction().coefficient(0.1 / 100.0);
    assert!(
        (at_a_tenth - (0.26 + 0.12 * (-0.1f64 / 0.08).exp() + 0.005)).abs() < 0.004,
        "{at_a_tenth}"
    );
    // A map point is the same study, although the file is not read again.
    let again = measured.at([("friction.static_coefficient", 0.42)]).expect("valid");
    assert_eq!(again.belt(), measured.belt());
    assert_eq!(
        measured.settings().iter().filter(|(path, _)| path == "friction.file.contents").count(),
        1,
        "what decides a map is in its settings"
    );
    let object = quell::verbs::verbs(&quell::Study::from(&measured)).check().expect("valid").json();
    assert!(
        object["contacts"][0]["friction"]["fit"]["rms_error"]
            .as_f64()
            .is_some_and(|error| error > 0.0),
        "{object}"
    );
}
