//! G, the zero-mean integral of a waveform, and the means of g and G, by quadrature.

use std::f64::consts::TAU;

use quell_model::Waveform;

use crate::waveform::phases;

/// Nodes and weights of Gauss and Legendre on [−1, 1], five points: exact for degree 9.
const RULE: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
];

/// ∫ f from `a` to `b` inside one period, split at the breaks of the waveform.
fn integral(waveform: &Waveform, a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let mut ends = vec![a];
    ends.extend(waveform.breaks().iter().filter(|&&phase| phase > a && phase < b));
    ends.push(b);
    let mut sum = 0.0;
    for span in ends.windows(2) {
        // 16 panels of at most 2π/16: the error of the rule is below rounding for sin and sin².
        let half = (span[1] - span[0]) / 32.0;
        for panel in 0..16 {
            let middle = span[0] + half * f64::from(2 * panel + 1);
            for (node, weight) in RULE {
                sum += half * weight * f(middle + half * node);
            }
        }
    }
    sum
}

#[test]
fn g_and_its_integral_have_zero_mean() {
    for waveform in Waveform::NAMED {
        let mean = integral(waveform, 0.0, TAU, |phase| waveform.value(phase)) / TAU;
        assert!(mean.abs() < 1e-15, "{waveform:?}: ⟨g⟩ = {mean}");
        let mean = integral(waveform, 0.0, TAU, |phase| waveform.integral(phase)) / TAU;
        assert!(mean.abs() < 1e-15, "{waveform:?}: ⟨G⟩ = {mean}");
    }
}

/// G(b) − G(a) = ∫ g over intervals inside a piece and across pieces.
/// The quadrature adds up to 240 terms to a sum below π: rounding up to 240·ε/2·π/3 = 3·10⁻¹⁴.
#[test]
fn the_derivative_of_the_integral_is_the_wave() {
    for waveform in Waveform::NAMED {
        let phases: Vec<f64> = phases().step_by(23).collect();
        for (index, &a) in phases.iter().enumerate() {
            for &b in phases[index..].iter().skip(1) {
                let change = waveform.integral(b) - waveform.integral(a);
                let quadrature = integral(waveform, a, b, |phase| waveform.value(phase));
                let error = (change - quadrature).abs();
                assert!(error < 3e-14, "{waveform:?} from {a} to {b}: {error:e}");
            }
        }
    }
}

#[test]
fn the_integral_is_even_and_periodic() {
    for waveform in Waveform::NAMED {
        for phase in phases() {
            let value = waveform.integral(phase);
            for other in [-phase, TAU - phase, phase - TAU, phase + TAU] {
                let found = waveform.integral(other);
                assert!(
                    (found - value).abs() < 4e-15,
                    "{waveform:?}: G({other}) = {found}, {value}"
                );
            }
        }
    }
}

/// The largest |G|, on a grid and then by bisection around its best point.
#[test]
fn the_peak_of_the_integral_has_its_stated_value() {
    for waveform in Waveform::NAMED {
        let size = |phase: f64| waveform.integral(phase).abs();
        let mut best =
            phases().fold(0.0, |best, phase| if size(phase) > size(best) { phase } else { best });
        let mut step = TAU / 997.0;
        while step > 1e-12 {
            for phase in [best - step, best + step] {
                if size(phase) > size(best) {
                    best = phase;
                }
            }
            step *= 0.5;
        }
        let (found, stated) = (size(best), waveform.peak_integral());
        assert!((found - stated).abs() < 1e-11, "{waveform:?}: {found} against {stated}");
    }
}

#[test]
fn mean_squares_have_their_stated_values() {
    for waveform in Waveform::NAMED {
        let square = |x: f64| x * x;
        let found = integral(waveform, 0.0, TAU, |phase| square(waveform.integral(phase))) / TAU;
        let stated = waveform.mean_square_integral();
        assert!((found - stated).abs() < 2e-15, "{waveform:?}: ⟨G²⟩ {found} against {stated}");
        let found = integral(waveform, 0.0, TAU, |phase| square(waveform.value(phase))) / TAU;
        let stated = square(waveform.root_mean_square());
        assert!((found - stated).abs() < 2e-15, "{waveform:?}: ⟨g²⟩ {found} against {stated}");
    }
}
