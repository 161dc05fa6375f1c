//! Systems against numbers computed by independent programs, and by two methods of our own.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use quell::run::system::tracked::TrackRequest;
use quell::verbs::verbs;
use quell::{Change, Study};
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

fn reference() -> Json {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../reference/systems.json");
    serde_json::from_str(&fs::read_to_string(path).expect("a file")).expect("JSON")
}

fn study(text: &str) -> Study {
    Study::parse(text, &[]).unwrap_or_else(|errors| panic!("{errors}"))
}

fn stability(text: &str) -> Json {
    verbs(&study(text)).stability().expect("an answer").json()
}

fn tracked(text: &str, parameter: &str, window: RealInterval) -> Json {
    let request = TrackRequest { parameter: parameter.to_owned(), window, along: None };
    verbs(&study(text)).tracked_stability(&request).expect("an answer").json()
}

fn number(value: &Json) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn close(name: &str, value: &Json, wanted: &Json, tolerance: f64) {
    let (value, wanted) = (number(value), number(wanted));
    let error = (value - wanted).abs();
    assert!(error <= tolerance * wanted.abs().max(1.0), "{name}: {value} {wanted} {error:e}");
}

fn list(value: &Json) -> &[Json] {
    value.as_array().map_or(&[], Vec::as_slice)
}

/// Every eigenvalue of the reference is among those found.
fn same_eigenvalues(name: &str, found: &Json, wanted: &Json, tolerance: f64) {
    assert_eq!(list(found).len(), list(wanted).len(), "{name}");
    for value in list(wanted) {
        let distance = |other: &Json| {
            (number(&value[0]) - number(&other[0])).hypot(number(&value[1]) - number(&other[1]))
        };
        let nearest = list(found).iter().map(distance).fold(f64::INFINITY, f64::min);
        assert!(nearest <= tolerance, "{name}: {value} is missing by {nearest:e}");
    }
}

/// Eigenvalues and contacts without dither (1e-12) and averaged (growth 1e-9, contacts 1e-10).
#[test]
fn eigenvalues_and_contacts_are_those_of_the_reference() {
    let reference = reference();
    for (part, tolerance) in [("stability", 1e-12), ("averaged", 1e-9)] {
        for case in list(&reference[part]) {
            let name = case["name"].as_str().expect("a name");
            let found = stability(case["study"].as_str().expect("a study"));
            close(name, &found["growth_rate"], &case["growth_rate"], tolerance);
            close(name, &found["frequency"], &case["frequency"], tolerance);
            same_eigenvalues(name, &found["eigenvalues"], &case["eigenvalues"], tolerance);
            for (contact, wanted) in list(&found["contacts"]).iter().zip(list(&case["contacts"])) {
                for (key, wanted) in wanted.as_object().expect("an object") {
                    match wanted {
                        Json::Number(_) => close(name, &contact[key], wanted, 1e-10),
                        _ => assert_eq!(&contact[key], wanted, "{name}: {key}"),
                    }
                }
            }
            if part == "averaged" {
                let undithered = &case["undithered"]["growth_rate"];
                close(name, &found["undithered"]["growth_rate"], undithered, 1e-12);
            }
            let error = number(&found["growth_rate_error"]);
            let difference = number(&found["growth_rate"]) - number(&case["growth_rate"]);
            assert!(part == "averaged" || difference.abs() <= error, "{name}: beyond its bound");
            if number(&case["growth_rate"]) == 0.0 {
                assert_eq!(found["verdict"], "undecided", "{name}");
            }
        }
    }
}

/// A disc written as a system has the growth of its own kind.
#[test]
fn discs_as_systems_have_their_own_growth() {
    for case in list(&reference()["disc"]) {
        let name = case["name"].as_str().expect("a name");
        let found = stability(case["study"].as_str().expect("a study"));
        close(name, &found["growth_rate"], &case["growth_rate"], 1e-12);
        close(name, &found["frequency"], &case["frequency"], 1e-12);
    }
}

