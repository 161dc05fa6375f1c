//! A system with parameters as a family of period maps.
//!
//! The state is that at t = 0. A contact that slips throughout the period is continued beyond a grazing of γ = 0, or of N = 0, in
//! its phase, regardless of the other contacts; the least slip velocity or load of these contacts is the distance from the border. The
//! events of the other contacts are integrated as they are.

use std::fmt;

use quell_linear::pure_slip::period;
use quell_model::system::Contact;
use quell_model::{RefusedNumbers, System};
use quell_numerics::continuation::{Image, PeriodMap};
use quell_numerics::cyclic::least_rotation;

use crate::motion::{
    ContactPhase, Immobile, MOTION_TOLERANCE, MassShot, Motion, MotionEnd, MotionObserver,
    MotionStart, MotionStopped, MotionVariation, RecordedEvent,
};
use crate::simulation::{EventKind, count_taken};

/// The sequence of events in a period.
#[derive(Clone, Debug, PartialEq)]
pub enum MotionSignature {
    /// No event: what each contact does.
    Steady(Vec<ContactPhase>),
    /// Events of some contacts.
    Events {
        /// The events in their cyclic order, contact by contact with the sign of γ afterwards. Of the cyclic permutations the
        /// least one is taken, so that the order does not depend on the phase of t = 0.
        sequence: Vec<(EventKind, usize, i8)>,
        /// What each contact without an event does; `None` for the others.
        others: Vec<Option<ContactPhase>>,
    },
}

/// A border that a contact reaches: of its slip velocity, or of its load.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct BorderGuard {
    pub(crate) contact: usize,
    /// Whether the contact opens there.
    pub(crate) is_load: bool,
}

impl MotionSignature {
    /// The signature of events and the phases at the end.
    pub(crate) fn of(events: &[(EventKind, usize, i8)], phases: Vec<ContactPhase>) -> Self {
        if events.is_empty() {
            return Self::Steady(phases);
        }
        let first = least_rotation(events, |(kind, contact, sign)| (*kind as u8, *contact, *sign));
        let acts = |contact: usize| events.iter().any(|(_, acting, _)| *acting == contact);
        let others = phases.into_iter().enumerate();
        let others = others.map(|(contact, phase)| (!acts(contact)).then_some(phase)).collect();
        Self::Events { sequence: [&events[first..], &events[..first]].concat(), others }
    }

    /// What a contact does throughout the period; `None` where it has events.
    pub fn throughout(&self, contact: usize) -> Option<ContactPhase> {
        match self {
            Self::Steady(phases) => phases.get(contact).copied(),
            Self::Events { others, .. } => others.get(contact).copied().flatten(),
        }
    }

    /// The phase of every contact that slips throughout, which can be kept beyond its border; `None` for the others.
    fn slipping(&self, contacts: usize) -> Vec<Option<ContactPhase>> {
        let slips = |phase: &ContactPhase| matches!(phase, ContactPhase::Slip(_));
        (0..contacts).map(|contact| self.throughout(contact).filter(slips)).collect()
    }

    /// The signatures with fewer events in which some contacts with events slip throughout instead, in the direction of their
    /// surfaces: the pieces that a motion with this signature may border on at a grazing of these contacts.
    fn with_fewer_events(&self, directions: &[i8]) -> Vec<Self> {
        let Self::Events { sequence, others } = self else { return Vec::new() };
        let acting: Vec<usize> = (0..others.len()).filter(|c| others[*c].is_none()).collect();
        let sets: Vec<Vec<usize>> = if acting.len() <= MOST_COMBINED {
            let member = |set: usize, place: usize| set >> place & 1 == 1;
            let of = |set| (0..acting.len()).filter(move |place| member(set, *place));
            (1..1 << acting.len()).map(|set| of(set).map(|place| acting[place]).collect()).collect()
        } else {
            let single = acting.iter().map(|contact| vec![*contact]);
            single.chain([acting.clone()]).collect()
        };
        let without = |set: &Vec<usize>| {
            let stays = |event: &&(EventKind, usize, i8)| !set.contains(&event.1);
            let sequence: Vec<_> = sequence.iter().filter(stays).copied().collect();
            let phase =
                |contact: usize| others[contact].unwrap_or(ContactPhase::Slip(directions[contact]));
            Self::of(&sequence, (0..others.len()).map(phase).collect())
        };
        sets.iter().map(without).collect()
    }

