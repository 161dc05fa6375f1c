//! Whether a Hopf bifurcation of steady sliding is supercritical or subcritical, exactly.
//!
//! About steady sliding the only nonlinear terms are those of the contacts. With δγ = −tᵀδq̇, δN = k nᵀδq + d nᵀδq̇, σ = sᵀδq and
//! the friction T = φμ(γ)N with its factor φ,
//!
//! ```text
//! ẏ = A y + ½B(y, y) + C(y, y, y)/6 + …
//! T₁(a) = φ[μ′N γₐ + μ Nₐ]
//! T₂(a, b) = φ[μ″N γₐγ_b + μ′(γₐN_b + γ_bNₐ)]
//! T₃(a, b, c) = φ[μ‴N γₐγ_bγ_c + μ″(γₐγ_bN_c + γₐN_bγ_c + Nₐγ_bγ_c)]
//! B(a, b) = M⁻¹(t + nσ₀) T₂(a, b) + M⁻¹n [σₐT₁(b) + σ_bT₁(a)]
//! C(a, b, c) = M⁻¹(t + nσ₀) T₃(a, b, c) + M⁻¹n [σₐT₂(b, c) + σ_bT₂(a, c) + σ_cT₂(a, b)]
//! ```
//!
//! with the derivatives of the law from its own recurrence; first-order equations have g in place of M⁻¹(t + nσ₀). The
//! coefficient is that of [`quell_numerics::normal_form`].

use num_complex::Complex64;
use quell_model::System;
use quell_numerics::continuation::criticality::{FirstLyapunov, NoFirstLyapunov};
use quell_numerics::eigen::Decomposition;
use quell_numerics::normal_form::{CriticalPair, DerivativesAlong, conjugate, hopf};
use quell_numerics::polar::modulus;

use crate::linearised::{LinearContact, Linearised};
use crate::spectrum::growth;

/// Largest growth rate of the critical pair over its frequency.
const ON_THE_AXIS: f64 = 1e-6;

/// l₁ of the Hopf bifurcation at which a motion of this angular frequency begins to grow, of a system without dither at the
/// threshold; `linear` are its equations of small motions.
///
/// The critical shape has the Euclidean norm 1 over the coordinates of the study (over the states of first-order equations), so
/// that l₁ has the unit of 1/displacement². Next to the threshold, a limit cycle q₀ + 2r Re(shape e^{iωt}) has r² = −Re λ/(ω l₁).
///
/// # Errors
/// [`NoFirstLyapunov`]; a frequency at which no eigenvalue is on the axis.
pub fn first_lyapunov(
    system: &System,
    linear: &Linearised,
    frequency: f64,
) -> Result<FirstLyapunov, NoFirstLyapunov> {
    let friction = linear.friction();
    if friction.iter().any(|friction| friction.bristles.is_some()) {
        return Err(NoFirstLyapunov::Bristles);
    }
    let matrix = linear.state_matrix_with(&friction);
    let decomposition = Decomposition::new(&matrix).map_err(|_| NoFirstLyapunov::NotCritical)?;
    let target = Complex64::new(0.0, frequency);
    let distances = decomposition.values().iter().map(|z| modulus(*z - target)).enumerate();
    let (index, off) =
        distances.min_by(|a, b| a.1.total_cmp(&b.1)).ok_or(NoFirstLyapunov::NotCritical)?;
    let value = decomposition.values()[index];
    if off.is_nan() || off > ON_THE_AXIS * frequency || value.im <= 0.0 {
        return Err(NoFirstLyapunov::NotCritical);
    }
    let pair = decomposition.pair(index);
    let pair = CriticalPair::new(&pair, linear.coordinates()).ok_or(NoFirstLyapunov::Unmeasured)?;
    let forms = ContactTerms::new(system, linear, &pair.right);
    let found = hopf(&matrix, &pair, &forms).ok_or(NoFirstLyapunov::Singular)?;
    if found.rounding == 0.0 {
        return Err(NoFirstLyapunov::Linear);
    }
    // A pair off the axis changes the coefficient in proportion, like an error of the matrix of that size.
    let off_axis = value.re.abs() / value.im / f64::EPSILON;
    let error = found.rounding * (1.0 + off_axis);
    Ok(FirstLyapunov { value: found.value / value.im, error: error / value.im })
}

/// l₁ of steady sliding at the value of a parameter at which its fastest growing motion begins to grow ([`first_lyapunov`]).
///
/// # Errors
/// As [`first_lyapunov`]; a system without steady sliding.
pub fn of_steady_sliding(system: &System) -> Result<FirstLyapunov, NoFirstLyapunov> {
    let linear = Linearised::new(system).map_err(|_| NoFirstLyapunov::NotCritical)?;
    let growth = growth(&linear, &linear.friction()).map_err(|_| NoFirstLyapunov::NotCritical)?;
    first_lyapunov(system, &linear, growth.frequency)
}

/// What a contact sees of a change: δγ, δN and σ.
#[derive(Clone, Copy)]
struct SeenChange {
    slip: Complex64,
    load: Complex64,
    tilt: Complex64,
}

/// A contact with the derivatives of its law.
struct NonlinearContact<'a> {
    linear: &'a LinearContact,
    /// μ … μ‴ times the factor on friction.
    law: [f64; 4],
    normal_load: f64,
}

