//! Springs, dampers and other couplings between coordinates, and between a coordinate and the ground, read from the matrices.
//!
//! A symmetric pair of negative entries −k is a spring k between two coordinates; what is left on the diagonal is a spring to the
//! ground. Any other pair of entries is a coupling that no spring between the two represents: both entries are written.

use quell_model::system::{Mechanical, Structure};
use quell_numerics::matrix::Matrix;

use super::body::{BodyKind, SketchBody};
use crate::picture::sketch::symbols::{indexed, pair};
use crate::study::SystemStudy;

/// Entries below this fraction of the diagonal are rounding errors of sums.
const ROUNDING: f64 = 1e-9;

/// A spring and a damper between a body and another one or the ground, or another coupling.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct SketchLink {
    pub(super) from: usize,
    /// The other body; `None` for the ground.
    pub(super) to: Option<usize>,
    pub(super) stiffness: Option<f64>,
    pub(super) damping: Option<f64>,
    /// Letter of the matrix, and its entries (from, to) and (to, from).
    pub(super) couplings: Vec<(&'static str, f64, f64)>,
}

impl SketchLink {
    fn is_drawn(&self) -> bool {
        self.stiffness.is_some() || self.damping.is_some() || !self.couplings.is_empty()
    }

    /// Symbol of its spring (`k`) or damper (`c`).
    pub(super) fn symbol(&self, letter: &str) -> String {
        match self.to {
            Some(to) => indexed(letter, &pair(self.from, to)),
            None => indexed(letter, &(self.from + 1).to_string()),
        }
    }
}

/// What two matrix entries are: a spring or damper, another coupling, or nothing.
enum EntryPair {
    Element(f64),
    Coupling(f64, f64),
    Nothing,
}

fn judged(matrix: &Matrix, i: usize, j: usize) -> EntryPair {
    let (one, other) = (matrix[(i, j)], matrix[(j, i)]);
    let size = (matrix[(i, i)].abs() + matrix[(j, j)].abs()) * ROUNDING;
    if one.abs() <= size && other.abs() <= size {
        EntryPair::Nothing
    } else if (one - other).abs() <= size.max(ROUNDING * one.abs()) && one < 0.0 {
        EntryPair::Element(-one)
    } else {
        EntryPair::Coupling(one, other)
    }
}

/// The links of a study whose coordinates are drawn one by one; none otherwise.
pub(super) fn of(study: &SystemStudy, bodies: &[SketchBody]) -> Vec<SketchLink> {
    let Structure::Mechanical(mechanical) = &study.system().structure else { return Vec::new() };
    if bodies.iter().any(|body| body.kind != BodyKind::Mass) {
        return Vec::new();
    }
    let n = mechanical.size();
    let mut links: Vec<SketchLink> = (0..n).map(|place| ground(mechanical, place)).collect();
    let mass = mechanical.mass().matrix();
    for i in 0..n {
        for j in i + 1..n {
            links.push(between(mechanical, &mass, i, j));
        }
    }
    links.retain(SketchLink::is_drawn);
    links
}

fn between(mechanical: &Mechanical, mass: &Matrix, i: usize, j: usize) -> SketchLink {
    let mut link = SketchLink { from: i, to: Some(j), ..SketchLink::default() };
    match judged(mechanical.stiffness(), i, j) {
        EntryPair::Element(stiffness) => link.stiffness = Some(stiffness),
        EntryPair::Coupling(one, other) => link.couplings.push(("K", one, other)),
        EntryPair::Nothing => {}
    }
    match judged(mechanical.damping(), i, j) {
        EntryPair::Element(damping) => link.damping = Some(damping),
        EntryPair::Coupling(one, other) => link.couplings.push(("C", one, other)),
        EntryPair::Nothing => {}
    }
    if mass[(i, j)] != 0.0 {
        link.couplings.push(("M", mass[(i, j)], mass[(j, i)]));
    }
    link
}

/// What is left of the diagonal when the springs and dampers to other coordinates are taken out.
fn ground(mechanical: &Mechanical, place: usize) -> SketchLink {
    let left = |matrix: &Matrix| {
        let others = (0..mechanical.size()).filter(|other| *other != place);
        let elements = others.map(|other| match judged(matrix, place, other) {
            EntryPair::Element(value) => value,
            EntryPair::Coupling(..) | EntryPair::Nothing => 0.0,
        });
        let total = matrix[(place, place)];
        let rest = total - elements.sum::<f64>();
        (rest.abs() > ROUNDING * total.abs()).then_some(rest)
    };
    SketchLink {
        from: place,
        to: None,
        stiffness: left(mechanical.stiffness()),
        damping: left(mechanical.damping()),
        couplings: Vec::new(),
    }
}
