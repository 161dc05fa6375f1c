//! Taylor series of slip on one branch of the friction law.
//!
//! With lengths in units of the law's velocity scale v_m, w = v_r/v_m, y = x/v_m, ν = v₀/v_m:
//!
//! ```text
//! y′ = ν − w
//! w′ = 2ζ(ν − w) + y − μ(w)·n(τ) − p(τ)
//! ```
//!
//! n is the normal load, p the tangential dither. The kernel is written over [`Lane`], so
//! that the same code runs one trajectory or several side by side.

use quell_model::friction::{BranchSeries, LawSeries};
use quell_numerics::lane::{Lane, horner, partial_product};
use quell_numerics::polynomial::side_by_side::margin_of_no_root;
use quell_numerics::polynomial::step_length;

use super::lane_row::LaneRow;
use super::taylor::{ORDER, RECIPROCALS};

const _: () = assert!(ORDER == 16, "the kernel is unrolled for order 16");

/// Constants of the slip equation, in units of the velocity scale.
#[derive(Clone, Copy, Debug)]
pub(super) struct SlipEquation<V> {
    /// 2ζ.
    pub(super) damping: V,
    /// ν = v₀/v_m.
    pub(super) belt_velocity: V,
}

/// Limits on the length of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct StepLimits<V> {
    /// Tolerance in units of the velocity scale.
    pub(super) tolerance: V,
    /// ORDER/2 radians of the fastest oscillation.
    pub(super) longest: V,
    /// Time to the next moment that no step may pass.
    pub(super) room: V,
}

/// The normal load along a step.
#[derive(Clone, Copy, Debug)]
pub(super) enum StepLoad<'a, V> {
    /// Constant.
    Steady(V),
    /// With normal dither.
    Series(&'a [V; ORDER + 1]),
}

/// The start of a slip step.
#[derive(Clone, Copy, Debug)]
pub(super) struct SlipStart<V> {
    /// Sign of the branch.
    pub(super) sign: V,
    /// y.
    pub(super) displacement: V,
    /// w.
    pub(super) slip: V,
    /// 0 where w′ vanishes by definition (a smooth release), else 1.
    pub(super) first_slope: V,
}

/// Taylor coefficients of y and w.
#[derive(Clone, Copy, Debug)]
pub(super) struct SlipSeries<V> {
    pub(super) displacement: [V; ORDER + 1],
    pub(super) slip: [V; ORDER + 1],
}

/// Taylor coefficients of a dither at the start of a step: a table times a phasor, plus a straight line.
#[derive(Clone, Copy, Debug)]
pub(super) struct DitherSeries<'a, V> {
    /// D Rᵏ/k! of a harmonic dither, or the complete series of several dithers; the lanes side by side.
    pub(super) table: &'a [LaneRow; ORDER + 1],
    /// sin, cos, −sin, −cos of the phase.
    pub(super) phasor: [V; 4],
    /// Value and slope of the straight part.
    pub(super) line: [V; 2],
}

impl<V: Lane> DitherSeries<'_, V> {
    /// Coefficient k.
    #[inline(always)]
    pub(super) fn coefficient(&self, k: usize) -> V {
        let (table, phasor) = (self.table[k].load::<V>(), self.phasor[k % 4]);
        if k < 2 { table.mul_add(phasor, self.line[k]) } else { table * phasor }
    }

    /// `from` minus coefficient k.
    #[inline(always)]
    fn subtracted(&self, k: usize, from: V) -> V {
        let (table, phasor) = (self.table[k].load::<V>(), self.phasor[k % 4]);
        let rest = if k < 2 { from - self.line[k] } else { from };
        (-table).mul_add(phasor, rest)
    }
}

impl<V: Lane> SlipEquation<V> {
    /// Writes the series of y and w to order [`ORDER`] from `start`, under the tangential dither and the load.
    /// Returns the length of the step.
    #[expect(
        clippy::out_of_bounds_indexing,
        reason = "the last pass of the unrolled loop is empty, K < ORDER is false there"
    )]
    #[inline(always)]
    pub(super) fn series<L: LawSeries>(
        &self,
        law: &mut L::Constants<V>,
        start: SlipStart<V>,
        dither: &DitherSeries<'_, V>,
        load: StepLoad<'_, V>,
        limits: StepLimits<V>,
        out: &mut SlipSeries<V>,
    ) -> V {
        let SlipSeries { displacement: y, slip: w } = out;
        let mut mu = [V::splat(0.0); ORDER + 1];
        y[0] = start.displacement;
        w[0] = start.slip;
        let mut branch = L::series::<V, { ORDER + 1 }>(law, start.sign, start.slip);
        let slope = branch.slope();
        let load_now = match load {
            StepLoad::Steady(load) => load,
            StepLoad::Series(load) => load[0],
        };
        // w′ to first order in the newest coefficient of w: −(2ζ + n μ′)wₖ.
        let newest = -load_now.mul_add(slope, self.damping);
        let velocity = self.belt_velocity - w[0];
        mu[0] = branch.first();
        y[1] = velocity;
        let elastic = self.damping.mul_add(velocity, dither.subtracted(0, y[0]));
        w[1] = (-load_now).mul_add(mu[0], elastic) * start.first_slope;
        quell_numerics::for_each_order_below_16!(J, {
            const K: usize = J + 1;
            if K < ORDER {
                let inverse = V::splat(RECIPROCALS[K + 1]);
                let lower = branch.lower(K, w);
                let known = (-load_now).mul_add(lower, dither.subtracted(K, y[K]));
                let known = match load {
                    StepLoad::Steady(_) => known,
                    StepLoad::Series(load) => {
                        mu[K] = slope.mul_add(w[K], lower);
                        known - partial_product(load, &mu, K, 1, K)
                    }
                };
                // Two separate products, so that the newest coefficient waits for one operation only.
                w[K + 1] = (newest * inverse).mul_add(w[K], known * inverse);
                y[K + 1] = -(w[K] * inverse);
            }
        });
        branch.trusted(w, limits.step(w))
    }
}

impl<V: Lane> StepLimits<V> {
    /// Length of a step along w: the last two retained terms are within the tolerance, and no oscillation of
    /// the problem is covered so far that the terms could be small by chance.
    #[inline(always)]
    fn step(&self, w: &[V; ORDER + 1]) -> V {
        step_length(self.tolerance, w[ORDER], w[ORDER - 1], ORDER).min(self.longest).min(self.room)
    }
}

impl<V: Lane> SlipSeries<V> {
    /// Positive where v_r provably keeps the branch's sign on the whole of a step of this
    /// length, after a zero of multiplicity `zeros` at its start.
    #[inline(always)]
    pub(super) fn margin(&self, zeros: V, length: V) -> V {
        margin_of_no_root(&self.slip, zeros, length)
    }

    /// Positive where v_r leaves a zero of multiplicity `zeros` towards the branch's side.
    #[inline(always)]
    pub(super) fn leaves(&self, sign: V, zeros: V) -> V {
        let twice = zeros.map(|n| if n == 2.0 { 1.0 } else { 0.0 });
        let first = (V::splat(1.0) - twice) * (self.slip[0] + zeros * self.slip[1]);
        twice.mul_add(self.slip[2], first) * sign
    }

    /// y and w at the end of a step.
    #[inline(always)]
    pub(super) fn end(&self, length: V) -> (V, V) {
        (horner(&self.displacement, length), horner(&self.slip, length))
    }
}