    /// Whether every contact slips throughout.
    pub fn is_pure_slip(&self) -> bool {
        matches!(self, Self::Steady(phases)
            if phases.iter().all(|phase| matches!(phase, ContactPhase::Slip(_))))
    }

    /// What the contacts do in a period, such as "1 stick, 2 reversals"; of several contacts each by its name.
    pub fn words(&self, contacts: &[String]) -> String {
        match contacts {
            [_] => self.words_of(0),
            several => {
                let each = several.iter().enumerate();
                let each =
                    each.map(|(contact, name)| format!("{name}: {}", self.words_of(contact)));
                each.collect::<Vec<_>>().join("; ")
            }
        }
    }

    fn words_of(&self, contact: usize) -> String {
        match (self.throughout(contact), self) {
            (Some(ContactPhase::Slip(_)), _) => "pure slip".to_owned(),
            (Some(ContactPhase::Stick), _) => "stick throughout".to_owned(),
            (Some(ContactPhase::Open), _) => "open throughout".to_owned(),
            (None, Self::Steady(_)) => "unknown".to_owned(),
            (None, Self::Events { sequence, .. }) => {
                let count = |kind| {
                    sequence.iter().filter(|event| event.0 == kind && event.1 == contact).count()
                };
                let kinds = [EventKind::Stick, EventKind::Reversal, EventKind::Separation];
                let parts = kinds.map(|kind| (count(kind), kind.name()));
                let parts = parts.iter().filter(|(count, _)| *count > 0).map(|(count, name)| {
                    format!("{count} {name}{}", if *count == 1 { "" } else { "s" })
                });
                parts.collect::<Vec<_>>().join(", ")
            }
        }
    }

    /// Number of events of a kind.
    pub fn count(&self, kind: EventKind) -> usize {
        match self {
            Self::Steady(_) => 0,
            Self::Events { sequence, .. } => {
                sequence.iter().filter(|event| event.0 == kind).count()
            }
        }
    }
}

/// Time over the time scale within which events of different contacts count as simultaneous in a signature: above the error of an
/// event near a grazing, where it is the square root of the accuracy of a state. With a larger value a change of the order of two
/// contacts is reported a little later.
const SIMULTANEOUS: f64 = 1e-6;

/// Contacts with events of which all combinations are tried as those that graze together; of more contacts only single ones and all
/// together are. There are 2ᵏ − 1 combinations of k contacts, and each costs a few periods where a motion is hard to follow.
const MOST_COMBINED: usize = 3;

/// Why there is no image.
#[derive(Clone, Debug, PartialEq)]
pub enum NoImage {
    /// The system cannot take these parameters.
    Invalid(RefusedNumbers),
    /// The motion cannot be computed.
    Immobile(Immobile),
    /// The run ended early.
    Stopped(MotionStopped),
    /// The dithers have no common period.
    NoPeriod,
    /// Their common period is another at every value of the parameter.
    PeriodJumps,
    /// The variational equation could not be integrated.
    NoVariation,
}

impl fmt::Display for NoImage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Invalid(why) => why.fmt(f),
            Self::Immobile(why) => why.fmt(f),
            Self::Stopped(why) => why.fmt(f),
            Self::NoPeriod => f.write_str("the frequencies of the dithers have no common period"),
            Self::PeriodJumps => f.write_str(
                "the common period of the dithers jumps from one value of the parameter to the next, so that no response can be followed",
            ),
            Self::NoVariation => f.write_str("the variational equation could not be integrated"),
        }
    }
}

