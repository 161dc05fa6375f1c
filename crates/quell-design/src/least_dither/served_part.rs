//! The largest connected part of a box of one coordinate in which one dither is quiet and keeps the limits, by exact responses.
//!
//! Points of a grid are judged, those where averaging has the dither nearest to being loud, and those where the search over the whole
//! box found one loud. The ends of the longest run of points that are served are bisected. The part is then judged as a box of its own:
//! at the points of a box ([`super::search::box_points`]), at the extremes of averaging between them and at the peaks of the
//! multipliers. A point that fails divides the part, and the search goes on with the longest run that is left.

use quell_numerics::interval::RealInterval;
use quell_numerics::order::{ascending, ascending_by};

use super::between_points::Towards;
use super::covered_box::{BeyondCovered, CoveredBox, Tried, longest_run};
use super::search::box_points;
use super::{DesignProblem, DesignStart, KEPT, OperatingPoint};
use crate::NoAnswer;
use crate::tasks::answers;

/// Closeness of the ends, as a share of the distance of the points around them, or of the part.
const CLOSENESS: f64 = 1e-7;

/// Distances beyond an unknown end of a part, as shares of its length, at which it is judged again: within about [`CLOSENESS`] of the end
/// of a branch of responses the solver fails where a point a little further is loud. An end where all of these are unknown stays unknown.
const BESIDE: [f64; 4] = [1e-6, 1e-5, 1e-4, 1e-3];

/// Times that a part is divided at points that fail. A part is what its points show in any case.
const ROUNDS: usize = 12;

/// Extremes of averaging that are judged.
const BOTH: [Towards; 2] = [Towards::Loud, Towards::Quiet];

/// What exact responses say about a dither at one point.
#[derive(Clone, Debug)]
enum Served {
    /// It is quiet and keeps the limits, with this multiplier.
    Yes(f64),
    /// Why it does not serve, or why that is unknown.
    No(BeyondCovered),
}

impl Served {
    fn multiplier(&self) -> Option<f64> {
        match self {
            Self::Yes(multiplier) => Some(*multiplier),
            Self::No(_) => None,
        }
    }

    fn is_unknown(&self) -> bool {
        matches!(self, Self::No(BeyondCovered::Unknown(_)))
    }
}

/// The points at which a dither was judged.
pub(super) struct ServedPart<'a> {
    problem: DesignProblem<'a>,
    tried: &'a Tried,
    /// In ascending order, each once.
    judged: Vec<(f64, Served)>,
}

impl<'a> ServedPart<'a> {
    /// A dither of a problem, before any point is judged.
    pub(super) fn new(problem: DesignProblem<'a>, tried: &'a Tried) -> Self {
        Self { problem, tried, judged: Vec::new() }
    }

    /// The largest part within a range, from points that are judged first; `None` where the dither serves none of them.
    ///
    /// # Errors
    /// Why a search between points failed.
    pub(super) fn largest(
        mut self,
        RealInterval { lower: low, upper: high }: RealInterval,
        seeds: &[f64],
    ) -> Result<Option<CoveredBox>, NoAnswer> {
        let Tried { amplitude, others } = self.tried;
        let loud = self.problem.plant.loud_points(self.problem.over, others, *amplitude)?;
        let mut seeds: Vec<f64> = seeds.iter().copied().chain(loud.into_iter().flatten()).collect();
        seeds.retain(|seed| (low..=high).contains(seed));
        ascending(&mut seeds);
        seeds.dedup();
        let extremes = self.problem.averaged_extremes(&seeds, (others, *amplitude), &BOTH);
        self.judge(seeds.into_iter().chain(extremes).collect());
        for _ in 0..ROUNDS {
            let Some(run) = self.run() else { return Ok(None) };
            self.bisect(run);
            let Some(run) = self.run() else { return Ok(None) };
            if self.has_every_point_inside(run) {
                break;
            }
        }
        Ok(self.run().map(|run| self.part(run)))
    }

    /// What exact responses say about a point.
    fn served(&self, point: f64) -> Served {
        let Tried { amplitude, others } = self.tried;
        let at = OperatingPoint { point: &[point], others };
        let verdict = match self.problem.plant.verdict(at, *amplitude) {
            Ok(verdict) if verdict.quiet => verdict,
            Ok(_) => return Served::No(BeyondCovered::Loud),
            Err(why) => return Served::No(BeyondCovered::Unknown(why)),
        };
        for limited in self.problem.limits {
            let used = if limited.0.is_of_exact_response() {
                self.problem.used_exactly_at(*limited, at, *amplitude)
            } else {
                self.problem.used_by_averaging(*limited, at, *amplitude)
            };
            match used {
                Ok(used) if used <= KEPT => {}
                Ok(_) => return Served::No(BeyondCovered::Exceeds(limited.0)),
                Err(why) => return Served::No(BeyondCovered::Unknown(why)),
            }
        }
        Served::Yes(verdict.multiplier)
    }

