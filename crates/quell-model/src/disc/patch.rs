//! A load over an area: Gauss–Legendre quadrature of a uniform pressure.
//!
//! The patch is a sector of the angular extent e around the load's angle, at the load's radius or over the radii r of
//! [`PatchRadius`]. Each of its quadrature points is a contact of its own with the share w_i of the load's mass, damper, spring
//! and friction, Σ w_i = 1, where a uniform pressure has w ∝ r dr dθ. The follower force at another radius is F_θ/r: its factor
//! is r₀/r. Products of two modes of q diameters vary as cos 2qθ, so that n points over the angle have a relative error of
//! about (0.68 q e/n)²ⁿ.

use quell_numerics::gauss_legendre::GaussLegendre;

use super::complaint::complain;
use crate::Invalid;
use crate::parameter::disc::{LOAD_EXTENT, LOAD_POINTS};
use crate::parameter::indexed;

/// The area over which a load is distributed.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    /// Angular extent, radians.
    pub extent: f64,
    /// Quadrature points over the angle; one suffices where the extent is 0.
    pub points: usize,
    /// Quadrature points over the radius; none for a patch at the load's own radius.
    pub radii: Vec<PatchRadius>,
}

/// A quadrature point over the radius.
#[derive(Clone, Debug, PartialEq)]
pub struct PatchRadius {
    /// Weight; the sum over the radii is 1.
    pub weight: f64,
    /// Load radius over this radius, r₀/r.
    pub lever: f64,
    /// Shapes of all modes at this radius.
    pub shapes: Vec<f64>,
}

/// A quadrature point of a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchPoint<'a> {
    /// Share of the load.
    pub weight: f64,
    /// Angle in the frame of the loads, radians.
    pub angle: f64,
    /// Load radius over the radius of this point.
    pub lever: f64,
    /// Shapes of all modes; `None` at the load's own radius.
    pub shapes: Option<&'a [f64]>,
}

impl Patch {
    /// A patch at the load's own radius, of an angular extent (radians) and with this many quadrature points.
    pub fn sector(extent: f64, points: usize) -> Self {
        Self { extent, points, radii: Vec::new() }
    }

    /// The same patch over a radial width around the load's radius (both over the outer radius): `shapes` gives those of all
    /// modes at a radius, `None` where they are unknown.
    pub fn over_radii(
        self,
        radius: f64,
        width: f64,
        points: usize,
        shapes: impl Fn(f64) -> Option<Vec<f64>>,
    ) -> Option<Self> {
        let rule = rule_of(points).into_iter().map(|(x, weight)| {
            let at = f64::mul_add(0.5 * width, x, radius);
            let (weight, lever) = (0.5 * weight * (at / radius), radius / at);
            Some(PatchRadius { weight, lever, shapes: shapes(at)? })
        });
        Some(Self { radii: rule.collect::<Option<_>>()?, ..self })
    }

    /// Enough points for modes of up to this many diameters: rounding is the largest error.
    pub fn enough_points(extent: f64, diameters: usize) -> usize {
        let mut points = 10;
        while (points as f64) < 0.75 * extent * diameters as f64 + 10.0 {
            points += 1;
        }
        points
    }

    /// The quadrature points around an angle.
    pub fn around(&self, angle: f64) -> Vec<PatchPoint<'_>> {
        let over_angle = if self.extent == 0.0 {
            vec![(angle, 1.0)]
        } else {
            let rule = rule_of(self.points);
            let at = |(x, w): (f64, f64)| (f64::mul_add(0.5 * self.extent, x, angle), 0.5 * w);
            rule.into_iter().map(at).collect()
        };
        let own = [(1.0, 1.0, None)];
        let radii = self.radii.iter().map(|at| (at.weight, at.lever, Some(at.shapes.as_slice())));
        let radii: Vec<_> = if self.radii.is_empty() { own.to_vec() } else { radii.collect() };
        let mut points = Vec::with_capacity(radii.len() * over_angle.len());
        for (share, lever, shapes) in radii {
            for &(angle, weight) in &over_angle {
                points.push(PatchPoint { weight: share * weight, angle, lever, shapes });
            }
        }
        points
    }

    pub(super) fn complaints(&self, modes: usize, index: usize, count: usize) -> Vec<Invalid> {
        let numbers = [(LOAD_EXTENT, self.extent.to_degrees()), (LOAD_POINTS, self.points as f64)];
        let mut complaints: Vec<Invalid> = numbers
            .iter()
            .filter_map(|(parameter, value)| complain(parameter, *value, index, count))
            .collect();
        let wrong = |radius: &&PatchRadius| {
            let numbers = radius.shapes.iter().chain([&radius.weight, &radius.lever]);
            radius.shapes.len() != modes || numbers.into_iter().any(|number| !number.is_finite())
        };
        if let Some(radius) = self.radii.iter().find(wrong) {
            let key = indexed("disc.load", index, count, "radial_extent");
            let allowed =
                format!("finite shapes of the {modes} modes at every radius of the patch");
            complaints.push(Invalid::new(key, radius.shapes.len(), allowed));
        }
        complaints
    }
}

/// Nodes and weights on [−1, 1].
fn rule_of(points: usize) -> Vec<(f64, f64)> {
    let rule = GaussLegendre::new(points);
    rule.nodes.into_iter().zip(rule.weights).collect()
}
