//! The rate at which areas of nearby states shrink along a run in slip: 2ζ + μ′(v_r)N, the negative divergence of the equation of
//! motion.
//!
//! Its integral over a period gives the product of an orbit's multipliers. Its mean over a long run decides whether a closed
//! curve attracts. Both use this definition.

use quell_model::Belt;
use quell_model::friction::{LawSeries, LawVisitor};
use quell_numerics::dispatch::{Work, with_fused_multiply_add};
use quell_numerics::lane::horner;

use crate::simulation::Segment;

/// |v_r| and the rate at N moments of a segment of slip, by a function of each law.
pub(crate) fn rates_along<const N: usize>(
    belt: &Belt,
    segment: &Segment<'_>,
    since: &[f64; N],
) -> ([f64; N], [f64; N]) {
    belt.friction().visit(Rates { belt, segment, since })
}

struct Rates<'a, 'c, const N: usize> {
    belt: &'a Belt,
    segment: &'a Segment<'c>,
    since: &'a [f64; N],
}

impl<const N: usize> LawVisitor for Rates<'_, '_, N> {
    type Output = ([f64; N], [f64; N]);

    fn visit<L: LawSeries>(self, law: &L) -> Self::Output {
        with_fused_multiply_add(RatesOf { rates: self, law })
    }
}

struct RatesOf<'a, 'c, 'l, L, const N: usize> {
    rates: Rates<'a, 'c, N>,
    law: &'l L,
}

impl<L: LawSeries, const N: usize> Work for RatesOf<'_, '_, '_, L, N> {
    type Output = ([f64; N], [f64; N]);

    #[inline(always)]
    fn run(self) -> Self::Output {
        let Rates { belt, segment, since } = self.rates;
        let sign = f64::from(segment.slip_sign());
        let (slip, unit) = segment.slip_series();
        let has_normal = belt.has_normal_dither();
        let mut speeds = [0.0; N];
        let mut rates = [0.0; N];
        for k in 0..N {
            speeds[k] = sign * unit * horner(slip, since[k]);
            let load = if has_normal {
                belt.normal_load_at(segment.clock().time() + since[k])
            } else {
                belt.normal_load()
            };
            rates[k] = belt.damping_rate(self.law.slope(speeds[k]), load);
        }
        (speeds, rates)
    }
}

/// The mean rate over a segment of slip by a quadrature rule on [0, 1]: its nodes and weights.
pub(crate) fn mean_rate<const N: usize>(
    belt: &Belt,
    segment: &Segment<'_>,
    [nodes, weights]: &[[f64; N]; 2],
) -> f64 {
    let since = nodes.map(|node| node * segment.duration());
    let (_, rates) = rates_along(belt, segment, &since);
    rates.iter().zip(weights).map(|(rate, weight)| rate * weight).sum()
}
