//! `design` of a system: the belt written as a system against independent numbers, dither on one of two masses, and refusals.

use quell::Study;
use quell::verbs::verbs;
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

use crate::designs::{complaint, facts};

/// The belt with ζ = 0.005 and F = 1 as a system of one mass.
const BELT: &str = "[system]\ncoordinates = [\"x\"]\nmass = [1.0]\ndamping = [0.01]\nstiffness = [1.0]\n[[contact]]\n\
                    name = \"belt\"\ntangent = { x = 1.0 }\nnormal_load = 1.0\nbelt_velocity = 0.1\n[friction]\n\
                    law = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n\
                    [[dither]]\nat = { x = 1.0 }\nwaveform = \"sine\"\namplitude = 1.0\nfrequency = 10.0\n";

fn design(vary: &str, over: &str, limits: &str) -> String {
    format!(
        "[design]\nminimise = \"amplitude\"\n{vary}\n[design.over]\n\"contact.belt.belt_velocity\" = {over}\n{limits}"
    )
}

const AMPLITUDE: &str = "vary = [\"dither.amplitude\"]\nfrom = [0.01]\nto = [20.0]";

fn number(value: &Json) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("no number: {value}"))
}

/// An independent program: D = 1.4863197137, 1.8916513091 and 0.9486004565 over the speeds .05 to .15.
#[test]
fn the_belt_as_a_system_has_its_numbers() {
    let waveforms = "\nwaveforms = [\"sine\", \"triangle\", \"square\"]";
    let found =
        facts(&format!("{BELT}{}", design(&format!("{AMPLITUDE}{waveforms}"), "[0.05, 0.15]", "")));
    assert_eq!((&found["feasible"], &found["waveform"]), (&true.into(), &"square".into()));
    let wanted = [1.4863197137178406, 1.8916513090546048, 0.9486004564844978];
    let rows = found["waveforms"].as_array().expect("a list");
    assert_eq!(rows.len(), 3);
    for (row, wanted) in rows.iter().zip(wanted) {
        let amplitude = number(&row["objective"]);
        assert!((amplitude / wanted - 1.0).abs() < 1e-6, "{row}");
    }
    assert_eq!(found["worst"]["contact.belt.belt_velocity"], 0.15);
    assert!(number(&found["verified"]["multiplier"]) < 1.0);
    assert_eq!(found["verified"]["protocol"], "local");
    let verified = number(&found["parameters"]["dither.amplitude"]);
    assert!((verified / number(&found["critical"]["dither.amplitude"]) - 1.001).abs() < 1e-12);
}

/// The same program: the box ends beyond the tip at .1623452749, where D = 1.6085159881.
#[test]
fn the_point_that_decides_is_a_tip_inside_the_box() {
    let found = facts(&format!("{BELT}{}", design(AMPLITUDE, "[0.05, 0.2]", "")));
    assert!(
        (number(&found["critical"]["dither.amplitude"]) / 1.6085159880796942 - 1.0).abs() < 1e-6
    );
    let worst = number(&found["worst"]["contact.belt.belt_velocity"]);
    assert!((worst / 0.16234527494519785 - 1.0).abs() < 1e-5, "{worst}");
}

/// The same program, with R chosen and the stroke limited to .04: R = 8.1272892355, D = 1.3010566064.
#[test]
fn the_stroke_decides_the_frequency() {
    let vary = "vary = [\"dither.amplitude\", \"dither.frequency\"]\nfrom = [0.01, 2.0]\nto = [20.0, 20.0]";
    let found = facts(&format!(
        "{BELT}{}",
        design(vary, "[0.05, 0.2]", "[design.limits]\nstroke = 0.04\n")
    ));
    assert_eq!(found["binding"], serde_json::json!(["stroke"]));
    let [amplitude, frequency] =
        ["dither.amplitude", "dither.frequency"].map(|path| number(&found["critical"][path]));
    assert!((amplitude / 1.3010566063571558 - 1.0).abs() < 1e-5, "{amplitude}");
    assert!((frequency / 8.127289235523428 - 1.0).abs() < 1e-5, "{frequency}");
    assert!(!found["frontier"].as_array().expect("a list").is_empty());
}

