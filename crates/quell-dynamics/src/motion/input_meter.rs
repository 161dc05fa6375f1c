//! The cost of the inputs of a motion: the power that each feeds into the structure, and its stroke.
//!
//! A force b u(t) feeds in u bᵀq̇. A modulation ΔN of a load, borne by the structure, pushes it away from the surface while the
//! contact is closed: it feeds in −ΔN nᵀq̇. The means of both are taken out: what an input does on average is no dither. Where the
//! contact has a spring, an actuator in series with it ([`SeriesActuator`]) makes the modulation, and has a stroke and a power of its
//! own.

use quell_linear::series_actuator::{NoSeriesActuator, SeriesActuator};
use quell_model::System;
use quell_model::profile::Profile;
use quell_model::system::{Contact, InputTarget, Structure};
use quell_numerics::dispatch::{InstructionSet, LaneWork, with_lanes};
use quell_numerics::lane::{Lane, horner};

use super::contact_meter::{NODES, RULE, mean_of, moments_of, values_at};
use super::observer::{MotionObserver, MotionSegment};
use super::phase::ContactPhase;
use super::row_meter::RowRange;
use super::rows::RowEntries;

use crate::simulation::{Clock, Series};

/// Why the power and the stroke of an input are unknown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoPower {
    /// First-order equations: where the input acts is no displacement.
    FirstOrder,
    /// Guides bear the modulation of the load.
    Guided,
    /// The input is a factor on friction, no force.
    Factor,
    /// The contact has no normal row: the model has no motion along which the load could do work.
    NoNormal,
}

impl NoPower {
    /// The reason in words.
    pub fn why(self) -> &'static str {
        match self {
            Self::FirstOrder => {
                "first-order equations do not give the displacement on which the input acts"
            }
            Self::Guided => {
                "guides bear the modulation of the load, which does no work on the structure"
            }
            Self::Factor => "the input multiplies friction and is no force of its own",
            Self::NoNormal => {
                "the contact has no normal row: the model has no motion in the normal direction"
            }
        }
    }
}

/// The cost of an input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InputCost {
    /// What it does to the structure.
    pub fed: Result<FedCost, NoPower>,
    /// Of a modulation of a load: the actuator in series with the spring of the contact; `None` for a force.
    pub in_series: Option<Result<SeriesCost, NoSeriesActuator>>,
}

/// What an input does to the structure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FedCost {
    /// Mean power that it feeds in.
    pub power: f64,
    /// Peak-to-peak displacement along its row.
    pub stroke: f64,
}

/// The cost of an actuator in series with the spring of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeriesCost {
    /// Mean power ⟨N u̇⟩ that it delivers.
    pub power: f64,
    /// Peak-to-peak elongation u; of several waves the sum of theirs.
    pub stroke: f64,
}

/// One input.
#[derive(Clone, Debug)]
struct Worker<'s> {
    /// Row over the displacements and over the velocities, and the sign of the force along it.
    rows: Result<([RowEntries; 2], f64), NoPower>,
    profile: &'s Profile,
    /// Its number among the forces, if it is one.
    push: Option<usize>,
    /// The contact without which it does no work.
    contact: Option<usize>,
    /// Steady load of that contact.
    steady_load: f64,
    /// Of a modulation of a load: an actuator for each wave, and its work.
    in_series: Option<Result<Vec<SeriesActuator>, NoSeriesActuator>>,
    series_work: f64,
    work: f64,
    extremes: RowRange,
}

/// Measures every input of a motion.
#[derive(Clone, Debug)]
pub struct InputMeter<'s> {
    length: f64,
    inputs: Vec<Worker<'s>>,
    set: InstructionSet,
}

impl<'s> InputMeter<'s> {
    /// For the inputs of a system.
    pub fn new(system: &'s System) -> Self {
        let mut pushes = 0..;
        let inputs = system.inputs.iter().map(|input| {
            let push =
                matches!(input.target, InputTarget::Force(_)).then(|| pushes.next()).flatten();
            let contact = match input.target {
                InputTarget::NormalLoad { contact, .. } => Some(contact),
                InputTarget::Force(_) | InputTarget::Friction { .. } => None,
            };
            let in_series = contact.map(|contact| {
                let Contact { normal_stiffness, normal_damping, .. } = system.contacts[contact];
                let waves = input.profile.waves().iter();
                waves
                    .map(|wave| SeriesActuator::new(wave, normal_stiffness, normal_damping))
                    .collect()
            });
            Worker {
                rows: rows_of(system, &input.target),
                profile: &input.profile,
                push,
                contact,
                steady_load: contact.map_or(0.0, |contact| system.contacts[contact].normal_load),
                in_series,
                series_work: 0.0,
                work: 0.0,
                extremes: RowRange::NONE,
            }
        });
        let inputs = inputs.collect();
        Self { length: 0.0, inputs, set: InstructionSet::widest() }
    }

