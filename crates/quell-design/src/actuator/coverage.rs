//! Where over frequency an actuator suffices: the largest amplitude that it can give against the least one that quenches.
//!
//! At every frequency the limits of an actuator give a largest amplitude, and averaging at a finite frequency ratio gives the least one
//! that is quiet. Both are known at any frequency, but not in closed form: resonances make them steep, a sample rate or the end of a
//! measured response cuts them off, and sets of quiet amplitudes begin and end. The range is therefore sampled, extremes between two
//! samples are refined, and every change (of the limit that binds, or from too little to enough) is bisected down to rounding. A change
//! and its reversal between two samples are found if the ratio that decides them has an extreme at a sample, which a dip or peak of
//! any width has.

use quell_numerics::interval::RealInterval;
use quell_numerics::order::ascending_by;
use quell_numerics::roots::{Closeness, minimise};

use super::demand::{ActuatorDemand, ActuatorLimit, ActuatorReach};
use crate::NoAnswer;

/// Halvings of an interval of frequencies: more than the digits of a double-precision number.
const HALVINGS: usize = 64;

/// At an undamped resonance the margin exceeds that at a relative distance of [`BESIDE`] by this factor: the ratio of that distance to
/// the closeness of an extreme, about 10⁻⁸, with room. A damping ratio above 10⁻⁷ stays below it.
const UNBOUNDED: f64 = 30.0;

/// Relative distance from a resonance.
const BESIDE: f64 = 1e-6;

/// What an actuator can give at one frequency of a dither, and what quenching needs there.
#[derive(Clone, Debug, PartialEq)]
pub struct ActuatorAtFrequency {
    /// The frequency of the dither.
    pub frequency: f64,
    /// The demand of a dither of unit amplitude, or why it is unknown.
    pub demand: Result<ActuatorDemand, NoAnswer>,
    /// The largest fast slip velocity of every contact for unit amplitude, or why it is unknown.
    pub slips: Result<Vec<f64>, NoAnswer>,
    /// The least amplitude that is quiet by averaging, or why no amplitude is.
    pub needed: Result<f64, NoAnswer>,
}

impl ActuatorAtFrequency {
    /// The largest amplitude that the actuator can give.
    ///
    /// # Errors
    /// Why it is unknown.
    pub fn reach(&self) -> Result<ActuatorReach, NoAnswer> {
        Ok(self.demand.as_ref().map_err(Clone::clone)?.reach()?)
    }

    /// The largest amplitude over the least one that quenches; infinite where nothing needs to be quenched.
    ///
    /// # Errors
    /// Why one of them is unknown.
    pub fn margin(&self) -> Result<f64, NoAnswer> {
        Ok(self.reach()?.amplitude / self.needed.clone()?)
    }

    /// The largest slip velocity at a contact under the largest amplitude that the actuator can give.
    ///
    /// # Errors
    /// Why it is unknown.
    pub fn reached_slip(&self, contact: usize) -> Result<f64, NoAnswer> {
        let slips = self.slips.as_ref().map_err(Clone::clone)?;
        let slip = slips.get(contact).ok_or(NoAnswer::NoSlipVelocity)?;
        Ok(slip * self.reach()?.amplitude)
    }

    /// Whether the actuator can quench.
    pub fn suffices(&self) -> bool {
        self.margin().is_ok_and(|margin| margin >= 1.0)
    }

    /// The limit that binds, if all are known.
    fn limit(&self) -> Option<ActuatorLimit> {
        self.reach().ok().map(|reach| reach.limit)
    }

    /// The logarithm of the margin, if it is finite.
    fn level(&self) -> Option<f64> {
        self.margin().ok().map(libm::log).filter(|level| level.is_finite())
    }
}

/// Frequencies over which one limit binds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BindingBand {
    /// Both ends.
    pub ends: RealInterval,
    /// The limit; `None` where the largest amplitude is unknown.
    pub limit: Option<ActuatorLimit>,
}