/// Runs of the belt as a system from rest and from squeal: the least amplitude is that of the design of the belt itself, whose runs are
/// those of another engine.
#[test]
fn designs_for_runs_agree_with_those_of_the_belt() {
    let belt = "[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = 0.1\n[friction]\nlaw = \"stribeck\"\n\
                static_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n[dither]\n\
                direction = \"tangential\"\nwaveform = \"sine\"\namplitude = 1.0\nfrequency_ratio = 10.0\n";
    let local = number(
        &facts(&format!("{BELT}[design]\nminimise = \"amplitude\"\n{AMPLITUDE}\n"))["critical"]["dither.amplitude"],
    );
    for start in ["rest", "squeal"] {
        let design = format!(
            "[design]\nminimise = \"amplitude\"\nstart = \"{start}\"\nvary = [\"dither.amplitude\"]\nfrom = [0.4]\nto = [1.6]\n"
        );
        let [of_system, of_belt] = [BELT, belt].map(|text| facts(&format!("{text}{design}")));
        let [system, belt] =
            [&of_system, &of_belt].map(|found| number(&found["critical"]["dither.amplitude"]));
        assert!((system / belt - 1.0).abs() < 1e-4, "{start}: {system} and {belt}");
        assert!(system >= local * (1.0 - 1e-6), "{start}: {system} below {local}");
        assert_eq!(of_system["verified"]["protocol"], start);
    }
}

/// Two masses, friction at the carriage, and dither on the motor or on the carriage.
fn two_masses(at: &str) -> String {
    format!(
        "[system]\ncoordinates = [\"motor\", \"carriage\"]\nmass = [1.0, 1.0]\ndamping = [[0.02, -0.01], [-0.01, 0.02]]\n\
         stiffness = [[2.0, -1.0], [-1.0, 1.0]]\n[[contact]]\nname = \"belt\"\ntangent = {{ carriage = 1.0 }}\n\
         normal_load = 1.0\nbelt_velocity = 0.1\n[friction]\nlaw = \"stribeck\"\nstatic_coefficient = 0.4\n\
         minimum_coefficient = 0.2857\nreference_velocity = 0.2\n[[dither]]\nat = {{ {at} = 1.0 }}\nwaveform = \"sine\"\n\
         amplitude = 1.0\nfrequency = 10.0\n"
    )
}

/// The least amplitude of a box is the largest threshold of its points, found by another verb; a force on the motor reaches the
/// contact through the spring between the masses and must be about R² as large.
#[test]
fn dither_on_one_of_two_masses() {
    use quell::run::thresholds::ThresholdsRequest;
    let mut least = Vec::new();
    for (at, to) in [("carriage", 20.0), ("motor", 400.0)] {
        let vary = format!("vary = [\"dither.amplitude\"]\nfrom = [0.01]\nto = [{to}]");
        let found = facts(&format!("{}{}", two_masses(at), design(&vary, "[0.05, 0.15]", "")));
        assert_eq!(found["feasible"], true, "{found}");
        let amplitude = number(&found["critical"]["dither.amplitude"]);
        let worst = number(&found["worst"]["contact.belt.belt_velocity"]);
        let text =
            two_masses(at).replace("belt_velocity = 0.1", &format!("belt_velocity = {worst}"));
        let study = Study::parse(&text, &[]).expect("a study");
        let request = ThresholdsRequest {
            parameter: "dither.amplitude".to_owned(),
            window: RealInterval::new(0.9 * amplitude, 1.1 * amplitude),
            ..ThresholdsRequest::default()
        };
        let thresholds = verbs(&study).thresholds(&request).expect("thresholds").facts();
        let values = thresholds["local"].as_array().expect("a list");
        let nearest = values.iter().map(|row| (number(&row["value"]) / amplitude - 1.0).abs());
        let nearest = nearest.fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-6, "{at}: {amplitude} {thresholds}");
        least.push(amplitude);
    }
    let ratio = least[1] / least[0];
    assert!((80.0..120.0).contains(&ratio), "{least:?}");
}

