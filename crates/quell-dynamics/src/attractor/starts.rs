//! Where many starts of one system end, and which of them on the same motion.

use std::fmt;

use quell_model::{OneMass, System};

use super::basin::{BasinLabel, BasinsOfAttraction, gather};
use super::end_of_run::{
    EndOfRun, NoEnd, ends_of_runs, judged_mass, measured_of_one_mass, starts_of_mass,
};
use super::settings::AttractorSettings;
use super::settle::{Patience, Settled, settle_many};
use super::system_attractor::SystemAttractor;
use super::unsettled::Unsettled;
use crate::simulation::Stalled;

/// The judge of many starts of one system: the sections of one mass, or every run by itself.
#[derive(Debug)]
pub struct StartJudge<'a> {
    system: &'a System,
    /// The observed row.
    row: &'a [f64],
    sections: Option<(OneMass, AttractorSettings)>,
}

/// Where some starts end, not yet grouped.
#[derive(Clone, Debug)]
pub enum JudgedStarts {
    /// By the sections of one mass.
    Sections(Vec<Result<Settled, Stalled>>),
    /// Each by itself.
    Each(Vec<Result<EndOfRun, NoEnd>>),
}

/// Why the motion on which a start ends is unknown.
#[derive(Clone, Debug, PartialEq)]
pub enum UnknownEnd {
    /// A run of one mass had not settled.
    Unsettled(Unsettled),
    /// A run of one mass stopped, for this reason.
    Stalled(&'static str),
    /// The run by itself has no known end.
    NoEnd(NoEnd),
}

impl fmt::Display for UnknownEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unsettled(why) => f.write_str(why.about()),
            Self::Stalled(why) => f.write_str(why),
            Self::NoEnd(why) => why.fmt(f),
        }
    }
}

impl std::error::Error for UnknownEnd {}

/// Starts grouped by the motions on which they end.
#[derive(Clone, Debug, Default)]
pub struct GroupedStarts {
    /// The motions, with the most periods of the dither that a start took.
    pub motions: Vec<(SystemAttractor, u32)>,
    /// The motion of each start, or why it is unknown.
    pub ends: Vec<Result<usize, UnknownEnd>>,
}

impl<'a> StartJudge<'a> {
    /// The judge of a system, whose motions are observed by a row over the coordinates.
    pub fn new(system: &'a System, row: &'a [f64]) -> Self {
        // Without a common period no section judges: the runs say so.
        let sections = judged_mass(system).and_then(|mass| {
            let settings = AttractorSettings::new(mass.belt()).ok()?;
            Some((mass, settings))
        });
        Self { system, row, sections }
    }

    /// Where starts end. The outcome of a start is independent of all others.
    pub fn of(&self, states: &[Vec<f64>]) -> JudgedStarts {
        match &self.sections {
            Some((mass, settings)) => {
                let starts = starts_of_mass(mass, states);
                JudgedStarts::Sections(settle_many(settings, &starts, Patience::BASIN))
            }
            None => JudgedStarts::Each(ends_of_runs(self.system, self.row, states)),
        }
    }

    /// All starts, in their order, grouped by motion. Each motion of one mass is measured once.
    ///
    /// # Errors
    /// [`NoEnd`] while a motion is measured.
    pub fn grouped(
        &self,
        parts: impl IntoIterator<Item = JudgedStarts>,
    ) -> Result<GroupedStarts, NoEnd> {
        let (mut settled, mut each) = (Vec::new(), Vec::new());
        for part in parts {
            match part {
                JudgedStarts::Sections(part) => settled.extend(part),
                JudgedStarts::Each(part) => each.extend(part),
            }
        }
        match &self.sections {
            Some((mass, settings)) => self.by_sections(mass, settings, &settled),
            None => Ok(GroupedStarts::of(self.system, each)),
        }
    }

    fn by_sections(
        &self,
        mass: &OneMass,
        settings: &AttractorSettings,
        settled: &[Result<Settled, Stalled>],
    ) -> Result<GroupedStarts, NoEnd> {
        let gathered = gather(settings, settled);
        let BasinsOfAttraction { basins, labels } =
            gathered.map_err(|why| NoEnd::of_mass(mass, &why))?;
        let periods = |basin: usize| {
            let mine = labels.iter().zip(settled).filter_map(|(label, run)| {
                let is_mine = *label == BasinLabel::Attractor(basin);
                run.as_ref().ok().filter(|_| is_mine).map(|run| run.periods)
            });
            u32::try_from(mine.max().unwrap_or(0)).unwrap_or(u32::MAX)
        };
        let motions = basins.iter().enumerate().map(|(place, basin)| {
            let periods = periods(place);
            let of = (self.system, mass);
            Ok((measured_of_one_mass(of, self.row, &basin.attractor, periods)?, periods))
        });
        let ends = labels.iter().map(|label| match label {
            BasinLabel::Attractor(place) => Ok(*place),
            BasinLabel::Unsettled(why) => Err(UnknownEnd::Unsettled(*why)),
            BasinLabel::Stalled(stalled) => Err(UnknownEnd::Stalled(stalled.why)),
        });
        Ok(GroupedStarts { motions: motions.collect::<Result<_, NoEnd>>()?, ends: ends.collect() })
    }
}

impl GroupedStarts {
    /// Ends of runs, of which the same motions are one.
    fn of(system: &System, found: Vec<Result<EndOfRun, NoEnd>>) -> Self {
        let mut motions: Vec<(SystemAttractor, u32)> = Vec::new();
        let mut place_of = |EndOfRun { attractor, periods }| {
            let place = motions.iter().position(|(known, _)| attractor.is(known, system));
            let place = place.unwrap_or_else(|| {
                motions.push((attractor, 0));
                motions.len() - 1
            });
            motions[place].1 = motions[place].1.max(periods);
            place
        };
        let ends = found.into_iter().map(|end| end.map(&mut place_of).map_err(UnknownEnd::NoEnd));
        let ends = ends.collect();
        Self { motions, ends }
    }
}