/// Thresholds by following eigenvalues and as critical amplitudes (1e-9 relative).
#[test]
fn thresholds_are_those_of_the_reference() {
    let reference = reference();
    let cases = list(&reference["stability_thresholds"]).iter();
    for case in cases.chain(list(&reference["averaged_thresholds"])) {
        let name = case["name"].as_str().expect("a name");
        let text = case["study"].as_str().expect("a study");
        let found = if case.get("from").is_some() {
            let parameter = case["parameter"].as_str().expect("a path");
            let window = RealInterval::new(number(&case["from"]), number(&case["to"]));
            tracked(text, parameter, window)["thresholds"].clone()
        } else {
            stability(text)["critical_amplitudes"].clone()
        };
        let value = |found: &Json| {
            let key = if found.get("value").is_some() { "value" } else { "amplitude" };
            number(&found[key])
        };
        let wanted = number(&case["value"]);
        let right = list(&found).iter().filter(|found| found["becomes"] == case["becomes"]);
        let nearest =
            right.map(|found| (value(found) - wanted).abs()).fold(f64::INFINITY, f64::min);
        assert!(nearest <= 1e-9 * wanted.abs(), "{name}: {nearest:e} of {found}");
    }
}

const MODE_COUPLING: &str = "[system]\ncoordinates = [\"x\", \"y\"]\nmass = [1, 1]\n\
    stiffness = [[2, 1], [1, \"2/3\"]]\n[[contact]]\nname = \"pad\"\ntangent = { x = 1 }\nnormal = { y = 1 }\n\
    normal_load = 1\nnormal_stiffness = \"4/3\"\nbelt_velocity = 1\n[contact.friction]\nlaw = \"coulomb\"\n\
    coefficient = 0.5\n";

/// Hoffmann et al. 2002: without damping two frequencies merge at μ = 3/4, where growth begins; with equal damping c it
/// begins at ¾(1 + 2c²).
#[test]
fn frequencies_merge_at_three_quarters() {
    let path = "contact.pad.friction.coefficient";
    let found = tracked(MODE_COUPLING, path, RealInterval::new(0.5, 1.0))["thresholds"].clone();
    assert_eq!(list(&found).len(), 1, "{found}");
    assert_eq!(
        (&found[0]["kind"], &found[0]["becomes"]),
        (&"coalescence".into(), &"unstable".into())
    );
    close("coalescence", &found[0]["value"], &0.75.into(), 1e-13);
    close("frequency", &found[0]["frequency"], &2f64.sqrt().into(), 1e-7);
    for damping in [0.02, 0.1] {
        let text = format!("{MODE_COUPLING}[parameters]\nc = {damping}\n")
            .replace("stiffness = [[", "damping = [[\"c\", 0], [0, \"c\"]]\nstiffness = [[");
        let found = tracked(&text, path, RealInterval::new(0.5, 1.0))["thresholds"].clone();
        let hopf = list(&found).iter().find(|found| found["kind"] == "hopf").expect("a Hopf point");
        close("Hopf", &hopf["value"], &(0.75 * (1.0 + 2.0 * damping * damping)).into(), 1e-12);
    }
}

/// Two weakly coupled frequencies cross between two of the values at which eigenvalues are computed first.
#[test]
fn a_narrow_range_of_instability_is_found_in_a_wide_window() {
    for (coupling, wanted) in [(1e-3, None), (1e-4, Some([3.29886863, 3.30113136])), (1e-5, None)] {
        let text = format!(
            "[system]\ncoordinates = [\"x\", \"y\"]\nmass = [1, 1]\ndamping = [[1e-6, 0], [0, 1e-6]]\n\
             stiffness = [[\"k\", {coupling}], [{coupling}, 0]]\n[parameters]\nk = 3\n[[contact]]\nname = \"pad\"\n\
             tangent = {{ x = 1 }}\nnormal = {{ y = 1 }}\nnormal_load = 1\nnormal_stiffness = 3.3\nbelt_velocity = 1\n\
             [contact.friction]\nlaw = \"coulomb\"\ncoefficient = 0.001\n"
        );
        let wide = tracked(&text, "parameters.k", RealInterval::new(0.5, 50.0));
        let narrow = tracked(&text, "parameters.k", RealInterval::new(3.29, 3.31));
        let of = |found: &Json| -> Vec<f64> {
            let changes = list(&found["thresholds"]).iter();
            let changes = changes.filter(|found| found["was"] != found["becomes"]);
            changes.map(|found| number(&found["value"])).collect()
        };
        let (wide, narrow) = (of(&wide), of(&narrow));
        assert_eq!((wide.len(), narrow.len()), (2, 2), "{coupling} {wide:?} {narrow:?}");
        for (a, b) in wide.iter().zip(wanted.unwrap_or([narrow[0], narrow[1]])) {
            assert!((a - b).abs() < 1e-8, "{coupling} {a} {b}");
        }
    }
}

