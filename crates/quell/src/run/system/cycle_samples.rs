//! One period of a periodic motion of a system: samples, extremes and the shares of stick and separation.

use quell_dynamics::motion::orbit::MotionOrbit;
use quell_dynamics::motion::{
    ContactPhase, MOTION_TOLERANCE, Motion, MotionObserver, MotionSegment, MotionStart,
};
use quell_model::System;

/// Number of sampling steps in a period.
const SAMPLES: usize = 1200;

/// One contact at the samples.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SampledContact {
    /// What it does.
    pub phases: Vec<ContactPhase>,
    /// Slip velocity γ.
    pub slip_velocity: Vec<f64>,
    /// Friction T.
    pub friction: Vec<f64>,
    /// Load N; 0 where it is open.
    pub normal_load: Vec<f64>,
    /// Time in stick.
    pub stuck: f64,
    /// Time open.
    pub open: f64,
}

/// Samples of a period, both ends included.
#[derive(Clone, Debug, PartialEq)]
pub struct CycleSamples {
    row: Vec<f64>,
    step: f64,
    size: usize,
    /// Times.
    pub times: Vec<f64>,
    /// States, one after the other.
    pub states: Vec<f64>,
    /// The observed displacement.
    pub observed: Vec<f64>,
    /// Its rate.
    pub rate: Vec<f64>,
    /// The contacts.
    pub contacts: Vec<SampledContact>,
}

impl CycleSamples {
    /// The samples of an orbit of a system, with the displacement that `row` observes.
    pub fn of(system: &System, row: &[f64], orbit: &MotionOrbit) -> Self {
        Self::over(system, row, &orbit.state, orbit.period)
    }

    /// The samples of a run from a state at t = 0.
    pub fn over(system: &System, row: &[f64], state: &[f64], duration: f64) -> Self {
        let mut samples = Self {
            row: row.to_vec(),
            step: duration / SAMPLES as f64,
            size: state.len(),
            times: Vec::new(),
            states: Vec::new(),
            observed: Vec::new(),
            rate: Vec::new(),
            contacts: vec![SampledContact::default(); system.contacts.len()],
        };
        let start = MotionStart { time: 0.0, state: state.to_vec() };
        // The orbit was already integrated when it was found; a run that stops keeps the part before.
        if let Ok(motion) = Motion::new(system) {
            let _ = motion.run(&start, duration, MOTION_TOLERANCE, &mut samples);
        }
        samples
    }

    /// The share of a period for which the time is given.
    pub fn share(&self, time: f64) -> f64 {
        (time / (self.step * SAMPLES as f64)).clamp(0.0, 1.0)
    }

    /// Least and largest of some samples.
    pub fn extremes(values: &[f64]) -> (f64, f64) {
        values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), value| {
            (least.min(*value), most.max(*value))
        })
    }

    /// Peak-to-peak of the observed displacement.
    pub fn size(&self) -> f64 {
        let (least, most) = Self::extremes(&self.observed);
        (most - least).max(0.0)
    }
}

impl MotionObserver for CycleSamples {
    fn segment(&mut self, segment: &MotionSegment<'_>) {
        let duration = segment.duration();
        for (index, contact) in self.contacts.iter_mut().enumerate() {
            match segment.phase(index) {
                ContactPhase::Stick => contact.stuck += duration,
                ContactPhase::Open => contact.open += duration,
                ContactPhase::Slip(_) => {}
            }
        }
        // The series of the observed displacement.
        let series = segment.row(&self.row, 0);
        while self.times.len() <= SAMPLES {
            let time = self.times.len() as f64 * self.step;
            let since = segment.clock().until(time);
            let is_last = self.times.len() == SAMPLES;
            // The last sample is at the end of the last segment, up to rounding.
            if since > duration && !(is_last && since <= duration + 1e-9 * self.step) {
                break;
            }
            let since = since.clamp(0.0, duration);
            self.times.push(time);
            let from = self.states.len();
            self.states.resize(from + self.size, 0.0);
            segment.state(since, &mut self.states[from..]);
            let terms = || series.iter().enumerate().rev();
            self.observed.push(terms().fold(0.0, |sum, (_, c)| f64::mul_add(sum, since, *c)));
            let slope = terms().filter(|(k, _)| *k > 0);
            self.rate.push(slope.fold(0.0, |sum, (k, c)| f64::mul_add(sum, since, k as f64 * c)));
            for (index, contact) in self.contacts.iter_mut().enumerate() {
                let phase = segment.phase(index);
                contact.phases.push(phase);
                let value = |series| MotionSegment::value(series, since);
                contact.slip_velocity.push(value(segment.slip_velocity(index)));
                contact.friction.push(value(segment.friction(index)));
                let load = value(segment.normal_load(index));
                contact.normal_load.push(if phase == ContactPhase::Open { 0.0 } else { load });
            }
        }
    }
}
