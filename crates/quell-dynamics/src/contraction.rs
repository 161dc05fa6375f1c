//! The rate at which areas of nearby states shrink along a run in slip: 2ζ + μ′(v_r)N, the negative divergence of the equation of
//! motion.
//!
//! Its integral over a period gives the product of an orbit's multipliers. Its mean over a long run decides whether a closed
//! curve attracts. Both use this definition.

use quell_model::Belt;
use quell_model::friction::{LawVisitor, SlidingLaw};
use quell_numerics::dispatch::{Work, with_fused_multiply_add};
use quell_numerics::lane::horner;

use crate::simulation::Segment;

/// |v_r| and the rate at N moments of a segment of slip, for observers that are compiled for the machine's best instruction set.
#[inline(always)]
pub(crate) fn rates_along<L: SlidingLaw, const N: usize>(
    belt: &Belt,
    law: &L,
    segment: &Segment<'_>,
    since: &[f64; N],
) -> ([f64; N], [f64; N]) {
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
        rates[k] = belt.damping_rate(law.slope(speeds[k]), load);
    }
    (speeds, rates)
}

/// The mean rate over a segment of slip by a quadrature rule on [0, 1]: its nodes and weights.
pub(crate) fn mean_rate<const N: usize>(
    belt: &Belt,
    segment: &Segment<'_>,
    rule: &[[f64; N]; 2],
) -> f64 {
    belt.friction().visit(MeanRate { belt, segment, rule })
}

struct MeanRate<'a, 's, 'c, const N: usize> {
    belt: &'a Belt,
    segment: &'s Segment<'c>,
    rule: &'a [[f64; N]; 2],
}

impl<const N: usize> LawVisitor for MeanRate<'_, '_, '_, N> {
    type Output = f64;

    fn visit<L: SlidingLaw>(self, law: &L) -> f64 {
        with_fused_multiply_add(MeanRateOf { mean: self, law })
    }
}

struct MeanRateOf<'a, 's, 'c, 'l, L, const N: usize> {
    mean: MeanRate<'a, 's, 'c, N>,
    law: &'l L,
}

impl<L: SlidingLaw, const N: usize> Work for MeanRateOf<'_, '_, '_, '_, L, N> {
    type Output = f64;

    #[inline(always)]
    fn run(self) -> f64 {
        let MeanRate { belt, segment, rule: [nodes, weights] } = self.mean;
        let since = nodes.map(|node| node * segment.duration());
        let (_, rates) = rates_along(belt, self.law, segment, &since);
        rates.iter().zip(weights).map(|(rate, weight)| rate * weight).sum()
    }
}
