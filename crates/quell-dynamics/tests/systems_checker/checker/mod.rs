//! A slow, simple simulator of linear systems with friction contacts: a reference for the engine of the library.
//!
//! It uses the data types of `quell_model` and shares no method with the engine: an extrapolated midpoint rule on a fine grid
//! of time, changes of sign and minima of guards on that grid, bisection, and the decision which contacts stick by trial of
//! all combinations.
//!
//! An open contact reacts on the structure as a closed one without load. With a modulation that guides take
//! (`reaction: false`), that is −N₀ − ΔN(t): the reaction is continuous where the contact opens.
//!
//! Two rare decisions are left out as ambiguous: a contact that stops and slips on in its old direction because another contact
//! releases at that moment, and a contact that lands without slip velocity.
//!
//! Not covered: factors on the friction force, surface velocities that jump, and normal or slope rows of first-order
//! equations.

mod decision;
mod equations;
mod extrapolation;
mod guards;
mod linear;
mod phase;
mod random;
mod waves;

use quell_model::System;

use decision::TOO_CLOSE;
use equations::{Drive, Equations, Mode};
use guards::{Ending, Guard};
use phase::{APART, Phase};

pub(crate) use random::random_system;

/// A change of the mode of one contact.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CheckedEvent {
    /// Time.
    pub(crate) time: f64,
    /// Index of the contact.
    pub(crate) contact: usize,
    /// `stick`, `release`, `reversal`, `separation` or `landing`.
    pub(crate) kind: &'static str,
    /// Sign of the slip velocity after the event; 0 in stick and for an open contact.
    pub(crate) slip_sign: i8,
    /// State at the event.
    pub(crate) state: Vec<f64>,
}

/// A trajectory.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Checked {
    /// The events in order; those of one moment in the order of contacts.
    pub(crate) events: Vec<CheckedEvent>,
    /// State at the end.
    pub(crate) state: Vec<f64>,
}

/// Why there is no trajectory.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Unchecked {
    /// Two events are very close together, or a decision or a guard is very close to its boundary: a comparison would be
    /// meaningless.
    Ambiguous(String),
    /// The system is not covered, or its motion ends.
    Failed(String),
}

/// The motion from a state at t = 0 until a time.
///
/// # Errors
/// If a comparison with it would be meaningless, or the checker does not cover the system.
pub(crate) fn trajectory(system: &System, start: &[f64], until: f64) -> Result<Checked, Unchecked> {
    let equations = Equations::new(system)?;
    let mut run = Run {
        equations: &equations,
        time: 0.0,
        state: start.to_vec(),
        modes: Vec::new(),
        fresh: vec![true; system.contacts.len()],
        last: 0.0,
        events: Vec::new(),
    };
    while run.time < until {
        let end = equations.next_break(run.time).min(until);
        let drive = equations.drive(run.time, end);
        if run.modes.is_empty() {
            run.begin(&drive)?;
        } else {
            run.decide(&drive, &[])?;
            run.last = run.time;
        }
        run.until(&drive, end)?;
        if end - run.last < APART {
            return Err(Unchecked::Ambiguous(format!("an event close to the break or end {end}")));
        }
    }
    Ok(Checked { events: run.events, state: run.state })
}

/// A trajectory in progress.
#[derive(Debug)]
struct Run<'a> {
    equations: &'a Equations<'a>,
    time: f64,
    state: Vec<f64>,
    modes: Vec<Mode>,
    /// Contacts whose guards may start from zero.
    fresh: Vec<bool>,
    /// Time of the latest event or break.
    last: f64,
    events: Vec<CheckedEvent>,
}

