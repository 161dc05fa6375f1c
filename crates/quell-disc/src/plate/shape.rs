//! Radial shape φ(r) of a mode, normalised so that φ cos jθ has unit mean square over the plate and φ(a) > 0.
//!
//! w = u + v, where u consists of J and Y, and v of I and K: ∇²u = −k²u, ∇²v = k²v. Green's formula gives the norm in closed
//! form,
//!
//! ```text
//! 2k² ∫ w² r dr = [ r²u'² + (k²r² − n²)u² − r²v'² + (k²r² + n²)v² − 2r(u'v − uv') ]      between b and 1
//! ```
//!
//! whose value at the clamp, where v = −u and v' = −u', is 2k²b²u². Unit mean square means ∫ φ² r dr = (1 − b²) for
//! n > 0 and half of that for n = 0. This is (5.7) without the mass of the plate, M_p = ρhπ(a² − b²): φ = R √M_p.
//! (5.7b) as printed cannot hold for n = 0, because sin 0 vanishes.

use super::characteristic::Basis;

/// Radial shape φ(r) of a mode.
#[derive(Debug, Clone, PartialEq)]
pub struct RadialShape {
    diameters: u32,
    wave_number: f64,
    inner_radius: f64,
    coefficients: [f64; 4],
}

impl RadialShape {
    /// Normalises the null vector at a root; `None` where it does not belong to a mode.
    pub(super) fn new(
        diameters: u32,
        wave_number: f64,
        inner_radius: f64,
        coefficients: [f64; 4],
    ) -> Option<Self> {
        let raw = Self { diameters, wave_number, inner_radius, coefficients };
        let mean_square =
            if diameters == 0 { 0.5 } else { 1.0 } * (1.0 - inner_radius * inner_radius);
        let factor = libm::sqrt(mean_square / raw.norm()?);
        let factor = if raw.value(1.0)? < 0.0 { -factor } else { factor };
        factor.is_finite().then(|| Self { coefficients: coefficients.map(|c| c * factor), ..raw })
    }

    /// ∫ w² r dr from the clamp to the free edge.
    fn norm(&self) -> Option<f64> {
        let k2 = self.wave_number * self.wave_number;
        let n2 = f64::from(self.diameters) * f64::from(self.diameters);
        let [u, u_slope, v, v_slope] = self.parts(1.0)?;
        let outer = (u_slope - v_slope) * (u_slope + v_slope) - n2 * (u - v) * (u + v)
            + k2 * (u * u + v * v)
            - 2.0 * (u_slope * v - u * v_slope);
        let [u_clamp, ..] = self.parts(self.inner_radius)?;
        let clamp = self.inner_radius * self.inner_radius * u_clamp * u_clamp;
        Some(outer / (2.0 * k2) - clamp)
    }

    /// u, u', v, v' at the radius r.
    fn parts(&self, radius: f64) -> Option<[f64; 4]> {
        let basis = Basis::new(self.diameters, self.wave_number, self.inner_radius, radius)?;
        let [j, y, i, k] = self.coefficients;
        let combine = |[fj, fy, fi, fk]: [f64; 4]| (j * fj + y * fy, i * fi + k * fk);
        let (u, v) = combine(basis.values);
        let (u_slope, v_slope) = combine(basis.slopes);
        Some([u, self.wave_number * u_slope, v, self.wave_number * v_slope])
    }

    /// φ at the radius r (in units of the outer radius), 0 at the clamp; `None` outside b/a ≤ r ≤ 1.
    #[must_use]
    pub fn value(&self, radius: f64) -> Option<f64> {
        self.value_and_slope(radius).map(|[value, _]| value)
    }

    /// φ and dφ/dr at the radius r (in units of the outer radius), both 0 at the clamp; `None` outside b/a ≤ r ≤ 1.
    #[must_use]
    pub fn value_and_slope(&self, radius: f64) -> Option<[f64; 2]> {
        if radius == self.inner_radius {
            return Some([0.0, 0.0]);
        }
        if !(radius > self.inner_radius && radius <= 1.0) {
            return None;
        }
        let [u, u_slope, v, v_slope] = self.parts(radius)?;
        Some([u + v, u_slope + v_slope])
    }

    /// φ(r) cos jθ, the deflection of the plate, for plots; `None` outside b/a ≤ r ≤ 1.
    #[must_use]
    pub fn deflection(&self, radius: f64, angle: f64) -> Option<f64> {
        self.value(radius).map(|value| value * libm::cos(f64::from(self.diameters) * angle))
    }
}
