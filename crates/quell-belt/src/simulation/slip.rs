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

use quell_model::friction::{BranchSeries, SlidingLaw};
use quell_numerics::lane::{Lane, partial_product};

use super::ORDER;

const _: () = assert!(ORDER == 16, "the kernel is unrolled for order 16");

/// 1/k for k = 1…ORDER (entry 0 unused).
const INVERSE: [f64; ORDER + 1] = {
    let mut table = [0.0; ORDER + 1];
    let mut k = 1;
    while k <= ORDER {
        table[k] = 1.0 / k as f64;
        k += 1;
    }
    table
};

/// Constants of the slip equation, in units of the velocity scale.
#[derive(Clone, Copy, Debug)]
pub(super) struct SlipEquation<V> {
    /// 2ζ.
    pub(super) damping: V,
    /// ν = v₀/v_m.
    pub(super) belt_velocity: V,
}

/// The normal load along a step.
#[derive(Clone, Copy, Debug)]
pub(super) enum Load<'a, V> {
    /// Constant.
    Steady(V),
    /// With normal dither.
    Series(&'a [V; ORDER + 1]),
}

/// Where a step of slip starts.
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

impl<V: Lane> SlipEquation<V> {
    /// Series of y and w to order [`ORDER`] from `start`, under the tangential dither's
    /// coefficients and the load.
    #[expect(
        clippy::out_of_bounds_indexing,
        reason = "the last turn of the unrolled loop is empty, K < ORDER is false there"
    )]
    #[inline(always)]
    pub(super) fn series<L: SlidingLaw>(
        &self,
        law: &L,
        start: SlipStart<V>,
        dither: &[V; ORDER + 1],
        load: Load<'_, V>,
    ) -> SlipSeries<V> {
        let mut y = [V::splat(0.0); ORDER + 1];
        let mut w = [V::splat(0.0); ORDER + 1];
        let mut mu = [V::splat(0.0); ORDER + 1];
        y[0] = start.displacement;
        w[0] = start.slip;
        let mut branch = law.series::<V, { ORDER + 1 }>(start.sign, start.slip);
        let slope = branch.slope();
        let load_now = match load {
            Load::Steady(load) => load,
            Load::Series(load) => load[0],
        };
        // w′ to first order in the newest coefficient of w: −(2ζ + n μ′)wₖ.
        let newest = -load_now.mul_add(slope, self.damping);
        let velocity = self.belt_velocity - w[0];
        mu[0] = branch.first();
        y[1] = velocity;
        let elastic = self.damping.mul_add(velocity, y[0] - dither[0]);
        w[1] = (-load_now).mul_add(mu[0], elastic) * start.first_slope;
        quell_numerics::for_each_order_below_16!(J, {
            const K: usize = J + 1;
            if K < ORDER {
                let inverse = V::splat(INVERSE[K + 1]);
                let lower = branch.lower(K, &w);
                let known = (-load_now).mul_add(lower, y[K] - dither[K]);
                let known = match load {
                    Load::Steady(_) => known,
                    Load::Series(load) => {
                        mu[K] = slope.mul_add(w[K], lower);
                        known - partial_product(load, &mu, K, 1, K)
                    }
                };
                // Two products apart, so that the newest coefficient waits for one operation only.
                w[K + 1] = (newest * inverse).mul_add(w[K], known * inverse);
                y[K + 1] = -(w[K] * inverse);
            }
        });
        SlipSeries { displacement: y, slip: w }
    }
}