/// The shares of the growth rate for which friction works explain it where nothing else does: undamped, with symmetric
/// matrices.
#[test]
fn friction_does_all_the_work_of_an_undamped_structure() {
    let text = MODE_COUPLING.replace("coefficient = 0.5", "coefficient = 0.9");
    let found = stability(&text);
    for motion in list(&found["motions"]) {
        let shares = list(&motion["friction_work"]).iter();
        let sum: f64 = shares.map(|share| number(&share["growth_rate"])).sum();
        close("work", &sum.into(), &motion["growth_rate"], 1e-13);
    }
}

const DISC: &str = "[system]\ncoordinates = [\"a\", \"b\"]\nmass = [1, 1]\ndamping = [[0.01, -0.6], [0.6, 0.01]]\n\
    stiffness = [[3.9, 0], [0, 3.9]]\n[[contact]]\nname = \"load\"\nnormal = { a = 0.9 }\nslope = { b = 1.8 }\n\
    normal_load = 1\nnormal_stiffness = 0.3\nnormal_damping = 0.1\nbelt_velocity = 1\n[contact.friction]\nlaw = \"coulomb\"\n\
    coefficient = 0.4\n[[dither]]\ncontact = \"load\"\ndirection = \"normal\"\nreaction = false\nwaveform = \"sine\"\n\
    amplitude = 0.5\nfrequency = 2.7\n";

/// The exact exponents tend to the eigenvalues for a dither that vanishes, and a follower load with dither has the exponents
/// of the splitting method that discs use.
#[test]
fn exact_exponents_have_the_right_limits() {
    let exact = |text: &str, amplitude: f64| {
        let changes =
            [Change::number("dither.amplitude", amplitude, quell::Origin::Argument("--set"))];
        let study = Study::parse(text, &changes).unwrap_or_else(|errors| panic!("{errors}"));
        verbs(&study).exact_stability().expect("pure slip").json()
    };
    let linear = stability(&DISC.replace("amplitude = 0.5", "amplitude = 0"));
    let weak = exact(DISC, 1e-7);
    close("weak dither", &weak["growth_rate"], &linear["growth_rate"], 1e-12);
    let strong = exact(DISC, 0.5);
    let study = study(DISC).system();
    let linear = quell_linear::linearised::Linearised::new(study.system()).expect("slides");
    let mut split = study.system().clone();
    // The same modulation as a factor on the friction force, which here does not depend on the load otherwise.
    for input in &mut split.inputs {
        input.target = quell_model::system::InputTarget::Friction { contact: 0 };
        let wave = input.profile.waves()[0].clone();
        input.profile = quell_model::profile::Profile::constant(1.0).with(wave);
    }
    let dithered =
        quell_linear::floquet::FollowerDither::new(&split, &linear, 2.7).expect("follower");
    let growth = dithered.growth(1.0, quell_numerics::floquet::Effort::default()).expect("finite");
    close("two methods", &strong["growth_rate"], &growth.rate.into(), 1e-9);
}

/// Contacts that reverse or open under dither are named instead of answered.
#[test]
fn what_is_not_pure_slip_is_refused() {
    let text = format!(
        "{MODE_COUPLING}[[dither]]\nat = {{ x = 1 }}\nwaveform = \"sine\"\namplitude = 60\nfrequency = 50\n"
    );
    let why = verbs(&study(&text)).exact_stability().map(|_| ()).expect_err("reverses").to_string();
    assert!(why.contains("pad") && why.contains("pure slip"), "{why}");
}

