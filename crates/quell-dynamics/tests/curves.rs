//! Curves of thresholds in two parameters.

use quell_dynamics::orbit::{ThresholdCurveEnd, ThresholdKind, ThresholdPlane, threshold_curves};
use quell_model::Waveform;
use quell_numerics::interval::RealInterval;
use quell_zoo::BeltExt;
use quell_zoo::belt::{decreasing_under, over_amplitude_and_velocity, over_amplitudes};

use crate::local_thresholds;

/// Both thresholds of the amplitude over the belt velocity; each point of a curve is a threshold at its own velocity.
#[test]
fn amplitude_over_belt_velocity() {
    let belt = decreasing_under(Waveform::Sine, 1.0);
    let at = over_amplitude_and_velocity(&belt);
    let plane = ThresholdPlane {
        at: &at,
        window: RealInterval::new(0.1, 16.0),
        between: RealInterval::new(0.85, 1.5),
        points: 60,
    };
    let found = threshold_curves(&plane, 3).expect("curves").curves;
    for curve in &found {
        println!("{:?} {:?} {} points", curve.kind, curve.ends, curve.points.len());
    }
    assert_eq!(found.len(), 2);
    for (kind, at_one) in
        [(ThresholdKind::NeimarkSacker, 4.322_392_624), (ThresholdKind::Grazing, 9.900_214_849)]
    {
        let curve = found.iter().find(|curve| curve.kind == kind).expect("a curve");
        assert!(
            curve.points.len() > 30 && curve.ends.contains(&ThresholdCurveEnd::Window),
            "{:?}",
            curve.ends
        );
        let nearest = curve
            .points
            .iter()
            .min_by(|a, b| (a.along - 1.0).abs().total_cmp(&(b.along - 1.0).abs()));
        let nearest = nearest.expect("points");
        assert!((nearest.value - at_one).abs() < 30.0 * (nearest.along - 1.0).abs() + 1e-6);
        for point in curve.points.iter().step_by(9) {
            let belt = belt.at_speed(point.along);
            let (from, to) = (0.8 * point.value, (1.1 * point.value).min(16.0));
            let line = local_thresholds(&over_amplitudes(&belt), RealInterval::new(from, to), 20);
            let of_kind = line.iter().filter(|threshold| threshold.kind == kind);
            let off = of_kind.map(|threshold| (threshold.value - point.value).abs());
            let off = off.fold(f64::INFINITY, f64::min);
            assert!(off < 1e-7, "{kind:?} at {}: {off:e}", point.along);
        }
    }
}