/// Frequencies over which an actuator can quench.
#[derive(Clone, Debug, PartialEq)]
pub struct SufficientBand {
    /// Both ends.
    pub ends: RealInterval,
    /// The frequency of the largest margin in it.
    pub best: ActuatorAtFrequency,
}

/// Width of a band, relative to its frequency, below which it is narrow: frequencies of a structure are hardly known more closely, and
/// they change with temperature and wear.
const NARROW: f64 = 0.02;

impl SufficientBand {
    /// Its width, relative to its lower end.
    pub fn width(&self) -> f64 {
        self.ends.upper / self.ends.lower - 1.0
    }

    /// Whether it is too narrow to rely on.
    pub fn is_narrow(&self) -> bool {
        self.width() < NARROW
    }
}

/// A frequency at which little dither quenches, because the structure amplifies it.
#[derive(Clone, Debug, PartialEq)]
pub struct DitherResonance {
    /// What is known there.
    pub at: ActuatorAtFrequency,
    /// Whether the margin is larger than at both neighbouring antiresonances, or ends of the range.
    pub helps: bool,
    /// Whether the margin grows without bound: an undamped resonance.
    pub unbounded: bool,
}

/// An actuator over a range of frequencies.
#[derive(Clone, Debug, PartialEq)]
pub struct ActuatorCoverage {
    /// The samples, ascending, those that were added at extremes included.
    pub points: Vec<ActuatorAtFrequency>,
    /// Which limit binds where; neighbours share their ends.
    pub binding: Vec<BindingBand>,
    /// Where the actuator can quench, ascending.
    pub sufficient: Vec<SufficientBand>,
    /// The largest margin of the range; `None` where no margin is finite.
    pub best: Option<ActuatorAtFrequency>,
    /// Resonances of the requirement, ascending.
    pub resonances: Vec<DitherResonance>,
}

/// An actuator at any frequency.
pub type AtFrequency<'a> = dyn Fn(f64) -> ActuatorAtFrequency + 'a;

/// An actuator over a range of frequencies, from its samples in ascending order, at least two.
pub fn coverage(samples: Vec<ActuatorAtFrequency>, at: &AtFrequency<'_>) -> ActuatorCoverage {
    let mut points = samples;
    for limit in limits(&points) {
        let slack = |point: &ActuatorAtFrequency| slack(point, limit);
        // Where another limit dips below the one that binds.
        let dips = extremes(&points, &slack, -1.0, at);
        insert(&mut points, dips, |point| point.limit() == Some(limit));
    }
    let level = ActuatorAtFrequency::level;
    let peaks = extremes(&points, &level, 1.0, at);
    let dips = extremes(&points, &level, -1.0, at);
    insert(&mut points, peaks, |_| true);
    insert(&mut points, dips, |_| true);
    let dips_of_need = extremes(&points, &need, -1.0, at);
    insert(&mut points, dips_of_need.clone(), |_| true);
    let binding = bands(&points, ActuatorAtFrequency::limit, at);
    let binding: Vec<BindingBand> =
        binding.into_iter().map(|(ends, limit)| BindingBand { ends, limit }).collect();
    let quenching = bands(&points, ActuatorAtFrequency::suffices, at);
    let quenching: Vec<RealInterval> =
        quenching.into_iter().filter(|(_, suffices)| *suffices).map(|(ends, _)| ends).collect();
    // The margin may be largest where a limit takes over, or where the margin begins or ceases to be known.
    let known = bands(&points, |point| point.level().is_some(), at);
    let ends = binding.iter().map(|band| band.ends);
    let ends = ends.chain(quenching.iter().copied()).chain(known.into_iter().map(|(ends, _)| ends));
    let ends: Vec<ActuatorAtFrequency> = ends
        .flat_map(|RealInterval { lower: from, upper: to }| [from, to, to * (1.0 - f64::EPSILON)])
        .filter(|end| (points[0].frequency..=points[points.len() - 1].frequency).contains(end))
        .map(at)
        .collect();
    insert(&mut points, ends, |_| true);
    let sufficient = quenching.into_iter().map(|ends| SufficientBand {
        ends,
        best: best(&points, ends).unwrap_or_else(|| at(ends.lower)),
    });
    let sufficient = sufficient.collect();
    let best = best(&points, RealInterval::WHOLE);
    let resonances = resonances(&points, &dips_of_need, at);
    ActuatorCoverage { points, binding, sufficient, best, resonances }
}

