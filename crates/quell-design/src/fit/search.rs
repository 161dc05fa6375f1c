//! The global minimum over the reference velocity and the exponent.
//!
//! The RSS after the elimination of the coefficients is computed on a logarithmic grid, and refined from its lowest local minima by
//! damped Gauss–Newton steps (Levenberg 1944, Marquardt 1963) in all free parameters at the projected point, of which only the
//! reference velocity and the exponent are taken over: Kaufman's form of variable projection. Near the minimum undamped steps
//! converge until they are at rounding.

use quell_numerics::interval::RealInterval;
use quell_numerics::least_squares::least_squares;
use quell_numerics::order::ascending_by;

use super::model::{FitModel, Influence};
use super::projection::{FitSamples, Position, Projected, project};

/// The reference velocity is searched from the least slip speed divided by this factor to the largest one multiplied by it: a law
/// whose fall is ten times faster or slower than every measured speed is flat or straight there.
const BEYOND: f64 = 10.0;

/// Grid points per decade of the reference velocity: one per 12 %, far below the width of a minimum, which is of the order of a
/// factor e.
const PER_DECADE: f64 = 20.0;

/// Exponents of the grid, and the range of the search: the largest is the bound of the parameter, and below the smallest the fall
/// extends over more than ten decades of the slip speed.
const EXPONENTS: RealInterval = RealInterval::new(0.1, 100.0);

/// Grid points of the exponent.
const EXPONENT_POINTS: usize = 31;

/// Local minima of the grid that are refined.
const REFINED: usize = 6;

/// Most steps of a refinement; they converge in a few tens at most.
const STEPS: usize = 200;

/// Relative change of a step below which a minimum is found: the next step, which is smaller still, is at rounding.
const CONVERGED: f64 = 1e-12;

/// Damping at which no step reduces the RSS further.
const LARGEST_DAMPING: f64 = 1e12;

/// A parameter that is searched, with its limits.
#[derive(Clone, Copy, Debug)]
struct SearchedParameter {
    place: usize,
    lower: f64,
    upper: f64,
    points: usize,
}

impl SearchedParameter {
    fn value(&self, index: usize) -> f64 {
        let share = index as f64 / (self.points - 1) as f64;
        self.lower * libm::exp(share * libm::log(self.upper / self.lower))
    }
}

/// A minimum.
#[derive(Clone, Debug)]
pub(super) struct FitMinimum {
    /// Values of all parameters.
    pub(super) values: Vec<f64>,
    pub(super) projected: Projected,
    pub(super) rss: f64,
    /// Places of parameters at a limit of the search.
    pub(super) at_limit: Vec<usize>,
}

/// The least RSS; `None` if it cannot be computed anywhere.
pub(super) fn least(model: &FitModel, samples: &FitSamples) -> Option<FitMinimum> {
    let searched = searched(model, samples);
    let mut best: Option<FitMinimum> = None;
    for start in starts(model, samples, &searched) {
        let Some(found) = refined(model, samples, &searched, &start) else { continue };
        if best.as_ref().is_none_or(|best| found.rss < best.rss) {
            best = Some(found);
        }
    }
    best
}

/// The parameters that are searched.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a few hundred points at most for any range of doubles"
)]
fn searched(model: &FitModel, samples: &FitSamples) -> Vec<SearchedParameter> {
    let speeds = || samples.speeds.iter().copied();
    let lower = speeds().fold(f64::INFINITY, f64::min) / BEYOND;
    let upper = speeds().fold(0.0, f64::max) * BEYOND;
    let points = (PER_DECADE * libm::log10(upper / lower)).ceil() as usize + 1;
    model
        .free()
        .filter_map(|place| match model.influence(place) {
            Influence::Velocity => Some(SearchedParameter { place, lower, upper, points }),
            Influence::Exponent => Some(SearchedParameter {
                place,
                lower: EXPONENTS.lower,
                upper: EXPONENTS.upper,
                points: EXPONENT_POINTS,
            }),
            Influence::Linear | Influence::Nothing => None,
        })
        .collect()
}

