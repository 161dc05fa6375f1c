//! The point on which a dither acts: what it does over a period, without the slope of friction, for unit amplitude.
//!
//! Of a belt it is the mass on its spring, x″ + 2ζx′ + x = g(Rτ); of a sliding system the coordinate bᵀq under b g(ωt), friction
//! carried along as in [`crate::harmonic`]. Of a dither that modulates the load of a contact by g it is the elongation u of an actuator
//! in series with the spring and the damper of the contact, k u + d u̇ = g ([`crate::series_actuator`]); the force there is all by which
//! the load varies, g + k nᵀq + d nᵀq̇. The response is exact for every waveform ([`crate::periodic_response`]). What the dither costs
//! ([`crate::linear_cost`], [`crate::input_cost`]) and what an actuator must give to make it follow from it.

use quell_model::system::InputTarget;
use quell_model::{System, Waveform};
use quell_numerics::matrix::Matrix;
use quell_numerics::periodic_polynomial::PeriodicPolynomial;

use crate::harmonic::DrivenEquations;
use crate::linearised::{LinearContact, Linearised};
use crate::periodic_response::{NoPeriodicResponse, ResponseToWave};
use crate::series_actuator::{NoSeriesActuator, OutputRow, WithElongation, jumps};

/// A sum of the force of the dither and the motion of its point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PointOutput {
    /// Factor of the force.
    pub force: f64,
    /// Factor of the displacement.
    pub displacement: f64,
    /// Factor of the velocity.
    pub velocity: f64,
    /// Factor of the acceleration.
    pub acceleration: f64,
}

impl PointOutput {
    /// The force.
    pub const FORCE: Self =
        Self { force: 1.0, displacement: 0.0, velocity: 0.0, acceleration: 0.0 };
    /// The displacement.
    pub const DISPLACEMENT: Self =
        Self { force: 0.0, displacement: 1.0, velocity: 0.0, acceleration: 0.0 };
    /// The velocity.
    pub const VELOCITY: Self =
        Self { force: 0.0, displacement: 0.0, velocity: 1.0, acceleration: 0.0 };
}

/// Why the motion of a driven point is unknown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoDrivenPoint {
    /// The dither is a factor on friction.
    Factor,
    /// An actuator in series with the spring of a contact has no motion.
    InSeries(NoSeriesActuator),
    /// First-order equations: where the dither acts is no displacement.
    FirstOrder,
    /// The mass matrix is singular.
    Singular,
    /// There is no periodic response.
    NoResponse(NoPeriodicResponse),
}

impl core::fmt::Display for NoDrivenPoint {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Factor => {
                f.write_str("this dither is a factor on friction: it has no stroke of its own")
            }
            Self::InSeries(why) => why.fmt(f),
            Self::FirstOrder => f.write_str(
                "first-order equations do not give the displacement on which the input acts",
            ),
            Self::Singular => f.write_str("the mass of the structure is singular"),
            Self::NoResponse(why) => why.fmt(f),
        }
    }
}

impl core::error::Error for NoDrivenPoint {}

/// How the velocity and the acceleration of a driven point follow.
#[derive(Clone, Debug)]
enum PointRates {
    /// Of a coordinate of the structure: rows over the state.
    OfStructure { velocity: OutputRow, acceleration: OutputRow },
    /// Of an elongation: its slopes, and the acceleration of the structure that carries the actuator.
    OfElongation { carrier: OutputRow },
}

/// What the spring and the mass of an actuator change.
#[derive(Clone, Copy, Debug)]
enum Passive {
    /// Between the ground and the point: the displacement under a unit force, `None` where the structure is free to move, and the
    /// acceleration under a sudden one.
    Parallel { compliance: Option<f64>, acceleration: f64 },
    /// Between the structure and a contact of this stiffness; 0 where the structure does not move the contact.
    InSeries { stiffness: f64 },
}

/// The periodic motion of a driven point for unit amplitude.
#[derive(Clone, Debug)]
pub struct DrivenPoint<'w> {
    response: ResponseToWave<'w>,
    waveform: &'w Waveform,
    frequency: f64,
    /// What the actuator works against.
    force: OutputRow,
    displacement: OutputRow,
    rates: PointRates,
    /// The fast part of the slip velocity of every contact, rows over the state.
    slips: Vec<Vec<f64>>,
    passive: Passive,
}

impl<'w> DrivenPoint<'w> {
    /// The mass of a belt under a tangential dither, in its equations.
    ///
    /// # Errors
    /// [`NoPeriodicResponse`].
    pub fn of_one_mass(
        waveform: &'w Waveform,
        frequency_ratio: f64,
        damping_ratio: f64,
    ) -> Result<Self, NoPeriodicResponse> {
        let lowest = [-1.0, -2.0 * damping_ratio];
        let matrix = Matrix::from_fn(2, 2, |i, j| [[0.0, 1.0], lowest][i][j]);
        let response = ResponseToWave::new(&matrix, &[0.0, 1.0], waveform, frequency_ratio)?;
        Ok(Self {
            response,
            waveform,
            frequency: frequency_ratio,
            force: (vec![0.0; 2], 1.0),
            displacement: (vec![1.0, 0.0], 0.0),
            rates: PointRates::OfStructure {
                velocity: (vec![0.0, 1.0], 0.0),
                acceleration: (lowest.to_vec(), 1.0),
            },
            // v₀ − x′ falls where the mass moves with the belt.
            slips: vec![vec![0.0, -1.0]],
            passive: Passive::Parallel { compliance: Some(1.0), acceleration: 1.0 },
        })
    }

