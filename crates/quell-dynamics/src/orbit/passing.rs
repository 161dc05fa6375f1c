//! How near a periodic motion passes to a state.

use quell_model::System;
use quell_numerics::roots::{Closeness, minimise};

use crate::motion::{MOTION_TOLERANCE, Motion, MotionObserver, MotionSegment, MotionStart};

/// Places in a segment between which the distance is looked at before it is minimised. A minimum narrower than their distance would be
/// missed, and one motion counted as two.
const PLACES: usize = 8;

/// The least distance between a state and the run from another one over a time, over the largest number of the state.
pub fn nearest_distance(system: &System, (from, duration): (&[f64], f64), target: &[f64]) -> f64 {
    let mut nearest = Nearest { target, least: f64::INFINITY };
    let start = MotionStart { time: 0.0, state: from.to_vec() };
    if let Ok(motion) = Motion::new(system) {
        // A run that stops keeps the part before.
        let _ = motion.run(&start, duration, MOTION_TOLERANCE, &mut nearest);
    }
    let size = target.iter().fold(0.0, |most: f64, number| most.max(number.abs()));
    nearest.least / size
}

/// Measures the distance to a state.
struct Nearest<'a> {
    target: &'a [f64],
    least: f64,
}

impl MotionObserver for Nearest<'_> {
    fn segment(&mut self, segment: &MotionSegment<'_>) {
        let mut state = vec![0.0; self.target.len()];
        let mut distance = |since: f64| {
            segment.state(since, &mut state);
            let differences = state.iter().zip(self.target).map(|(a, b)| a - b);
            differences.map(|difference| difference * difference).sum::<f64>().sqrt()
        };
        let step = segment.duration() / PLACES as f64;
        let distances: Vec<f64> = (0..=PLACES).map(|place| distance(step * place as f64)).collect();
        for (place, found) in distances.iter().enumerate() {
            let before = place.saturating_sub(1);
            let after = (place + 1).min(PLACES);
            self.least = self.least.min(*found);
            if distances[before] < *found || distances[after] < *found {
                continue;
            }
            let (low, high) = (step * before as f64, step * after as f64);
            if let Ok(minimum) = minimise(&mut distance, low, high, Closeness::default()) {
                self.least = self.least.min(minimum.value);
            }
        }
    }
}