/// A limit that does not bind changes nothing; one that does makes the design infeasible and is named, with the part of the box that
/// is served.
#[test]
fn limits_that_bind_and_that_do_not() {
    let with =
        |limits: &str| facts(&format!("{BELT}{}", design(AMPLITUDE, "[0.05, 0.15]", limits)));
    let free = with("");
    let loose = with("[design.limits]\namplitude = 3.0\npower = 1.0\nminimum_normal_load = 0.5\n");
    assert_eq!(free["critical"], loose["critical"]);
    assert_eq!(loose["binding"], serde_json::json!([]));
    let tight = with("[design.limits]\namplitude = 1.0\n");
    assert_eq!(tight["feasible"], false);
    assert!(tight["sentence"].as_str().expect("a text").contains("amplitude would be"), "{tight}");
    let covered = tight["covered"]["contact.belt.belt_velocity"].as_array().expect("a range");
    assert!(number(&covered[0]) == 0.05 && number(&covered[1]) < 0.15);
}

#[test]
fn what_design_cannot_do_is_refused_by_name() {
    let own = format!("{BELT}{}", design(AMPLITUDE, "[0.05, 0.15]", ""));
    let with = |from: &str, to: &str| {
        assert!(own.contains(from), "{from}");
        complaint(&own.replace(from, to))
    };
    for (from, to, key) in [
        ("\"contact.belt.belt_velocity\"", "\"contact.belt.belt_velcity\"", "design.over"),
        ("\"contact.belt.belt_velocity\"", "\"dither.amplitude\"", "design.over"),
        ("vary = [\"dither.amplitude\"]", "vary = [\"dither.frequency\"]", "design.vary"),
        ("[0.05, 0.15]", "[0.15, 0.05]", "design.over"),
        ("from = [0.01]", "start = \"afar\"\nfrom = [0.01]", "design.start"),
        ("from = [0.01]", "from = [-0.01]", "design.vary"),
        ("minimise = \"amplitude\"", "minimise = \"noise\"", "design.minimise"),
        ("[design.over]", "[design.limits]\nstroke_m = 0.1\n[design.over]", "stroke_m"),
        ("[design.over]", "[design.limits]\nstroke = -0.1\n[design.over]", "design.limits.stroke"),
        (
            "waveform = \"sine\"\namplitude = 1.0\nfrequency = 10.0",
            "waveform = \"noise\"\namplitude = 1.0\nband = [8.0, 12.0]\nseed = 1",
            "dither",
        ),
    ] {
        let said = with(from, to);
        assert!(said.contains(key), "{to}: {said}");
    }
    assert!(complaint(BELT).contains("design"));
}

/// A structure of 20 modes: the answer is verified, and averaging is near it because the dither is fast.
#[test]
fn a_structure_of_twenty_modes() {
    let modes: Vec<String> = (0..20)
        .map(|k| {
            let (frequency, share) = (1.0 + 0.2 * f64::from(k), 1.0 / f64::from(1 + k));
            format!(
                "[[system.mode]]\nfrequency = {frequency}\ndamping_ratio = 0.005\nshape = {{ tip = {share}, drive = {} }}\n",
                0.8 * share
            )
        })
        .collect();
    let modes = modes.concat();
    let text = format!(
        "[system]\nunits = \"none\"\n{modes}[[contact]]\nname = \"belt\"\ntangent = {{ tip = 1.0 }}\nnormal_load = 1.0\n\
         belt_velocity = 0.1\n[friction]\nlaw = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2857\n\
         reference_velocity = 0.2\n[[dither]]\nat = {{ drive = 1.0 }}\nwaveform = \"sine\"\namplitude = 1.0\nfrequency = 40.0\n{}",
        design("vary = [\"dither.amplitude\"]\nfrom = [0.01]\nto = [100.0]", "[0.05, 0.15]", "")
    );
    let found = facts(&text);
    assert_eq!(found["feasible"], true, "{found}");
    let [exact, averaged] =
        ["critical", "averaged"].map(|name| number(&found[name]["dither.amplitude"]));
    assert!((exact / averaged - 1.0).abs() < 0.01, "{exact} {averaged}");
    assert!(number(&found["verified"]["multiplier"]) < 1.0);
}