impl Run<'_> {
    /// The modes at the start.
    fn begin(&mut self, drive: &Drive) -> Result<(), Unchecked> {
        let contacts = self.fresh.len();
        let mut at = self.equations.instant();
        let slipping = vec![Mode::Slip(1); contacts];
        self.equations.evaluate(drive, self.time, &self.state, &slipping, &mut at);
        self.modes = slipping;
        for c in 0..contacts {
            let compliant = self.equations.is_compliant(c);
            let stopped = at.slip[c].abs() < 1e-13;
            if (compliant && at.load[c].abs() < TOO_CLOSE)
                || (!stopped && at.slip[c].abs() < TOO_CLOSE)
            {
                return Err(Unchecked::Ambiguous(format!("contact {c} starts close to an event")));
            }
            self.modes[c] = if compliant && at.load[c] < 0.0 {
                Mode::Open
            } else if stopped {
                Mode::Stick
            } else {
                Mode::Slip(sign(at.slip[c]))
            };
        }
        self.select(drive, &vec![0; contacts])?;
        self.fresh.fill(false);
        for (fresh, slip) in self.fresh.iter_mut().zip(&at.slip) {
            *fresh = slip.abs() < TOO_CLOSE;
        }
        Ok(())
    }

    /// Runs between two breaks.
    fn until(&mut self, drive: &Drive, end: f64) -> Result<(), Unchecked> {
        while self.time < end {
            let modes = self.modes.clone();
            let mut phase = Phase::new(self.equations, drive, &modes);
            let ended = phase.run((self.time, &self.state), &self.fresh, end)?;
            self.time = ended.point.time;
            self.state = ended.point.state;
            self.fresh.fill(false);
            if !ended.triggers.is_empty() {
                if self.time - self.last < APART {
                    return Err(Unchecked::Ambiguous(format!("two events at {}", self.time)));
                }
                self.last = self.time;
                self.decide(drive, &ended.triggers)?;
            }
        }
        Ok(())
    }

    /// New modes at a moment where guards vanish, or where a profile has a break; records the events.
    fn decide(&mut self, drive: &Drive, triggers: &[Guard]) -> Result<(), Unchecked> {
        let old = self.modes.clone();
        let mut released = vec![0; old.len()];
        for trigger in triggers {
            if let Ending::Bound(direction) = trigger.ending {
                released[trigger.contact] = direction;
            }
        }
        if triggers.iter().any(|trigger| matches!(trigger.ending, Ending::Stop(_))) {
            // Another contact stops at the same moment: all forces of the contacts at rest are new.
            released.fill(0);
        }
        self.open_and_close(drive, triggers)?;
        for trigger in triggers {
            if matches!(trigger.ending, Ending::Stop(_))
                && self.modes[trigger.contact] != Mode::Open
            {
                self.modes[trigger.contact] = Mode::Stick;
            }
        }
        self.select(drive, &released)?;
        for trigger in triggers {
            self.fresh[trigger.contact] = true;
            if self.modes[trigger.contact] == old[trigger.contact] {
                return Err(Unchecked::Ambiguous(format!(
                    "{trigger:?} without effect at {}",
                    self.time
                )));
            }
        }
        self.record(&old);
        Ok(())
    }

    /// Opens and closes compliant contacts.
    fn open_and_close(&mut self, drive: &Drive, triggers: &[Guard]) -> Result<(), Unchecked> {
        let mut at = self.equations.instant();
        self.equations.evaluate(drive, self.time, &self.state, &self.modes, &mut at);
        for c in 0..self.modes.len() {
            if !self.equations.is_compliant(c) {
                continue;
            }
            let changes = |ending| triggers.contains(&Guard { contact: c, ending });
            let open = self.modes[c] == Mode::Open;
            let opens = if triggers.is_empty() {
                if at.load[c].abs() < TOO_CLOSE {
                    return Err(Unchecked::Ambiguous(format!(
                        "contact {c} without load at {}",
                        self.time
                    )));
                }
                at.load[c] < 0.0
            } else {
                (open && !changes(Ending::Landing)) || changes(Ending::Separation)
            };
            if opens {
                self.modes[c] = Mode::Open;
            } else if open {
                if at.slip[c].abs() < TOO_CLOSE {
                    return Err(Unchecked::Ambiguous(format!("contact {c} lands without slip")));
                }
                self.modes[c] = Mode::Slip(sign(at.slip[c]));
            }
        }
        Ok(())
    }

    /// Decides which of the contacts with mode `Stick` do stick, and the directions of the others.
    fn select(&mut self, drive: &Drive, released: &[i8]) -> Result<(), Unchecked> {
        let (contacts, contest) =
            self.equations.contest(drive, self.time, &self.state, &self.modes);
        let released: Vec<i8> = contacts.iter().map(|&c| released[c]).collect();
        let directions = contest.decide(&released)?;
        for (&c, direction) in contacts.iter().zip(directions) {
            self.modes[c] = if direction == 0 { Mode::Stick } else { Mode::Slip(direction) };
        }
        Ok(())
    }

    /// Records what changed.
    fn record(&mut self, old: &[Mode]) {
        for (contact, (&before, &after)) in old.iter().zip(&self.modes).enumerate() {
            if before == after {
                continue;
            }
            self.fresh[contact] = true;
            let (kind, slip_sign) = match (before, after) {
                (_, Mode::Open) => ("separation", 0),
                (Mode::Open, Mode::Slip(sign)) => ("landing", sign),
                (Mode::Stick, Mode::Slip(sign)) => ("release", sign),
                (_, Mode::Slip(sign)) => ("reversal", sign),
                (_, Mode::Stick) => ("stick", 0),
            };
            let state = self.state.clone();
            self.events.push(CheckedEvent { time: self.time, contact, kind, slip_sign, state });
        }
    }
}

/// The sign of a number that is not zero.
fn sign(value: f64) -> i8 {
    if value > 0.0 { 1 } else { -1 }
}
