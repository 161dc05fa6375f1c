//! Thresholds of systems with several contacts: the grazing of a further contact, and contacts that graze together.

use quell_dynamics::motion::{MOTION_TOLERANCE, Motion, MotionStart};
use quell_dynamics::orbit::{
    BranchEnding, OrbitVerdict, Threshold, ThresholdKind, ThresholdPlane, branch_thresholds, near,
    threshold_curves,
};
use quell_model::profile::{Profile, Wave};
use quell_model::system::{Contact, Input, InputTarget, MassMatrix, Mechanical};
use quell_model::{LawKind, System, Waveform};
use quell_numerics::continuation::multipliers;
use quell_numerics::interval::RealInterval;
use quell_numerics::matrix::Matrix;
use quell_numerics::polar::modulus;

fn unit(at: usize) -> Vec<f64> {
    (0..2).map(|place| f64::from(u8::from(place == at))).collect()
}

/// Two masses joined by a spring, each on its own surface, under the same dither.
fn two_masses(amplitude: f64, speeds: [f64; 2]) -> System {
    let stiffness = Matrix::from_fn(2, 2, |i, j| if i == j { 1.4 } else { -0.4 });
    let damping = Matrix::from_fn(2, 2, |i, j| if i == j { 0.02 } else { 0.0 });
    let contact = |at: usize| Contact {
        name: format!("pad {at}"),
        tangent: Some(unit(at)),
        force: None,
        normal: None,
        slope: None,
        normal_load: 1.0,
        normal_stiffness: 0.0,
        tangential_stiffness: None,
        normal_damping: 0.0,
        surface_velocity: Profile::constant(speeds[at]),
        friction: LawKind::Decreasing.build(&[0.4, 0.2, 0.3]).expect("a law"),
        varying_load: None,
    };
    let wave =
        Wave { waveform: Waveform::Sine, amplitude, frequency: 5.0, phase: 0.0, envelope: None };
    let input = Input {
        target: InputTarget::Force(vec![1.0, 1.0]),
        profile: Profile::default().with(wave),
    };
    let names = vec!["x".to_owned(), "y".to_owned()];
    System {
        structure: Mechanical::new(names, MassMatrix::identity(2), damping, stiffness).into(),
        contacts: vec![contact(0), contact(1)],
        inputs: vec![input],
    }
}

fn thresholds(speeds: [f64; 2], window: RealInterval) -> Vec<Threshold> {
    let at = |values: &[f64]| Ok(two_masses(values[0], speeds));
    let found =
        branch_thresholds(&at, window.lower, window.upper, 40, None).expect("a base response");
    assert_eq!(found.ending, BranchEnding::Covered, "{window:?}");
    found.thresholds
}

/// The slow contact reverses at every amplitude; the fast one grazes at a value that is its own, below which it has no event.
#[test]
fn the_grazing_of_a_further_contact_is_one_of_that_contact() {
    let speeds = [0.1, 0.3];
    for window in
        [RealInterval::new(0.1, 4.0), RealInterval::new(1.2, 1.7), RealInterval::new(2.0, 1.0)]
    {
        let found = thresholds(speeds, window);
        let [found] = found.as_slice() else { panic!("{window:?}: {found:?}") };
        assert_eq!((found.kind, &found.contacts), (ThresholdKind::Grazing, &vec![1]));
        assert!((found.value - 1.440_123_242).abs() < 1e-8, "{found:?}");
        assert!(found.error < 1e-8, "{found:?}");
        assert_eq!(found.was, Some(OrbitVerdict::Unstable));
        assert_eq!(found.becomes, Some(OrbitVerdict::Stable));
        for (offset, is_beyond) in [(-1e-6, false), (1e-6, true)] {
            let system = two_masses(found.value + offset, speeds);
            let orbit = near(&system, &found.state, 1).expect("an orbit");
            assert!(orbit.events.iter().any(|event| event.contact == 0));
            let has_event = orbit.events.iter().any(|event| event.contact == 1);
            assert_eq!(has_event, is_beyond, "{window:?} {offset}");
        }
    }
}

/// Equal contacts graze at one value, and the multipliers beyond it, through pairs of events at one moment, are those of differences
/// of the period map.
#[test]
fn equal_contacts_graze_together() {
    for window in
        [RealInterval::new(0.1, 4.0), RealInterval::new(1.0, 2.0), RealInterval::new(1.3, 1.6)]
    {
        let found = thresholds([0.3; 2], window);
        let [found] = found.as_slice() else { panic!("{window:?}: {found:?}") };
        assert_eq!((found.kind, &found.contacts), (ThresholdKind::Grazing, &vec![0, 1]));
        assert!((found.value - 1.442_597_910).abs() < 1e-8, "{found:?}");
        let orbit = near(&two_masses(found.value + 0.02, [0.3; 2]), &found.state, 1);
        let orbit = orbit.expect("an orbit");
        let h = 1e-6;
        let system = two_masses(found.value + 0.02, [0.3; 2]);
        let motion = Motion::new(&system).expect("a motion");
        let image = |change: &[f64]| -> Vec<f64> {
            let state = orbit.state.iter().zip(change).map(|(x, d)| x + d).collect();
            let start = MotionStart { time: 0.0, state };
            motion.run(&start, orbit.period, MOTION_TOLERANCE, &mut ()).expect("an end").state
        };
        let matrix = Matrix::from_fn(4, 4, |i, j| {
            let change = |side: f64| -> Vec<f64> {
                (0..4).map(|k| if k == j { side * h } else { 0.0 }).collect()
            };
            (image(&change(1.0))[i] - image(&change(-1.0))[i]) / (2.0 * h)
        });
        let largest = multipliers(&matrix).expect("multipliers")[0];
        let radius = modulus(largest);
        assert!((radius - orbit.radius()).abs() < 1e-4, "{radius} {}", orbit.radius());
    }
}

/// Both kinds of grazing are followed over the speed of a surface; each point is a threshold of its own line.
#[test]
fn grazings_of_named_contacts_are_followed() {
    for (equal, contacts) in [(false, vec![1]), (true, vec![0, 1])] {
        let speeds = |along: f64| [if equal { along } else { 0.1 }, along];
        let at = |values: &[f64]| Ok(two_masses(values[0], speeds(values[1])));
        let plane = ThresholdPlane {
            at: &at,
            window: RealInterval::new(0.8, 2.0),
            between: RealInterval::new(0.28, 0.32),
            points: 10,
        };
        let found = threshold_curves(&plane, 1).expect("curves");
        assert!(found.open.is_empty(), "{:?}", found.open);
        let [curve] = found.curves.as_slice() else { panic!("{:?}", found.curves) };
        assert_eq!((curve.kind, &curve.contacts), (ThresholdKind::Grazing, &contacts));
        let (first, last) = (&curve.points[0], &curve.points[curve.points.len() - 1]);
        assert!(((first.along - last.along).abs() - 0.04).abs() < 1e-9, "{curve:?}");
        for point in [first, last] {
            let line = thresholds(
                speeds(point.along),
                RealInterval::new(0.9 * point.value, 1.1 * point.value),
            );
            let off = line.iter().map(|found| (found.value - point.value).abs());
            assert!(off.fold(f64::INFINITY, f64::min) < 1e-7, "{point:?} {line:?}");
        }
    }
}
