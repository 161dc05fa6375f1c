//! One period of a periodic motion of a system: samples, exact extremes, and the means of its contacts.

use quell_model::System;
use quell_numerics::interval::RealInterval;

use crate::motion::{
    ContactMeans, ContactMeter, ContactPhase, MOTION_TOLERANCE, Motion, MotionObserver,
    MotionSegment, MotionStart, RowRange,
};
use crate::orbit::Orbit;
use crate::simulation::ORDER;

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
    /// The least slip speed of each contact while it slips; infinite where it never does.
    pub least_slip: Vec<f64>,
    /// Of the observed displacement, and of its rate.
    ranges: [RowRange; 2],
    /// Means and extremes of the contacts.
    meter: ContactMeter,
}

impl CycleSamples {
    /// The samples of an orbit of a system, with the displacement that `row` observes.
    pub fn of(system: &System, row: &[f64], orbit: &Orbit) -> Self {
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
            ranges: [RowRange::NONE; 2],
            least_slip: vec![f64::INFINITY; system.contacts.len()],
            meter: ContactMeter::new(system.contacts.len()),
        };
        let start = MotionStart { time: 0.0, state: state.to_vec() };
        // The orbit was already integrated when it was found; a run that stops keeps the part before.
        if let Ok(motion) = Motion::new(system) {
            let _ = motion.run(&start, duration, MOTION_TOLERANCE, &mut samples);
        }
        samples
    }

    /// Means of every contact; empty if the run stopped at once.
    pub fn means(&self) -> Vec<ContactMeans> {
        self.meter.means().unwrap_or_default()
    }

    /// The largest slip speed of a contact.
    pub fn largest_slip(&self, contact: usize) -> f64 {
        self.meter.largest_slip(contact)
    }

    /// Exact least and largest value of the observed displacement, and of its rate.
    pub fn extremes(&self) -> [RealInterval; 2] {
        self.ranges.map(|range| RealInterval::new(range.least, range.most))
    }
}

impl MotionObserver for CycleSamples {
    fn segment(&mut self, segment: &MotionSegment<'_>) {
        let duration = segment.duration();
        self.meter.segment(segment);
        // The series of the observed displacement and of its rate.
        let series = segment.row(&self.row, 0);
        let mut rate = [0.0; ORDER + 1];
        for (k, (rate, term)) in rate.iter_mut().zip(&series[1..]).enumerate() {
            *rate = (k + 1) as f64 * term;
        }
        let [displacements, rates] = &mut self.ranges;
        displacements.add(&series, duration);
        rates.add(&rate, duration);
        for (index, least) in self.least_slip.iter_mut().enumerate() {
            if let ContactPhase::Slip(sign) = segment.phase(index) {
                let mut range = RowRange::NONE;
                range.add(segment.slip_velocity(index), duration);
                *least = least.min(if sign > 0 { range.least } else { -range.most }.max(0.0));
            }
        }
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
            self.observed.push(MotionSegment::value(&series, since));
            self.rate.push(MotionSegment::value(&rate, since));
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

#[cfg(test)]
mod tests {
    use quell_model::{Belt, LawKind};

    use super::*;

    #[test]
    fn a_free_oscillator_reaches_its_amplitude() {
        // Without friction x = cos τ: from an extreme of x to beyond every other one.
        let law = LawKind::Stribeck.build(&[0.0, 0.0, 1.0]).expect("valid");
        let belt = Belt::new(0.0, 1.0, 10.0, law, Vec::new()).expect("valid");
        let extremes =
            |until| CycleSamples::over(&belt.system(), &[1.0], &[1.0, 0.0], until).extremes();
        for RealInterval { lower: low, upper: high } in extremes(7.0) {
            assert!((low + 1.0).abs() < 1e-11 && (high - 1.0).abs() < 1e-11, "{low} {high}");
        }
        // Over a part of the period the ends count, and the extremes between them.
        let [displacement, velocity] = extremes(2.0);
        assert!((displacement.lower - 2.0_f64.cos()).abs() < 1e-11);
        assert!((velocity.lower + 1.0).abs() < 1e-11 && velocity.upper.abs() < 1e-11);
    }
}
