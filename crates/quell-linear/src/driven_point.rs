//! The point on which a dither acts: what it does over a period, without the slope of friction, for unit amplitude.
//!
//! Of a belt it is the mass on its spring, x″ + 2ζx′ + x = g(Rτ); of a sliding system the coordinate bᵀq under b g(ωt), friction
//! carried along as in [`crate::harmonic`]. The response is exact for every waveform ([`crate::periodic_response`]). What the dither
//! costs ([`crate::linear_cost`], [`crate::input_cost`]) and what an actuator must give to make it follow from it.

use quell_model::system::InputTarget;
use quell_model::{System, Waveform};
use quell_numerics::matrix::Matrix;
use quell_numerics::periodic_polynomial::PeriodicPolynomial;

use crate::harmonic::DrivenEquations;
use crate::linearised::Linearised;
use crate::periodic_response::{NoPeriodicResponse, ResponseToWave};

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
    /// The dither modulates the load of a contact.
    Modulation,
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
            Self::Modulation => f.write_str(
                "this dither modulates the load of a contact: it has no stroke of its own",
            ),
            Self::FirstOrder => f.write_str(
                "first-order equations do not give the displacement on which the input acts",
            ),
            Self::Singular => f.write_str("the mass of the structure is singular"),
            Self::NoResponse(why) => why.fmt(f),
        }
    }
}

impl core::error::Error for NoDrivenPoint {}

/// The periodic motion of a driven point for unit amplitude.
#[derive(Clone, Debug)]
pub struct DrivenPoint<'w> {
    response: ResponseToWave<'w>,
    waveform: &'w Waveform,
    frequency: f64,
    displacement: Vec<f64>,
    velocity: Vec<f64>,
    /// A row over the state, and the share of the force itself.
    acceleration: (Vec<f64>, f64),
    /// The fast part of the slip velocity of every contact, rows over the state.
    slips: Vec<Vec<f64>>,
    /// Static displacement under a unit force; `None` where the structure is free to move.
    compliance: Option<f64>,
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
            displacement: vec![1.0, 0.0],
            velocity: vec![0.0, 1.0],
            acceleration: (lowest.to_vec(), 1.0),
            // v₀ − x′ falls where the mass moves with the belt.
            slips: vec![vec![0.0, -1.0]],
            compliance: Some(1.0),
        })
    }

    /// The coordinate of a sliding system on which a force acts, in the units of the system.
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
        let InputTarget::Force(row) = target else { return Err(NoDrivenPoint::Modulation) };
        if sliding.matrices().is_none() {
            return Err(NoDrivenPoint::FirstOrder);
        }
        let equations =
            DrivenEquations::new(system, sliding, target).ok_or(NoDrivenPoint::Singular)?;
        let [displacement, velocity] = [0, 1].map(|order| equations.over_state(row, order));
        let (matrix, source) = (&equations.matrix, &equations.source);
        let states = matrix.rows();
        let along = |j: usize| -> f64 { (0..states).map(|i| velocity[i] * matrix[(i, j)]).sum() };
        let direct = velocity.iter().zip(source).map(|(row, b)| row * b).sum();
        let acceleration = ((0..states).map(along).collect(), direct);
        let contacts = sliding.contacts().iter();
        let slips = contacts.map(|contact| equations.slip_row(contact)).collect();
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
            displacement,
            velocity,
            acceleration,
            slips,
            compliance,
        })
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
        let (row_of_acceleration, direct) = &self.acceleration;
        let rows: Vec<(Vec<f64>, f64)> = wanted
            .iter()
            .map(|output| {
                let entry = |j: usize| {
                    output.displacement * self.displacement[j]
                        + output.velocity * self.velocity[j]
                        + output.acceleration * row_of_acceleration[j]
                };
                let row = (0..self.displacement.len()).map(entry).collect();
                (row, output.force + output.acceleration * direct)
            })
            .collect();
        let rows: Vec<(&[f64], f64)> =
            rows.iter().map(|(row, direct)| (row.as_slice(), *direct)).collect();
        self.response.outputs(&rows)
    }

    /// How much a spring to the ground and a mass at the point change the structure: the larger of the ratios to its own stiffness under
    /// a constant force and its own mass under a sudden one. Infinite for a spring on a structure that is free to move.
    pub fn change_by(&self, stiffness: f64, mass: f64) -> f64 {
        let spring = match self.compliance {
            _ if stiffness == 0.0 => 0.0,
            Some(compliance) => stiffness * compliance,
            None => f64::INFINITY,
        };
        spring.max(mass * self.acceleration.1.abs())
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
