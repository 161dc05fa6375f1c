//! Slip beyond the range of the friction law: where it occurs in an answer, and the warning about it.
//!
//! Averages reach v₀ plus the largest fast velocity of the dither. For runs the slip is measured: verbs that keep a record
//! use the record; those that report attractors and orbits run each of them again for a few periods, and every start for one.

use std::f64::consts::TAU;

use quell_dynamics::belt_motion::{ContactStart, run_belt};
use quell_dynamics::simulation::{
    DEFAULT_TOLERANCE, LargestSlip, Observer, SimulationRun, Start, simulate, simulate_many,
};
use quell_linear::averaging::{Averaging, DitheredContact, FastMotion};
use quell_model::friction::SlipRange;
use quell_model::units::Quantity;
use quell_model::{Belt, Contact, System};

use crate::study::BeltStudy;
use crate::words::in_words;

/// Time for which a start is observed: its first slow period, in which a decaying transient is largest.
pub(crate) const OF_START: f64 = TAU;

/// Warnings about contacts of a system whose slip leaves the range of their law; `dithered` has their fast motion.
pub(crate) fn outside_of_laws(
    system: &System,
    in_words: impl Fn(f64) -> String,
    dithered: Option<&[DitheredContact]>,
) -> Vec<String> {
    let contacts = system.contacts.iter().enumerate();
    contacts
        .filter_map(|(index, contact)| {
            let slip = match dithered {
                Some(found) => found[index].largest_slip(contact),
                None => contact.surface_velocity.mean().abs(),
            };
            at_contact(contact, slip, &in_words)
        })
        .collect()
}

/// The slip reached by the runs of an answer, each compared with the range of its own law.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SlipMet {
    runs: usize,
    beyond: usize,
    /// The slip speed that is largest relative to its range, and that range.
    worst: Option<(f64, SlipRange)>,
}

impl SlipMet {
    /// The slip reached in a record of velocities x′.
    pub(crate) fn of_velocities(belt: &Belt, velocities: impl Iterator<Item = f64>) -> Self {
        let mut met = Self::default();
        let speeds = velocities.map(|velocity| (belt.belt_velocity() - velocity).abs());
        met.add(belt, speeds.fold(0.0, f64::max));
        met
    }

    /// Adds a run that reaches slip up to `speed`.
    pub(crate) fn add(&mut self, belt: &Belt, speed: f64) {
        self.runs += 1;
        let Some(range) = belt.friction().range().filter(|range| speed > range.upper) else {
            return;
        };
        self.beyond += 1;
        let larger = |&(known, of): &(f64, SlipRange)| speed / range.upper > known / of.upper;
        if self.worst.as_ref().is_none_or(larger) {
            self.worst = Some((speed, range));
        }
    }

    /// Adds a run from a start over its first slow period.
    pub(crate) fn add_start(&mut self, belt: &Belt, start: Start) {
        self.add_run(belt, start, OF_START);
    }

    /// Adds a run of duration `length` from a state. A run that stops counts up to there.
    pub(crate) fn add_run(&mut self, belt: &Belt, state: Start, length: f64) {
        let mut slip = LargestSlip::of(belt);
        if slip.watches() && belt.has_contact_state() {
            let from = (state, ContactStart::Relaxed);
            run_belt(belt, from, state.time + length, DEFAULT_TOLERANCE, &mut slip).ok();
        } else if slip.watches() {
            simulate(belt, state, state.time + length, DEFAULT_TOLERANCE, &mut slip).ok();
        }
        self.add(belt, slip.speed);
    }

    /// The largest slip speed of the runs that leave the range of the law, if any.
    pub(crate) fn largest_beyond(&self) -> Option<f64> {
        self.worst.map(|(speed, _)| speed)
    }

    /// The warning, if a run leaves the range.
    pub fn warnings(&self, study: &BeltStudy) -> Vec<String> {
        let Some((speed, range)) = self.worst else { return Vec::new() };
        let others = if self.runs > 1 {
            let leave = if self.beyond == 1 { "leaves" } else { "leave" };
            format!(" ({} of {} runs {leave} it)", self.beyond, self.runs)
        } else {
            String::new()
        };
        vec![sentence(study, &range, "slip reaches", speed) + &others]
    }
}

