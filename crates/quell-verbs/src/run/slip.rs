//! The largest slip speed at each contact that the motions of an answer reach.

use std::f64::consts::TAU;

use quell_dynamics::attractor::starts_of_mass;
use quell_dynamics::motion::{ContactMeter, MOTION_TOLERANCE, Motion, MotionStart};
use quell_dynamics::response::vibration_frequency;
use quell_dynamics::simulation::largest_slips;
use quell_linear::pure_slip::period;
use quell_model::{OneMass, System};

/// Time of the equations of one mass for which a start is observed: its first slow period, in which a decaying transient is largest.
const OF_START: f64 = TAU;

/// Periods of the vibration over which the slip of a motion of several masses is observed: the first ones, in which a transient is
/// largest. Over fewer a slow beat could be missed, and with it a warning; more only take longer. One mass has no beat of its own: its first
/// one is enough. A common period of the dither that is longer is observed whole.
const SLOW_PERIODS: f64 = 4.0;

/// The largest slip speeds so far.
pub struct SlipReached {
    /// Whether a law has a range that slip may leave.
    watches: bool,
    largest: Vec<f64>,
}

impl SlipReached {
    /// Of a system, without motions yet.
    pub fn new(system: &System) -> Self {
        let watches = system.contacts.iter().any(|contact| contact.friction.range().is_some());
        Self { watches, largest: vec![0.0; system.contacts.len()] }
    }

    /// Adds a motion of a system from a state at t = 0. One that stops early counts up to there.
    pub(crate) fn add(&mut self, system: &System, state: &[f64]) {
        self.add_all(system, &[state.to_vec()]);
    }

    /// Adds motions of a system from several states; those of one mass are computed in one batch.
    pub fn add_all(&mut self, system: &System, states: &[Vec<f64>]) {
        if !self.watches {
            return;
        }
        match system.one_mass() {
            Some(mass) => self.include(&[largest_of_mass(system, &mass, states)]),
            None => states.iter().for_each(|state| self.add_motion(system, state)),
        }
    }

    /// Adds the largest slip speed of each contact in other motions.
    pub(crate) fn include(&mut self, speeds: &[f64]) {
        for (largest, speed) in self.largest.iter_mut().zip(speeds) {
            *largest = speed.max(*largest);
        }
    }

    fn add_motion(&mut self, system: &System, state: &[f64]) {
        let Ok(motion) = Motion::new(system) else { return };
        let slow =
            vibration_frequency(system).map_or(0.0, |frequency| SLOW_PERIODS * TAU / frequency);
        let length = period(system).map_or(slow, |period| slow.max(period));
        let mut meter = ContactMeter::new(system.contacts.len());
        let start = MotionStart { time: 0.0, state: state.to_vec() };
        motion.run(&start, length, MOTION_TOLERANCE, &mut meter).ok();
        let speeds = (0..self.largest.len()).map(|contact| meter.largest_slip(contact));
        self.include(&speeds.collect::<Vec<f64>>());
    }

    /// The largest slip speed of each contact; 0 where no law has a range.
    pub fn largest(self) -> Vec<f64> {
        self.largest
    }
}

/// The largest slip speed in the first period of the vibration of one mass, or of the dither, from several states.
fn largest_of_mass(system: &System, mass: &OneMass, states: &[Vec<f64>]) -> f64 {
    let starts = starts_of_mass(mass, states);
    let cases: Vec<_> = starts.iter().map(|start| (mass.belt(), *start)).collect();
    let length = period(system).map_or(OF_START, |period| OF_START.max(mass.rate() * period));
    // Its slip is that of the belt.
    largest_slips(&cases, length).into_iter().fold(0.0, f64::max)
}