/// In SI with m = 2 kg and k = 200 N/m, twins of limits and paths: D k in newtons.
#[test]
fn a_system_in_si_has_the_same_answer() {
    let text = "[system]\nunits = \"SI\"\ncoordinates = [\"x\"]\nmass = [2.0]\ndamping = [0.2]\nstiffness = [200.0]\n[[contact]]\n\
                name = \"belt\"\ntangent = { x = 1.0 }\nnormal_load_n = 200.0\nbelt_velocity_m_per_s = 1.0\n[friction]\n\
                law = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity_m_per_s = 2.0\n\
                [[dither]]\nat = { x = 1.0 }\nwaveform = \"sine\"\namplitude_n = 200.0\nfrequency_hz = 15.915494309189533\n\
                [design]\nminimise = \"stroke\"\nvary = [\"dither.amplitude_n\"]\nfrom = [2.0]\nto = [4000.0]\n\
                [design.over]\n\"contact.belt.belt_velocity_m_per_s\" = [0.5, 1.5]\n\
                [design.limits]\nstroke_m = 0.5\namplitude_n = 1000.0\n";
    let found = facts(text);
    let newtons = number(&found["critical"]["dither.amplitude_n"]);
    assert!((newtons / (200.0 * 1.4863197137178406) - 1.0).abs() < 1e-6, "{newtons}");
    // 2 D/(R² − 1) metres, with the damping's part of 10⁻⁶.
    let stroke = number(&found["objective"]);
    assert!((stroke / (2.0 * 1.4863197137178406 / 99.0) - 1.0).abs() < 1e-5, "{stroke}");
}