/// Largest slip speed of each run up to `length` after its start, computed in one batch; 0 if the law has no range.
pub(crate) fn of_starts(cases: &[(&Belt, Start)], length: f64) -> Vec<f64> {
    let mut slips: Vec<LargestSlip> = cases.iter().map(|(belt, _)| LargestSlip::of(belt)).collect();
    let runs = cases
        .iter()
        .zip(&mut slips)
        .filter(|(_, slip)| slip.watches())
        .map(|(&(belt, start), slip)| {
            let observer: &mut dyn Observer = slip;
            SimulationRun { belt, start, until: start.time + length, observer }
        })
        .collect();
    simulate_many(runs, DEFAULT_TOLERANCE);
    slips.into_iter().map(|slip| slip.speed).collect()
}

/// The largest fast slip velocity at the belt velocity, at the finite R of the study; in the limit R → ∞ where that has none.
pub(crate) fn fast_velocity(belt: &Belt) -> f64 {
    let motion = FastMotion::of(belt, belt.belt_velocity(), Averaging::FiniteR);
    let fast = motion.and_then(|motion| motion.largest_slip());
    fast.unwrap_or_else(|_| belt.fast_velocity())
}

/// Slip that averages reach at slip speed `slip`: that speed plus the largest fast velocity.
pub(crate) fn with_dither(belt: &Belt, slip: f64) -> f64 {
    slip + fast_velocity(belt)
}

/// Slip that averages reach at v₀ with the first dither at this amplitude.
pub(crate) fn at_amplitude(belt: &Belt, amplitude: f64) -> f64 {
    let mut dithers = belt.dithers().to_vec();
    if let Some(dither) = dithers.first_mut() {
        dither.amplitude = amplitude;
    }
    // An amplitude that the belt cannot have, such as normal dither that opens the contact, moves the mass as in the limit.
    let fast = match belt.dithered_by(dithers.clone()) {
        Ok(acting) => fast_velocity(&acting),
        Err(_) => dithers.iter().map(|dither| belt.fast_velocity_of(dither)).sum(),
    };
    belt.belt_velocity() + fast
}

/// Warnings if averages at the study's own slip, v₀, leave the range.
pub(crate) fn averaged(study: &BeltStudy) -> Vec<String> {
    let belt = study.belt();
    let Some(range) = belt.friction().range() else { return Vec::new() };
    let mut warnings = Vec::new();
    let (slow, fast) = (belt.belt_velocity(), fast_velocity(belt));
    if slow + fast > range.upper {
        let dither = if fast > 0.0 { "including" } else { "without" };
        warnings.push(sentence(
            study,
            &range,
            &format!("slip {dither} dither reaches"),
            slow + fast,
        ));
    }
    if slow > 0.0 && slow < range.lower {
        warnings.push(sentence(study, &range, "steady sliding has a slip of", slow));
    }
    warnings
}

/// The warning about slip at a contact of a system beyond the range of its law, or about a surface slower than that range; `in_words` writes a
/// velocity with its unit.
pub(crate) fn at_contact(
    contact: &Contact,
    slip: f64,
    in_words: impl Fn(f64) -> String,
) -> Option<String> {
    let range = contact.friction.range()?;
    let slow = contact.surface_velocity.mean().abs();
    let (verb, slip) = if slip > range.upper {
        ("reaches", slip)
    } else if slow > 0.0 && slow < range.lower {
        ("is", slow)
    } else {
        return None;
    };
    Some(format!(
        "the slip velocity at contact {} {verb} {}, outside the range of the {} law, {} to {} ({}): numbers from there are \
             extrapolated",
        contact.name,
        in_words(slip),
        contact.friction.kind().name(),
        in_words(range.lower),
        in_words(range.upper),
        range.limit
    ))
}

/// One sentence about slip outside a range; `what` is the part before the speed.
pub(crate) fn sentence(study: &BeltStudy, range: &SlipRange, what: &str, speed: f64) -> String {
    let words = |speed: f64| in_words(study, Quantity::Velocity, speed);
    format!(
        "{what} {}, outside the range of the {} law, {} to {} ({}): numbers from there are extrapolated",
        words(speed),
        study.belt().friction().kind().name(),
        words(range.lower),
        words(range.upper),
        range.limit
    )
}
