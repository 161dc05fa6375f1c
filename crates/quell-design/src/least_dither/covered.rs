//! How far one dither reaches where none serves the whole box: the largest connected part of the box in which it is quiet and keeps the
//! limits.
//!
//! Averaging ranks dithers by the length of that part: on a grid over the box first, then with ends of their own, so that the best
//! amplitude does not depend on the points of the grid. Exact responses then decide ([`super::served_part`]).

use std::fmt;

use quell_numerics::interval::RealInterval;
use quell_numerics::order::{ascending, descending_by};
use quell_numerics::roots::{Closeness, minimise};

use super::covered_box::{CoveredBox, Tried, longest_run};
use super::exact::InfeasibleDesign;
use super::no_design::NoDesign;
use super::quiet::QuietAmplitudes;
use super::search::grid;
use super::served_part::ServedPart;
use super::{DesignProblem, LimitedQuantity, OperatingPoint};
use crate::NoAnswer;
use crate::tasks::answers;

/// Points of the box along its coordinate, amplitudes that are tried, and choices of each other design variable.
const POINTS: usize = 65;
const AMPLITUDES: usize = 65;
const CHOICES: [usize; 4] = [1, 13, 5, 3];

/// Halvings of the distance of two points at an end of the part by averaging.
const HALVINGS: usize = 30;

/// Choices of the dither that exact responses judge, those of averaging.
const JUDGED: usize = 2;

/// Why no part of a box is known that one dither serves.
#[derive(Clone, Debug, PartialEq)]
pub enum NoCoveredBox {
    /// The box is one point.
    OnePoint,
    /// It has several coordinates.
    SeveralCoordinates,
    /// A search between its points failed.
    Failed(NoAnswer),
    /// No dither that was judged is quiet and keeps every limit in a part of it.
    NothingServed,
}

impl fmt::Display for NoCoveredBox {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OnePoint => f.write_str("the study has one operating point"),
            Self::SeveralCoordinates => {
                f.write_str("only for a box of one coordinate is the largest part searched")
            }
            Self::Failed(why) => why.fmt(f),
            Self::NothingServed => f.write_str(
                "no dither that was judged by exact responses is quiet and keeps every limit in a part of the range",
            ),
        }
    }
}

impl std::error::Error for NoCoveredBox {}

/// The largest part of a box of one coordinate for which one dither suffices, where `none` serves the whole box.
///
/// # Errors
/// [`NoCoveredBox`].
pub fn covered(
    problem: DesignProblem<'_>,
    none: &InfeasibleDesign,
) -> Result<CoveredBox, NoCoveredBox> {
    let range = match problem.over {
        [range] => range,
        [] => return Err(NoCoveredBox::OnePoint),
        _ => return Err(NoCoveredBox::SeveralCoordinates),
    };
    let points: Vec<f64> =
        grid(&[*range], [1, POINTS, 2, 2], false).into_iter().flatten().collect();
    let lines = grid(problem.others, CHOICES, true).into_iter();
    let lines = lines.map(|others| AveragedLine::new(problem, others, &points));
    let mut ranked: Vec<_> = lines.filter_map(|line| Some((line.best()?, line))).collect();
    descending_by(&mut ranked, |a| a.0.length);
    ranked.truncate(JUDGED);
    let nearest = none.nearest.as_ref();
    let of_nearest = nearest.map(|point| Tried {
        amplitude: problem.verified_amplitude(point.amplitude),
        others: point.others.clone(),
    });
    // Points at which the search found a dither loud, or beyond a limit.
    let decisive = nearest.iter().flat_map(|point| point.worst.iter().chain(&point.decisive));
    let failed = match &none.why {
        NoDesign::NeverQuiet { point } | NoDesign::Failed { point, .. } => Some(point),
        NoDesign::Limit { point, .. } | NoDesign::Unlimited { point, .. } => point.as_ref(),
    };
    let seeds: Vec<f64> =
        points.iter().copied().chain(decisive.chain(failed).flatten().copied()).collect();
    let mut best: Option<CoveredBox> = None;
    let tried = ranked.into_iter().map(|(best, line)| line.refined(best)).chain(of_nearest);
    for tried in tried {
        let part = ServedPart::new(problem, &tried).largest(*range, &seeds);
        let longer = |known: &CoveredBox, part: &CoveredBox| part.length() > known.length();
        if let Some(part) = part.map_err(NoCoveredBox::Failed)?
            && best.as_ref().is_none_or(|known| longer(known, &part))
        {
            best = Some(part);
        }
    }
    best.ok_or(NoCoveredBox::NothingServed)
}

/// The quiet amplitudes by averaging at points of the box, for one choice of the other design variables.
struct AveragedLine<'a> {
    problem: DesignProblem<'a>,
    others: Vec<f64>,
    points: &'a [f64],
    sets: Vec<Result<QuietAmplitudes, NoAnswer>>,
}

