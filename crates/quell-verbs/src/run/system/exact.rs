//! `stability --exact` of a system: Floquet exponents of its dithered motion in pure slip.

use quell_linear::growth::{Growth, Verdict};
use quell_linear::pure_slip::{SlipExponent, SlipOrbit, orbit};
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::{failed, has_equations, oscillating, rate_of};
use crate::complaint::Failure;
use crate::fields::Fields;
use crate::study::SystemStudy;

/// The exact verdict on a system in pure slip.
#[derive(Clone, Debug)]
pub struct ExactStability {
    /// The periodic motion and its exponents.
    pub orbit: SlipOrbit,
}

/// The exact verdict on a study's system.
///
/// # Errors
/// [`Failure::Failed`] without dither, and where the dithered motion is not pure slip, with the contact and the reason.
pub fn run(study: &SystemStudy) -> Result<ExactStability, Failure> {
    has_equations(study, "stability --exact")?;
    if !study.system().is_dithered() {
        let why = "the study has no dither: the eigenvalues of `stability` are exact";
        return Err(failed("stability", why));
    }
    let orbit = orbit(study.system()).map_err(|why| failed("stability", why))?;
    Ok(ExactStability { orbit })
}

impl ExactStability {
    /// The answer in one sentence.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let Growth { rate, error, frequency } = self.orbit.growth();
        let units = study.units();
        match self.orbit.growth().verdict() {
            Verdict::Stable => format!(
                "The dithered motion in pure slip is stable: every deviation decays, the slowest at the rate {}.",
                rate_of(units, -rate)
            ),
            Verdict::Unstable => format!(
                "The dithered motion in pure slip is unstable: a deviation {} (up to multiples of that of the motion) grows at the \
                 rate {}.",
                oscillating(units, frequency),
                rate_of(units, rate)
            ),
            Verdict::Undecided => format!(
                "The stability of the dithered motion in pure slip is undecided: the largest growth rate is zero within its error, \
                 {error:.1e}."
            ),
        }
    }

    /// As JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let units = study.units();
        let Growth { rate, error, frequency } = self.orbit.growth();
        let mut fields = Fields::in_units(units);
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("verdict", self.orbit.growth().verdict().name())
            .plain("protocol", "floquet")
            .rate("growth_rate", rate)
            .rate("growth_rate_error", error)
            .number("frequency", Quantity::FrequencyRatio, frequency)
            .number("period", Quantity::Time, self.orbit.period)
            .plain("state", self.orbit.state.clone())
            .plain("residual", self.orbit.residual);
        let exponents = self.orbit.exponents.iter().map(|found: &SlipExponent| {
            let mut inner = Fields::in_units(units);
            inner
                .rate("growth_rate", found.exponent.re)
                .rate("growth_rate_error", found.error)
                .number("frequency", Quantity::FrequencyRatio, found.exponent.im)
                .plain("multiplier", vec![found.multiplier.re, found.multiplier.im]);
            inner
        });
        fields.list("exponents", exponents.collect::<Vec<_>>());
        fields.plain("warnings", study.warnings());
        fields.finish()
    }
}