/// A system as a function of parameters.
pub type SystemAt<'a> = dyn Fn(&[f64]) -> Result<System, RefusedNumbers> + 'a;

/// The period map of a system with parameters.
pub struct OrbitFamily<'a> {
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

/// Typical size of the numbers of a state.
pub(crate) fn scale_of(motion: &Motion<'_>, state: &[f64]) -> f64 {
    let system = motion.system();
    let speeds = system.contacts.iter().map(|contact| contact.surface_velocity.mean().abs());
    let largest = state.iter().map(|value| value.abs()).chain(speeds).fold(0.0, f64::max);
    if largest > 0.0 { largest } else { 1.0 }
}

/// Steps of a request that the variation of one step counts for: above the 16 of a belt's own variation, because this one shows every step
/// to its observer. With less, a search that extreme numbers make hopeless keeps its user waiting; the longest that was met takes 50 s. No
/// result depends on it but that a search is stopped.
const VARIATION: u64 = 20;

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
    let sign = held.and_then(|held| match held.throughout(0) {
        Some(ContactPhase::Slip(sign)) => Some(sign),
        _ => None,
    });
    if let Some(found) = motion.mass_shot((state, time), sign, tolerance) {
        return Ok(of_one_mass(motion, found.map_err(NoImage::Stopped)?));
    }
    let new = || MotionVariation::new(motion).map_err(NoImage::Immobile);
    let (end, variation) = run_over(motion, state, (time, tolerance), held, new)?;
    count_taken(VARIATION * end.steps);
    if variation.has_failed {
        return Err(NoImage::NoVariation);
    }
    let phases: Vec<ContactPhase> = end.contacts.iter().map(|contact| contact.phase).collect();
    let events = in_order(&variation.events, SIMULTANEOUS * motion.time_scale());
    let signature = MotionSignature::of(&events, phases);
    let derivative = variation.matrix();
    let MotionVariation { events, is_one_sided, approaches, .. } = variation;
    let shot = Shot { events, is_one_sided, approaches };
    let distance = shot.nearest(&signature).map_or(f64::INFINITY, |(_, distance)| distance);
    Ok((Image { state: end.state, derivative, distance, signature }, shot))
}

/// The image and what was met on the way of one mass, from its run.
fn of_one_mass(motion: &Motion<'_>, found: MassShot) -> (Image<MotionSignature>, Shot) {
    let MassShot { end, derivative, events, least_slip } = found;
    count_taken(VARIATION * end.steps);
    let phases: Vec<ContactPhase> = end.contacts.iter().map(|contact| contact.phase).collect();
    let signature = MotionSignature::of(&in_order(&events, 0.0), phases);
    let contact = &motion.system().contacts[0];
    let speed = contact.surface_velocity.mean().abs();
    let scale = if speed > 0.0 { speed } else { contact.friction.velocity_scale() };
    let approaches = vec![[least_slip / scale, f64::INFINITY]];
    let shot = Shot { events, is_one_sided: false, approaches };
    let distance = shot.nearest(&signature).map_or(f64::INFINITY, |(_, distance)| distance);
    (Image { state: end.state, derivative, distance, signature }, shot)
}

/// Events of different contacts within a time are listed in the order of contacts, as events of one moment are: of equal parts of a
/// structure rounding would decide which is first.
fn in_order(events: &[RecordedEvent], together: f64) -> Vec<(EventKind, usize, i8)> {
    let mut ordered: Vec<&RecordedEvent> = events.iter().collect();
    for group in ordered.chunk_by_mut(|a, b| b.time - a.time <= together) {
        group.sort_by_key(|event| event.contact);
    }
    ordered.into_iter().map(|event| (event.kind, event.contact, event.slip_sign)).collect()
}

