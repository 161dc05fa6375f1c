//! How fast the structure is with its contacts: what sets the time scale of a run, and how long a period is.

use quell_model::Structure;
use quell_numerics::eigen::eigenvalues;
use quell_numerics::matrix::Matrix;

use super::contact_equation::ContactEquation;
use super::own_state::OwnStateKind;

/// The fastest rates of a structure that its contacts close.
#[derive(Clone, Copy, Debug)]
pub(super) struct FastestRates {
    /// Estimate of the fastest rate.
    pub(super) of_all: f64,
    /// Estimate of the fastest oscillation: damping makes rates faster, but no oscillation.
    pub(super) of_oscillations: f64,
}

impl FastestRates {
    /// Of a state matrix with what contacts with states of their own add ([`adhering`]).
    pub(super) fn of(structure: &Structure, closed: Matrix, contacts: &[ContactEquation]) -> Self {
        let closed = with_normal_springs(closed, contacts);
        let of_all = fastest_rate(&closed);
        let of_oscillations = match structure {
            Structure::Mechanical(mechanical) => fastest_rate(&undamped(closed, mechanical.size())),
            Structure::StateSpace(_) => fastest_oscillation(&closed, of_all),
        };
        Self { of_all, of_oscillations }
    }
}

/// The state matrix with elastic sliders that adhere and bristles near rest, for an estimate of its fastest rate.
pub(super) fn adhering(matrix: &Matrix, contacts: &[ContactEquation]) -> Matrix {
    let (size, mut closed) = (matrix.rows(), matrix.clone());
    for contact in contacts {
        let Some(own) = contact.own else { continue };
        let (along, tangent) = (contact.along.dense(size), contact.tangent.dense(size));
        // T = s x_own + d γ, and the rate of x_own is r γ.
        let (share, damping, rate) = match own.kind {
            OwnStateKind::Elastic { stiffness } => (1.0, 0.0, stiffness),
            OwnStateKind::Bristles { stiffness, damping, viscous } => {
                (contact.normal_load * stiffness, contact.normal_load * (damping + viscous), 1.0)
            }
        };
        for i in 0..size {
            closed[(i, own.place)] += along[i] * share;
            closed[(own.place, i)] -= rate * tangent[i];
            for j in 0..size {
                closed[(i, j)] -= along[i] * damping * tangent[j];
            }
        }
    }
    closed
}

/// The state matrix with the springs and dampers that press the contacts.
fn with_normal_springs(mut closed: Matrix, contacts: &[ContactEquation]) -> Matrix {
    for contact in contacts {
        for (i, across) in contact.across.pairs() {
            let row = closed.row_mut(i);
            for (j, approach) in contact.approach.pairs() {
                row[j] -= across * approach;
            }
        }
    }
    closed
}

/// The state matrix of a mechanical structure with `n` coordinates without forces by velocities.
fn undamped(mut closed: Matrix, n: usize) -> Matrix {
    for i in n..2 * n {
        closed.row_mut(i)[n..2 * n].fill(0.0);
    }
    closed
}

/// The fastest oscillation of first-order equations, by their eigenvalues; where none oscillates, the slowest rate, which sets the time
/// of the motion. Without eigenvalues the fastest rate.
fn fastest_oscillation(closed: &Matrix, rate: f64) -> f64 {
    let Ok(values) = eigenvalues(closed) else { return rate };
    let fastest = values.iter().fold(0.0, |most: f64, value| most.max(value.im.abs()));
    if fastest > 0.0 {
        return fastest;
    }
    let rates = values.iter().map(|value| value.re.abs()).filter(|rate| *rate > 0.0);
    rates.fold(rate, f64::min)
}

/// ‖A⁴‖^(1/4) of the structure with the springs of its contacts: an estimate of its fastest rate, which scales time alone.
fn fastest_rate(closed: &Matrix) -> f64 {
    let size = closed.rows();
    // Applied to a vector of ones with the signs of no cancellation: |A| instead of A.
    let mut vector = vec![1.0; size];
    let (mut sum, mut count) = (0.0, 0);
    for pass in 0..8 {
        let next: Vec<f64> = (0..size)
            .map(|i| closed.row(i).iter().zip(&vector).map(|(a, x)| (a * x).abs()).sum())
            .collect();
        let largest = next.iter().fold(0.0, |m: f64, x| m.max(*x));
        if largest == 0.0 || !largest.is_finite() {
            break;
        }
        if pass >= 4 {
            sum += libm::log(largest);
            count += 1;
        }
        vector = next.iter().map(|x| x / largest).collect();
    }
    if count == 0 { 1.0 } else { libm::exp(sum / f64::from(count)) }
}