/// A belt as a system: for ζ → 0 its averages are those of the belt's own finite-R averaging, for every waveform.
#[test]
fn belts_as_systems_have_their_own_averages() {
    let law = "law = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n";
    for waveform in ["sine", "triangle", "square"] {
        for (ratio, amplitude) in [(5.0, 0.1), (5.0, 0.4), (20.0, 1.6)] {
            let belt = stability(&format!(
                "[belt]\ndamping_ratio = 1e-12\nnormal_load = 1\nbelt_velocity = 0.05\n[friction]\n{law}\
                 [dither]\ndirection = \"tangential\"\nwaveform = \"{waveform}\"\namplitude = {amplitude}\nfrequency_ratio = {ratio}\n"
            ));
            let system = stability(&format!(
                "[system]\ncoordinates = [\"x\"]\nmass = [1]\ndamping = [2e-12]\nstiffness = [1]\n[[contact]]\n\
                 tangent = {{ x = 1 }}\nnormal_load = 1\nbelt_velocity = 0.05\n[contact.friction]\n{law}\
                 [[dither]]\nat = {{ x = 1 }}\nwaveform = \"{waveform}\"\namplitude = {amplitude}\nfrequency = {ratio}\n"
            ));
            let own = &belt;
            close(waveform, &system["growth_rate"], &own["growth_rate"], 1e-11);
            let (first, wanted) =
                (&system["critical_amplitudes"][0], &own["critical_amplitudes"][0]);
            close(waveform, &first["amplitude"], &wanted["amplitude"], 1e-12);
            assert_eq!(first["kind"], wanted["kind"]);
        }
    }
}

/// A measured response computed from matrices gives their verdict and their contacts.
#[test]
fn measured_responses_decide_as_their_matrices() {
    let folder = tempfile::tempdir().expect("a folder");
    let contact = "[[contact]]\nname = \"pad\"\ntangent = { x = 1 }\nnormal = { y = 1 }\nnormal_load = 1\n\
        normal_stiffness = 1.3333333333333333\nnormal_damping = 0.01\nbelt_velocity = 0.2\n[contact.friction]\nlaw = \"coulomb\"\n\
        coefficient = COEFFICIENT\n";
    let dither =
        "[[dither]]\nat = { x = 1 }\nwaveform = \"sine\"\namplitude = AMPLITUDE\nfrequency = 8\n";
    let matrices = "[system]\ncoordinates = [\"x\", \"y\"]\nmass = [1, 1]\ndamping = [0.02, 0.02]\n\
        stiffness = [[2, 1], [1, 0.6666666666666667]]\n";
    // H = (K − ω² + 0.02iω)⁻¹ of two rows.
    let mut rows = String::from("frequency,output,input,re,im\n");
    for k in 0..=6_500 {
        let frequency =
            if k < 5_000 { 6e-4 * f64::from(k) } else { 3.0 + 0.1 * f64::from(k - 5_000) };
        let damper = num_complex::Complex64::new(0.0, 0.02 * frequency);
        let [a, d] = [2.0, 0.666_666_666_666_666_7].map(|k| damper + (k - frequency * frequency));
        let determinant = a * d - 1.0;
        for (out, into, value) in
            [("x", "x", d), ("y", "y", a), ("x", "y", (-1.0).into()), ("y", "x", (-1.0).into())]
        {
            let value = value / determinant;
            let _ = writeln!(rows, "{frequency:?},{out},{into},{:?},{:?}", value.re, value.im);
        }
    }
    fs::write(folder.path().join("frf.csv"), rows).expect("written");
    for (coefficient, amplitude) in [("0.6", "0.5"), ("0.8", "0.5"), ("0.8", "2.0")] {
        let ending = format!("{contact}{dither}")
            .replace("COEFFICIENT", coefficient)
            .replace("AMPLITUDE", amplitude);
        let computed = stability(&format!("{matrices}{ending}"));
        let text = format!("[system]\nfrequency_response = \"frf.csv\"\n{ending}");
        let measured =
            Study::parse_in(&text, &[], folder.path()).unwrap_or_else(|errors| panic!("{errors}"));
        let found = verbs(&measured).stability().expect("a verdict").json();
        assert_eq!(found["verdict"], computed["verdict"], "μ = {coefficient}, A = {amplitude}");
        assert!(found["growth_rate"].is_null() && found["why"]["growth_rate"].is_string());
        for key in ["friction", "normal", "slip_amplitude"] {
            close(key, &found["contacts"][0][key], &computed["contacts"][0][key], 1e-5);
        }
        let [critical, wanted] =
            [&found, &computed].map(|of| of["critical_amplitudes"][0]["amplitude"].clone());
        if wanted.is_number() {
            assert!(critical.is_number(), "{found:#}");
            close("critical amplitude", &critical, &wanted, 1e-8);
        }
        for verb in [verbs(&measured).modes(), verbs(&measured).reach(None)] {
            assert!(
                verb.map(|_| ())
                    .expect_err("needs matrices")
                    .to_string()
                    .contains("frequency response")
            );
        }
    }
}

