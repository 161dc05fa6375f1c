//! What an analysis says about stability: a growth rate, its error bound, and the verdict they allow.

/// Whether the disc squeals.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// Every motion decays: the growth rate is below zero by more than its error.
    Stable,
    /// Some motion grows: the growth rate is above zero by more than its error.
    Unstable,
    /// The growth rate is zero within its error. So it is on whole lines of the map at ξ = 0, where one combination of two
    /// waves is out of the load's reach.
    Undecided,
}

impl Verdict {
    /// Word in outputs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::Unstable => "unstable",
            Self::Undecided => "undecided",
        }
    }
}

/// Distances at which the verdict on the two sides of a change is evaluated, until it is decided. The least is well above the
/// rounding of the change itself; at the largest, a second change closer than that would be mistaken for one.
const ASIDE: [f64; 4] = [1e-10, 1e-8, 1e-6, 1e-4];

/// The verdicts below and beyond a change, as close to it as they are decided; `at` gives the verdict at a signed distance, in
/// units that the caller chooses.
///
/// # Errors
/// The first error of `at`.
pub(crate) fn verdicts_around<E>(
    at: impl Fn(f64) -> Result<Verdict, E>,
) -> Result<[Verdict; 2], E> {
    let side = |sign: f64| {
        for distance in ASIDE {
            let verdict = at(sign * distance)?;
            if verdict != Verdict::Undecided {
                return Ok(verdict);
            }
        }
        Ok(Verdict::Undecided)
    };
    Ok([side(-1.0)?, side(1.0)?])
}

/// Largest growth rate with its error bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Growth {
    /// Growth rate: the largest Re ρ, per unit of τ = ω_ref t.
    pub rate: f64,
    /// Bound on its error.
    pub error: f64,
    /// Frequency |Im ρ| in ω_ref; under dither between 0 and R/2, for exponents are known up to multiples of iR.
    pub frequency: f64,
}

impl Growth {
    /// The verdict that rate and error allow.
    pub fn verdict(&self) -> Verdict {
        if self.rate > self.error {
            Verdict::Unstable
        } else if self.rate < -self.error {
            Verdict::Stable
        } else {
            Verdict::Undecided
        }
    }
}

/// Growth rate of small slow motions of one mass, Re ρ of ρ² + cρ + 1 = 0 with the averaged criterion c = 2ζ + Fμ̄′ (2.26).
pub fn of_criterion(criterion: f64) -> f64 {
    let half = 0.5 * criterion;
    let overdamped = (half.abs() - 1.0).max(0.0) * (half.abs() + 1.0);
    overdamped.sqrt() - half
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn growth_rates_solve_the_characteristic_equation() {
        for criterion in [-0.3, 0.0, 0.01, 1.9] {
            assert_eq!(of_criterion(criterion), -0.5 * criterion);
        }
        for criterion in [-5.0, 2.5, 40.0] {
            let rate = of_criterion(criterion);
            assert!((rate * rate + criterion * rate + 1.0).abs() < 1e-12 * criterion * criterion);
        }
    }
}