/// Values to refine: the lowest local minima of the grid.
fn starts(model: &FitModel, samples: &FitSamples, searched: &[SearchedParameter]) -> Vec<Vec<f64>> {
    let start = model.start();
    let (rows, columns) = match searched {
        [] => return vec![start],
        [only] => (1, only.points),
        [first, second, ..] => (first.points, second.points),
    };
    let at = |row: usize, column: usize| {
        let mut values = start.clone();
        match searched {
            [only] => values[only.place] = only.value(column),
            [first, second, ..] => {
                values[first.place] = first.value(row);
                values[second.place] = second.value(column);
            }
            [] => {}
        }
        values
    };
    let grid: Vec<f64> = (0..rows * columns)
        .map(|index| {
            let values = at(index / columns, index % columns);
            project(model, samples, &values).map_or(f64::INFINITY, |found| found.rss)
        })
        .collect();
    let rss = |row: usize, column: usize| grid[row * columns + column];
    let mut minima: Vec<(f64, Vec<f64>)> = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let own = rss(row, column);
            let around = |other: usize, size: usize| other.saturating_sub(1)..(other + 2).min(size);
            let lowest = around(row, rows)
                .flat_map(|r| around(column, columns).map(move |c| (r, c)))
                .all(|(r, c)| own <= rss(r, c));
            if lowest && own.is_finite() {
                minima.push((own, at(row, column)));
            }
        }
    }
    ascending_by(&mut minima, |minimum| minimum.0);
    minima.truncate(REFINED);
    minima.into_iter().map(|(_, values)| values).collect()
}

/// Refines a start to a minimum.
fn refined(
    model: &FitModel,
    samples: &FitSamples,
    searched: &[SearchedParameter],
    start: &[f64],
) -> Option<FitMinimum> {
    let mut current = project(model, samples, start)?;
    let mut damping = 0.0_f64;
    for _ in 0..STEPS {
        let Some(step) = step(model, samples, searched, &current, damping) else { break };
        let mut values = current.values.clone();
        let mut change = 0.0_f64;
        for (own, step) in searched.iter().zip(step) {
            // A step of more than a factor e is beyond what a linearisation shows.
            let factor = (step / values[own.place]).clamp(-1.0, 1.0);
            let next = (values[own.place] * libm::exp(factor)).clamp(own.lower, own.upper);
            change = change.max((next / values[own.place] - 1.0).abs());
            values[own.place] = next;
        }
        let next = project(model, samples, &values).filter(|next| {
            // At the minimum the RSS is flat to rounding.
            next.rss <= current.rss * (1.0 + 4.0 * f64::EPSILON)
        });
        match next {
            Some(next) => {
                current = next;
                if change <= CONVERGED {
                    break;
                }
                damping = if damping < 1e-8 { 0.0 } else { 0.1 * damping };
            }
            None if damping > LARGEST_DAMPING || change <= CONVERGED => break,
            None => damping = (10.0 * damping).max(1e-6),
        }
    }
    let at_limit = searched
        .iter()
        .filter(|own| {
            let value = current.values[own.place];
            value <= own.lower || value >= own.upper
        })
        .map(|own| own.place)
        .collect();
    Some(FitMinimum {
        values: current.values.clone(),
        rss: current.rss,
        projected: current,
        at_limit,
    })
}

/// The change of the searched parameters in one damped Gauss–Newton step.
fn step(
    model: &FitModel,
    samples: &FitSamples,
    searched: &[SearchedParameter],
    current: &Projected,
    damping: f64,
) -> Option<Vec<f64>> {
    if searched.is_empty() {
        return None;
    }
    let gradient = model.gradient(&current.values, &samples.speeds);
    let mut columns = linear_columns(model, samples, current, &gradient);
    let linear = columns.len();
    let count = samples.speeds.len();
    let mut target = current.residuals.clone();
    target.resize(count + searched.len(), 0.0);
    for column in &mut columns {
        column.resize(count + searched.len(), 0.0);
    }
    for (index, own) in searched.iter().enumerate() {
        let mut column = samples.weighted(&gradient[own.place]);
        let size = column.iter().map(|entry| entry * entry).sum::<f64>().sqrt();
        column.resize(count + searched.len(), 0.0);
        column[count + index] = damping.sqrt() * size;
        columns.push(column);
    }
    let solved = least_squares(&columns, &target)?;
    Some(solved.solution[linear..].to_vec())
}

/// The weighted derivatives by the coefficients inside their bounds; that of a tied level is added to the other one.
pub(super) fn linear_columns(
    model: &FitModel,
    samples: &FitSamples,
    current: &Projected,
    gradient: &[Vec<f64>],
) -> Vec<Vec<f64>> {
    interior(current)
        .map(|place| {
            let mut column = gradient[place].clone();
            if let Some((upper, lower)) = model.levels()
                && upper == place
                && current.position(lower) == Some(Position::Tied)
            {
                for (entry, other) in column.iter_mut().zip(&gradient[lower]) {
                    *entry += other;
                }
            }
            samples.weighted(&column)
        })
        .collect()
}

/// Places of the coefficients inside their bounds.
pub(super) fn interior(current: &Projected) -> impl Iterator<Item = usize> {
    current
        .positions
        .iter()
        .filter(|(_, position)| *position == Position::Interior)
        .map(|(place, _)| *place)
}
