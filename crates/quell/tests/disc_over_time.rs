//! Discs under any waveform, and under loads and dither that vary in time: runs against Runge–Kutta steps, moments, and refusals.

use std::path::Path;

use quell::run::disc::resonances::ResonancesRequest;
use quell::run::disc::{motion, stability};
use quell::run::simulate::MotionRequest;
use quell::study::{DiscStudy, Study};
use quell::verbs::verbs;
use quell_dynamics::motion::MotionStart;
use quell_linear::linearised::Linearised;
use quell_model::system::InputTarget;
use serde_json::Value as Json;

const PLATE: &str = "schema = 1\n[disc]\ninner_radius_ratio = 0.5\nmodal_damping = 0.001\n";

/// A load without spring and damper is prescribed, so that the equations are linear in any motion.
const LOAD: &str = "[disc.load]\nradius_ratio = 0.75\nmass = 0.1\nfriction = 0.2\nspeed = 0.4\n";

const NORMAL: &str = "[dither]\ndirection = \"normal\"\namplitude = 0.6\nfrequency_ratio = 2.7\n";

const TANGENTIAL: &str =
    "[dither]\ndirection = \"tangential\"\namplitude = 0.8\nfrequency_ratio = 2.7\n";

const WAVES: [&str; 6] = [
    "waveform = \"triangle\"\n",
    "waveform = \"square\"\n",
    "waveform = \"fourier\"\nharmonics = [{ order = 1, sine = 0.7 }, { order = 3, sine = 0.2, cosine = -0.3 }]\n",
    "waveform = \"samples\"\nvalues = [0.2, 1.0, -0.3, -0.9]\n",
    "waveform = \"samples\"\nhold = \"zero\"\nvalues = [0.2, 1.0, -0.3, -0.9]\n",
    "waveform = \"burst\"\ncarrier = \"sine\"\non = 2\noff = 1\n",
];

fn read(text: &str) -> DiscStudy {
    DiscStudy::parse_in(text, &[], Path::new("")).unwrap_or_else(|errors| panic!("{errors:#?}"))
}

fn study(text: &str) -> Study {
    Study::parse(text, &[]).unwrap_or_else(|wrong| panic!("{text}\n{wrong:?}"))
}