impl NonlinearContact<'_> {
    fn seen(&self, change: &[Complex64]) -> SeenChange {
        let product = |row: Option<&[f64]>, of: &[Complex64]| -> Complex64 {
            row.unwrap_or_default().iter().zip(of).map(|(r, z)| z * *r).sum()
        };
        // Of first-order equations the tangent is a row over the states.
        let n = self.linear.across().len();
        let (position, velocity) = change.split_at(n.min(change.len()));
        let sliding = if velocity.is_empty() { position } else { velocity };
        let (stiffness, damping) = self.linear.normal_spring();
        let normal = self.linear.normal();
        SeenChange {
            slip: -product(self.linear.tangent(), sliding),
            load: stiffness * product(normal, position) + damping * product(normal, velocity),
            tilt: product(self.linear.slope_row(), position),
        }
    }

    fn first(&self, a: SeenChange) -> Complex64 {
        let [value, slope, ..] = self.law;
        slope * self.normal_load * a.slip + value * a.load
    }

    fn second(&self, a: SeenChange, b: SeenChange) -> Complex64 {
        let [_, slope, bend, _] = self.law;
        bend * self.normal_load * a.slip * b.slip + slope * (a.slip * b.load + b.slip * a.load)
    }

    fn third(&self, a: SeenChange, b: SeenChange, c: SeenChange) -> Complex64 {
        let [_, _, bend, third] = self.law;
        let loads = a.slip * b.slip * c.load + a.slip * b.load * c.slip + a.load * b.slip * c.slip;
        third * self.normal_load * a.slip * b.slip * c.slip + bend * loads
    }

    /// Adds the rates of change that a friction force and a normal one cause.
    fn add(&self, friction: Complex64, normal: Complex64, out: &mut [Complex64]) {
        let n = self.linear.along().len();
        let first = out.len() - n;
        let rows = self.linear.along().iter().zip(self.linear.across());
        for (rate, (along, across)) in out[first..].iter_mut().zip(rows) {
            *rate += *along * friction + *across * normal;
        }
    }
}

/// The second and third derivatives along a critical vector.
struct ContactTerms<'a> {
    contacts: Vec<NonlinearContact<'a>>,
    q: &'a [Complex64],
}

impl<'a> ContactTerms<'a> {
    fn new(system: &System, linear: &'a Linearised, q: &'a [Complex64]) -> Self {
        let contacts = system.contacts.iter().zip(linear.contacts()).map(|(given, linear)| {
            let law = given.friction.derivatives(given.surface_velocity.mean());
            let law = law.map(|derivative| linear.steady.factor * derivative);
            NonlinearContact { linear, law, normal_load: linear.steady.normal_load }
        });
        Self { contacts: contacts.collect(), q }
    }
}

impl DerivativesAlong for ContactTerms<'_> {
    fn quadratic(&self, v: &[Complex64]) -> Vec<Complex64> {
        let mut rates = vec![Complex64::new(0.0, 0.0); v.len()];
        for contact in &self.contacts {
            let (a, b) = (contact.seen(self.q), contact.seen(v));
            let turned = a.tilt * contact.first(b) + b.tilt * contact.first(a);
            contact.add(contact.second(a, b), turned, &mut rates);
        }
        rates
    }

    fn cubic(&self) -> Vec<Complex64> {
        let mirrored = conjugate(self.q);
        let mut rates = vec![Complex64::new(0.0, 0.0); self.q.len()];
        for contact in &self.contacts {
            let (a, b) = (contact.seen(self.q), contact.seen(&mirrored));
            let turned = 2.0 * a.tilt * contact.second(a, b) + b.tilt * contact.second(a, a);
            contact.add(contact.third(a, a, b), turned, &mut rates);
        }
        rates
    }
}

#[cfg(test)]
mod tests {
    use quell_model::friction::Expression;
    use quell_model::{Belt, Friction};
    use quell_numerics::continuation::criticality::Criticality;

    use super::*;

    fn polynomial(constants: &[(&str, f64)]) -> Friction {
        let named: Vec<(String, f64)> =
            constants.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
        let formula = "m0 - a*abs(v) + b*abs(v)^3 + c*v^2";
        Expression::new(formula, &named, None, 1.0).map(Friction::Expression).expect("valid")
    }

    /// Averaging of ẍ + 2ζẋ + x = F μ(v − ẋ) with x = 2r cos(τ + φ) and 2ζ + μ′F = 0 gives ṙ = −F μ‴r³/4. The square term
    /// F μ″ẋ²/2 gives nothing: with it alone, ẍ + x = cẋ² has closed orbits.
    #[test]
    fn the_belt_has_the_averaged_coefficient() {
        let (speed, load, a, b) = (0.3, 2.0, 0.12, 0.15);
        for bend in [0.0, 0.08] {
            let law = polynomial(&[("m0", 0.4), ("a", a), ("b", b), ("c", bend)]);
            let slope = -a + 3.0 * b * speed * speed + 2.0 * bend * speed;
            let damping = -0.5 * slope * load;
            let belt = Belt::new(damping, load, speed, law, Vec::new()).expect("valid");
            let system = belt.system();
            let linear = Linearised::new(&system).expect("slides");
            let found = first_lyapunov(&system, &linear, 1.0).expect("a Hopf bifurcation");
            let expected = -load * 6.0 * b / 4.0;
            assert!((found.value - expected).abs() <= found.error, "{found:?} {expected}");
            assert!(found.error < 1e-12, "{found:?}");
            assert_eq!(found.criticality(), Some(Criticality::Supercritical));
        }
    }
}