/// The derivatives of the least amplitude: of the belt written as a system, as a belt, and in SI, they are the same up to units, and
/// agree with least amplitudes of changed studies.
#[test]
fn derivatives_are_in_the_units_of_the_study() {
    let own = format!("{BELT}{}", design(AMPLITUDE, "[0.05, 0.15]", ""));
    let found = facts(&own);
    assert_eq!(found["threshold"]["kind"], "grazing");
    assert!(found["threshold"]["meets"].is_null());
    let amplitude = number(&found["critical"]["dither.amplitude"]);
    for (path, from, to, change) in [
        ("friction.static_coefficient", "= 0.4", "= 0.4004", 4e-4),
        ("dither.frequency", "frequency = 10.0", "frequency = 10.01", 1e-2),
        ("contact.belt.belt_velocity", "[0.05, 0.15]", "[0.05, 0.15015]", 1.5e-4),
        ("system.damping[0]", "damping = [0.01]", "damping = [0.01001]", 1e-5),
    ] {
        let rate = number(&found["sensitivity"][path]);
        let changed = number(&facts(&own.replace(from, to))["critical"]["dither.amplitude"]);
        let difference = (changed - amplitude) / change;
        let size = difference.abs().max(1e-3 * amplitude);
        // The least amplitudes are located to 10⁻⁷, and the difference is one-sided.
        assert!((rate - difference).abs() < 5e-3 * size, "{path}: {rate} {difference}");
    }
    let relative = &found["sensitivity_relative"];
    assert!((number(&relative["dither.frequency"]) - 1.01 / 0.99).abs() < 0.02, "{relative}");
    assert!(found["sensitivity"]["dither.amplitude"].is_null());
    assert!(found["sensitivity"].get("dither.amplitude").is_none(), "{found}");
    // In SI with m = 2 kg and k = 200 N/m.
    let si = "[system]\nunits = \"SI\"\ncoordinates = [\"x\"]\nmass = [2.0]\ndamping = [0.2]\nstiffness = [200.0]\n[[contact]]\n\
              name = \"belt\"\ntangent = { x = 1.0 }\nnormal_load_n = 200.0\nbelt_velocity_m_per_s = 1.0\n[friction]\n\
              law = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity_m_per_s = 2.0\n\
              [[dither]]\nat = { x = 1.0 }\nwaveform = \"sine\"\namplitude_n = 200.0\nfrequency_hz = 15.915494309189533\n\
              [design]\nminimise = \"amplitude\"\nvary = [\"dither.amplitude_n\"]\nfrom = [2.0]\nto = [4000.0]\n\
              [design.over]\n\"contact.belt.belt_velocity_m_per_s\" = [0.5, 1.5]\n";
    let in_si = facts(si);
    let twins = [
        ("contact.belt.belt_velocity", "contact.belt.belt_velocity_m_per_s", 200.0 / 10.0),
        ("dither.frequency", "dither.frequency_hz", 200.0 * std::f64::consts::TAU / 10.0),
        ("friction.reference_velocity", "friction.reference_velocity_m_per_s", 200.0 / 10.0),
        ("contact.belt.normal_load", "contact.belt.normal_load_n", 1.0),
    ];
    for (path, twin, unit) in twins {
        let (own, other) =
            (number(&found["sensitivity"][path]), number(&in_si["sensitivity"][twin]));
        assert!((own * unit - other).abs() < 1e-5 * other.abs().max(1.0), "{path}: {own} {other}");
        let [own, other] = [(&found, path), (&in_si, twin)]
            .map(|(json, path)| number(&json["sensitivity_relative"][path]));
        assert!((own - other).abs() < 1e-6, "{path}: {own} {other}");
    }
    assert_eq!(in_si["units"]["sensitivity"], "N per unit of the number");
}

/// At a tip the amplitude does not depend on the speed of the study, and both thresholds are named.
#[test]
fn derivatives_at_a_tip_are_those_of_the_tip() {
    let own = format!("{BELT}{}", design(AMPLITUDE, "[0.05, 0.2]", ""));
    let found = facts(&own);
    assert_eq!(found["threshold"]["kind"], "grazing");
    assert!(found["threshold"]["meets"].is_string(), "{found}");
    assert!(number(&found["sensitivity"]["contact.belt.belt_velocity"]).abs() < 1e-6);
    let changed = facts(&own.replace("= 0.2857", "= 0.28599"));
    let amplitude = |json: &Json| number(&json["critical"]["dither.amplitude"]);
    let difference = (amplitude(&changed) - amplitude(&found)) / 2.9e-4;
    let rate = number(&found["sensitivity"]["friction.minimum_coefficient"]);
    assert!((rate - difference).abs() < 0.01 * difference.abs(), "{rate} {difference}");
}

