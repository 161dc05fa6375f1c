//! Smooth ordinary differential equations to full accuracy: Gragg's midpoint steps, extrapolated (Bulirsch and Stoer).
//!
//! One step of length H is computed with 2, 4, …, 2k substeps of the modified midpoint rule, whose errors are even in the substep,
//! and extrapolated to substep zero. The difference of the last two extrapolations bounds the error of the step; a step above
//! the tolerance is repeated with half the length. The right-hand side must be smooth between the two ends.
//!
//! Reference: E. Hairer, S. P. Nørsett, G. Wanner, *Solving Ordinary Differential Equations I* (2nd ed. 1993), sec. II.9.

/// Columns of the extrapolation: order 2·COLUMNS.
const COLUMNS: usize = 8;

/// Shortest step over the whole interval.
const SHORTEST: f64 = 1e-9;

/// Largest number of steps.
const MOST_STEPS: usize = 200_000;

/// Why an integration ended early.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Unintegrated {
    /// The tolerance needs steps that are too short or too many.
    StepTooShort {
        /// Where.
        time: f64,
    },
    /// The solution overflows.
    NotFinite {
        /// Where.
        time: f64,
    },
}

impl std::fmt::Display for Unintegrated {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::StepTooShort { time } => write!(f, "the steps become too short at time {time}"),
            Self::NotFinite { time } => write!(f, "the solution overflows at time {time}"),
        }
    }
}

impl std::error::Error for Unintegrated {}

/// Integrates ẏ = f(t, y) from `from` to `to` with steps of at most `longest`; calls `at_step(t, y)` after each. Returns a bound on
/// the sum of the errors of the steps, in the largest norm of y relative to 1 + |y|.
///
/// # Errors
/// [`Unintegrated`].
pub fn integrate(
    f: &mut impl FnMut(f64, &[f64], &mut [f64]),
    (from, to): (f64, f64),
    y: &mut [f64],
    (tolerance, longest): (f64, f64),
    mut at_step: impl FnMut(f64, &[f64]),
) -> Result<f64, Unintegrated> {
    let span = to - from;
    let mut workspace = Workspace::new(y.len());
    let (mut time, mut length, mut errors) = (from, longest.min(span), 0.0);
    for _ in 0..MOST_STEPS {
        if time >= to {
            return Ok(errors);
        }
        let last = time + length >= to - 1e-12 * span;
        let step = if last { to - time } else { length };
        let error = workspace.step(f, time, step, y);
        if !error.is_finite() && step <= SHORTEST * span {
            return Err(Unintegrated::NotFinite { time });
        }
        if error.is_nan() || error > tolerance {
            length = 0.5 * step;
            if length < SHORTEST * span {
                return Err(Unintegrated::StepTooShort { time });
            }
            continue;
        }
        y.copy_from_slice(workspace.value());
        time = if last { to } else { time + step };
        errors += error;
        at_step(time, y);
        if error < 1e-2 * tolerance {
            length = (1.5 * step).min(longest);
        }
    }
    Err(Unintegrated::StepTooShort { time })
}

struct Workspace {
    slope: Vec<f64>,
    before: Vec<f64>,
    now: Vec<f64>,
    /// The last row of the extrapolation: entry k is of order 2(k + 1).
    row: Vec<Vec<f64>>,
}

impl Workspace {
    fn new(size: usize) -> Self {
        let zeros = || vec![0.0; size];
        let row = (0..COLUMNS).map(|_| zeros()).collect();
        Self { slope: zeros(), before: zeros(), now: zeros(), row }
    }

    /// The value after the last step.
    fn value(&self) -> &[f64] {
        &self.row[COLUMNS - 1]
    }

    /// One step of length H. Returns its error: the difference of the two highest orders.
    fn step(
        &mut self,
        f: &mut impl FnMut(f64, &[f64], &mut [f64]),
        time: f64,
        length: f64,
        y: &[f64],
    ) -> f64 {
        for column in 0..COLUMNS {
            let count = 2 * (column + 1);
            self.midpoint(f, (time, length), y, count);
            // T(j, k+1) = T(j, k) + (T(j, k) − T(j−1, k))/((n_j/n_{j−k−1})² − 1), in place along the row.
            for i in 0..y.len() {
                let mut value = self.now[i];
                for k in 0..column {
                    let old = std::mem::replace(&mut self.row[k][i], value);
                    let ratio = count as f64 / (2 * (column - k)) as f64;
                    value += (value - old) / ratio.mul_add(ratio, -1.0);
                }
                self.row[column][i] = value;
            }
        }
        let (high, low) = (&self.row[COLUMNS - 1], &self.row[COLUMNS - 2]);
        let errors = high.iter().zip(low).map(|(a, b)| (a - b).abs() / (1.0 + a.abs()));
        errors.fold(
            0.0,
            |most: f64, error| {
                if most.is_nan() || error.is_nan() { f64::NAN } else { most.max(error) }
            },
        )
    }

    /// The modified midpoint rule with `count` substeps, into `now`.
    fn midpoint(
        &mut self,
        f: &mut impl FnMut(f64, &[f64], &mut [f64]),
        (time, length): (f64, f64),
        y: &[f64],
        count: usize,
    ) {
        let h = length / count as f64;
        self.before.copy_from_slice(y);
        f(time, y, &mut self.slope);
        for ((now, y), slope) in self.now.iter_mut().zip(y).zip(&self.slope) {
            *now = h.mul_add(*slope, *y);
        }
        for k in 1..count {
            f((k as f64).mul_add(h, time), &self.now, &mut self.slope);
            for ((now, before), slope) in self.now.iter_mut().zip(&mut self.before).zip(&self.slope)
            {
                let next = (2.0 * h).mul_add(*slope, *before);
                *before = std::mem::replace(now, next);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_oscillator_returns_after_a_period() {
        let mut y = [1.0, 0.0];
        let mut f = |_: f64, y: &[f64], slope: &mut [f64]| {
            slope[0] = y[1];
            slope[1] = -y[0];
        };
        let (tolerance, longest) = (1e-15, 1.0);
        let error = integrate(
            &mut f,
            (0.0, std::f64::consts::TAU),
            &mut y,
            (tolerance, longest),
            |_, _| {},
        )
        .expect("smooth");
        assert!((y[0] - 1.0).abs() < 1e-14 && y[1].abs() < 1e-14, "{y:?}");
        assert!(error < 1e-13);
    }

    #[test]
    fn a_pole_is_reported() {
        let mut y = [1.0];
        let mut f = |_: f64, y: &[f64], slope: &mut [f64]| slope[0] = y[0] * y[0];
        let ended = integrate(&mut f, (0.0, 2.0), &mut y, (1e-12, 0.1), |_, _| {});
        assert!(ended.is_err(), "{ended:?}");
    }
}
