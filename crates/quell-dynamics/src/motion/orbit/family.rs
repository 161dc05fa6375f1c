//! A system with parameters as a family of period maps.
//!
//! The state is that at t = 0. A motion in which every contact slips is continued beyond a grazing of γ = 0, or of N = 0, with
//! every contact kept in its phase; the least slip velocity or load is its distance from the border. Other motions are integrated
//! as they are.

use std::fmt;

use quell_linear::pure_slip::period;
use quell_model::System;
use quell_numerics::continuation::{Image, PeriodMap};

use super::super::{
    ContactPhase, Immobile, LeastDistance, MOTION_TOLERANCE, Motion, MotionEnd, MotionObserver,
    MotionStart, MotionStopped, MotionVariation,
};
use crate::simulation::EventKind;

/// The sequence of events in a period.
#[derive(Clone, Debug, PartialEq)]
pub enum MotionSignature {
    /// No event: what each contact does.
    Steady(Vec<ContactPhase>),
    /// These events in their cyclic order, contact by contact with the sign of γ afterwards. Of the cyclic permutations the
    /// least one is taken, so that the order does not depend on the phase of t = 0.
    Events(Vec<(EventKind, usize, i8)>),
}

impl MotionSignature {
    /// The signature of events and the phases at the end.
    pub(crate) fn of(events: &[(EventKind, usize, i8)], phases: Vec<ContactPhase>) -> Self {
        if events.is_empty() {
            return Self::Steady(phases);
        }
        let key = |first: usize| {
            let rotated = events[first..].iter().chain(&events[..first]);
            rotated.map(|(kind, contact, sign)| (*kind as u8, *contact, *sign)).collect::<Vec<_>>()
        };
        let first = (0..events.len()).min_by_key(|first| key(*first)).unwrap_or(0);
        Self::Events([&events[first..], &events[..first]].concat())
    }

    /// Whether every contact slips throughout.
    pub fn is_pure_slip(&self) -> bool {
        matches!(self, Self::Steady(phases)
            if phases.iter().all(|phase| matches!(phase, ContactPhase::Slip(_))))
    }

    /// Number of events of a kind.
    pub fn count(&self, kind: EventKind) -> usize {
        match self {
            Self::Steady(_) => 0,
            Self::Events(events) => events.iter().filter(|event| event.0 == kind).count(),
        }
    }
}

/// Why there is no image.
#[derive(Clone, Debug, PartialEq)]
pub enum NoImage {
    /// The system cannot take these parameters.
    Invalid(String),
    /// The motion cannot be computed.
    Immobile(Immobile),
    /// The run ended early.
    Stopped(MotionStopped),
    /// The dithers have no common period.
    NoPeriod,
    /// The variational equation could not be integrated.
    NoVariation,
}

impl fmt::Display for NoImage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Invalid(why) => f.write_str(why),
            Self::Immobile(why) => why.fmt(f),
            Self::Stopped(why) => why.fmt(f),
            Self::NoPeriod => f.write_str("the frequencies of the dithers have no common period"),
            Self::NoVariation => f.write_str("the variational equation could not be integrated"),
        }
    }
}

/// A system as a function of parameters.
pub type SystemAt<'a> = dyn Fn(&[f64]) -> Result<System, String> + 'a;

/// The period map of a system with parameters.
pub struct MotionFamily<'a> {
    /// The system at given parameters.
    pub at: &'a SystemAt<'a>,
    /// Number of common periods of the dithers in a period of the motion.
    pub periods: u32,
    /// Length of the state, and the typical size of its numbers.
    pub size: usize,
    /// Typical size of the numbers of a state.
    pub scale: f64,
}

/// The time over which the states of a system are mapped. Without waves, where only steady sliding is followed, it is a time
/// scale of the system that no motion of it is expected to have as its period.
pub(crate) fn time_of(motion: &Motion<'_>, periods: u32) -> Result<f64, NoImage> {
    if !motion.system().has_waves() {
        return Ok(motion.time_scale());
    }
    period(motion.system()).map(|period| f64::from(periods) * period).ok_or(NoImage::NoPeriod)
}

