//! Taylor series of a law along a slip, and the functions that several laws share to compute them.

use quell_numerics::lane::{Lane, MOST_LANES};

/// Taylor coefficients μ₀, μ₁, … of the coefficient along a slip w(t) = Σ wₖtᵏ.
///
/// μₖ = μ′(w₀)·wₖ + (a part that depends only on w₀…wₖ₋₁): with separate parts the engine can prepare the
/// second while wₖ is still being computed, which halves the time of a scalar step.
pub trait BranchSeries<V: Lane> {
    /// μ₀, with the sign of the branch.
    fn first(&self) -> V;

    /// μ′(w₀) = dμ/dw on the branch, per unit of w.
    fn slope(&self) -> V;

    /// μₖ − μ′(w₀)wₖ, for k = 1, 2, … in ascending order, given w₀…wₖ₋₁.
    fn lower(&mut self, k: usize, w: &[V]) -> V;

    /// The part of a step of `length` along w, of order `w.len() − 1`, over which the last retained
    /// terms bound the remainder. An exponential that grows from almost zero has negligible last terms
    /// for any step length, so its law must limit the step.
    #[inline(always)]
    fn trusted(&self, w: &[V], length: V) -> V {
        let _ = w;
        length
    }
}

/// Half the order of a step: with c the change of an exponent over the step, the terms of eᶜ decrease from
/// the c-th on, and from k = 2c on each is less than half of the previous one.
#[inline(always)]
pub(super) fn longest_change(order: usize) -> f64 {
    0.5 * order as f64
}

/// The part of `length` over which `times` Σ aₖtᵏ without its first term changes by no more than `most`:
/// every term shrinks at least as fast as the step.
#[inline(always)]
pub(super) fn length_of_change<V: Lane>(series: &[V], times: V, length: V, most: f64) -> V {
    let mut largest = V::splat(0.0);
    for k in (1..series.len()).rev() {
        largest = largest.mul_add(length, series[k].abs());
    }
    let share =
        (largest * length * times).map(|change| if change > most { most / change } else { 1.0 });
    length * share
}

/// One number of each of [`Lane::LANES`] laws, as lanes.
#[inline(always)]
pub(super) fn side_by_side<V: Lane, L>(laws: &[L], number: impl Fn(&L) -> f64) -> V {
    let mut lanes = [0.0; MOST_LANES];
    for (lane, law) in lanes.iter_mut().zip(laws) {
        *lane = number(law);
    }
    V::load(&lanes)
}