    /// Judges points that are not known.
    fn judge(&mut self, mut points: Vec<f64>) {
        points.retain(|point| self.judged.iter().all(|(known, _)| known != point));
        let served = answers(self.problem.tasks, &points, |point| self.served(*point));
        self.add(points.into_iter().zip(served).collect());
    }

    fn add(&mut self, judged: Vec<(f64, Served)>) {
        self.judged.extend(judged);
        ascending_by(&mut self.judged, |a| a.0);
        self.judged.dedup_by(|a, b| a.0 == b.0);
    }

    /// The places of the longest run of points that are served.
    fn run(&self) -> Option<(usize, usize)> {
        let points: Vec<f64> = self.judged.iter().map(|(point, _)| *point).collect();
        longest_run(&points, |place| self.judged[place].1.multiplier().is_some())
    }

    /// Adds the points by which the ends of a run are bisected.
    fn bisect(&mut self, (first, last): (usize, usize)) {
        let point = |place: usize| self.judged[place].0;
        let below = first.checked_sub(1).map(|outside| (point(first), point(outside)));
        let above = (last + 1 < self.judged.len()).then(|| (point(last), point(last + 1)));
        let length = point(last) - point(first);
        let ends: Vec<(f64, f64)> = below.into_iter().chain(above).collect();
        let seen = answers(self.problem.tasks, &ends, |&(mut inside, far)| {
            let (mut outside, mut seen) = (far, Vec::new());
            let closeness = CLOSENESS * length.max((outside - inside).abs());
            while (outside - inside).abs() > closeness {
                let middle = f64::midpoint(inside, outside);
                let served = self.served(middle);
                let is_served = served.multiplier().is_some();
                *(if is_served { &mut inside } else { &mut outside }) = middle;
                seen.push((middle, served));
            }
            let step = (far - inside).signum() * length;
            let further = BESIDE.map(|share| share.mul_add(step, outside));
            let further = further.into_iter().take_while(|point| (far - point) * step > 0.0);
            let is_unknown = |(at, served): &(f64, Served)| *at == outside && served.is_unknown();
            if seen.iter().any(is_unknown) {
                seen.extend(further.map(|point| (point, self.served(point))));
            }
            seen
        });
        self.add(seen.into_iter().flatten().collect());
    }

    /// Judges the points of a run as those of a box; whether the dither serves them all.
    fn has_every_point_inside(&mut self, (first, last): (usize, usize)) -> bool {
        let Tried { amplitude, others } = self.tried;
        let (low, high) = (self.judged[first].0, self.judged[last].0);
        let fine = box_points(&[RealInterval::new(low, high)]).into_iter().flatten();
        let inside = self.judged[first..=last].iter().map(|(point, _)| *point);
        let mut points: Vec<f64> = fine.chain(inside).collect();
        ascending(&mut points);
        points.dedup();
        points.extend(self.problem.averaged_extremes(&points, (others, *amplitude), &BOTH));
        self.judge(points);
        // Runs from a start have no multiplier that grows towards where they are loud, and each takes long.
        if self.problem.start == DesignStart::Local {
            let inside: Vec<&(f64, Served)> =
                self.judged.iter().filter(|(point, _)| (low..=high).contains(point)).collect();
            let points: Vec<f64> = inside.iter().map(|(point, _)| *point).collect();
            let multipliers: Vec<_> =
                inside.iter().map(|(_, served)| served.multiplier()).collect();
            let around = self.problem.around_peaks(&points, &multipliers, |point| {
                let served = self.served(point);
                (served.multiplier(), served)
            });
            self.add(around);
        }
        let mut inside = self.judged.iter().filter(|(point, _)| (low..=high).contains(point));
        inside.all(|(_, served)| served.multiplier().is_some())
    }

    /// What the points next to an end of the part, in their order from there, say of what is beyond it: the first of those close to the end
    /// that is known.
    fn beyond(next: &[&(f64, Served)], length: f64) -> BeyondCovered {
        let Some((end, Served::No(first))) = next.first() else { return BeyondCovered::BoxEnds };
        let reach = 2.0 * BESIDE[BESIDE.len() - 1] * length;
        let beside = next.iter().take_while(|(point, _)| (point - end).abs() <= reach);
        let known = beside.filter(|(_, served)| !served.is_unknown());
        match known.map(|(_, served)| served).next() {
            Some(Served::No(why)) => why.clone(),
            _ => first.clone(),
        }
    }

    /// The part that a run of points shows.
    fn part(&self, (first, last): (usize, usize)) -> CoveredBox {
        let length = self.judged[last].0 - self.judged[first].0;
        let above: Vec<_> = self.judged[last + 1..].iter().collect();
        let below: Vec<_> = self.judged[..first].iter().rev().collect();
        let gaps = self.judged[first..=last].windows(2).map(|pair| pair[1].0 - pair[0].0);
        CoveredBox {
            ends: RealInterval::new(self.judged[first].0, self.judged[last].0),
            amplitude: self.tried.amplitude,
            others: self.tried.others.clone(),
            points: last - first + 1,
            largest_gap: gaps.fold(0.0, f64::max),
            beyond: [below, above].map(|next| Self::beyond(&next, length)),
        }
    }
}
