//! Waveforms by harmonics, by samples and by bursts.
//!
//! Numbers: `reference/waveforms.json` (source and tolerance in `reference/README.md`).

use quell::run::orbit::Wanted;
use quell::run::response::ResponseRequest;
use quell::run::simulate::{MotionRequest, Simulation};
use quell::run::thresholds::ThresholdsRequest;
use quell::run::waveforms::WaveformComparison;
use quell::run::{simulate, waveforms};
use quell::study::{BeltStudy, SystemStudy};
use quell::sweep::{MapQuantity, Plan};
use quell::verbs::{system_of, verbs};
use quell::{Failure, Study};
use quell_dynamics::orbit::branch_thresholds;
use quell_linear::averaging::{Averaging, Becomes, CrossingKind, critical_amplitudes};
use quell_linear::linear_cost::linear_cost;
use quell_model::{Belt, Direction, Dither, Waveform};
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

fn reference() -> Json {
    serde_json::from_str(include_str!("../../../reference/waveforms.json")).expect("JSON")
}

fn number(value: &Json) -> f64 {
    value.as_f64().or_else(|| value.as_str()?.parse().ok()).expect("a number")
}

fn numbers(value: &Json) -> Vec<f64> {
    value.as_array().expect("numbers").iter().map(number).collect()
}

fn study(text: &str) -> BeltStudy {
    BeltStudy::parse(text, &[]).unwrap_or_else(|wrong| panic!("{text}\n{wrong:?}"))
}

/// The run of a belt from its start.
fn simulated(study: &BeltStudy, until: f64) -> Simulation {
    let system = Study::from(study).system();
    simulate::run(&system, &MotionRequest::to(until)).unwrap_or_else(|why| panic!("{why}"))
}

