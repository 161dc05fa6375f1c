//! Approximate wave numbers of a clamped–free annular plate, complete and in order, which a root search cannot guarantee.
//!
//! For w(r) cos nθ the energies of a thin plate (Kirchhoff; lengths in the outer radius, D = ρh = 1) are, up to π,
//!
//! ```text
//! 2U = ∫ [ w''² + g² + 2ν w'' g + 2(1 − ν) t² ] r dr,   g = w'/r − n² w/r²,   t = n (w'/r − w/r²)
//! 2T = ω² ∫ w² r dr
//! ```
//!
//! Rayleigh's principle on a space of trial functions with w = w' = 0 at r = b gives upper bounds: the p-th Ritz
//! value is above the p-th exact one, so no frequency can be missing from the list or appear twice.
//! The space consists of hierarchical C¹ elements: cubic Hermite functions and bubbles whose second derivatives are the
//! Legendre polynomials P₂, P₃ …. The elements grow geometrically, at most by a factor of 2, so that ln r, r^{±n} and the Bessel
//! functions near a small inner radius converge equally fast in every element. The Ritz values are then starting points for the
//! roots of the exact characteristic equation (`characteristic`). Measured over the whole domain,
//! they are above the roots by less than 10⁻¹² relative in k.

use quell_numerics::gauss_legendre::{GaussLegendre, legendre};
use quell_numerics::symmetric::{SymmetricMatrix, pencil_eigenvalues};

/// Relative distance below a Ritz value within which its exact wave number is searched; far more than the distance measured.
pub(super) const ACCURACY: f64 = 1e-5;

/// Polynomial degree in excess of what the waves within an element require: ten more than half the phase give at least seven
/// digits.
const SPARE_DEGREE: usize = 10;

/// Trial functions of one element at the nodes of its quadrature.
struct Element {
    /// Radii of the nodes.
    radii: Vec<f64>,
    /// Weights times r.
    weights: Vec<f64>,
    /// Per function: its index among the unknowns, and its value, slope and second derivative at every node.
    functions: Vec<(usize, Vec<[f64; 3]>)>,
}

/// The trial space on one plate, for every number of nodal diameters up to the one that it was constructed for.
pub(super) struct TrialSpace {
    elements: Vec<Element>,
    unknowns: usize,
    poisson_ratio: f64,
}

impl TrialSpace {
    /// Space on b/a ≤ r ≤ 1 that resolves `radial` modes of up to `diameters` nodal diameters.
    pub(super) fn new(
        inner_radius: f64,
        poisson_ratio: f64,
        radial: usize,
        diameters: u32,
    ) -> Self {
        let count = libm::ceil(-libm::log2(inner_radius)).max(1.0);
        let edge = |e: f64| libm::pow(inner_radius, 1.0 - e / count);
        let mut space = Self { elements: Vec::new(), unknowns: 0, poisson_ratio };
        let mut left: Option<(usize, usize)> = None;
        let mut from = inner_radius;
        let phase = core::f64::consts::PI * radial as f64 / (1.0 - inner_radius);
        let elements = whole(count);
        for e in 0..elements {
            let to = if e + 1 == elements { 1.0 } else { edge((e + 1) as f64) };
            let waves =
                0.7 * phase * (to - from) + 0.5 * f64::from(diameters) * libm::log(to / from);
            let degree = SPARE_DEGREE + whole(libm::ceil(waves));
            let first = space.unknowns;
            let bubbles = degree - 3;
            let right = (first + bubbles, first + bubbles + 1);
            space.unknowns = first + bubbles + 2;
            space.elements.push(Element::new(from, to, degree, left, first, right));
            left = Some(right);
            from = to;
        }
        space
    }

    /// The lowest `count` wave numbers k = √ω for n nodal diameters, ascending; `None` if the space is too small or the
    /// matrices could not be factored.
    pub(super) fn wave_numbers(&self, diameters: u32, count: usize) -> Option<Vec<f64>> {
        let mut stiffness = SymmetricMatrix::zeros(self.unknowns);
        let mut mass = SymmetricMatrix::zeros(self.unknowns);
        for element in &self.elements {
            element.assemble(diameters, self.poisson_ratio, &mut stiffness, &mut mass);
        }
        let reciprocal = pencil_eigenvalues(&mass, &stiffness)?;
        let values: Vec<f64> =
            reciprocal.iter().rev().take(count).map(|mu| libm::pow(*mu, -0.25)).collect();
        (values.len() == count && values.iter().all(|k| k.is_finite())).then_some(values)
    }
}

