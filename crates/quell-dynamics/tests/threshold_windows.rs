//! Thresholds do not depend on the window in which they are searched: a wide window finds those of narrow windows that tile it.

use quell_dynamics::orbit::{BranchEnding, SystemAt, ThresholdKind, branch_thresholds};
use quell_model::{Belt, Direction, Dither, LawKind, Waveform};
use quell_zoo::BeltExt;
use quell_zoo::belt::{over_amplitudes, over_velocities};
use quell_zoo::dither::tangential;

/// Thresholds over a window that must be covered.
fn thresholds(at: &SystemAt<'_>, (from, to): (f64, f64)) -> Vec<(f64, ThresholdKind)> {
    let found = branch_thresholds(at, from, to, 40, None)
        .unwrap_or_else(|why| panic!("{why} {:?}", at(&[from])));
    assert_eq!(found.ending, BranchEnding::Covered, "from {from} to {to}: {:?}", at(&[from]));
    found.thresholds.iter().map(|threshold| (threshold.value, threshold.kind)).collect()
}

fn assert_tiled(over: &SystemAt<'_>, (from, to): (f64, f64)) -> usize {
    let wide = thresholds(over, (from, to));
    let at = |k: u32| from + (to - from) * f64::from(k) / 4.0;
    let narrow: Vec<_> = (0..4).flat_map(|k| thresholds(over, (at(k), at(k + 1)))).collect();
    assert_eq!(wide.len(), narrow.len(), "{wide:?} {narrow:?} {:?}", over(&[from]));
    for (a, b) in wide.iter().zip(&narrow) {
        assert!((a.0 - b.0).abs() < 1e-7 * (to - from) && a.1 == b.1, "{wide:?} {narrow:?}");
    }
    wide.len()
}

/// The response grazes from the side with stick, next to which no step of a wide window converges.
#[test]
fn a_grazing_from_the_side_with_stick_is_found_in_every_window() {
    let law = LawKind::Decreasing.build(&[0.4, 0.25, 0.3]).expect("a law");
    let dither = tangential(Waveform::Sine, 2.0, 10.0);
    let belt = Belt::new(0.01, 1.0, 0.05, law, vec![dither]).expect("a belt");
    let over = over_velocities(&belt);
    for window in [(0.05, 1.0), (0.15, 0.25), (0.05, 2.0), (1.0, 0.05), (0.19, 0.21)] {
        let found = thresholds(&over, window);
        let kind = ThresholdKind::Grazing;
        let grazing = found.iter().find(|(_, found)| *found == kind).expect("a grazing");
        assert!((grazing.0 - 0.201_946_265_931_5).abs() < 1e-9, "{window:?}: {found:?}");
    }
    assert_eq!(assert_tiled(&over, (0.05, 1.0)), 2);
    // The value is that at which the amplitude grazes.
    let at = belt.at_speed(0.201_946_265_931_5);
    let found = thresholds(&over_amplitudes(&at), (1.9, 2.1));
    assert!((found[0].0 - 2.0).abs() < 1e-8 && found[0].1 == ThresholdKind::Grazing, "{found:?}");
}

#[test]
fn random_belts_have_the_same_thresholds_in_wide_and_narrow_windows() {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = |from: f64, to: f64| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        from + (to - from) * ((state >> 11) as f64 / (1u64 << 53) as f64)
    };
    let mut count = 0;
    for number in 0..24 {
        let level = random(0.2, 0.6);
        let law = [level, level * random(0.5, 0.95), 0.05 * random(0.0, 2.3).exp()];
        let law = LawKind::Decreasing.build(&law).expect("a law");
        let waveforms = [Waveform::Sine, Waveform::Square, Waveform::Triangle];
        let dither = Dither {
            direction: Direction::Tangential,
            waveform: waveforms[number % 3].clone(),
            amplitude: random(0.05, 3.0),
            frequency_ratio: random(2.5, 14.0),
            phase: 0.0,
            envelope: None,
        };
        let velocity = 0.01 * random(0.0, 3.9).exp();
        let damping = 1e-3 * random(0.0, 4.6).exp();
        let belt = Belt::new(damping, 1.0, velocity, law, vec![dither.clone()]).expect("a belt");
        count += match number % 2 {
            0 => {
                let window = (0.02 * dither.amplitude, 3.0 * dither.amplitude);
                assert_tiled(&over_amplitudes(&belt), window)
            }
            _ => assert_tiled(&over_velocities(&belt), (0.2 * velocity, 20.0 * velocity)),
        };
    }
    assert!(count > 20, "{count}");
}