    /// The coordinate of a sliding system on which a force acts, or the actuator in series with the contact whose load is modulated, in the
    /// units of the system.
    ///
    /// # Errors
    /// [`NoDrivenPoint`].
    pub fn of_input(
        system: &System,
        sliding: &Linearised,
        target: &InputTarget,
        waveform: &'w Waveform,
        frequency: f64,
    ) -> Result<Self, NoDrivenPoint> {
        if matches!(target, InputTarget::Friction { .. }) {
            return Err(NoDrivenPoint::Factor);
        }
        if matches!(target, InputTarget::Force(_)) && sliding.matrices().is_none() {
            return Err(NoDrivenPoint::FirstOrder);
        }
        let equations =
            DrivenEquations::new(system, sliding, target).ok_or(NoDrivenPoint::Singular)?;
        let slips = sliding.contacts().iter().map(|contact| equations.slip_row(contact)).collect();
        match target {
            InputTarget::NormalLoad { contact, reaction } => {
                let contact = sliding.contacts().get(*contact);
                let contact = contact.ok_or(NoDrivenPoint::InSeries(NoSeriesActuator::NoSpring))?;
                Self::in_series(&equations, contact, *reaction, slips, waveform, frequency)
            }
            InputTarget::Force(row) => Self::of_force(&equations, row, slips, waveform, frequency),
            InputTarget::Friction { .. } => Err(NoDrivenPoint::Factor),
        }
    }

    /// The coordinate on which a force acts.
    fn of_force(
        equations: &DrivenEquations,
        row: &[f64],
        slips: Vec<Vec<f64>>,
        waveform: &'w Waveform,
        frequency: f64,
    ) -> Result<Self, NoDrivenPoint> {
        let [displacement, velocity] = [0, 1].map(|order| equations.over_state(row, order));
        let (matrix, source) = (&equations.matrix, &equations.source);
        let states = matrix.rows();
        let acceleration = equations.rate_of(&velocity);
        let column = Matrix::from_fn(states, 1, |i, _| -source[i]);
        let rest = matrix.solve(&column).filter(Matrix::is_finite);
        let moved =
            |rest: Matrix| (0..states).map(|i| displacement[i] * rest[(i, 0)]).sum::<f64>().abs();
        let compliance = rest.map(moved);
        let response = ResponseToWave::new(matrix, source, waveform, frequency)
            .map_err(NoDrivenPoint::NoResponse)?;
        Ok(Self {
            response,
            waveform,
            frequency,
            force: (vec![0.0; states], 1.0),
            displacement: (displacement, 0.0),
            passive: Passive::Parallel { compliance, acceleration: acceleration.1.abs() },
            rates: PointRates::OfStructure { velocity: (velocity, 0.0), acceleration },
            slips,
        })
    }

    /// The elongation of an actuator between the structure, or guides, and a contact.
    fn in_series(
        equations: &DrivenEquations,
        contact: &LinearContact,
        reaction: bool,
        mut slips: Vec<Vec<f64>>,
        waveform: &'w Waveform,
        frequency: f64,
    ) -> Result<Self, NoDrivenPoint> {
        let (stiffness, damping) = contact.normal_spring();
        let (matrix, source) = (&equations.matrix, &equations.source);
        let whole = WithElongation::new(matrix, source, stiffness, damping)
            .map_err(NoDrivenPoint::InSeries)?;
        let states = whole.matrix.rows();
        let mut load = equations.load_row(contact);
        let normal = contact.normal().filter(|_| reaction);
        let mut carrier = match normal {
            Some(normal) => equations.rate_of(&equations.over_state(normal, 1)),
            None => (Vec::new(), 0.0),
        };
        for row in slips.iter_mut().chain([&mut load, &mut carrier.0]) {
            row.resize(states, 0.0);
        }
        let response = ResponseToWave::new(&whole.matrix, &whole.source, waveform, frequency)
            .map_err(NoDrivenPoint::NoResponse)?;
        let point = Self {
            response,
            waveform,
            frequency,
            force: (load, 1.0),
            displacement: whole.elongation,
            rates: PointRates::OfElongation { carrier },
            slips,
            passive: Passive::InSeries {
                stiffness: if contact.normal().is_some() { stiffness } else { 0.0 },
            },
        };
        let elongation = point.outputs(&[PointOutput::DISPLACEMENT]);
        if elongation.iter().any(jumps) {
            return Err(NoDrivenPoint::InSeries(NoSeriesActuator::Jumps));
        }
        Ok(point)
    }