    /// The cost of every input; `None` if no time has been measured.
    pub fn costs(&self) -> Option<Vec<InputCost>> {
        let cost = |worker: &Worker<'_>| InputCost {
            fed: worker.rows.as_ref().map_err(|why| *why).map(|_| FedCost {
                power: worker.work / self.length,
                stroke: worker.extremes.width(),
            }),
            in_series: worker.in_series.as_ref().map(|actuators| {
                let actuators = actuators.as_ref().map_err(|why| *why)?;
                Ok(SeriesCost {
                    power: worker.series_work / self.length,
                    stroke: actuators.iter().map(SeriesActuator::stroke).sum(),
                })
            }),
        };
        (self.length > 0.0).then(|| self.inputs.iter().map(cost).collect())
    }
}

/// The rows along which an input does work on the structure, and the sign of its force.
fn rows_of(system: &System, target: &InputTarget) -> Result<([RowEntries; 2], f64), NoPower> {
    let Structure::Mechanical(structure) = &system.structure else {
        return Err(NoPower::FirstOrder);
    };
    let (row, sign) = match target {
        InputTarget::Force(row) => (row, 1.0),
        InputTarget::Friction { .. } => return Err(NoPower::Factor),
        InputTarget::NormalLoad { reaction: false, .. } => return Err(NoPower::Guided),
        InputTarget::NormalLoad { contact, .. } => {
            let normal = system.contacts[*contact].normal.as_ref();
            (normal.ok_or(NoPower::NoNormal)?, -1.0)
        }
    };
    Ok(([RowEntries::at(row, 0), RowEntries::at(row, structure.size())], sign))
}

impl MotionObserver for InputMeter<'_> {
    fn segment(&mut self, segment: &MotionSegment<'_>) {
        self.length += segment.duration();
        for worker in &mut self.inputs {
            with_lanes(self.set, InputOnSegment { worker, segment });
        }
    }
}

struct InputOnSegment<'a, 'b, 's> {
    worker: &'a mut Worker<'s>,
    segment: &'a MotionSegment<'b>,
}

impl LaneWork for InputOnSegment<'_, '_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lane>(self) {
        let Self { worker, segment } = self;
        let open = |contact: usize| segment.phase(contact) == ContactPhase::Open;
        let is_open = worker.contact.is_some_and(open);
        if let Ok((rows, sign)) = &worker.rows {
            let duration = segment.duration();
            let [displacement, velocity] = [0, 1].map(|row| segment.row_of(&rows[row]));
            worker.extremes.add(&displacement, duration);
            if !is_open {
                let power = worker.mean_power::<V>(&velocity, segment);
                worker.work = f64::mul_add(sign * duration, power, worker.work);
            }
        }
        worker.work_in_series(segment, is_open);
    }
}

impl Worker<'_> {
    /// Mean of the force times the velocity along its row, over a segment.
    #[inline(always)]
    fn mean_power<V: Lane>(&self, velocity: &Series, segment: &MotionSegment<'_>) -> f64 {
        let moments = moments_of(segment.duration());
        let mut powers = values_at::<V>(velocity, &moments);
        match self.push.and_then(|push| segment.force(push)) {
            Some(force) => {
                let (forces, mean) = (values_at::<V>(force, &moments), self.profile.mean());
                powers.iter_mut().zip(&forces).for_each(|(power, force)| *power *= force - mean);
            }
            None => {
                for (power, since) in powers.iter_mut().zip(&moments[..NODES]) {
                    *power *= wave_force(self.profile, segment.clock(), *since);
                }
            }
        }
        mean_of(&powers)
    }

    /// Adds the work of actuators in series with the contact, against the load less its steady part: that does none in a period, and over a
    /// record of other length only what its ends make of it.
    fn work_in_series(&mut self, segment: &MotionSegment<'_>, is_open: bool) {
        let (Some(contact), Some(Ok(actuators))) = (self.contact, &self.in_series) else {
            return;
        };
        let (load, duration) = (segment.normal_load(contact), segment.duration());
        let load_at = |since: f64| if is_open { 0.0 } else { horner(load, since) };
        let [nodes, weights] = &*RULE;
        for (node, weight) in nodes.iter().zip(weights) {
            let since = node * duration;
            let time = segment.clock().after(since).time();
            let rate: f64 = actuators.iter().map(|actuator| actuator.rate_at(time)).sum();
            self.series_work = f64::mul_add(
                weight * duration,
                (load_at(since) - self.steady_load) * rate,
                self.series_work,
            );
        }
    }
}

/// What a profile adds to its mean at a time after a moment.
fn wave_force(profile: &Profile, clock: Clock, since: f64) -> f64 {
    profile.value(clock.after(since).time()) - profile.mean()
}