impl ActuatorCoverage {
    /// The frequencies at which the limit that binds changes, with the limits below and above.
    pub fn changes(&self) -> impl Iterator<Item = (f64, [Option<ActuatorLimit>; 2])> {
        self.binding.windows(2).map(|pair| (pair[0].ends.upper, [pair[0].limit, pair[1].limit]))
    }
}

/// The limits that are known somewhere.
fn limits(points: &[ActuatorAtFrequency]) -> Vec<ActuatorLimit> {
    let mut limits = Vec::new();
    for demand in points.iter().filter_map(|point| point.demand.as_ref().ok()) {
        for known in &demand.limits {
            if !limits.contains(&known.limit) {
                limits.push(known.limit);
            }
        }
    }
    limits
}

/// The logarithm of the amplitude that a limit allows over that which the others allow, if both are finite.
fn slack(point: &ActuatorAtFrequency, limit: ActuatorLimit) -> Option<f64> {
    let demand = point.demand.as_ref().ok()?;
    let allowed = demand.allowed(limit).ok()?;
    let others = demand.limits.iter().filter(|known| known.limit != limit);
    let least = others
        .map(|known| demand.allowed(known.limit).ok())
        .try_fold(f64::INFINITY, |least, allowed| Some(f64::min(least, allowed?)))?;
    Some(libm::log(allowed / least)).filter(|level| level.is_finite())
}

/// The local maxima (`sign` 1) or minima (`sign` −1) of a level between the samples.
fn extremes(
    points: &[ActuatorAtFrequency],
    level: &dyn Fn(&ActuatorAtFrequency) -> Option<f64>,
    sign: f64,
    at: &AtFrequency<'_>,
) -> Vec<ActuatorAtFrequency> {
    let levels: Vec<Option<f64>> = points.iter().map(level).collect();
    let mut found = Vec::new();
    for (place, triple) in levels.windows(3).enumerate() {
        let [Some(before), Some(here), Some(after)] = triple else { continue };
        if sign * here < sign * before || sign * here <= sign * after {
            continue;
        }
        let (low, high) = (points[place].frequency, points[place + 2].frequency);
        // Outside of what is known nothing is extreme.
        let below = |w: f64| level(&at(w)).map_or(f64::MAX, |level| -sign * level);
        if let Ok(extreme) = minimise(below, low, high, Closeness::default()) {
            found.push(at(extreme.location));
        }
    }
    found
}

/// Inserts the points that a test keeps, in order.
fn insert(
    points: &mut Vec<ActuatorAtFrequency>,
    new: Vec<ActuatorAtFrequency>,
    keep: impl Fn(&ActuatorAtFrequency) -> bool,
) {
    points.extend(new.into_iter().filter(|point| keep(point)));
    ascending_by(points, |a| a.frequency);
    points.dedup_by(|a, b| a.frequency == b.frequency);
}

/// Intervals over which a label is constant, with ends down to rounding.
fn bands<T: PartialEq + Copy>(
    points: &[ActuatorAtFrequency],
    label: impl Fn(&ActuatorAtFrequency) -> T,
    at: &AtFrequency<'_>,
) -> Vec<(RealInterval, T)> {
    let Some(first) = points.first() else { return Vec::new() };
    let (mut begin, mut current) = (first.frequency, label(first));
    let mut found = Vec::new();
    for pair in points.windows(2) {
        let (mut low, high, last) = (pair[0].frequency, pair[1].frequency, label(&pair[1]));
        while current != last {
            let (end, next) = first_change(low, high, (current, last), |w| label(&at(w)));
            found.push((RealInterval::new(begin, end), current));
            (begin, current, low) = (end, next, end);
        }
    }
    found.push((RealInterval::new(begin, points[points.len() - 1].frequency), current));
    found
}