/// A critical amplitude by a response that was measured at few frequencies states how far interpolation may be off, and keeps that.
#[test]
fn measured_responses_state_their_interpolation() {
    let folder = tempfile::tempdir().expect("a folder");
    let ending = "[[contact]]\nname = \"pad\"\ntangent = { x = 1 }\nnormal = { y = 1 }\nnormal_load = 1\n\
        normal_stiffness = 1.3333333333333333\nnormal_damping = 0.01\nbelt_velocity = 0.2\n[contact.friction]\nlaw = \"coulomb\"\n\
        coefficient = 0.8\n[[dither]]\nat = { x = 1 }\nwaveform = \"sine\"\namplitude = 0.5\nfrequency = 8.03\n";
    let matrices = "[system]\ncoordinates = [\"x\", \"y\"]\nmass = [1, 1]\ndamping = [0.02, 0.02]\n\
        stiffness = [[2, 1], [1, 0.6666666666666667]]\n";
    let wanted =
        number(&stability(&format!("{matrices}{ending}"))["critical_amplitudes"][0]["amplitude"]);
    for points in [3_000_u32, 1_200, 600] {
        let step = 12.0 / f64::from(points);
        let mut rows = String::from("frequency,output,input,re,im\n");
        for k in 0..=points {
            let frequency = step * f64::from(k);
            let damper = num_complex::Complex64::new(0.0, 0.02 * frequency);
            let [a, d] =
                [2.0, 0.666_666_666_666_666_7].map(|k| damper + (k - frequency * frequency));
            let minus = num_complex::Complex64::new(-1.0, 0.0);
            for (out, into, value) in
                [("x", "x", d), ("y", "y", a), ("x", "y", minus), ("y", "x", minus)]
            {
                let value = value / (a * d - 1.0);
                let _ = writeln!(rows, "{frequency:?},{out},{into},{:?},{:?}", value.re, value.im);
            }
        }
        fs::write(folder.path().join("frf.csv"), rows).expect("written");
        let text = format!("[system]\nfrequency_response = \"frf.csv\"\n{ending}");
        let measured = Study::parse_in(&text, &[], folder.path()).expect("a study");
        let found = verbs(&measured).stability().expect("a verdict").json();
        let critical = &found["critical_amplitudes"][0];
        let error = (number(&critical["amplitude"]) - wanted).abs();
        // Every second of the coarsest frequencies may not decide.
        let Some(stated) = critical["amplitude_error"].as_f64() else {
            let why = &found["why"]["critical_amplitudes[0].amplitude_error"];
            assert!(
                points == 600 && why.is_string() && error < 1e-6,
                "{points}: {error:e} {found}"
            );
            continue;
        };
        assert!(error <= stated && stated < 0.01 * wanted, "{step}: {error:e} {stated:e}");
    }
}

/// Shapes that are normalised in tonnes have a mass a thousand times too small in SI: warned of by the load and by the spring there.
#[test]
fn the_scale_of_modes_is_checked() {
    let folder = tempfile::tempdir().expect("a folder");
    let shapes = "frequency_hz,damping_ratio,pad_x,pad_z,rotor_z\n1900,0.004,-12,22,1\n2300,0.004,20,9,1\n3100,0.002,1,-3,14\n\
        4700,0.003,-4,6,-9\n";
    fs::write(folder.path().join("modes.csv"), shapes).expect("written");
    let warnings = |units: &str, load: &str, stiffness: &str| {
        let text = format!(
            "[system]\nunits = \"{units}\"\nmodes = \"modes.csv\"\n[[contact]]\nname = \"pad\"\ntangent = {{ pad_x = 1.0 }}\n\
             normal = {{ pad_z = 1.0, rotor_z = -1.0 }}\nnormal_load = \"{load}\"\nnormal_stiffness = \"{stiffness}\"\n\
             belt_velocity = \"50 mm/s\"\n[contact.friction]\nlaw = \"coulomb\"\ncoefficient = 0.55\n"
        );
        let study = Study::parse_in(&text, &[], folder.path()).expect("a study");
        let stability = verbs(&study).stability().expect("a verdict").json();
        let check = verbs(&study).check().expect("valid").facts();
        assert_eq!(stability["warnings"].to_string(), check["warnings"].to_string());
        check["warnings"].to_string()
    };
    assert_eq!(warnings("mm-t-s", "3 kN", "1e8 N/m"), "[]");
    let load = warnings("SI", "3 kN", "1e8 N/m");
    assert!(load.contains("times the weight") && load.contains("31.6"), "{load}");
    let spring = warnings("SI", "30 N", "1e8 N/m");
    assert!(spring.contains("normal spring alone would vibrate at"), "{spring}");
}

