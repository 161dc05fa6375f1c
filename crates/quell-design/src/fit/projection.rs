//! The best coefficients for a given reference velocity and exponent: linear least squares within the bounds, exactly.
//!
//! The coefficients are at least 0, and the static one is at least the sliding one. The minimum of a convex quadratic function over
//! such a polyhedron is the unconstrained minimum on one of its faces. A law has at most three coefficients, so that every face is
//! tried. The unconstrained minimum is taken at once if it is feasible.

use quell_numerics::least_squares::least_squares;

use super::model::{Estimate, FitModel, Influence};
use super::point::FitPoint;

/// The points as columns.
#[derive(Clone, Debug)]
pub(super) struct FitSamples {
    pub(super) speeds: Vec<f64>,
    pub(super) coefficients: Vec<f64>,
    /// 1/σ.
    pub(super) weights: Vec<f64>,
}

impl FitSamples {
    pub(super) fn of(points: &[FitPoint]) -> Self {
        Self {
            speeds: points.iter().map(FitPoint::speed).collect(),
            coefficients: points.iter().map(|point| point.coefficient).collect(),
            weights: points.iter().map(|point| point.standard_deviation.recip()).collect(),
        }
    }

    /// A column divided by σ.
    pub(super) fn weighted(&self, column: &[f64]) -> Vec<f64> {
        column.iter().zip(&self.weights).map(|(value, weight)| value * weight).collect()
    }
}

/// Where a free coefficient is on a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Position {
    /// Inside its bounds.
    Interior,
    /// At its lower bound 0.
    Zero,
    /// At the value of the other level, which is fixed.
    AtLevel(f64),
    /// Equal to the other level, which is free (of the lower level).
    Tied,
}

/// The least RSS for one reference velocity and exponent.
#[derive(Clone, Debug)]
pub(super) struct Projected {
    /// Values of all parameters.
    pub(super) values: Vec<f64>,
    /// Position of the free coefficients, by place.
    pub(super) positions: Vec<(usize, Position)>,
    pub(super) rss: f64,
    /// (c − μ)/σ.
    pub(super) residuals: Vec<f64>,
}

impl Projected {
    /// Position of the parameter at a place, if it is a free coefficient.
    pub(super) fn position(&self, place: usize) -> Option<Position> {
        self.positions.iter().find(|(own, _)| *own == place).map(|(_, position)| *position)
    }
}

/// The best free coefficients with the other parameters as in `values`.
pub(super) fn project(model: &FitModel, samples: &FitSamples, values: &[f64]) -> Option<Projected> {
    let bases = model.bases(values, &samples.speeds)?;
    let bases: Vec<(usize, Vec<f64>)> =
        bases.into_iter().map(|(place, basis)| (place, samples.weighted(&basis))).collect();
    let free: Vec<usize> =
        model.free().filter(|place| model.influence(*place) == Influence::Linear).collect();
    let mut target = samples.weighted(&samples.coefficients);
    for (place, basis) in bases.iter().filter(|(place, _)| !free.contains(place)) {
        for (left, entry) in target.iter_mut().zip(basis) {
            *left -= values[*place] * entry;
        }
    }
    let columns: Vec<&Vec<f64>> = free
        .iter()
        .filter_map(|place| bases.iter().find(|(own, _)| own == place).map(|(_, basis)| basis))
        .collect();
    let problem = ActiveProblem { model, free: &free, columns: &columns, target: &target, values };
    let interior = vec![Position::Interior; free.len()];
    if let Some(found) = problem.on_face(&interior) {
        return Some(found);
    }
    let choices: Vec<Vec<Position>> = free.iter().map(|place| positions(model, *place)).collect();
    let mut best: Option<Projected> = None;
    for face in faces(&choices) {
        let Some(found) = problem.on_face(&face) else { continue };
        if best.as_ref().is_none_or(|best| found.rss < best.rss) {
            best = Some(found);
        }
    }
    best
}

/// Every position that a free coefficient may have.
fn positions(model: &FitModel, place: usize) -> Vec<Position> {
    let mut positions = vec![Position::Interior, Position::Zero];
    if let Some((upper, lower)) = model.levels() {
        let other = if place == upper {
            Some(lower)
        } else if place == lower {
            Some(upper)
        } else {
            None
        };
        match other.map(|other| model.estimates()[other]) {
            Some(Estimate::Fixed(level)) => positions.push(Position::AtLevel(level)),
            Some(Estimate::Free) if place == lower => positions.push(Position::Tied),
            _ => {}
        }
    }
    positions
}

/// The product of the choices.
fn faces(choices: &[Vec<Position>]) -> Vec<Vec<Position>> {
    choices.iter().fold(vec![Vec::new()], |faces, choice| {
        faces
            .iter()
            .flat_map(|face| choice.iter().map(|position| [face.as_slice(), &[*position]].concat()))
            .collect()
    })
}

struct ActiveProblem<'a> {
    model: &'a FitModel,
    free: &'a [usize],
    columns: &'a [&'a Vec<f64>],
    target: &'a [f64],
    values: &'a [f64],
}

impl ActiveProblem<'_> {
    /// The minimum on one face; `None` if it is not unique or violates a bound.
    fn on_face(&self, face: &[Position]) -> Option<Projected> {
        let mut target = self.target.to_vec();
        let mut columns: Vec<Vec<f64>> = Vec::new();
        let mut solved: Vec<usize> = Vec::new();
        for (index, position) in face.iter().enumerate() {
            match position {
                Position::Interior => {
                    columns.push(self.columns[index].clone());
                    solved.push(index);
                }
                Position::AtLevel(level) => {
                    for (left, entry) in target.iter_mut().zip(self.columns[index]) {
                        *left -= level * entry;
                    }
                }
                Position::Zero | Position::Tied => {}
            }
        }
        let (upper, lower) = self.model.levels().unzip();
        let index_of = |place: Option<usize>| {
            place.and_then(|place| self.free.iter().position(|own| *own == place))
        };
        let (upper, lower) = (index_of(upper), index_of(lower));
        if let Some(tied) = face.iter().position(|position| *position == Position::Tied) {
            let column = solved.iter().position(|index| Some(*index) == upper)?;
            for (entry, other) in columns[column].iter_mut().zip(self.columns[tied]) {
                *entry += other;
            }
        }
        let solution = least_squares(&columns, &target)?;
        let mut found = vec![0.0; face.len()];
        for (index, value) in solved.iter().zip(&solution.solution) {
            found[*index] = *value;
        }
        for (index, position) in face.iter().enumerate() {
            match position {
                Position::AtLevel(level) => found[index] = *level,
                Position::Tied => found[index] = found[upper?],
                Position::Interior | Position::Zero => {}
            }
        }
        let mut values = self.values.to_vec();
        for (place, value) in self.free.iter().zip(&found) {
            values[*place] = *value;
        }
        let ordered = match self.model.levels() {
            Some((above, below)) if upper.is_some() || lower.is_some() => {
                self.model.estimates()[above] == Estimate::Unused || values[above] >= values[below]
            }
            _ => true,
        };
        let bounded = found.iter().all(|value| value.is_finite() && *value >= 0.0);
        let rss: f64 = solution.residuals.iter().map(|residual| residual * residual).sum();
        (ordered && bounded && rss.is_finite()).then(|| Projected {
            values,
            positions: self.free.iter().copied().zip(face.iter().copied()).collect(),
            rss,
            residuals: solution.residuals,
        })
    }
}
