//! The motion of every belt: by the engine for belts, or by that for systems where drive, load or amplitude vary in time.
//!
//! The engine for belts ([`crate::simulation`]) is faster and has constant drives; that for systems ([`crate::motion`]) has every
//! belt. Observers of belts see both.

use std::fmt;

use quell_model::{Belt, System};

use crate::motion::orbit::sliding_state;
use crate::motion::{
    ContactEnd, ContactPhase, MOTION_TOLERANCE, Motion, MotionEnd, MotionEvent, MotionMoment,
    MotionObserver, MotionSegment, MotionStart, MotionStopped,
};
use crate::simulation::{Event, FinalState, Observer, Segment, Stalled, Start, simulate};

/// The end of a run of a belt.
#[derive(Clone, Debug, PartialEq)]
pub struct BeltEnd {
    /// The final state.
    pub state: FinalState,
    /// The contact at the end; `None` where the engine for belts has run.
    pub contact: Option<ContactEnd>,
}

/// Why a run of a belt ended early.
#[derive(Clone, Debug, PartialEq)]
pub enum BeltStopped {
    /// The engine for belts could not continue.
    Stalled(Stalled),
    /// The engine for systems could not continue.
    Stopped(MotionStopped),
    /// The belt has no motion, with the reason.
    Immobile(String),
}

impl fmt::Display for BeltStopped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stalled(why) => why.fmt(f),
            Self::Stopped(why) => why.fmt(f),
            Self::Immobile(why) => f.write_str(why),
        }
    }
}

impl std::error::Error for BeltStopped {}

/// Whether the engine for belts has the motion of a belt: nothing but the dither varies in time, and friction has no state.
pub fn is_of_the_engine_for_belts(belt: &Belt) -> bool {
    belt.is_steady() && !belt.has_contact_state()
}

/// The state of a contact that has one, where a run of a belt begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ContactStart {
    /// Without load: T of an elastic slider and z of bristles are zero.
    Relaxed,
    /// As in steady sliding.
    Sliding,
    /// With this number, in which an earlier run has ended: T of an elastic slider, or z of bristles.
    Carried(f64),
}

impl BeltEnd {
    /// The start of a run that goes on from here.
    pub fn restart(&self) -> (Start, ContactStart) {
        let own = self.contact.map(|contact| contact.bristle.unwrap_or(contact.friction));
        (self.state.restart(), own.map_or(ContactStart::Relaxed, ContactStart::Carried))
    }
}

/// The start of a belt's run as that of its system.
pub fn motion_start(system: &System, (start, contact): (Start, ContactStart)) -> MotionStart {
    let mut state = vec![start.displacement, start.velocity];
    let structure = state.len();
    state.resize(system.state_size(), 0.0);
    match contact {
        ContactStart::Relaxed => {}
        ContactStart::Carried(own) => state[structure..].fill(own),
        ContactStart::Sliding => {
            if let Ok(sliding) = sliding_state(system) {
                state[structure..].copy_from_slice(&sliding[structure..]);
            }
        }
    }
    MotionStart { time: start.time, state }
}

/// Integrates `belt` from `start` to τ = `until` and passes every segment and event to `observer`.
///
/// `tolerance` bounds the last two retained Taylor terms of a step relative to F, as in
/// [`simulate`]; the engine for systems takes the smaller of it and its own.
///
/// # Errors
/// [`BeltStopped`] with time and reason.
pub fn run_belt(
    belt: &Belt,
    (start, contact): (Start, ContactStart),
    until: f64,
    tolerance: f64,
    observer: &mut dyn Observer,
) -> Result<BeltEnd, BeltStopped> {
    if is_of_the_engine_for_belts(belt) {
        let state = simulate(belt, start, until, tolerance, observer);
        return Ok(BeltEnd { state: state.map_err(BeltStopped::Stalled)?, contact: None });
    }
    let system = belt.system();
    let motion = Motion::new(&system).map_err(|why| BeltStopped::Immobile(why.to_string()))?;
    let start = motion_start(&system, (start, contact));
    let mut watch = AsBelt { observer, is_jump: false };
    let end = motion.run(&start, until, tolerance.min(MOTION_TOLERANCE), &mut watch);
    let end = end.map_err(BeltStopped::Stopped)?;
    Ok(BeltEnd { state: final_state(&end), contact: end.contacts.first().copied() })
}

fn final_state(end: &MotionEnd) -> FinalState {
    let phase = end.contacts.first().map_or(ContactPhase::Stick, |contact| contact.phase);
    FinalState {
        time: end.time,
        displacement: end.state[0],
        velocity: end.state[1],
        sticking: phase == ContactPhase::Stick,
        slip_sign: phase.slip_sign(),
        events: end.events,
        steps: end.steps,
        near_tangential_releases: end.near_tangential_releases,
    }
}

/// Shows the motion of a belt as a system to an observer of belts.
struct AsBelt<'a> {
    observer: &'a mut dyn Observer,
    /// Whether the events of this moment are caused by a jump of the dither.
    is_jump: bool,
}

impl MotionObserver for AsBelt<'_> {
    fn segment(&mut self, segment: &MotionSegment<'_>) {
        let displacement = segment.row(&[1.0], 0);
        self.observer.segment(&Segment::of_motion(
            (segment.clock(), segment.duration()),
            segment.phase(0).slip_sign(),
            segment.surface(0),
            &displacement,
            segment.slip_velocity(0),
        ));
    }

    fn moment(&mut self, moment: &MotionMoment<'_>) {
        self.is_jump = moment.is_jump;
    }

    fn event(&mut self, event: &MotionEvent<'_>) {
        self.observer.event(&Event {
            time: event.time,
            contact: event.contact,
            kind: event.kind,
            slip_sign: event.slip_sign,
            displacement: event.state[0],
            velocity: event.state[1],
            is_jump: self.is_jump,
        });
    }

    fn watches(&self) -> bool {
        self.observer.watches()
    }
}