fn refused(text: &str) -> String {
    let wrong = BeltStudy::parse(text, &[]).expect_err(text);
    wrong.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

#[test]
fn events_and_states_agree_with_independent_integrators() {
    let reference = reference();
    let cases = reference["trajectories"].as_array().expect("cases");
    assert_eq!(cases.len(), 9);
    for case in cases {
        let study = study(case["study"].as_str().expect("text"));
        let run = simulated(&study, number(&case["until"]));
        let events = &run.history.events;
        assert_eq!(run.end.events, case["n_events"].as_u64().expect("a count"), "{}", case["name"]);
        for (event, expected) in events.iter().zip(case["events"].as_array().expect("events")) {
            let kind = expected["kind"].as_str().expect("a kind");
            assert_eq!(event.kind.name(), kind, "{} {event:?}", case["name"]);
            assert!((event.time - number(&expected["time"])).abs() < 1e-9, "{event:?}: {expected}");
            let moved = (event.state[0] - number(&expected["displacement"])).abs();
            assert!(moved < 1e-9, "{event:?}: {expected}");
        }
        let end = &case["final"];
        let name = &case["name"];
        assert!((run.end.state[0] - number(&end["displacement"])).abs() < 1e-9, "{name}");
        assert!((run.end.state[1] - number(&end["velocity"])).abs() < 1e-9, "{name}");
    }
}

#[test]
fn averages_are_those_of_the_definition() {
    for row in reference()["averaged"].as_array().expect("rows") {
        let study = study(row["study"].as_str().expect("text"));
        let ratio = number(&row["frequency_ratio"]);
        let waveform = study.belt().dithers()[0].waveform.clone();
        let RealInterval { lower: least, upper: largest } = waveform.integral_range();
        let shape = &row["waveform"];
        assert!((largest - number(&shape["G_max"])).abs() < 1e-12, "{row}: {largest}");
        assert!((least - number(&shape["G_min"])).abs() < 1e-12, "{row}: {least}");
        let mean_square = waveform.mean_square_integral();
        assert!((mean_square / number(&shape["G_mean_square"]) - 1.0).abs() < 1e-12, "{row}");
        for case in row["effective"].as_array().expect("cases") {
            let alpha = number(&case["amplitude_ratio"]);
            let study = study.with("dither.amplitude", alpha * ratio).expect("an amplitude");
            let at = numbers(&case["slip_velocity"]);
            let found = verbs(&Study::from(&study)).friction(Some(&at), false).expect("friction");
            let found = &found.json()["contacts"][0];
            // The reference is of the limit R → ∞.
            let limit =
                |name: &str| numbers(&found[&format!("limit_effective_{name}")]).into_iter();
            let values = limit("coefficient").zip(limit("slope"));
            let expected = numbers(&case["coefficient"]).into_iter().zip(numbers(&case["slope"]));
            for ((value, slope), (exact, exact_slope)) in values.zip(expected) {
                assert!((value - exact).abs() < 1e-10 * exact.abs(), "{row}: {value} {exact}");
                assert!((slope - exact_slope).abs() < 1e-9, "{row}: {slope} {exact_slope}");
            }
        }
        let stability = &row["stability"];
        let belt = study.belt();
        assert_eq!(belt.belt_velocity(), number(&stability["belt_velocity"]));
        let found = critical_amplitudes(belt, Averaging::Limit).expect("an average");
        let end = number(&stability["scanned_to"]);
        let found: Vec<_> =
            found.iter().filter(|critical| critical.amplitude_ratio < end).collect();
        let expected = stability["critical_amplitudes"].as_array().expect("amplitudes");
        assert_eq!(found.len(), expected.len(), "{row}: {found:?}");
        for (found, expected) in found.iter().zip(expected) {
            let exact = number(&expected["amplitude_ratio"]);
            assert!((found.amplitude_ratio / exact - 1.0).abs() < 1e-9, "{row}: {found:?}");
            let jumps = expected["kind"] == "jump";
            assert_eq!(found.crossing == CrossingKind::Jump, jumps, "{row}");
            assert_eq!(found.becomes == Becomes::Stable, expected["becomes"] == "stable", "{row}");
        }
    }
}

#[test]
fn a_burst_without_pause_is_its_carrier() {
    for case in reference()["no_pause"].as_array().expect("cases") {
        let [burst, carrier] =
            ["burst", "carrier"].map(|name| study(case[name].as_str().expect("text")));
        assert_eq!(burst.belt(), carrier.belt());
    }
}

/// Without a pause a burst gives the answers of its carrier bit for bit: of belts, systems and discs.
#[test]
fn a_burst_without_pause_has_the_answers_of_its_carrier() {
    const DISC: &str = "[disc]\ninner_radius_ratio = 0.5\nmodal_damping = 0.001\n[disc.load]\nradius_ratio = 0.75\nmass = 0.1\n\
         friction = 0.2\nspeed = 0.4\n[dither]\ndirection = \"normal\"\namplitude = 0.6\nfrequency_ratio = 2.7\n";
    for carrier in ["sine", "triangle", "square"] {
        let burst = format!("waveform = \"burst\"\ncarrier = \"{carrier}\"\non = 3\noff = 0\n");
        let named = format!("waveform = \"{carrier}\"\n");
        let sweep = "[[sweep]]\nparameter = \"dither.amplitude\"\nvalues = [0.3, 0.5]\n";
        let belts =
            [&burst, &named].map(|keys| Study::from(&study(&(with("tangential", keys) + sweep))));
        let systems = [&burst, &named]
            .map(|keys| Study::parse(&format!("{SYSTEM}{keys}"), &[]).expect("a system"));
        let discs = [&burst, &named]
            .map(|keys| Study::parse(&format!("{DISC}{keys}"), &[]).expect("a disc"));
        let runs = belts
            .each_ref()
            .map(|study| verbs(study).simulate(&MotionRequest::to(60.0)).expect("a run").json());
        assert_eq!(runs[0], runs[1], "{carrier}");
        let answers = |of: &Study| {
            let verbs = verbs(of);
            let replies = [
                verbs.response(&ResponseRequest::default()),
                verbs.stability(),
                verbs.orbit(&Wanted::default()),
            ];
            replies.map(|reply| {
                reply.map_or_else(|why| why.to_string(), |found| found.json().to_string())
            })
        };
        for pair in [&belts, &systems, &discs] {
            assert_eq!(answers(&pair[0]), answers(&pair[1]), "{carrier}");
        }
        let request = ThresholdsRequest {
            parameter: "dither.amplitude".to_owned(),
            window: RealInterval::new(0.2, 1.4),
            protocols: Vec::new(),
            ..ThresholdsRequest::default()
        };
        let thresholds = belts
            .each_ref()
            .map(|study| verbs(study).thresholds(&request).expect("thresholds").json());
        assert_eq!(thresholds[0], thresholds[1], "{carrier}");
        let maps = belts.each_ref().map(|study| {
            let asked = MapQuantity::named("residual-vibration", "--quantity").expect("a quantity");
            let plan = Plan::new(study, &[asked]).expect("a plan");
            let points = plan.compute_points(0..plan.grid().len());
            points.iter().map(|array| format!("{array:?}")).collect::<Vec<_>>()
        });
        assert_eq!(maps[0], maps[1], "{carrier}");
    }
}

/// A system of one mass.
const SYSTEM: &str = "[system]\ncoordinates = [\"x\"]\nmass = [1]\ndamping = [[0.02]]\nstiffness = [[1]]\n[[contact]]\nname = \"pad\"\n\
     tangent = { x = 1 }\nnormal_load = 1\nbelt_velocity = 0.1\n[contact.friction]\nlaw = \"stribeck\"\n\
     static_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n\
     [[dither]]\nat = { x = 1 }\namplitude = 0.5\nfrequency = 10\n";

/// A sum of one harmonic is a sine of another amplitude and frequency, under both kinds of averaging.
#[test]
fn one_harmonic_is_a_sine() {
    let critical = |keys: &str, ratio: &str, response| {
        let text = with("tangential", keys).replace("frequency_ratio = 10.0", ratio);
        let options = response;
        critical_amplitudes(study(&text).belt(), options).expect("an average")
    };
    for response in [Averaging::Limit, Averaging::FiniteR] {
        let half = "waveform = \"fourier\"\nharmonics = [{ order = 2, sine = 0.3, cosine = 0.4 }]";
        let found = critical(half, "frequency_ratio = 10.0", response);
        let sine = critical("waveform = \"sine\"", "frequency_ratio = 20.0", response);
        assert_eq!(found.len(), sine.len());
        for (found, sine) in found.iter().zip(&sine) {
            assert!(
                (found.amplitude / (2.0 * sine.amplitude) - 1.0).abs() < 1e-12,
                "{found:?} {sine:?}"
            );
            assert_eq!(found.crossing, sine.crossing);
        }
    }
}

const BELT: &str = "[belt]\ndamping_ratio = 0.01\nnormal_load = 1.0\nbelt_velocity = 0.1\n[friction]\nlaw = \"stribeck\"\n\
     static_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n[dither]\namplitude = 0.5\n\
     frequency_ratio = 10.0\n";

fn with(direction: &str, keys: &str) -> String {
    format!("{BELT}direction = \"{direction}\"\n{keys}\n")
}

/// 1000 samples of a sine that are held: nearly the sine.
#[test]
fn held_samples_of_a_sine_are_nearly_a_sine() {
    let values: Vec<String> = (0..1000)
        .map(|k| format!("{:?}", (std::f64::consts::TAU * (f64::from(k) + 0.5) / 1000.0).sin()))
        .collect();
    let keys = format!("waveform = \"samples\"\nhold = \"zero\"\nvalues = [{}]", values.join(", "));
    let [held, sine] = [keys.as_str(), "waveform = \"sine\""].map(|keys| {
        critical_amplitudes(study(&with("tangential", keys)).belt(), Averaging::Limit)
            .expect("an average")
    });
    assert_eq!(held.len(), sine.len());
    for (held, sine) in held.iter().zip(&sine) {
        assert!((held.amplitude_ratio / sine.amplitude_ratio - 1.0).abs() < 1e-5, "{held:?}");
    }
}

/// 1000 samples of a sine that are held have the exact threshold of the base response under the sine: the first harmonic of the steps is
/// smaller by sinc(π/1000), 1.6·10⁻⁶.
#[test]
fn held_samples_of_a_sine_have_its_exact_threshold() {
    let values: Vec<String> = (0..1000)
        .map(|k| format!("{:?}", (std::f64::consts::TAU * (f64::from(k) + 0.5) / 1000.0).sin()))
        .collect();
    let keys = format!("waveform = \"samples\"\nhold = \"zero\"\nvalues = [{}]", values.join(", "));
    let [held, sine] = [keys.as_str(), "waveform = \"sine\""].map(|keys| {
        let belt = study(&with("tangential", keys));
        let at = |values: &[f64]| Ok(belt.belt().with_amplitude(0, values[0])?.system());
        let found = branch_thresholds(&at, 0.9, 1.3, 8, None).expect("a branch");
        found.thresholds.iter().map(|threshold| threshold.value).collect::<Vec<f64>>()
    });
    assert!(!sine.is_empty());
    assert_eq!(held.len(), sine.len(), "{held:?} {sine:?}");
    for (held, sine) in held.iter().zip(&sine) {
        assert!((held / sine - 1.0).abs() < 1e-5, "{held} {sine}");
        assert!(held != sine);
    }
}

#[test]
fn wrong_waveforms_are_refused_with_the_place() {
    for (keys, complaints) in [
        ("waveform = \"sin\"", "did you mean"),
        ("waveform = \"sine\"\non = 3", "dither.on"),
        ("waveform = \"fourier\"", "dither.harmonics"),
        ("waveform = \"fourier\"\nharmonics = []", "1 to 1000 harmonics"),
        ("waveform = \"fourier\"\nharmonics = [{ sine = 1.0 }]", "dither.harmonics[0]"),
        (
            "waveform = \"fourier\"\nharmonics = [{ order = 0, sine = 1.0 }]",
            "dither.harmonics[0].order",
        ),
        ("waveform = \"fourier\"\nharmonics = [{ order = 2, sine = 0.0 }]", "not all zero"),
        (
            "waveform = \"fourier\"\nharmonics = [{ order = 2, sinus = 1.0 }]",
            "dither.harmonics[0].sinus",
        ),
        ("waveform = \"samples\"\nvalues = [1.0]", "2 to 1000000 samples"),
        ("waveform = \"samples\"\nvalues = [1.0, 1.0]", "samples that differ"),
        ("waveform = \"samples\"\nvalues = [1.0, nan]", "sample 1"),
        ("waveform = \"samples\"\nvalues = [1.0, 2.0]\nhold = \"cubic\"", "dither.hold"),
        ("waveform = \"burst\"\ncarrier = \"sine\"\non = 0\noff = 2", "dither.on"),
        ("waveform = \"burst\"\ncarrier = \"sine\"\non = 2.5\noff = 2", "whole number"),
        ("waveform = \"burst\"\ncarrier = \"burst\"\non = 2\noff = 2", "dither.carrier"),
        ("waveform = \"burst\"\non = 2\noff = 2", "dither.carrier"),
    ] {
        let said = refused(&with("tangential", keys));
        assert!(said.contains(complaints), "{keys}: {said}");
    }
    // The load of a waveform with a deep minimum must stay positive.
    let deep = "waveform = \"samples\"\nvalues = [3.0, 0.0, 0.0, 0.0]\nhold = \"zero\"";
    let upside_down = "waveform = \"samples\"\nvalues = [-3.0, 0.0, 0.0, 0.0]\nhold = \"zero\"";
    study(&with("normal", deep));
    assert!(refused(&with("normal", upside_down)).contains("dither.amplitude"));
}

/// The same dither on the same mass, as a belt and as a system: the same periodic motion, by two engines.
#[test]
fn a_belt_and_a_system_have_the_same_periodic_motion() {
    for keys in [
        "waveform = \"burst\"\ncarrier = \"sine\"\non = 3\noff = 2",
        "waveform = \"burst\"\ncarrier = \"triangle\"\non = 2\noff = 1",
        "waveform = \"samples\"\nvalues = [0.3, 1.0, -0.4, -1.2, 0.5]",
        "waveform = \"samples\"\nhold = \"zero\"\nvalues = [0.3, 1.0, -0.4, -1.2, 0.5]",
        "waveform = \"fourier\"\nharmonics = [{ order = 1, sine = 1.0 }, { order = 4, cosine = 0.3 }]",
    ] {
        let system = format!(
            "[system]\ncoordinates = [\"x\"]\nmass = [1.0]\ndamping = [0.02]\nstiffness = [1.0]\n[[contact]]\nname = \"belt\"\n\
             tangent = {{ x = 1.0 }}\nnormal_load = 1.0\nbelt_velocity = 0.1\n[contact.friction]\nlaw = \"stribeck\"\n\
             static_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n[[dither]]\nat = {{ x = 1.0 }}\n\
             {keys}\namplitude = 1.5\nfrequency = 10.0\n"
        );
        let belt = with("tangential", keys).replace("amplitude = 0.5", "amplitude = 1.5");
        let facts = [belt, system].map(|text| {
            let study =
                Study::parse(&text, &[]).unwrap_or_else(|wrong| panic!("{text}\n{wrong:?}"));
            verbs(&study).orbit(&Wanted::default()).expect("an orbit").facts()
        });
        let [belt, system] = &facts;
        assert!(
            (number(&belt["period"]) / number(&system["period"]) - 1.0).abs() < 1e-14,
            "{keys}"
        );
        let leading = numbers(&belt["multipliers"][0]);
        let radius = leading[0].hypot(leading[1]);
        assert!((radius - number(&system["radius"])).abs() < 1e-8, "{facts:?}");
        let state = numbers(&system["state"]);
        assert!((number(&belt["displacement"]) - state[0]).abs() < 1e-9, "{keys}: {facts:?}");
        assert!((number(&belt["velocity"]) - state[1]).abs() < 1e-9, "{keys}");
        assert_eq!(belt["verdict"], system["verdict"], "{keys}");
    }
}

const MODES: &str = "[system]\ncoordinates = [\"x\", \"y\"]\nmass = [1.0, 1.0]\ndamping = [0.05, 0.05]\n\
     stiffness = [[2.0, 1.0], [1.0, 0.6666666666666667]]\n[[contact]]\nname = \"pad\"\ntangent = { x = 1.0 }\n\
     normal = { y = 1.0 }\nnormal_load = 1.0\nnormal_stiffness = 1.3333333333333333\nbelt_velocity = 1.0\n[contact.friction]\n\
     law = \"coulomb\"\ncoefficient = 0.9\n";

/// Averaging of a system under a sum of harmonics is that under its harmonics as dithers of their own.
#[test]
fn a_system_averages_a_sum_of_harmonics() {
    let at = "at = { x = 1.0 }";
    let sum = format!(
        "{MODES}[[dither]]\n{at}\nwaveform = \"fourier\"\namplitude = 20.0\nfrequency = 20.0\nphase = 0.7\n\
         harmonics = [{{ order = 1, sine = 1.0 }}, {{ order = 2, sine = 0.3, cosine = 0.4 }}]\n"
    );
    let phase = 2.0 * 0.7 + 0.4_f64.atan2(0.3);
    let several = format!(
        "{MODES}[[dither]]\n{at}\nwaveform = \"sine\"\namplitude = 20.0\nfrequency = 20.0\nphase = 0.7\n[[dither]]\n{at}\n\
         waveform = \"sine\"\namplitude = 10.0\nfrequency = 40.0\nphase = {phase:?}\n"
    );
    let facts = [sum, several].map(|text| {
        let study = Study::parse(&text, &[]).unwrap_or_else(|wrong| panic!("{text}\n{wrong:?}"));
        verbs(&study).stability().expect("an average").facts()
    });
    let [sum, several] = &facts;
    assert_eq!(sum["verdict"], several["verdict"], "{facts:?}");
    let off = number(&sum["growth_rate"]) - number(&several["growth_rate"]);
    assert!(off.abs() < 1e-10, "{facts:?}");
    let slip = |facts: &Json| number(&facts["contacts"][0]["slip_amplitude"]);
    assert!((slip(sum) / slip(several) - 1.0).abs() < 1e-10, "{facts:?}");
}

const QUENCH: &str = "[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = 0.05\n[friction]\nlaw = \"stribeck\"\n\
     static_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n[dither]\ndirection = \"tangential\"\n\
     waveform = \"sine\"\namplitude = 0.4\nfrequency_ratio = 60.0\n";

/// The comparison of a belt, by its system.
fn compared(text: &str) -> Result<(SystemStudy, WaveformComparison), Failure> {
    let system = system_of(&Study::from(&study(text)), "waveforms")?;
    let found = waveforms::run(&system)?;
    Ok((system, found))
}

/// The least amplitude of each waveform is that at which its fast velocity reaches the belt: G_max = 1, π/4, π/2, and 2 less the
/// duty cycle of bursts of a sine. The exact amplitudes at R = 60 differ by less than 1/R.
#[test]
fn least_amplitudes_of_every_waveform() {
    let (study, (system, found)) = (study(QUENCH), compared(QUENCH).expect("a comparison"));
    assert_eq!(found.rows.len(), 10);
    for row in &found.rows {
        let least = row.averaged.as_ref().expect("an amplitude");
        let peak = match row.waveform.name() {
            "sine" => 1.0,
            "triangle" => std::f64::consts::FRAC_PI_4,
            "square" => std::f64::consts::FRAC_PI_2,
            _ => 2.0 - row.duty_cycle,
        };
        // The form is that of the limit R → ∞; the comparison has the same amplitude at the study's R.
        let dither = Dither { waveform: row.waveform.clone(), ..study.belt().dithers()[0].clone() };
        let law = study.belt().friction().clone();
        let belt = Belt::new(0.005, 1.0, 0.05, law, vec![dither]).expect("a belt");
        let of = |options| {
            let found = critical_amplitudes(&belt, options).expect("an average");
            let stable = found.iter().find(|critical| critical.becomes == Becomes::Stable);
            stable.expect("an amplitude").amplitude_ratio
        };
        let limit = of(Averaging::Limit);
        assert!((limit * peak / 0.05 - 1.0).abs() < 1e-9, "{row:?}");
        let ratio = least.amplitude / 60.0;
        assert!((ratio / of(Averaging::FiniteR) - 1.0).abs() < 1e-12, "{row:?}");
        // The fast velocity of a sine is larger by 1/(1 − 1/R²).
        if row.waveform == Waveform::Sine {
            assert!((ratio / limit / (1.0 - 1.0 / 3600.0) - 1.0).abs() < 1e-9, "{row:?}");
        }
        let exact = row.exact.as_ref().expect("an exact amplitude");
        // The longest bursts repeat at 7.5 times the natural frequency only.
        let off = 3.0 * f64::from(row.waveform.cycles()) / 60.0 / 8.0 + 1.0 / 60.0;
        assert!((exact.amplitude / least.amplitude - 1.0).abs() < off, "{row:?}");
        let share = match row.waveform.name() {
            "sine" => 0.5_f64.sqrt(),
            "triangle" => (1.0_f64 / 3.0).sqrt(),
            "square" => 1.0,
            _ => (0.5 * row.duty_cycle).sqrt(),
        };
        assert!((row.waveform.root_mean_square() / share - 1.0).abs() < 1e-9, "{row:?}");
    }
    let json = found.json(&system);
    let rows = json["waveforms"].as_array().expect("rows");
    // The stroke of a sine: 2D/(R² − 1), as damping has no part in it.
    let stroke = number(&rows[0]["stroke"]);
    let amplitude = number(&rows[0]["amplitude"]);
    assert!((stroke / (2.0 * amplitude / 3599.0) - 1.0).abs() < 1e-5, "{stroke}");
    // The mean power 2ζ⟨x′²⟩ of a sine whose velocity is the belt's.
    let power = number(&rows[0]["power"]);
    assert!((power / (0.01 * 0.5 * 0.05 * 0.05) - 1.0).abs() < 1e-3, "{power}");
    // Bursts of half the time take ⟨G²⟩/G_max² = (1.5 d − d²)/(2 − d)² of it, over that of the sine.
    let half = rows.iter().find(|row| row["duty_cycle"] == 0.5).expect("a burst");
    let half = number(&half["power"]);
    assert!((half / power / (0.5 / 2.25 / 0.5) - 1.0).abs() < 0.02, "{half} {power}");
    assert_eq!(json["best"]["stroke"], "square");
    assert_eq!(json["best"]["power"], "burst 1 : 7");
    assert_eq!(
        found.dataset(&system).csv().lines().filter(|line| !line.starts_with('#')).count(),
        11
    );
}

#[test]
fn what_cannot_be_compared_has_a_reason() {
    // Nothing to quench.
    let quiet = QUENCH.replace("belt_velocity = 0.05", "belt_velocity = 0.5");
    let (quiet, found) = compared(&quiet).expect("a comparison");
    assert!(found.rows.iter().all(|row| row.averaged.is_err() && row.exact.is_err()));
    let json = found.json(&quiet);
    assert!(json["waveforms"][0]["amplitude"].is_null() && json["best"]["amplitude"].is_null());
    assert!(
        json["why"]["waveforms[0].amplitude"].as_str().expect("why").contains("stable without")
    );
    // Normal dither does no work on the structure.
    let normal = QUENCH
        .replace("tangential", "normal")
        .replace("frequency_ratio = 60.0", "frequency_ratio = 10.0");
    let (normal, found) = compared(&normal).expect("a comparison");
    let found = found.json(&normal);
    assert!(found["waveforms"][0]["power"].is_null(), "{found}");
    // Without dither there is no direction and no frequency, and a disc has no such verb.
    let bare = &QUENCH[..QUENCH.find("[dither]").expect("a table")];
    assert!(compared(bare).is_err());
    assert!(compared(&QUENCH.replace("belt_velocity = 0.05", "belt_velocity = 0.0")).is_err());
    let disc = Study::parse(include_str!("../../../studies/which-dither-frequency.toml"), &[]);
    assert!(verbs(&disc.expect("a disc")).waveforms().is_err());
}

/// The study's own waveform is one of the rows; of bursts only once.
#[test]
fn own_waveforms_are_compared() {
    for (keys, count, carrier) in [
        ("waveform = \"burst\"\ncarrier = \"triangle\"\non = 3\noff = 5", 10, "triangle"),
        ("waveform = \"burst\"\ncarrier = \"square\"\non = 4\noff = 1", 11, "square"),
        ("waveform = \"samples\"\nvalues = [1.0, 0.2, -1.0]", 11, "sine"),
    ] {
        let (_, found) =
            compared(&QUENCH.replace("waveform = \"sine\"", keys)).expect("a comparison");
        assert_eq!((found.rows.len(), found.carrier), (count, carrier), "{keys}");
        assert_eq!(found.rows.iter().filter(|row| row.own).count(), 1, "{keys}");
    }
}

/// Samples of a file are those of the study; a wrong line is named, and unchanged files are not read again.
#[test]
fn samples_of_a_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let keys = "waveform = \"samples\"\nfile = \"wave.csv\"";
    let text = with("tangential", keys);
    let parse = || BeltStudy::parse_in(&text, &[], folder.path());
    let said = || {
        let wrong = parse().expect_err("a wrong file");
        wrong.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    };
    let missing = said();
    assert!(missing.contains("dither.file") && missing.contains("wave.csv"), "{missing}");
    let write = |text: &str| std::fs::write(folder.path().join("wave.csv"), text).expect("a file");
    write("# a period\ntime,value\n0,0.3\n1,1.0\n2,-0.4\n3,-1.2\n4,0.5\n");
    let of_file = parse().expect("samples");
    let listed =
        study(&with("tangential", "waveform = \"samples\"\nvalues = [0.3, 1.0, -0.4, -1.2, 0.5]"));
    assert_eq!(of_file.belt(), listed.belt());
    // A change of another number keeps the samples that were read.
    write("nonsense\n");
    assert!(said().contains("2 to 1000000 samples"), "{}", said());
    let changed = of_file.with("dither.amplitude", 0.7).expect("an amplitude");
    assert_eq!(changed.belt().dithers()[0].waveform, listed.belt().dithers()[0].waveform);
    for (text, words) in [
        ("1\n\n-1\n", "line 2 is empty"),
        ("1\nx\n", "line 2 must have a finite number"),
        ("time,force\n0,1\n", "a column value"),
        ("1\n1\n", "samples that differ"),
    ] {
        write(text);
        assert!(said().contains(words) && said().contains("dither.file"), "{text}: {}", said());
    }
    let both =
        with("tangential", "waveform = \"samples\"\nfile = \"wave.csv\"\nvalues = [1.0, -1.0]");
    assert!(refused(&both).contains("dither.values"));
}

