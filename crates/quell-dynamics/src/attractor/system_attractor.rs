//! The motion on which a run of any system ends.

use quell_model::System;
use quell_numerics::interval::RealInterval;

use super::rotation::Rotation;
use crate::orbit::{CycleSamples, nearest_distance};

/// Mismatch of states, relative to their size, of one motion.
pub(super) const SAME: f64 = 1e-5;

/// The kind of a motion on which a run ends.
#[derive(Clone, Debug, PartialEq)]
pub enum MotionKind {
    /// It repeats after this number of periods of the dither.
    Periodic {
        /// The number of periods.
        periods: u32,
        /// Modulus of the deciding multiplier.
        radius: f64,
    },
    /// It fills a closed curve of the section, by its rotation number; known of one mass alone.
    QuasiPeriodic {
        /// Periods of the dither over which it was followed.
        tried: u32,
    },
    /// It does not repeat itself.
    NotPeriodic {
        /// Periods of the dither over which it was followed.
        tried: u32,
    },
    /// A limit cycle without dither.
    Cycle {
        /// Its period.
        period: f64,
        /// Modulus of the deciding multiplier.
        radius: f64,
    },
    /// Rest or steady sliding, without dither.
    Rest,
}

/// The motion on which a run ends.
#[derive(Clone, Debug, PartialEq)]
pub struct SystemAttractor {
    /// Its kind.
    pub kind: MotionKind,
    /// Whether it is the response that continues steady sliding as the dither grows; `None` where that is not known, and without dither.
    pub base: Option<bool>,
    /// Whether it is quiet: in step with the dither, or periodic with a frequency above the band of the vibration; at rest without it.
    pub quiet: bool,
    /// Slow revolutions per period of the dither; `None` of a motion in step with it, and where they are not known.
    pub rotation: Option<Rotation>,
    /// Angular frequency of the slow revolutions.
    pub slow: Option<f64>,
    /// A state of it at a whole period of the dither.
    pub state: Vec<f64>,
    /// Its states at whole periods; of a limit cycle also those at its events.
    pub states: Vec<Vec<f64>>,
    /// Observed displacement at whole periods.
    pub section: Vec<f64>,
    /// Least and largest observed displacement.
    pub extremes: RealInterval,
    /// Share of the time that each contact sticks.
    pub stick: Vec<f64>,
    /// Largest slip speed of each contact.
    pub largest_slip: Vec<f64>,
}

impl SystemAttractor {
    /// Words of its kinds, with their codes in datasets.
    pub const KINDS: [(u8, &str); 7] = [
        (0, "period-1"),
        (1, "locked"),
        (2, "not-periodic"),
        (3, "limit-cycle"),
        (4, "rest"),
        (5, "unknown"),
        (6, "quasi-periodic"),
    ];

    pub(super) fn new(
        kind: MotionKind,
        row: &[f64],
        states: Vec<Vec<f64>>,
        samples: &CycleSamples,
    ) -> Self {
        let observed =
            |state: &Vec<f64>| -> f64 { row.iter().zip(state).map(|(w, x)| w * x).sum() };
        let section: Vec<f64> = states.iter().map(observed).collect();
        let [range, _] = samples.extremes();
        let bounds = section.iter().fold(range, |range, x| range.hull(RealInterval::point(*x)));
        let means = samples.means().into_iter();
        let stick: Vec<f64> = means.map(|means| means.stick_fraction).collect();
        let largest_slip = (0..stick.len()).map(|contact| samples.largest_slip(contact)).collect();
        let state = states.first().cloned().unwrap_or_default();
        let (base, rotation, slow) = (None, None, None);
        let quiet = kind == MotionKind::Rest;
        Self {
            kind,
            base,
            quiet,
            rotation,
            slow,
            state,
            states,
            section,
            extremes: bounds,
            stick,
            largest_slip,
        }
    }

    /// Peak-to-peak of the observed displacement.
    pub fn size(&self) -> f64 {
        self.extremes.width()
    }

    /// Whether it is steady sliding: without dither and at rest, while every contact slips.
    pub fn slides(&self) -> bool {
        self.kind == MotionKind::Rest && self.stick.iter().all(|share| *share == 0.0)
    }

    /// Name of its kind in JSON.
    pub fn kind_name(&self) -> &'static str {
        Self::KINDS[usize::from(self.kind_code())].1
    }

    /// Code of its kind in datasets.
    pub fn kind_code(&self) -> u8 {
        match self.kind {
            MotionKind::Periodic { periods: 1, .. } => 0,
            MotionKind::Periodic { .. } => 1,
            MotionKind::NotPeriodic { .. } => 2,
            MotionKind::Cycle { .. } => 3,
            MotionKind::Rest => 4,
            MotionKind::QuasiPeriodic { .. } => 6,
        }
    }

    /// Whether both are one motion of a system: periodic with the same states, perhaps after some periods of the dither, or the same
    /// cycle, found at another of its moments.
    pub fn is(&self, other: &Self, system: &System) -> bool {
        let size = self.state.iter().chain(&self.section).fold(0.0, |m: f64, x| m.max(x.abs()));
        let near = |state: &Vec<f64>| {
            let pairs = state.iter().zip(&self.state);
            pairs.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs())) <= SAME * size
        };
        match (&self.kind, &other.kind) {
            (
                MotionKind::Periodic { periods, .. },
                MotionKind::Periodic { periods: others, .. },
            ) => periods == others && other.states.iter().any(near),
            (MotionKind::Cycle { period, .. }, MotionKind::Cycle { period: others, .. }) => {
                let passes =
                    || nearest_distance(system, (&other.state, *others), &self.state) <= SAME;
                (period - others).abs() <= SAME * period
                    && (other.states.iter().any(near) || passes())
            }
            // A record shows a part of a motion that is not periodic: such motions count as one.
            (MotionKind::Rest, MotionKind::Rest)
            | (MotionKind::QuasiPeriodic { .. }, MotionKind::QuasiPeriodic { .. })
            | (MotionKind::NotPeriodic { .. }, MotionKind::NotPeriodic { .. }) => true,
            _ => false,
        }
    }
}