/// The image of a state after a time, with its derivative and events.
pub(crate) fn shot(
    motion: &Motion<'_>,
    state: &[f64],
    time: f64,
    held: Option<&MotionSignature>,
) -> Result<(Image<MotionSignature>, Shot), NoImage> {
    shot_within(motion, state, time, held, MOTION_TOLERANCE)
}

/// The same with another tolerance, which contacts that keep their phases do not take.
pub(super) fn shot_within(
    motion: &Motion<'_>,
    state: &[f64],
    time: f64,
    held: Option<&MotionSignature>,
    tolerance: f64,
) -> Result<(Image<MotionSignature>, Shot), NoImage> {
    let mut variation = MotionVariation::new(motion);
    let (end, kept) = run_over(motion, state, (time, tolerance), held, &mut variation)?;
    if variation.has_failed {
        return Err(NoImage::NoVariation);
    }
    let phases: Vec<ContactPhase> = end.contacts.iter().map(|contact| contact.phase).collect();
    let events: Vec<_> =
        variation.events.iter().map(|event| (event.kind, event.contact, event.slip_sign)).collect();
    let signature = match kept {
        Some(phases) => MotionSignature::Steady(phases.clone()),
        None => MotionSignature::of(&events, phases),
    };
    let distance = match variation.least {
        Some(least) if signature.is_pure_slip() => least.distance,
        _ => f64::INFINITY,
    };
    let image = Image { state: end.state, derivative: variation.matrix(), distance, signature };
    let MotionVariation { events, is_one_sided, least, approaches, .. } = variation;
    Ok((image, Shot { events, is_one_sided, least, approaches }))
}

/// The run over a time, and the phases that the contacts keep on it if they do.
fn run_over<'s>(
    motion: &Motion<'_>,
    state: &[f64],
    (time, tolerance): (f64, f64),
    held: Option<&'s MotionSignature>,
    observer: &mut dyn MotionObserver,
) -> Result<(MotionEnd, Option<&'s Vec<ContactPhase>>), NoImage> {
    let start = MotionStart { time: 0.0, state: state.to_vec() };
    let kept = match held {
        Some(MotionSignature::Steady(phases))
            if held.is_some_and(MotionSignature::is_pure_slip) =>
        {
            Some(phases)
        }
        _ => None,
    };
    let end = match kept {
        Some(phases) => motion.continued(&start, phases, time, observer),
        None => motion.run(&start, time, tolerance, observer),
    };
    end.map(|end| (end, kept)).map_err(NoImage::Stopped)
}

/// What a shot met on its way.
pub(crate) struct Shot {
    pub(crate) events: Vec<super::super::RecordedEvent>,
    pub(crate) is_one_sided: bool,
    /// The nearest event of a contact that slips.
    pub(crate) least: Option<LeastDistance>,
    /// The least distance of each contact from its events: of its slip velocity and of its load.
    pub(crate) approaches: Vec<[f64; 2]>,
}

impl PeriodMap for MotionFamily<'_> {
    type Signature = MotionSignature;
    type Error = NoImage;

    fn dimension(&self) -> usize {
        self.size
    }

    fn scale(&self) -> f64 {
        self.scale
    }

    fn image(
        &self,
        state: &[f64],
        parameters: &[f64],
        held: Option<&MotionSignature>,
    ) -> Result<Image<MotionSignature>, NoImage> {
        let system = (self.at)(parameters).map_err(NoImage::Invalid)?;
        let motion = Motion::new(&system).map_err(NoImage::Immobile)?;
        let time = time_of(&motion, self.periods)?;
        shot(&motion, state, time, held).map(|(image, _)| image)
    }

    fn image_state(
        &self,
        state: &[f64],
        parameters: &[f64],
        held: Option<&MotionSignature>,
    ) -> Result<Vec<f64>, NoImage> {
        let system = (self.at)(parameters).map_err(NoImage::Invalid)?;
        let motion = Motion::new(&system).map_err(NoImage::Immobile)?;
        let time = time_of(&motion, self.periods)?;
        run_over(&motion, state, (time, MOTION_TOLERANCE), held, &mut ()).map(|(end, _)| end.state)
    }
}