/// A schedule over a box of one coordinate has the exact least amplitude of each operating point alone, and says what it saves.
#[test]
fn a_schedule_has_the_designs_of_its_points() {
    let found = facts(&format!("{BELT}{}", design(AMPLITUDE, "[0.05, 0.15]", "")));
    let rows = found["schedule"].as_array().expect("a list");
    assert_eq!(rows.len(), 33);
    let path = "contact.belt.belt_velocity";
    for place in [0, 16, 32] {
        let speed = number(&rows[place][path]);
        let alone = format!("[{speed}, {speed}]");
        let single = facts(&format!("{BELT}{}", design(AMPLITUDE, &alone, "")));
        let single = number(&single["critical"]["dither.amplitude"]);
        let amplitude = number(&rows[place]["amplitude"]);
        assert!((amplitude / single - 1.0).abs() < 1e-6, "{speed}: {amplitude} {single}");
    }
    let mean = rows.iter().map(|row| number(&row["objective"])).sum::<f64>() / 33.0;
    let saved = 1.0 - mean / number(&found["objective"]);
    assert!((number(&found["saved_by_schedule"]) - saved).abs() < 1e-12);
    // By averaging at high frequency the amplitude is in proportion to the speed: 1/3 is saved.
    assert!((saved - 1.0 / 3.0).abs() < 0.01, "{saved}");
    let two = "[0.05, 0.15]\n\"contact.belt.normal_load\" = [0.9, 1.0]";
    let box_of_two = facts(&format!("{BELT}{}", design(AMPLITUDE, two, "")));
    assert!(box_of_two["schedule"].is_null() && box_of_two["saved_by_schedule"].is_null());
}

/// The response is that of the exact orbit: of one mass far above resonance A/(R² − 1) for a sine. A limit below it makes the design
/// infeasible where nothing can give way, and decides the frequency where that is free.
#[test]
fn a_limited_response_is_that_of_exact_orbits() {
    let free = facts(&format!("{BELT}{}", design(AMPLITUDE, "[0.05, 0.15]", "")));
    let amplitude = number(&free["parameters"]["dither.amplitude"]);
    let [rms, peak] = ["response_rms", "response_peak"].map(|name| number(&free[name]));
    assert!((peak * 99.0 / amplitude - 1.0).abs() < 0.03, "{peak}");
    assert!((rms * 99.0 / amplitude * 2.0_f64.sqrt() - 1.0).abs() < 0.03, "{rms}");
    let limit = |limits: &str| format!("[design.limits]\n{limits}\n");
    let loose =
        design(AMPLITUDE, "[0.05, 0.15]", &limit(&format!("response_rms = {}", 1.01 * rms)));
    assert_eq!(facts(&format!("{BELT}{loose}"))["critical"], free["critical"]);
    let tight = design(AMPLITUDE, "[0.05, 0.15]", &limit(&format!("response_rms = {}", 0.9 * rms)));
    let none = facts(&format!("{BELT}{tight}"));
    assert_eq!(none["feasible"], false);
    assert!(none["sentence"].as_str().expect("a text").contains("the response rms"), "{none}");
    let vary = "vary = [\"dither.amplitude\", \"dither.frequency\"]\nfrom = [0.01, 2.0]\nto = [20.0, 20.0]";
    let bound = design(vary, "[0.05, 0.2]", &limit("response_peak = 0.02"));
    let found = facts(&format!("{BELT}{bound}"));
    assert_eq!(found["binding"], serde_json::json!(["response_peak"]), "{found}");
    let peak = number(&found["response_peak"]);
    assert!((peak / 0.02 - 1.0).abs() < 1e-5, "{peak}");
    // Close to a stroke of 0.04 without friction, which has R = 8.1273.
    let frequency = number(&found["critical"]["dither.frequency"]);
    assert!((frequency / 8.1273 - 1.0).abs() < 0.1, "{frequency}");
}

/// Where a schedule leaves the mean friction above that without dither, no percentage is named.
#[test]
fn a_schedule_that_loses_no_friction_says_so() {
    let asked =
        design(AMPLITUDE, "[0.05, 0.3]", "").replace("\"amplitude\"\n", "\"friction-loss\"\n");
    let found = facts(&format!("{BELT}{asked}"));
    assert!(number(&found["saved_by_schedule"]) > 1.0, "{found}");
    let rows = found["schedule"].as_array().expect("a list");
    assert!(rows.iter().map(|row| number(&row["objective"])).sum::<f64>() < 0.0);
    let notes = found["notes"].to_string();
    assert!(notes.contains("the friction loss is negative on average"), "{notes}");
    assert!(!notes.contains("less friction loss"), "{notes}");
}