/// Numbers that no machine has are asked about, of a belt and of a system alike, and a dither that its actuator cannot give.
#[test]
fn magnitudes_are_checked() {
    let belt = |mu: &str, speed: &str, load: &str, amplitude: &str| {
        let text = format!(
            "[belt]\nmass_kg = 0.5\nnatural_frequency_hz = 5600.0\ndamping_ratio = 0.005\nnormal_force_n = \"{load}\"\n\
             belt_velocity_m_per_s = {speed}\n[friction]\nlaw = \"coulomb\"\ncoefficient = {mu}\n[dither]\n\
             direction = \"tangential\"\nwaveform = \"sine\"\namplitude_n = \"{amplitude}\"\nfrequency_hz = 20000\n\
             [actuator]\nkind = \"piezo\"\nblocked_force_n = \"2 kN\"\n"
        );
        verbs(&study(&text)).check().expect("valid").facts()["warnings"].to_string()
    };
    assert_eq!(belt("0.4", "0.1", "4 kN", "0.8 kN"), "[]");
    let system = |mu: &str, speed: &str, load: &str, amplitude: &str| {
        let text = format!(
            "[system]\nunits = \"SI\"\ncoordinates = [\"x\"]\nmass = [0.5]\ndamping = [[176.0]]\nstiffness = [[619e6]]\n\
             [[contact]]\nname = \"belt\"\ntangent = {{ x = 1 }}\nnormal_load = \"{load}\"\nbelt_velocity = {speed}\n\
             [contact.friction]\nlaw = \"coulomb\"\ncoefficient = {mu}\n[[dither]]\nat = {{ x = 1 }}\nwaveform = \"sine\"\n\
             amplitude = \"{amplitude}\"\nfrequency = \"20 kHz\"\n[actuator]\nkind = \"piezo\"\nblocked_force = \"2 kN\"\n"
        );
        verbs(&study(&text)).check().expect("valid").facts()["warnings"].to_string()
    };
    assert_eq!(system("0.4", "0.1", "4 kN", "0.8 kN"), "[]");
    for (mu, speed, load, amplitude, words) in [
        ("40", "0.1", "4 kN", "0.8 kN", "friction coefficient of contact belt is 40"),
        ("0.4", "100.0", "4 kN", "0.8 kN", "moves at 100 m/s"),
        ("0.4", "0.1", "580 MN", "0.8 kN", "load of contact belt is 580000000 N"),
        ("0.4", "0.1", "4 kN", "580 MN", "amplitude of a dither is 580000000 N"),
        (
            "0.4",
            "0.1",
            "4 kN",
            "5.8 kN",
            "times what the actuator can give, by the blocked force of the actuator",
        ),
    ] {
        for warnings in [belt(mu, speed, load, amplitude), system(mu, speed, load, amplitude)] {
            assert!(warnings.contains(words), "{words}: {warnings}");
        }
    }
}

/// A range of any width has numbers, or is refused by the part in which the equations have some.
#[test]
fn the_reach_over_any_range_is_a_number() {
    let text = "[system]\ncoordinates = [\"x\"]\nmass = [1]\ndamping = [[0.02]]\nstiffness = [[1]]\n[[contact]]\n\
                tangent = { x = 1 }\nnormal_load = 1\nbelt_velocity = 0.05\n[contact.friction]\nlaw = \"coulomb\"\n\
                coefficient = 0.4\n[[dither]]\nat = { x = 1 }\nwaveform = \"sine\"\namplitude = 0.4\nfrequency = 10\n";
    let refused = verbs(&study(text))
        .reach(Some(RealInterval::new(1e-300, 1e300)))
        .map(|_| ())
        .expect_err("overflow");
    let said = refused.to_string();
    assert!(
        said.contains("--frequency") && said.contains("overflow") && !said.contains("NaN"),
        "{said}"
    );
    let wide =
        verbs(&study(text)).reach(Some(RealInterval::new(1e-100, 1e100))).expect("numbers").facts();
    assert!(
        !wide.to_string().contains("NaN") && wide["from"] == 1e-100 && wide["to"] == 1e100,
        "{wide}"
    );
}