    /// The waveform of the dither.
    pub fn waveform(&self) -> &'w Waveform {
        self.waveform
    }

    /// Its angular frequency per unit of time of the equations: the phase is this times the time.
    pub fn frequency(&self) -> f64 {
        self.frequency
    }

    /// Sums of the force and the motion, over the phase.
    pub fn outputs(&self, wanted: &[PointOutput]) -> Vec<PeriodicPolynomial> {
        let rows: Vec<OutputRow> = wanted.iter().map(|output| self.row(output)).collect();
        let rows: Vec<(&[f64], f64)> =
            rows.iter().map(|(row, direct)| (row.as_slice(), *direct)).collect();
        let outputs = self.response.outputs(&rows);
        let needs_slopes =
            |output: &PointOutput| output.velocity != 0.0 || output.acceleration != 0.0;
        if matches!(self.rates, PointRates::OfStructure { .. }) || !wanted.iter().any(needs_slopes)
        {
            return outputs;
        }
        let (row, direct) = &self.displacement;
        let elongation = self.response.outputs(&[(row, *direct)]);
        let slope = elongation[0].derivative();
        let curvature = slope.derivative();
        let added = |(sum, output): (PeriodicPolynomial, &PointOutput)| {
            let with_velocity = sum.combined(1.0, output.velocity * self.frequency, &slope);
            let square = self.frequency * self.frequency;
            with_velocity.combined(1.0, output.acceleration * square, &curvature)
        };
        outputs.into_iter().zip(wanted).map(added).collect()
    }

    /// The part of an output that is a row over the state.
    fn row(&self, output: &PointOutput) -> OutputRow {
        let mut terms =
            vec![(output.force, &self.force), (output.displacement, &self.displacement)];
        match &self.rates {
            PointRates::OfStructure { velocity, acceleration } => {
                terms.extend([(output.velocity, velocity), (output.acceleration, acceleration)]);
            }
            PointRates::OfElongation { carrier } => terms.push((output.acceleration, carrier)),
        }
        let mut row = vec![0.0; self.displacement.0.len()];
        let mut direct = 0.0;
        for (factor, (entries, of_wave)) in terms {
            row.iter_mut().zip(entries).for_each(|(sum, entry)| *sum += factor * entry);
            direct += factor * of_wave;
        }
        (row, direct)
    }

    /// Whether the velocity of the point jumps, so that a mass there would need an unlimited force.
    pub fn velocity_jumps(&self) -> bool {
        self.outputs(&[PointOutput::VELOCITY]).iter().any(jumps)
    }

    /// Whether the actuator is in series with a contact, as opposed to between the ground and a coordinate.
    pub fn is_in_series(&self) -> bool {
        matches!(self.passive, Passive::InSeries { .. })
    }

    /// How much the spring and the mass of an actuator change the structure. Between the ground and the point it is the larger of the ratios
    /// to the stiffness of the structure under a constant force and to its mass under a sudden one, infinite for a spring on a structure
    /// that is free to move. In series with a contact it is the share of its stiffness that is lost.
    pub fn change_by(&self, stiffness: f64, mass: f64) -> f64 {
        match self.passive {
            Passive::Parallel { compliance, acceleration } => {
                let spring = match compliance {
                    _ if stiffness == 0.0 => 0.0,
                    Some(compliance) => stiffness * compliance,
                    None => f64::INFINITY,
                };
                spring.max(mass * acceleration)
            }
            Passive::InSeries { stiffness: 0.0 } => 0.0,
            Passive::InSeries { stiffness: own } => own / (own + stiffness),
        }
    }

    /// The largest fast slip velocity of every contact.
    pub fn slip_amplitudes(&self) -> Vec<f64> {
        let rows: Vec<(&[f64], f64)> = self.slips.iter().map(|row| (row.as_slice(), 0.0)).collect();
        let size = |slip: &PeriodicPolynomial| {
            let [least, largest] = slip.range();
            largest.max(-least)
        };
        self.response.outputs(&rows).iter().map(size).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x″ + 2ζx′ + x − g = 0 at every phase, for every waveform.
    #[test]
    fn the_motion_obeys_its_equation() {
        for waveform in Waveform::NAMED {
            let damping_ratio = 0.03;
            let point = DrivenPoint::of_one_mass(waveform, 2.7, damping_ratio).expect("a motion");
            let balance = PointOutput {
                force: -1.0,
                displacement: 1.0,
                velocity: 2.0 * damping_ratio,
                acceleration: 1.0,
            };
            let [least, largest] = point.outputs(&[balance])[0].range();
            assert!(least > -1e-13 && largest < 1e-13, "{waveform:?} {least} {largest}");
            assert_eq!(point.change_by(0.2, 0.1), 0.2);
            assert_eq!(point.change_by(0.2, 0.3), 0.3);
            let [slip] = point.slip_amplitudes()[..] else { panic!("one contact") };
            let [slowest, fastest] = point.outputs(&[PointOutput::VELOCITY])[0].range();
            assert_eq!(slip, fastest.max(-slowest));
        }
    }
}
