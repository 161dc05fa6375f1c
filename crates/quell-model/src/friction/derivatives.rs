//! The first derivatives of a law, from its recurrence.

use super::{BranchSeries, Friction, FrictionConstants};

impl Friction {
    /// μ, μ′, μ″ and μ‴ at a slip velocity γ, per unit of velocity: μ is odd, so that the first and third are even in γ. At γ = 0
    /// those of the branch γ > 0.
    pub fn derivatives(&self, slip: f64) -> [f64; 4] {
        let scale = self.velocity_scale();
        let sign = if slip < 0.0 { -1.0 } else { 1.0 };
        let scaled = [slip / scale, 1.0, 0.0, 0.0];
        let mut constants = FrictionConstants::of(self);
        let mut branch = constants.series::<4>(sign, scaled[0]);
        let slope = branch.slope();
        // w = w₀ + t: the terms beyond the first have no part from the slope, and the k-th derivative is k! times its term.
        let mut derivatives = [branch.first(), slope / scale, 0.0, 0.0];
        let _ = branch.lower(1, &scaled[..1]);
        derivatives[2] = 2.0 * branch.lower(2, &scaled[..2]) / (scale * scale);
        derivatives[3] = 6.0 * branch.lower(3, &scaled[..3]) / (scale * scale * scale);
        derivatives
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Expression, LawKind};
    use super::*;

    /// The derivatives of every law agree with differences of the one before, on both branches.
    #[test]
    fn each_derivative_is_that_of_the_one_before() {
        let formula = "0.3 + 0.1*exp(-abs(v)/0.2) + 0.05*v^2/(1 + v^2)";
        let laws = [
            LawKind::Stribeck.build(&[0.4, 0.2857, 0.2]),
            LawKind::StribeckExponential.build(&[0.25, 0.4, 0.1, 2.0, 0.05]),
            LawKind::StribeckExponential.build(&[0.25, 0.4, 0.1, 1.5, 0.0]),
            LawKind::Decreasing.build(&[0.4, 0.25, 0.1]),
            LawKind::Coulomb.build(&[0.3, 0.3, 0.0]),
            Expression::new(formula, &[], None, 1.0).map(Friction::Expression),
        ];
        for law in laws {
            let law = law.expect("valid");
            for slip in [0.07, -0.13, 0.21] {
                let at = law.derivatives(slip);
                let value = slip.signum() * law.coefficient(slip.abs());
                assert!((at[0] - value).abs() < 1e-15, "{law:?}");
                assert!((at[1] - law.slope(slip.abs())).abs() < 1e-13, "{law:?}");
                let step = 1e-4;
                let (after, before) = (law.derivatives(slip + step), law.derivatives(slip - step));
                for k in 0..3 {
                    let difference = (after[k] - before[k]) / (2.0 * step);
                    let size = at[k + 1].abs().max(at[k].abs());
                    let off = (difference - at[k + 1]).abs();
                    assert!(off <= 1e-4 * size.max(1e-9), "{law:?} {slip} {k}: {off}");
                }
            }
        }
    }

    #[test]
    fn the_stribeck_law_has_its_closed_derivatives() {
        let law = LawKind::Stribeck.build(&[0.4, 0.25, 0.2]).expect("valid");
        let fall = 1.5 * 0.15;
        let [_, slope, bend, third] = law.derivatives(0.05);
        let w: f64 = 0.25;
        assert!((slope - -fall * (1.0 - w * w) / 0.2).abs() < 1e-14);
        assert!((bend - fall * 2.0 * w / 0.04).abs() < 1e-13);
        assert!((third - fall * 2.0 / 0.008).abs() < 1e-11);
    }
}