fn refused(text: &str) -> String {
    let wrong = Study::parse(text, &[]).expect_err(text);
    wrong.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

fn from(state: &[f64], until: f64) -> MotionRequest {
    let from = Some(MotionStart { time: 0.0, state: state.to_vec() });
    MotionRequest { until: Some(until), from, ..MotionRequest::default() }
}

/// The state of a run by Runge–Kutta steps between the breaks of dither and load: friction is that of the study times both.
fn by_runge_kutta(disc: &DiscStudy, state: &[f64], until: f64, knots: &[f64]) -> Vec<f64> {
    let system = disc.disc().system();
    let linear = Linearised::new(&system).expect("flat");
    let friction: Vec<f64> =
        linear.contacts().iter().map(|contact| contact.steady.friction).collect();
    let matrix = |time: f64| {
        let factors = system
            .inputs
            .iter()
            .filter(|input| matches!(input.target, InputTarget::Friction { .. }));
        let contacts = friction.iter().zip(factors).zip(disc.disc().loads());
        let now: Vec<f64> = contacts
            .map(|((friction, factor), load)| {
                let share = load.share.as_ref().map_or(1.0, |share| share.value(time));
                friction * factor.profile.value(time) * share
            })
            .collect();
        linear.state_matrix(&now)
    };
    let mut cuts = vec![0.0, until];
    cuts.extend(knots);
    for wave in system.waves() {
        let period = wave.waveform.period() / wave.frequency;
        for phase in wave.waveform.breaks() {
            let first = ((phase - wave.phase) / wave.frequency).rem_euclid(period);
            cuts.extend((0..).map(|k| first + f64::from(k) * period).take_while(|at| *at < until));
        }
    }
    cuts.sort_by(f64::total_cmp);
    let mut state = state.to_vec();
    let longest = 2e-3;
    for part in cuts.windows(2).filter(|part| part[1] - part[0] > 1e-12) {
        let steps = ((part[1] - part[0]) / longest).ceil();
        let step = (part[1] - part[0]) / steps;
        let inside = 1e-11;
        for begin in
            (0..).map(|k| part[0] + step * f64::from(k)).take_while(|at| *at < part[1] - 0.5 * step)
        {
            let rate = |time: f64, y: &[f64]| -> Vec<f64> {
                let a = matrix(time);
                (0..y.len()).map(|i| a.row(i).iter().zip(y).map(|(a, y)| a * y).sum()).collect()
            };
            let moved = |slope: &[f64], by: f64| -> Vec<f64> {
                state.iter().zip(slope).map(|(y, slope)| y + by * slope).collect()
            };
            let one = rate(begin + inside, &state);
            let two = rate(begin + 0.5 * step, &moved(&one, 0.5 * step));
            let three = rate(begin + 0.5 * step, &moved(&two, 0.5 * step));
            let four = rate(begin + step - inside, &moved(&three, step));
            for i in 0..state.len() {
                state[i] += step / 6.0 * (one[i] + 2.0 * (two[i] + three[i]) + four[i]);
            }
        }
    }
    state
}

fn agree(text: &str, knots: &[f64]) -> Json {
    let disc = read(text);
    let size = disc.disc().system().state_size();
    let state: Vec<f64> = (0..size).map(|i| 1e-3 * (1.0 + i as f64 / 7.0)).collect();
    let done = motion::run(&disc, &from(&state, 12.0)).expect("a motion");
    let wanted = by_runge_kutta(&disc, &state, 12.0, knots);
    let largest = wanted.iter().fold(0.0, |most: f64, y| most.max(y.abs()));
    for (found, wanted) in done.motion.end.state.iter().zip(&wanted) {
        assert!((found - wanted).abs() < 1e-8 * largest, "{text}: {found} {wanted}");
    }
    done.json(&disc)
}

#[test]
fn runs_under_any_waveform_are_those_of_runge_kutta() {
    for dither in [NORMAL, TANGENTIAL] {
        for wave in WAVES {
            let run = agree(&format!("{PLATE}{LOAD}{dither}{wave}"), &[]);
            assert!(run.get("manoeuvre").is_none_or(Json::is_null), "{run}");
        }
    }
}

#[test]
fn runs_under_loads_and_dither_over_time_are_those_of_runge_kutta() {
    let linear = "[disc.load.envelope]\ntime = [1.0, 5.0, 5.0]\nshare = [0.5, 1.0, 0.7]\n";
    let smooth =
        "[disc.load.envelope]\ntime = [1.0, 5.0]\nshare = [0.2, 1.5]\nshape = \"smooth\"\n";
    let waving = "[disc.load.envelope]\noscillation = { amplitude = 0.4, frequency_ratio = 0.9, phase = 0.3 }\n";
    let ramp = "[dither.envelope]\ntime = [2.0, 7.0]\nshare = [0.0, 1.0]\n";
    for (text, knots) in [
        (format!("{PLATE}{LOAD}{linear}"), &[1.0, 5.0][..]),
        (format!("{PLATE}{LOAD}{smooth}{TANGENTIAL}{}", WAVES[3]), &[1.0, 5.0]),
        (format!("{PLATE}{LOAD}{waving}{NORMAL}{}", WAVES[5]), &[]),
        (format!("{PLATE}{LOAD}{NORMAL}{}{ramp}", WAVES[2]), &[2.0, 7.0]),
        (format!("{PLATE}{LOAD}{linear}{NORMAL}{}{ramp}", WAVES[0]), &[1.0, 2.0, 5.0, 7.0]),
    ] {
        let run = agree(&text, knots);
        assert!(run["manoeuvre"].is_object(), "{run}");
        assert!(run["growth_observed"].is_null());
        assert!(run["why"]["growth_observed"].as_str().is_some_and(|why| why.contains("varies")));
    }
}

/// A load that does not vary is the constant one, and so is a full envelope.
#[test]
fn constant_tables_change_nothing() {
    let flat = "[disc.load.envelope]\ntime = [0.0, 4.0]\nshare = [1.0, 1.0]\n";
    let full = "[dither.envelope]\ntime = [0.0]\nshare = [1.0]\n";
    let run = |text: &str| {
        let disc = read(text);
        let state = vec![1e-3; disc.disc().system().state_size()];
        motion::run(&disc, &from(&state, 20.0)).expect("a motion").motion.end.state
    };
    let plain = run(&format!("{PLATE}{LOAD}{NORMAL}"));
    let table = run(&format!("{PLATE}{LOAD}{flat}{NORMAL}{full}"));
    for (plain, table) in plain.iter().zip(&table) {
        assert!((plain - table).abs() < 1e-12, "{plain} {table}");
    }
}

#[test]
fn a_moment_is_a_steady_study() {
    let ramp = "[disc.load.envelope]\ntime = [0.0, 10.0]\nshare = [0.5, 1.5]\n";
    let rising = "[dither.envelope]\ntime = [0.0, 10.0]\nshare = [0.0, 1.0]\n";
    let whole = study(&format!("{PLATE}{LOAD}{ramp}{NORMAL}{}{rising}", WAVES[0]));
    assert_eq!(whole.varies_by(), Some("disc.load.envelope"));
    let at = whole.at_time(8.0).expect("a moment");
    assert_eq!(at.varies_by(), None);
    let disc = at.disc().expect("a disc");
    assert!((disc.disc().loads()[0].friction - 0.2 * 1.3).abs() < 1e-15);
    let amplitude = disc.disc().dither().mean_and_amplitude().1;
    assert!((amplitude - 0.6 * 0.8).abs() < 1e-15);
    assert!(verbs(&at).stability().is_ok());
    // The amplitude that is not given is 1.
    let unsaid = "[dither]\ndirection = \"normal\"\nfrequency_ratio = 2.7\n";
    let at = study(&format!("{PLATE}{LOAD}{unsaid}{rising}")).at_time(3.0).expect("a moment");
    let amplitude = at.disc().expect("a disc").disc().dither().mean_and_amplitude().1;
    assert!((amplitude - 0.3).abs() < 1e-15);
    // Under a law the load is the normal load; of several loads each has its own share.
    let pads = "[[disc.load]]\nradius_ratio = 0.75\nnormal_load = 0.5\nspeed = 0.3\n\
        [disc.load.envelope]\ntime = [0.0]\nshare = [0.4]\n\
        [[disc.load]]\nradius_ratio = 0.75\nangle_deg = 180\nnormal_load = 0.5\n\
        [friction]\nlaw = \"stribeck\"\nstatic_coefficient = 0.5\nminimum_coefficient = 0.3\nreference_velocity = 0.5\n";
    let at = study(&format!("{PLATE}{pads}")).at_time(1.0).expect("a moment");
    let loads = at.disc().expect("a disc");
    let normal: Vec<Option<f64>> =
        loads.disc().loads().iter().map(|load| load.normal_load).collect();
    assert_eq!(normal, [Some(0.2), Some(0.5)]);
}

#[test]
fn verbs_about_a_steady_disc_refuse_one_that_varies() {
    let ramp = "[disc.load.envelope]\ntime = [0.0, 10.0]\nshare = [0.5, 1.5]\n";
    let varying = study(&format!("{PLATE}{LOAD}{ramp}"));
    let verbs = verbs(&varying);
    for reply in [verbs.stability(), verbs.modes(), verbs.resonances(ResonancesRequest::default())]
    {
        let Err(why) = reply else { panic!("an answer about a steady disc") };
        let why = why.to_string();
        assert!(why.contains("disc.load.envelope") && why.contains("--at-time"), "{why}");
    }
    let check = verbs.check().expect("valid").json();
    let load = &check["disc"]["loads"][0];
    assert_eq!(
        (load["least_share"].as_f64(), load["largest_share"].as_f64()),
        (Some(0.5), Some(1.5))
    );
}

#[test]
fn wrong_tables_are_named() {
    for (tables, words) in [
        (
            "[disc.load.envelope]\ntime = [0.0, 1.0]\nshare = [1.0, 0.0]\n",
            "disc.load.envelope.share[1]",
        ),
        (
            "[disc.load.envelope]\noscillation = { amplitude = 1.2, frequency_ratio = 1.0 }\n",
            "above 0 at all times",
        ),
        (
            "[disc.load.envelope]\ntime_s = [0.0]\nshare = [1.0]\n",
            "the size and material of the plate",
        ),
        ("[disc.load.envelope]\ntime = [0.0]\nload = [1.0]\n", "disc.load.envelope.load"),
        ("[disc.drive]\ntime = [0.0]\nvelocity = [0.3]\n", "disc.drive.velocity"),
        ("[disc.load.drive]\ntime = [0.0]\nspeed = [0.3]\n", "all loads rotate together"),
        (
            "[dither]\ndirection = \"normal\"\nfrequency_ratio = 3\nwaveform = \"burst\"\ncarrier = \"sine\"\noff = 1\n",
            "dither.on",
        ),
        (
            "[dither]\ndirection = \"normal\"\nfrequency_ratio = 3\non = 1\n",
            "only the waveform \"burst\" has it",
        ),
        (
            "[dither]\ndirection = \"normal\"\nfrequency_ratio = 3\nwaveform = \"samples\"\nvalues = [3, -1]\n",
            "at most 0.5",
        ),
        ("[dither]\ndirection = \"normal\"\nfrequency_ratio = 3\nphase = 1\n", "dither.phase"),
        (
            "[dither]\ndirection = \"tangential\"\nfrequency_ratio = 3\n[dither.envelope]\ntime = [0]\nshare = [1]\n",
            "no weaker dither",
        ),
    ] {
        let said = refused(&format!("{PLATE}{LOAD}{tables}"));
        assert!(said.contains(words), "{tables}: {said}");
    }
}

/// Times and frequencies in SI, where the disc has its scales.
#[test]
fn tables_in_si_are_those_without_units() {
    let steel = "youngs_modulus_pa = 210e9\ndensity_kg_per_m3 = 7850\nthickness_m = 0.01\nouter_radius_m = 0.14\n";
    let disc = |tables: &str| read(&format!("{PLATE}{steel}{LOAD}{tables}{NORMAL}"));
    let plain = disc("[disc.load.envelope]\ntime = [0.0, 5.0]\nshare = [0.5, 1.0]\n");
    let hertz = plain.reference_hz().expect("a material");
    let seconds = 5.0 / (std::f64::consts::TAU * hertz);
    let si =
        disc(&format!("[disc.load.envelope]\ntime_s = [0.0, {seconds:?}]\nshare = [0.5, 1.0]\n"));
    for time in [1.0, 4.0, 7.0] {
        let share = |study: &DiscStudy| {
            study.disc().loads()[0].share.as_ref().expect("a share").value(time)
        };
        assert!((share(&plain) - share(&si)).abs() < 1e-12);
    }
}

/// The answers of `stability` and `resonances` know every waveform, the marginal frictions of `stability` too.
#[test]
fn stability_knows_every_waveform() {
    for wave in WAVES {
        // A frequency so low that higher harmonics meet at speeds below 1.
        let text = format!("{PLATE}{LOAD}{TANGENTIAL}{wave}").replace("2.7", "1.2");
        let disc = read(&text);
        let found = stability::run(&disc).expect("finite");
        assert!(found.growth.error < 1e-11 && found.growth.rate.is_finite());
        let changes = found.changes.expect("by exponents");
        let up_to = found.changes_up_to.expect("a limit");
        assert!(!changes.is_empty() && changes.iter().all(|change| change.friction <= up_to));
        for change in changes {
            let marginal = disc.disc().with_friction_of(0, change.friction).expect("valid");
            let all = quell_disc::marginal::exponents(&marginal).expect("finite");
            let least = all.iter().map(|exponent| exponent.rate.abs()).fold(f64::MAX, f64::min);
            assert!(least < 1e-11, "{wave} {change:?}: {least}");
        }
        let done = verbs(&study(&text));
        let json = done.resonances(ResonancesRequest::default()).expect("resonances").json();
        let dithered = json["dithered"].as_array().expect("a list");
        assert!(
            dithered
                .iter()
                .any(|meeting| meeting["harmonic"].as_i64().is_some_and(|h| h.abs() > 1))
        );
    }
}