impl Element {
    fn new(
        from: f64,
        to: f64,
        degree: usize,
        left: Option<(usize, usize)>,
        first_bubble: usize,
        right: (usize, usize),
    ) -> Self {
        // The integrands are polynomials of degree 2·degree times r⁻³: a ratio of radii below 2 costs at most nine more nodes.
        let rule = GaussLegendre::new(degree + 10);
        let half = 0.5 * (to - from);
        let radii: Vec<f64> = rule.nodes.iter().map(|x| from + half * (1.0 + x)).collect();
        let weights = rule.weights.iter().zip(&radii).map(|(w, r)| w * half * r).collect();
        let mut functions: Vec<(usize, Vec<[f64; 3]>)> = Vec::with_capacity(degree + 1);
        let hermite: [(Option<usize>, usize); 4] = [
            (left.map(|l| l.0), 0),
            (left.map(|l| l.1), 1),
            (Some(right.0), 2),
            (Some(right.1), 3),
        ];
        for (unknown, kind) in hermite {
            if let Some(unknown) = unknown {
                let values = rule.nodes.iter().map(|x| scaled(hermite_cubic(kind, *x, half), half));
                functions.push((unknown, values.collect()));
            }
        }
        let tables: Vec<Vec<f64>> = rule.nodes.iter().map(|x| legendre(degree, *x)).collect();
        for j in 2..=degree - 2 {
            let values = tables.iter().map(|table| scaled(bubble(j, table), half));
            functions.push((first_bubble + j - 2, values.collect()));
        }
        Self { radii, weights, functions }
    }

    fn assemble(
        &self,
        diameters: u32,
        poisson_ratio: f64,
        stiffness: &mut SymmetricMatrix,
        mass: &mut SymmetricMatrix,
    ) {
        let n = f64::from(diameters);
        // Per function and node: w, w'', g, t.
        let strains: Vec<Vec<[f64; 4]>> = self
            .functions
            .iter()
            .map(|(_, values)| {
                let strain = |(&[w, slope, bend], &r): (&[f64; 3], &f64)| {
                    let rotation = slope / r;
                    let lift = w / (r * r);
                    [w, bend, rotation - n * n * lift, n * (rotation - lift)]
                };
                values.iter().zip(&self.radii).map(strain).collect()
            })
            .collect();
        for (i, (row, _)) in self.functions.iter().enumerate() {
            for (j, (column, _)) in self.functions.iter().enumerate().take(i + 1) {
                let (mut bending, mut inertia) = (0.0, 0.0);
                for ((&[w, b, g, t], &[v, c, h, s]), weight) in
                    strains[i].iter().zip(&strains[j]).zip(&self.weights)
                {
                    inertia += weight * w * v;
                    let energy = b * c
                        + g * h
                        + poisson_ratio * (b * h + g * c)
                        + 2.0 * (1.0 - poisson_ratio) * t * s;
                    bending += weight * energy;
                }
                stiffness.add(*row, *column, bending);
                mass.add(*row, *column, inertia);
            }
        }
    }
}

/// Converts a small whole number to a count.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "at most 7 elements, degrees of a few hundred, never negative: b/a, modes and diameters are bounded"
)]
fn whole(value: f64) -> usize {
    value as usize
}

/// Converts value and derivatives in x to derivatives in r = … + half·x.
fn scaled([value, slope, bend]: [f64; 3], half: f64) -> [f64; 3] {
    [value, slope / half, bend / (half * half)]
}

/// Cubic Hermite functions on [−1, 1]: left value, left slope, right value, right slope (slopes with respect to r).
fn hermite_cubic(kind: usize, x: f64, half: f64) -> [f64; 3] {
    let side = if kind < 2 { -1.0 } else { 1.0 };
    let y = side * x;
    if kind.is_multiple_of(2) {
        // ¼ (1 + y)² (2 − y)
        [0.25 * (1.0 + y) * (1.0 + y) * (2.0 - y), side * 0.75 * (1.0 - y * y), -1.5 * y]
    } else {
        // side · half · ¼ (1 + y)² (y − 1)
        let factor = side * half;
        [
            factor * 0.25 * (1.0 + y) * (1.0 + y) * (y - 1.0),
            half * 0.25 * (1.0 + y) * (3.0 * y - 1.0),
            factor * 0.5 * (3.0 * y + 1.0),
        ]
    }
}

/// The function with second derivative √(j + ½) Pⱼ that vanishes with its slope at both ends; j ≥ 2.
fn bubble(j: usize, legendre: &[f64]) -> [f64; 3] {
    let order = j as f64;
    let norm = libm::sqrt(order + 0.5);
    let (up, middle, down) = (legendre[j + 2], legendre[j], legendre[j - 2]);
    let upper = (up - middle) / (2.0 * order + 3.0);
    let lower = (middle - down) / (2.0 * order - 1.0);
    let slope = (legendre[j + 1] - legendre[j - 1]) / (2.0 * order + 1.0);
    [norm * (upper - lower) / (2.0 * order + 1.0), norm * slope, norm * middle]
}
