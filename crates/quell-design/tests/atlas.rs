//! The atlas against an independent program, against the exact computation at random points and nodes, and its limits.

use quell_design::atlas::{
    Atlas, AtlasChange, AtlasLaw, AtlasPoint, AtlasSurface, AtlasTable, ERROR_BANDS, RANGE,
    WAVEFORMS,
};
use quell_design::quench::quench;
use quell_model::{Belt, Direction, Dither, LawKind, Waveform};
use quell_numerics::interval::RealInterval;
use quell_numerics::random::SplitMix;

/// Every table is there, in the order of the laws, with errors for every band.
#[test]
fn the_shipped_atlas_is_whole() {
    let atlas = Atlas::shipped();
    for law in AtlasLaw::ALL {
        for waveform in WAVEFORMS {
            for surface in AtlasSurface::ALL {
                assert!(atlas.table(law, &waveform, surface).is_some());
                for RealInterval { lower: low, upper: high } in ERROR_BANDS {
                    let error = atlas.stated_error((law, &waveform), surface, 0.5 * (low + high));
                    let error = error.expect("an error");
                    assert!((1e-9..1e-2).contains(&error), "{law:?} {surface:?} {high} {error}");
                }
            }
        }
    }
    assert_eq!(atlas.tables.len(), 18);
    assert_eq!(atlas.errors.len(), 18 * ERROR_BANDS.len());
}

/// A few nodes of each table, computed again. The values of the file have nine digits, and κ_n converges to 10⁻¹¹.
#[test]
fn nodes_are_reproduced() {
    let mut random = SplitMix::new(5);
    for table in &Atlas::shipped().tables {
        let nodes = AtlasTable::nodes(table.law, table.surface);
        for _ in 0..6 {
            let index = usize::try_from(random.bits() % nodes.len() as u64).expect("an index");
            let (node, value) = (&nodes[index], table.values[index]);
            let again = AtlasTable::compute(table.law, &table.waveform, table.surface, node);
            let again = again.unwrap_or_else(|why| panic!("{why} at {node:?}"));
            let close = 5.1e-9 * value.abs().max(2e-3);
            let (law, waveform, surface) = (table.law, table.waveform.name(), table.surface);
            let is_close = (again - value).abs() < close;
            assert!(is_close, "{law:?} {waveform} {surface:?} {node:?}: {again} {value}");
        }
    }
}

/// The exact values and the tables against an independent program (`reference/atlas.json`), whose numbers hold to 10⁻⁸. Its last point
/// has more friction per cycle than the tables.
#[test]
fn surfaces_of_an_independent_program() {
    let text = include_str!("../../../reference/atlas.json");
    let reference: serde_json::Value = serde_json::from_str(text).expect("JSON");
    let cases = reference["cases"].as_array().expect("cases");
    let mut tabulated = 0;
    for case in cases {
        let number = |key: &str| case[key].as_f64().expect("a number");
        let law = AtlasLaw::from_name(case["law"].as_str().expect("a law")).expect("a law");
        let waveform = Waveform::from_name(case["waveform"].as_str().expect("a waveform"));
        let waveform = waveform.expect("a waveform");
        let point = AtlasPoint {
            law,
            waveform: waveform.clone(),
            relative_damping: number("relative_damping"),
            relative_velocity: number("relative_velocity"),
            frequency_ratio: number("frequency_ratio"),
            friction_damping: number("friction_damping"),
        };
        let (inverse, per_cycle) = (point.frequency_ratio.recip(), point.damping_per_cycle());
        let grazing = [point.relative_damping, point.relative_velocity, inverse, per_cycle];
        let neutral = [point.relative_velocity, inverse, per_cycle, number("grazing_share")];
        let expected = [
            number("grazing_amplitude") / point.corner().expect("a corner"),
            number("neutral_damping"),
        ];
        let places = [grazing, neutral];
        for ((surface, place), expected) in AtlasSurface::ALL.into_iter().zip(places).zip(expected)
        {
            let exact = AtlasTable::compute(law, &waveform, surface, &place).expect("a value");
            let close = 1e-8 * expected.abs().max(0.1);
            assert!((exact - expected).abs() < close, "{case} {surface:?} {exact} {expected}");
            let range = RANGE.damping_per_cycle;
            if per_cycle > range.upper {
                continue;
            }
            let atlas = Atlas::shipped();
            let table = atlas.table(law, &waveform, surface).expect("a table");
            let stated =
                atlas.stated_error((law, &waveform), surface, per_cycle).expect("an error");
            let error = (table.at(&place) - expected).abs();
            assert!(error < stated * expected.max(1.0), "{case} {surface:?} {error} {stated}");
            tabulated += 1;
        }
    }
    assert_eq!((cases.len(), tabulated), (27, 36));
}

/// A random point of the range in a band of ζ_f/R.
fn random_point(
    random: &mut SplitMix,
    (law, waveform): (AtlasLaw, &Waveform),
    band: RealInterval,
) -> AtlasPoint {
    let mut within = |range: RealInterval| range.width().mul_add(random.share(), range.lower);
    let RealInterval { lower: slow, upper: fast } = RANGE.frequency_ratio;
    let frequency_ratio = within(RealInterval::new(slow.ln(), fast.ln())).exp();
    AtlasPoint {
        law,
        waveform: waveform.clone(),
        relative_damping: within(RANGE.relative_damping).powi(2),
        relative_velocity: law.largest_velocity() * within(RANGE.velocity_share),
        frequency_ratio,
        friction_damping: frequency_ratio * within(band),
    }
}

