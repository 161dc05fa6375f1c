//! The variation of random systems against differences of their motions.

use quell_dynamics::motion::{
    MOTION_TOLERANCE, Motion, MotionRecorder, MotionStart, MotionVariation,
};

use crate::checker::random_system;

/// Systems that are compared.
const SYSTEMS: u64 = 400;

/// Time up to which they are compared.
const UNTIL: f64 = 4.0;

/// Half the distance of two starts, whose numbers are of order 1: differences are wrong by its square, and by rounding over it.
const NUDGE: f64 = 1e-6;

/// Largest difference, relative to the largest entry of the derivative. Differences are good to 10⁻⁹ (the error of a motion, 10⁻¹⁵
/// to 10⁻¹³, over the nudge, and its square times the curvature); a wrong or missing term of the saltation, or of stick on a
/// tilted surface, changes entries by 10⁻⁵ and more.
const SAME: f64 = 1e-7;

/// What a comparison met.
#[derive(Default)]
struct Met {
    systems: usize,
    /// With events of each kind: stick, release, reversal, separation, landing.
    kinds: [usize; 5],
    /// With a slope row and a stick.
    tilted: usize,
    worst: f64,
}

/// Compares the derivative along one direction; `None` where the three motions differ in their events.
fn compare(seed: u64, met: &mut Met) -> Option<Result<(), String>> {
    let (system, start) = random_system(seed);
    let motion = Motion::new(&system).ok()?;
    let from = MotionStart { time: 0.0, state: start.clone() };
    let mut variation = MotionVariation::new(&motion).ok()?;
    motion.run(&from, UNTIL, MOTION_TOLERANCE, &mut variation).ok()?;
    let direction: Vec<f64> =
        (0..start.len()).map(|i| ((7 * i + 3) as f64 * 1.7 + seed as f64).sin()).collect();
    let moved = |by: f64| {
        let state = start.iter().zip(&direction).map(|(x, d)| x + by * d).collect();
        let mut recorder = MotionRecorder::default();
        let from = MotionStart { time: 0.0, state };
        let end = motion.run(&from, UNTIL, MOTION_TOLERANCE, &mut recorder).ok()?;
        Some((end.state, recorder.events))
    };
    let ((ahead, events_ahead), (behind, events_behind)) = (moved(NUDGE)?, moved(-NUDGE)?);
    let order = |events: &[quell_dynamics::motion::RecordedEvent]| {
        events.iter().map(|e| (e.kind.name(), e.contact, e.slip_sign)).collect::<Vec<_>>()
    };
    let own = order(&variation.events);
    if own != order(&events_ahead) || own != order(&events_behind) || variation.is_one_sided {
        return None;
    }
    let matrix = variation.matrix();
    let mut worst = 0.0_f64;
    for (i, (a, b)) in ahead.iter().zip(&behind).enumerate() {
        let exact: f64 = matrix.row(i).iter().zip(&direction).map(|(m, d)| m * d).sum();
        worst = worst.max((exact - (a - b) / (2.0 * NUDGE)).abs());
    }
    let worst = worst / matrix.largest().max(1.0);
    met.worst = met.worst.max(worst);
    met.systems += 1;
    for (count, kind) in
        met.kinds.iter_mut().zip(["stick", "release", "reversal", "separation", "landing"])
    {
        *count += usize::from(own.iter().any(|event| event.0 == kind));
    }
    let sticks = own.iter().any(|event| event.0 == "release");
    let tilts = system.contacts.iter().any(|contact| contact.slope.is_some());
    met.tilted += usize::from(sticks && tilts);
    if worst <= SAME {
        Some(Ok(()))
    } else {
        Some(Err(format!("{worst:e}, events {own:?}, tilted {tilts}")))
    }
}

#[test]
fn the_variation_of_random_systems_is_the_derivative_of_their_motion() {
    let mut met = Met::default();
    let mut different = Vec::new();
    for seed in 0..SYSTEMS {
        if let Some(Err(why)) = compare(seed, &mut met) {
            different.push(format!("system {seed}: {why}"));
        }
    }
    println!(
        "{} systems, {:?}, {} tilted, worst {:e}",
        met.systems, met.kinds, met.tilted, met.worst
    );
    assert!(different.is_empty(), "{}", different.join("\n"));
    assert!(met.systems > 200 && met.kinds.iter().all(|count| *count > 20), "{:?}", met.kinds);
    assert!(met.tilted > 5, "{}", met.tilted);
}