/// The frequency at which a label ends that holds at `low` and not at `high`, and the label beyond.
fn first_change<T: PartialEq + Copy>(
    mut low: f64,
    mut high: f64,
    (is, mut beyond): (T, T),
    label: impl Fn(f64) -> T,
) -> (f64, T) {
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(low, high);
        if middle <= low || middle >= high {
            break;
        }
        let there = label(middle);
        if there == is {
            low = middle;
        } else {
            (high, beyond) = (middle, there);
        }
    }
    (high, beyond)
}

/// The largest finite margin between two frequencies.
fn best(points: &[ActuatorAtFrequency], ends: RealInterval) -> Option<ActuatorAtFrequency> {
    let inside = points.iter().filter(|point| ends.contains(point.frequency));
    let known = inside.filter_map(|point| Some((point, point.level()?)));
    known.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(point, _)| point.clone())
}

/// The logarithm of the requirement, if it is finite.
fn need(point: &ActuatorAtFrequency) -> Option<f64> {
    let needed = point.needed.as_ref().ok().map(|needed| libm::log(*needed));
    needed.filter(|level| level.is_finite())
}

/// The local minima of the requirement, and whether the margin gains there.
fn resonances(
    points: &[ActuatorAtFrequency],
    dips: &[ActuatorAtFrequency],
    at: &AtFrequency<'_>,
) -> Vec<DitherResonance> {
    let peaks = extremes(points, &need, 1.0, at);
    let known: Vec<&ActuatorAtFrequency> =
        points.iter().filter(|point| need(point).is_some()).collect();
    let ends = [known.first().copied(), known.last().copied()];
    let found = dips.iter().map(|dip| {
        let level = dip.level();
        let before = peaks.iter().rfind(|peak| peak.frequency < dip.frequency).or(ends[0]);
        let after = peaks.iter().find(|peak| peak.frequency > dip.frequency).or(ends[1]);
        let gains = |neighbour: Option<&ActuatorAtFrequency>| {
            let other = neighbour.and_then(ActuatorAtFrequency::level);
            level.is_some_and(|level| other.is_none_or(|other| level > other))
        };
        let beside = at(dip.frequency * (1.0 + BESIDE));
        let steep = need(&beside).zip(need(dip));
        let unbounded = steep.is_some_and(|(beside, here)| beside - here >= libm::log(UNBOUNDED));
        DitherResonance { at: dip.clone(), helps: gains(before) && gains(after), unbounded }
    });
    found.collect()
}

#[cfg(test)]
mod tests {
    use super::super::demand::{LimitUse, SignalSize, UnknownDemand};
    use super::*;

    const NOTHING: SignalSize = SignalSize { peak: 0.0, root_mean_square: 0.0, peak_to_peak: 0.0 };

    /// Limits that allow given amplitudes, and a requirement.
    fn known(
        frequency: f64,
        allowed: &[(ActuatorLimit, f64)],
        needed: Result<f64, NoAnswer>,
    ) -> ActuatorAtFrequency {
        let limits = allowed
            .iter()
            .map(|(limit, allowed)| LimitUse { limit: *limit, used: Ok(allowed.recip()) })
            .collect();
        let demand = ActuatorDemand {
            in_series: false,
            force: NOTHING,
            displacement: NOTHING,
            voltage: Err(UnknownDemand::NoLimit),
            current: Err(UnknownDemand::NoLimit),
            change_of_structure: 0.0,
            samples_per_period: None,
            limits,
        };
        ActuatorAtFrequency { frequency, demand: Ok(demand), slips: Ok(vec![1.0]), needed }
    }

    fn sampled(at: &AtFrequency<'_>) -> Vec<ActuatorAtFrequency> {
        (0..=40).map(|k| at(1.0 + 0.1 * f64::from(k))).collect()
    }

