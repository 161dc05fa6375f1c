//! Waveforms g: symmetry, peak, pieces, names.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

use quell_model::Waveform;
use quell_model::waveform::Piece;

/// Phases in (0, 2π), none of them a break of a waveform made of fractions of π.
pub(crate) fn phases() -> impl Iterator<Item = f64> {
    (0..997).map(|i| (f64::from(i) + 0.371) * TAU / 997.0)
}

/// Pieces with the phases that open and close them; the last may close beyond 2π.
fn spans(waveform: &Waveform) -> Vec<(f64, f64, Piece)> {
    let (breaks, pieces) = (waveform.breaks(), waveform.pieces());
    if breaks.is_empty() {
        return vec![(0.0, TAU, pieces[0])];
    }
    let mut closes = breaks[1..].to_vec();
    closes.push(breaks[0] + TAU);
    let ends = breaks.iter().copied().zip(closes);
    ends.zip(pieces).map(|((open, close), &piece)| (open, close, piece)).collect()
}

fn along(piece: Piece, open: f64, phase: f64) -> f64 {
    match piece {
        Piece::Harmonic => phase.sin(),
        Piece::Affine { value, slope } => value + slope * (phase - open),
    }
}

#[test]
fn waves_are_odd_and_periodic() {
    for waveform in Waveform::NAMED {
        for phase in phases() {
            let value = waveform.value(phase);
            let mirrored = waveform.value(-phase);
            assert!((value + mirrored).abs() < 4e-15, "{waveform:?}({phase})");
            for periods in [-3.0, -1.0, 1.0, 1000.0] {
                // θ + 2πn is known to half a unit of its last place; slopes are at most 1.
                let allowed = 4e-15 + f64::EPSILON * TAU * f64::abs(periods);
                let later = waveform.value(phase + TAU * periods);
                assert!(
                    (later - value).abs() < allowed,
                    "{waveform:?}({phase}) + {periods} periods"
                );
            }
        }
    }
}

#[test]
fn waves_have_unit_peak() {
    for waveform in Waveform::NAMED {
        let ends = spans(waveform).into_iter().flat_map(|(open, close, _)| [open, close - 1e-12]);
        let quarters = (0..8).map(|k| f64::from(k) * FRAC_PI_4);
        let mut peak: f64 = 0.0;
        for phase in phases().chain(ends).chain(quarters) {
            peak = peak.max(waveform.value(phase).abs());
        }
        assert!((peak - 1.0).abs() < 1e-12, "{waveform:?}: peak {peak}");
    }
}

#[test]
fn breaks_ascend_within_one_period_and_each_opens_a_piece() {
    for waveform in Waveform::NAMED {
        let breaks = waveform.breaks();
        assert!(breaks.iter().all(|phase| (0.0..TAU).contains(phase)), "{waveform:?}");
        assert!(breaks.windows(2).all(|pair| pair[0] < pair[1]), "{waveform:?}");
        assert_eq!(waveform.pieces().len(), breaks.len().max(1), "{waveform:?}");
    }
}

/// The engine integrates the pieces and everything else calls `value`: both are the same wave.
#[test]
fn pieces_agree_with_the_value_on_both_sides_of_every_break() {
    for waveform in Waveform::NAMED {
        for (open, close, piece) in spans(waveform) {
            assert_eq!(waveform.value(open), along(piece, open, open), "{waveform:?} at {open}");
            let width = close - open;
            for phase in [open + 1e-9, open + 0.3 * width, open + 0.8 * width, close - 1e-9] {
                let difference = waveform.value(phase) - along(piece, open, phase);
                assert!(difference.abs() < 4e-15, "{waveform:?} at {phase}: {difference:e}");
            }
        }
    }
}

/// A break without a kink or a jump would cost the engine an unnecessary step.
#[test]
fn every_break_is_a_kink_or_a_jump() {
    for waveform in Waveform::NAMED {
        let spans = spans(waveform);
        if waveform.breaks().is_empty() {
            continue;
        }
        for (index, &(open, _, after)) in spans.iter().enumerate() {
            let before = spans[(index + spans.len() - 1) % spans.len()];
            let arriving = |back: f64| along(before.2, before.0, before.1 - back);
            let jump = (along(after, open, open) - arriving(0.0)).abs();
            let slope_before = (arriving(0.0) - arriving(0.01)) / 0.01;
            let slope_after = (along(after, open, open + 0.01) - along(after, open, open)) / 0.01;
            assert!(jump.max((slope_after - slope_before).abs()) > 0.1, "{waveform:?} at {open}");
        }
    }
}

#[test]
fn names_round_trip() {
    for (index, waveform) in Waveform::NAMED.iter().enumerate() {
        assert_eq!(Waveform::from_name(waveform.name()), Some(waveform.clone()));
        assert!(Waveform::NAMED[..index].iter().all(|other| other.name() != waveform.name()));
    }
    for unknown in ["", "no such wave", "Sine"] {
        assert_eq!(Waveform::from_name(unknown), None);
    }
}

/// Stored numbers: g at 0, π/4, π/2, π, 5π/4, 3π/2; G_max, ⟨G²⟩, √⟨g²⟩ as printed.
#[test]
fn waves_of_the_dissertation_have_its_values() {
    let half = 0.5_f64.sqrt();
    for (waveform, values, facts) in [
        (Waveform::Sine, [0.0, half, 1.0, 0.0, -half, -1.0], [1.0, 0.5, half]),
        (
            Waveform::Triangle,
            [0.0, 0.5, 1.0, 0.0, -0.5, -1.0],
            [FRAC_PI_4, PI * PI / 30.0, (1.0_f64 / 3.0).sqrt()],
        ),
        (Waveform::Square, [1.0, 1.0, 1.0, -1.0, -1.0, -1.0], [FRAC_PI_2, PI * PI / 12.0, 1.0]),
    ] {
        for (quarter, value) in [0.0, 0.5, 1.0, 2.0, 2.5, 3.0].into_iter().zip(values) {
            let found = waveform.value(quarter * FRAC_PI_2);
            assert!((found - value).abs() < 1e-15, "{waveform:?} at {quarter} π/2: {found}");
        }
        let found = [
            waveform.peak_integral(),
            waveform.mean_square_integral(),
            waveform.root_mean_square(),
        ];
        for (found, fact) in found.into_iter().zip(facts) {
            assert!((found - fact).abs() < 2e-16, "{waveform:?}: {found} against {fact}");
        }
    }
}