/// Random belts of the range: the answers have the changes that the exact computation finds, within the error that they state. The fall
/// of the coefficient, which is no group, differs from belt to belt.
#[test]
fn random_belts_within_the_stated_error() {
    let mut random = SplitMix::new(17);
    let (mut certain, mut open, mut sensitive) = (0, 0, 0);
    for law in AtlasLaw::ALL {
        for waveform in &WAVEFORMS {
            for band in ERROR_BANDS {
                for _ in 0..2 {
                    let point = random_point(&mut random, (law, waveform), band);
                    // The load is the scale of tolerances: it is of the order of the speed.
                    let fall = point.friction_damping / point.relative_velocity;
                    let fall = fall * (0.5 + random.share());
                    let belt = point.belt_with_fall(0.0, fall).expect("a belt");
                    let answer = Atlas::shipped().answer(&point).expect("an answer");
                    let exact = quench(&belt.system(), 0).expect("a base response").branch;
                    // Beyond the grazing the continuation may lose a response that sticks and reverses.
                    let grazing = answer.grazing.0;
                    assert!(exact.end.is_none_or(|end| end > grazing), "{answer:?} {exact:?}");
                    let errors = answer.changes.iter().map(|change| change.error);
                    let errors = errors.collect::<Option<Vec<f64>>>();
                    let Some(errors) = errors.filter(|_| !answer.may_change_more) else {
                        open += 1;
                        continue;
                    };
                    certain += 1;
                    sensitive += usize::from(answer.changes.iter().any(AtlasChange::is_sensitive));
                    assert_eq!(answer.quiet_without, exact.quiet_at_first, "{point:?}");
                    assert_eq!(answer.changes.len(), exact.changes.len(), "{answer:?} {exact:?}");
                    for ((change, error), exact) in
                        answer.changes.iter().zip(errors).zip(&exact.changes)
                    {
                        assert_eq!(change.becomes_quiet, exact.becomes_quiet, "{point:?}");
                        assert_eq!(change.kind, exact.kind, "{point:?}");
                        let bound = error + exact.error + 1e-9 * exact.amplitude;
                        let difference = (change.amplitude - exact.amplitude).abs();
                        assert!(difference < bound, "{point:?} {change:?} {exact:?}");
                    }
                }
            }
        }
    }
    println!("{certain} certain, of these {sensitive} sensitive; {open} open");
    assert!(certain >= 60 && open <= 8, "{certain} {open}");
}

/// The groups of a belt do not depend on its units, on the level of friction, nor on the amplitude and the phase of its dither.
#[test]
fn groups_scale_out() {
    let law = LawKind::Decreasing.build(&[0.5, 0.3, 0.25]).expect("a law");
    let dither = |amplitude: f64, phase: f64| Dither {
        direction: Direction::Tangential,
        waveform: Waveform::Triangle,
        amplitude,
        frequency_ratio: 8.0,
        phase,
        envelope: None,
    };
    let belt = |scale: f64, fall: f64, dither: Dither| {
        let levels = [0.1 + 0.2 * fall, 0.1, 0.25 * scale];
        let law = LawKind::Decreasing.build(&levels).expect("a law");
        Belt::new(0.01, 0.75 * scale / fall, 0.5 * scale, law, vec![dither]).expect("a belt")
    };
    let one = Belt::new(0.01, 0.75, 0.5, law, vec![dither(0.0, 0.0)]).expect("a belt");
    let one = AtlasPoint::of(&one).expect("inside");
    // ζ_f = F Δμ/(2 v_m) = 0.75 · 0.2/0.5.
    assert!((one.friction_damping - 0.3).abs() < 1e-15, "{one:?}");
    assert!((one.relative_damping - 1.0 / 30.0).abs() < 1e-15, "{one:?}");
    assert_eq!((one.relative_velocity, one.frequency_ratio), (2.0, 8.0));
    for belt in [
        belt(1.0, 1.0, dither(3.0, 0.3)),
        belt(7.0, 1.0, dither(0.0, 0.0)),
        belt(2.0, 3.0, dither(0.1, 1.0)),
    ] {
        let other = AtlasPoint::of(&belt).expect("inside");
        assert!((other.friction_damping / one.friction_damping - 1.0).abs() < 1e-14, "{other:?}");
        assert!((other.relative_damping / one.relative_damping - 1.0).abs() < 1e-14, "{other:?}");
        assert!((other.relative_velocity / one.relative_velocity - 1.0).abs() < 1e-14);
    }
    // A viscous part of a law is damping.
    let viscous = |damping: f64, viscous: f64| {
        let law = LawKind::StribeckExponential.build(&[0.3, 0.5, 0.25, 2.0, viscous]);
        let dither = dither(0.0, 0.0);
        Belt::new(damping, 0.75, 0.25, law.expect("a law"), vec![dither]).expect("a belt")
    };
    let (with, without) = (viscous(0.01, 0.04), viscous(0.01 + 0.5 * 0.75 * 0.04, 0.0));
    let [with_point, without_point] =
        [&with, &without].map(|belt| AtlasPoint::of(belt).expect("inside"));
    assert!((with_point.relative_damping / without_point.relative_damping - 1.0).abs() < 1e-14);
    let [one, other] = [&with, &without].map(|belt| quench(&belt.system(), 0).expect("a response"));
    let [one, other] = [&one, &other].map(|found| found.branch.changes[0].amplitude);
    assert!((one / other - 1.0).abs() < 1e-9, "{one} {other}");
}
