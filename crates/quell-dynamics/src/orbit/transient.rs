//! Whether a run still changes: what separates a slow transient from a motion that does not repeat itself.

/// Relative change of the spread of the states from one window to the next at which a run still changes. The spread of a motion on a
/// torus or of a chaotic one varies by less in windows of hundreds of periods; a decay that is slower than this per window is
/// not noticed.
const SPREAD_CHANGES: f64 = 0.02;

/// The same of the mean, over the spread.
const MEAN_CHANGES: f64 = 0.1;

/// Whether the states of the last two quarters of a run have the same mean and the same spread. With fewer than eight states nothing is
/// known, and the run counts as one that changes.
pub(super) fn is_steady(states: &[Vec<f64>]) -> bool {
    let quarter = states.len() / 4;
    if quarter < 2 {
        return false;
    }
    let (before, last) = states[states.len() - 2 * quarter..].split_at(quarter);
    let (one, other) = (StateWindow::of(before), StateWindow::of(last));
    let shift = one.mean.iter().zip(&other.mean).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
    let (one, other) = (libm::sqrt(one.spread), libm::sqrt(other.spread));
    (one - other).abs() <= SPREAD_CHANGES * one
        && libm::sqrt(shift) <= MEAN_CHANGES * one.max(other)
}

/// Mean of some states, and their mean squared distance from it.
struct StateWindow {
    mean: Vec<f64>,
    spread: f64,
}

impl StateWindow {
    fn of(states: &[Vec<f64>]) -> Self {
        let count = states.len() as f64;
        let size = states.first().map_or(0, Vec::len);
        let mean: Vec<f64> =
            (0..size).map(|i| states.iter().map(|state| state[i]).sum::<f64>() / count).collect();
        let off = |state: &Vec<f64>| -> f64 {
            state.iter().zip(&mean).map(|(x, mean)| (x - mean) * (x - mean)).sum()
        };
        let spread = states.iter().map(off).sum::<f64>() / count;
        Self { mean, spread }
    }
}

#[cfg(test)]
mod tests {
    use super::is_steady;

    fn run(count: u32, state: impl Fn(f64) -> [f64; 2]) -> Vec<Vec<f64>> {
        (0..count).map(|k| state(f64::from(k)).to_vec()).collect()
    }

    #[test]
    fn a_decay_changes_and_a_torus_does_not() {
        let turning = |k: f64, size: f64| [size * libm::cos(0.61 * k), size * libm::sin(0.61 * k)];
        assert!(is_steady(&run(1000, |k| turning(k, 0.3))));
        assert!(!is_steady(&run(1000, |k| turning(k, 0.3 * libm::exp(-k / 5000.0)))));
        assert!(!is_steady(&run(1000, |k| turning(k, 1e-9 * libm::exp(k / 5000.0)))));
        assert!(!is_steady(&run(1000, |k| [libm::cos(0.61 * k) + 1e-3 * k, 0.0])), "drift");
        assert!(!is_steady(&run(7, |k| turning(k, 0.3))), "too short");
    }
}