/// The image of a state on the piece of a signature at given parameters.
pub(super) fn shot_of(
    family: &OrbitFamily<'_>,
    state: &[f64],
    parameters: &[f64],
    signature: &MotionSignature,
) -> Result<(Image<MotionSignature>, Shot), NoImage> {
    let system = (family.at)(parameters).map_err(NoImage::Invalid)?;
    let motion = Motion::new(&system).map_err(NoImage::Immobile)?;
    let time = time_of(&motion, family.periods)?;
    shot(&motion, state, time, Some(signature))
}

/// The run over a time, continued on the piece of a signature, and its observer.
///
/// T of an elastic slider that slides follows from its slip and load: a guess whose T misses that level would adhere first, which no
/// motion near the periodic one does. It begins at the level, unless it would end the period in adhesion, where T is a number of its own.
fn run_over<O: MotionObserver>(
    motion: &Motion<'_>,
    state: &[f64],
    (time, tolerance): (f64, f64),
    held: Option<&MotionSignature>,
    observer: impl Fn() -> Result<O, NoImage>,
) -> Result<(MotionEnd, O), NoImage> {
    let contacts = motion.system().contacts.len();
    let run = |state: Vec<f64>| {
        let start = MotionStart { time: 0.0, state };
        let mut observer = observer()?;
        let (phases, tolerance) = match held {
            Some(held) => (held.slipping(contacts), MOTION_TOLERANCE),
            None => (Vec::new(), tolerance),
        };
        let end = motion.continued(&start, &phases, (time, tolerance), &mut observer);
        end.map(|end| (end, observer)).map_err(NoImage::Stopped)
    };
    if let Some((at_levels, sliders)) = motion.at_sliding_levels(state) {
        let found = run(at_levels)?;
        let slides = |slider: &usize| found.0.contacts[*slider].phase != ContactPhase::Stick;
        if sliders.iter().all(slides) {
            return Ok(found);
        }
    }
    run(state.to_vec())
}

/// What a shot met on its way.
pub(crate) struct Shot {
    pub(crate) events: Vec<RecordedEvent>,
    pub(crate) is_one_sided: bool,
    /// The least distance of each contact from its events: of its slip velocity and of its load.
    pub(crate) approaches: Vec<[f64; 2]>,
}

impl Shot {
    /// The distances of the contacts that slip throughout from their borders, relative to the velocities of their surfaces or to
    /// their loads.
    pub(crate) fn distances(
        &self,
        signature: &MotionSignature,
    ) -> impl Iterator<Item = (BorderGuard, f64)> {
        let slipping = signature.slipping(self.approaches.len());
        let slipping = slipping.into_iter().enumerate().filter(|(_, phase)| phase.is_some());
        slipping.flat_map(|(contact, _)| {
            let of = move |is_load: bool| BorderGuard { contact, is_load };
            let [slip, load] = self.approaches[contact];
            [(of(false), slip), (of(true), load)]
        })
    }

    /// The nearest border and its distance; `None` where no contact that slips throughout has one.
    pub(crate) fn nearest(&self, signature: &MotionSignature) -> Option<(BorderGuard, f64)> {
        let distances = self.distances(signature).filter(|(_, distance)| distance.is_finite());
        distances.min_by(|a, b| a.1.total_cmp(&b.1))
    }
}

impl PeriodMap for OrbitFamily<'_> {
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
        run_over(&motion, state, (time, MOTION_TOLERANCE), held, || Ok(()))
            .map(|(end, ())| end.state)
    }

    fn smoother(&self, signature: &MotionSignature, parameters: &[f64]) -> Vec<MotionSignature> {
        let Ok(system) = (self.at)(parameters) else { return Vec::new() };
        let direction = |contact: &Contact| {
            if contact.surface_velocity.mean() < 0.0 { -1 } else { 1 }
        };
        let directions: Vec<i8> = system.contacts.iter().map(direction).collect();
        signature.with_fewer_events(&directions)
    }
}