    fn close(value: f64, exact: f64) {
        assert!((value / exact - 1.0).abs() < 1e-12, "{value} should be {exact}");
    }

    /// A voltage that falls as 1/w and a current that falls as 1/w² cross at 2.34; the requirement is 0.2 from 1.7 on.
    #[test]
    fn planted_changes_are_found_exactly() {
        let at = |w: f64| {
            let allowed = [
                (ActuatorLimit::MaximumVoltage, 1.0 / w),
                (ActuatorLimit::MaximumCurrent, 2.34 / (w * w)),
            ];
            let needed = if w < 1.7 { Err(NoAnswer::NeverQuiet) } else { Ok(0.2) };
            known(w, &allowed, needed)
        };
        let found = coverage(sampled(&at), &at);
        let changes: Vec<_> = found.changes().collect();
        let [(change, limits)] = changes[..] else { panic!("one change: {changes:?}") };
        close(change, 2.34);
        assert_eq!(
            limits,
            [Some(ActuatorLimit::MaximumVoltage), Some(ActuatorLimit::MaximumCurrent)]
        );
        let [band] = &found.sufficient[..] else { panic!("one band: {:?}", found.sufficient) };
        close(band.ends.lower, 1.7);
        close(band.ends.upper, (2.34_f64 / 0.2).sqrt());
        // The margin falls with the frequency, so that it is largest where it begins to be known, between two samples.
        assert!(found.best.is_some_and(|best| (best.frequency / 1.7 - 1.0).abs() < 1e-12));
    }

    /// Between two samples a third limit binds, and the margin falls below 1, over less than the distance of the samples.
    #[test]
    fn what_lies_between_two_samples_is_found() {
        let centre = 3.033;
        let at = |w: f64| {
            let dip = 0.5 + 40.0 * (w - centre).abs();
            let allowed = [(ActuatorLimit::MaximumVoltage, 1.0), (ActuatorLimit::FreeStroke, dip)];
            known(w, &allowed, Ok(0.8))
        };
        let found = coverage(sampled(&at), &at);
        let changes: Vec<f64> = found.changes().map(|(at, _)| at).collect();
        assert_eq!(changes.len(), 2, "{changes:?}");
        close(changes[0], centre - 0.5 / 40.0);
        close(changes[1], centre + 0.5 / 40.0);
        let ends: Vec<RealInterval> = found.sufficient.iter().map(|band| band.ends).collect();
        assert_eq!(ends.len(), 2, "{ends:?}");
        close(ends[0].upper, centre - 0.3 / 40.0);
        close(ends[1].lower, centre + 0.3 / 40.0);
    }

    /// A resonance lowers the requirement; it helps unless the actuator loses as much there.
    #[test]
    fn a_resonance_helps_where_the_margin_gains() {
        let requirement = |w: f64| 0.1 + (w - 3.05) * (w - 3.05);
        let strong = |w: f64| known(w, &[(ActuatorLimit::RmsCurrent, 1.0)], Ok(requirement(w)));
        let found = coverage(sampled(&strong), &strong);
        let [resonance] = &found.resonances[..] else { panic!("{:?}", found.resonances) };
        assert!(resonance.helps && !resonance.unbounded);
        assert!((resonance.at.frequency - 3.05).abs() < 1e-6);
        assert!(found.best.is_some_and(|best| (best.frequency - 3.05).abs() < 1e-6));
        // A stroke falls faster than the requirement.
        let short = |w: f64| {
            let allowed = requirement(w) * requirement(w);
            known(w, &[(ActuatorLimit::FreeStroke, allowed)], Ok(requirement(w)))
        };
        let found = coverage(sampled(&short), &short);
        assert!(!found.resonances[0].helps);
        let undamped = |w: f64| known(w, &[(ActuatorLimit::RmsCurrent, 1.0)], Ok((w - 3.05).abs()));
        let found = coverage(sampled(&undamped), &undamped);
        assert!(found.resonances[0].unbounded);
    }
}