/// A system of one mass has the least amplitudes of averaging, and the stroke and the power of that mass on its spring.
#[test]
fn waveforms_of_a_system() {
    let keys = "waveform = \"fourier\"\nharmonics = [{ order = 1, sine = 1.0 }, { order = 3, sine = 0.2 }]";
    let text = format!(
        "[system]\ncoordinates = [\"x\"]\nmass = [1.0]\ndamping = [0.02]\nstiffness = [1.0]\n[[contact]]\nname = \"belt\"\n\
         tangent = {{ x = 1.0 }}\nnormal_load = 1.0\nbelt_velocity = 0.1\n[contact.friction]\nlaw = \"stribeck\"\n\
         static_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n[[dither]]\nat = {{ x = 1.0 }}\n\
         {keys}\namplitude = 1.5\nfrequency = 10.0\n"
    );
    let study = Study::parse(&text, &[]).expect("a system");
    let facts = verbs(&study).waveforms().expect("a comparison").facts();
    let rows = facts["waveforms"].as_array().expect("rows");
    let names: Vec<&str> = rows.iter().filter_map(|row| row["waveform"].as_str()).collect();
    assert_eq!(names[..5], ["sine", "triangle", "square", "fourier", "burst"]);
    assert_eq!(names.len(), 11, "seven bursts: {names:?}");
    let stability = verbs(&study).stability().expect("an average").facts();
    let critical = number(&stability["critical_amplitudes"][0]["amplitude"]);
    assert!((number(&rows[3]["amplitude"]) / critical - 1.0).abs() < 1e-9, "{rows:?}");
    for (row, waveform) in rows.iter().zip(Waveform::NAMED) {
        let dither = Dither {
            direction: Direction::Tangential,
            waveform: waveform.clone(),
            amplitude: number(&row["amplitude"]),
            frequency_ratio: 10.0,
            phase: 0.0,
            envelope: None,
        };
        let exact = linear_cost(&dither, 0.01).expect("a response");
        // One oscillator in closed form, and the wave on the structure as a Taylor series.
        assert!((number(&row["stroke"]) / exact.stroke - 1.0).abs() < 1e-9, "{row} {exact:?}");
        assert!((number(&row["power"]) / exact.power - 1.0).abs() < 1e-9, "{row} {exact:?}");
        // Where the fast velocity of the mass without its damper reaches the belt: the damper takes 2(ζ/R)² of it, more of harmonics.
        let taken = 1.0 - exact.velocity / 0.1;
        assert!((1e-6..4e-6).contains(&taken), "{taken:e} {row} {exact:?}");
    }
    assert_eq!(facts["best"]["amplitude"], "square");
    // The study's own burst has the least amplitude of `stability`. Its integral reaches 2 − 2/3 where that of its carrier reaches 1, so
    // that it needs 3/4 of the amplitude as R → ∞; at a repetition of 10/3 the difference is about (3/10)²/4.
    let burst = text.replace(keys, "waveform = \"burst\"\ncarrier = \"sine\"\non = 2\noff = 1");
    let study = Study::parse(&burst, &[]).expect("a system");
    let facts = verbs(&study).waveforms().expect("a comparison").facts();
    let stability = verbs(&study).stability().expect("an average").facts();
    let critical = number(&stability["critical_amplitudes"][0]["amplitude"]);
    let own = number(&facts["waveforms"][3]["amplitude"]);
    assert!((own / critical - 1.0).abs() < 1e-9, "{own} {critical}");
    let sine = number(&facts["waveforms"][0]["amplitude"]);
    assert!((own / sine - 0.75).abs() < 0.0225, "{own} {sine}");
    let bare = &text[..text.find("[[dither]]").expect("a dither")];
    assert!(verbs(&Study::parse(bare, &[]).expect("a system")).waveforms().is_err());
}