/// An amplitude with the length of its part of the box, and the amplitudes next to it that were tried.
#[derive(Clone, Copy)]
struct LengthOfAmplitude {
    length: f64,
    amplitude: f64,
    between: RealInterval,
}

impl<'a> AveragedLine<'a> {
    fn new(problem: DesignProblem<'a>, others: Vec<f64>, points: &'a [f64]) -> Self {
        let mut line = Self { problem, others, points, sets: Vec::new() };
        line.sets = answers(problem.tasks, points, |point| line.quiet_at(*point));
        line
    }

    fn quiet_at(&self, point: f64) -> Result<QuietAmplitudes, NoAnswer> {
        let at = OperatingPoint { point: &[point], others: &self.others };
        self.problem.plant.averaged(at, self.problem.amplitude)
    }

    /// Whether an amplitude is quiet and allowed at a point, whose quiet amplitudes are known.
    fn serves(
        &self,
        set: &Result<QuietAmplitudes, NoAnswer>,
        (point, amplitude): (f64, f64),
    ) -> bool {
        let at = OperatingPoint { point: &[point], others: &self.others };
        let keeps = |limited: &(LimitedQuantity, f64)| {
            self.problem.used_by_averaging(*limited, at, amplitude).is_ok_and(|used| used <= 1.0)
        };
        set.as_ref().is_ok_and(|set| set.contains(amplitude))
            && self.problem.limits.iter().all(keeps)
    }

    /// The places of the points of the largest part that an amplitude serves.
    fn longest(&self, amplitude: f64) -> Option<(usize, usize)> {
        longest_run(self.points, |place| {
            self.serves(&self.sets[place], (self.points[place], amplitude))
        })
    }

    /// The amplitude whose part of the points is largest; `None` where no amplitude is quiet and allowed at a point.
    fn best(&self) -> Option<LengthOfAmplitude> {
        let RealInterval { lower: from, upper: to } = self.problem.amplitude;
        let mut amplitudes: Vec<f64> =
            grid(&[RealInterval::new(from, to)], [1, AMPLITUDES, 2, 2], true)
                .into_iter()
                .flatten()
                .collect();
        // The ends of quiet sets are where the part changes.
        amplitudes.extend(self.sets.iter().flatten().flat_map(|set| {
            set.intervals().iter().map(|quiet| quiet.lower * (1.0 + 1e-9)).filter(|low| *low <= to)
        }));
        ascending(&mut amplitudes);
        amplitudes.dedup();
        let lengths = answers(self.problem.tasks, &amplitudes, |amplitude| {
            let (first, last) = self.longest(*amplitude)?;
            Some(self.points[last] - self.points[first])
        });
        let length = lengths.iter().flatten().copied().max_by(f64::total_cmp)?;
        // Amplitudes that reach the same points reach differently far between them.
        let first = lengths.iter().position(|known| *known == Some(length))?;
        let equal = lengths[first..].iter().take_while(|known| **known == Some(length)).count();
        let last = amplitudes.len() - 1;
        let between = RealInterval::new(
            amplitudes[first.saturating_sub(1)],
            amplitudes[(first + equal).min(last)],
        );
        Some(LengthOfAmplitude { length, amplitude: amplitudes[first], between })
    }

    /// The length of the part that an amplitude serves, with ends between the points.
    fn length(&self, amplitude: f64) -> f64 {
        let Some((first, last)) = self.longest(amplitude) else { return 0.0 };
        let end = |inside: usize, outside: Option<&f64>| {
            let mut inside = self.points[inside];
            let Some(mut outside) = outside.copied() else { return inside };
            for _ in 0..HALVINGS {
                let middle = f64::midpoint(inside, outside);
                let is_served = self.serves(&self.quiet_at(middle), (middle, amplitude));
                *(if is_served { &mut inside } else { &mut outside }) = middle;
            }
            inside
        };
        let below = first.checked_sub(1).and_then(|place| self.points.get(place));
        end(last, self.points.get(last + 1)) - end(first, below)
    }

    /// The dither whose part is largest among the amplitudes between those that were tried.
    fn refined(self, best: LengthOfAmplitude) -> Tried {
        let RealInterval { lower: low, upper: high } = best.between;
        let found = minimise(|value| -self.length(value), low, high, Closeness::default());
        let inside = found.ok().map(|found| (-found.value, found.location));
        let known = [best.amplitude, high].map(|amplitude| (self.length(amplitude), amplitude));
        // Of amplitudes that reach equally far the first, which was tried.
        let mut longest = known[0];
        for tried in known[1..].iter().copied().chain(inside) {
            if tried.0 > longest.0 {
                longest = tried;
            }
        }
        Tried { amplitude: longest.1, others: self.others }
    }
}
