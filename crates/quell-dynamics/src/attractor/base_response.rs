//! The base response (the period-1 response continued from steady sliding), and a distance from it that decays geometrically.
//!
//! For a complex pair of multipliers λ = ρe^{±iθ} of M = [[a, b], [c, d]] the form c x² + (d − a) x v − b v² is multiplied
//! by det M = ρ² in each period, independent of the phase of the slow motion. Its square root is the distance used here: it
//! decreases by exactly the factor ρ per period while the motion is small, so that a measured rate can be compared with ln ρ. For
//! real multipliers the distance is √(x² + v²).
//!
//! Without dither the response is steady sliding, x = μ(v₀)F, and M is that of x″ + (2ζ + μ′(v₀)F)x′ + x = 0 in closed form.

use quell_model::{Belt, System};
use quell_numerics::continuation::{multipliers, spectral_radius};
use quell_numerics::matrix::Matrix;

use super::section::StroboscopicSection;
use crate::orbit::{BASE_STEPS, NoOrbit, Orbit, OrbitVerdict, base_response};
use crate::simulation::Matrix2;

/// The base response.
#[derive(Clone, Debug, PartialEq)]
pub struct BaseResponse {
    /// x at τ = 0.
    pub displacement: f64,
    /// x′ at τ = 0.
    pub velocity: f64,
    /// The larger modulus of its multipliers over one period of the section.
    pub radius: f64,
    /// Whether it is stable.
    pub verdict: OrbitVerdict,
    /// Coefficients of x², xv, v² of the form above; `None` for real multipliers.
    form: Option<[f64; 3]>,
}

impl BaseResponse {
    /// The base response of a belt.
    ///
    /// # Errors
    /// [`NoOrbit`] if shooting does not find it.
    pub(super) fn of(
        system: &System,
        belt: &Belt,
        section: StroboscopicSection,
    ) -> Result<Self, NoOrbit> {
        if section.dithered {
            return Self::of_orbit(&base_response(system, BASE_STEPS)?);
        }
        let slope = belt.friction().slope(belt.belt_velocity());
        let damping = belt.damping_rate(slope, belt.normal_load());
        let matrix = flow(0.5 * damping, section.period);
        let radius = radius(&matrix);
        Ok(Self::new((belt.steady_sliding(), 0.0), &matrix, radius))
    }

    fn of_orbit(orbit: &Orbit) -> Result<Self, NoOrbit> {
        let (&[displacement, velocity], Some(monodromy)) =
            (orbit.state.as_slice(), &orbit.monodromy)
        else {
            return Err(NoOrbit::NoDither);
        };
        let matrix = [0, 1].map(|i| [0, 1].map(|j| monodromy[(i, j)]));
        let base = Self::new((displacement, velocity), &matrix, orbit.radius());
        Ok(Self { verdict: orbit.verdict(), ..base })
    }

    fn new((displacement, velocity): (f64, f64), matrix: &Matrix2, radius: f64) -> Self {
        let [[a, b], [c, d]] = *matrix;
        // −(discriminant)/4 = Im²λ, the determinant of the form.
        let squared = -(0.25 * (a - d) * (a - d) + b * c);
        let form = (squared > 0.0).then(|| {
            let unit = libm::copysign(libm::sqrt(squared), c);
            [c / unit, (d - a) / unit, -b / unit]
        });
        Self { displacement, velocity, radius, verdict: OrbitVerdict::of(radius, 0.0), form }
    }

    /// Distance of a state of the section from the base response.
    pub fn distance(&self, displacement: f64, velocity: f64) -> f64 {
        let (x, v) = (displacement - self.displacement, velocity - self.velocity);
        match self.form {
            Some([xx, xv, vv]) => libm::sqrt((xx * x * x + xv * x * v + vv * v * v).abs()),
            None => libm::hypot(x, v),
        }
    }

    /// ln ρ, the rate per period at which all small motions decay or grow; `None` for real multipliers, where the rates differ.
    pub fn rate(&self) -> Option<f64> {
        self.form.map(|_| libm::log(self.radius))
    }
}

/// e^{At} of x″ + 2δx′ + x = 0.
fn flow(delta: f64, t: f64) -> Matrix2 {
    let square = 1.0 - delta * delta;
    let omega = libm::sqrt(square.abs());
    let fall = libm::exp(-delta * t);
    // cos ωt and sin(ωt)/ω, or their hyperbolic counterparts.
    let (even, odd) = if square > 0.0 {
        (libm::cos(omega * t), libm::sin(omega * t) / omega)
    } else if square < 0.0 {
        (libm::cosh(omega * t), libm::sinh(omega * t) / omega)
    } else {
        (1.0, t)
    };
    [[fall * (even + delta * odd), fall * odd], [-fall * odd, fall * (even - delta * odd)]]
}

/// Spectral radius of a period map.
fn radius(matrix: &Matrix2) -> f64 {
    let found = multipliers(&Matrix::from_fn(2, 2, |i, j| matrix[i][j]));
    // A matrix that is not finite has no eigenvalues.
    found.map_or(f64::INFINITY, |found| spectral_radius(&found))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_distance_decreases_by_the_radius_each_period() {
        for delta in [0.003, 0.4, -0.02] {
            let matrix = flow(delta, 0.7);
            let base = BaseResponse::new((0.3, 0.0), &matrix, radius(&matrix));
            assert!((base.radius - (-delta * 0.7_f64).exp()).abs() < 1e-15);
            let [[a, b], [c, d]] = matrix;
            let (mut x, mut v) = (0.2, -0.1);
            for _ in 0..5 {
                let before = base.distance(0.3 + x, v);
                (x, v) = (a * x + b * v, c * x + d * v);
                let after = base.distance(0.3 + x, v);
                assert!((after / before - base.radius).abs() < 1e-12, "{delta}");
            }
        }
        // An overdamped belt has no such form.
        let matrix = flow(1.5, 0.7);
        assert!(BaseResponse::new((0.0, 0.0), &matrix, radius(&matrix)).rate().is_none());
    }
}
