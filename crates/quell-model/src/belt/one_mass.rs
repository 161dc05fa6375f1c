//! Systems that are one mass on a moving surface, however they are written: the belt that each of them is.

use std::f64::consts::PI;

use super::Belt;
use crate::dither::{Direction, Dither};
use crate::profile::{Profile, Wave};
use crate::system::{Contact, Input, InputTarget, Mechanical, System};

/// Static coefficient below which a system is not taken for a belt, whose errors are bounded relative to the load: 10⁻¹² of the load is 10⁻⁹
/// of the friction here, and would not be small compared with a weaker one.
const LEAST_COEFFICIENT: f64 = 1e-3;

/// A system as the belt that it is, and what one unit of the belt's numbers is in those of the system.
///
/// With y = t q of the tangent t and ω = √(K/M), lengths of the belt are ω y, so that velocities and the law stay as they are;
/// its time is τ = ωt, and its forces are over [`OneMass::force`] = √(KM)/t².
///
/// ```
/// use quell_model::{Belt, Coulomb, Friction};
///
/// let law = Friction::Coulomb(Coulomb::constant(0.4));
/// let belt = Belt::new(0.05, 1.0, 0.5, law, Vec::new())?;
/// let same = belt.system().one_mass().expect("it is one");
/// assert_eq!((same.belt(), same.rate()), (&belt, 1.0));
/// # Ok::<(), quell_model::InvalidValues>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct OneMass {
    belt: Belt,
    rate: f64,
    tangent: f64,
    direction: f64,
    force: f64,
    shift: f64,
}

impl OneMass {
    /// The belt.
    pub fn belt(&self) -> &Belt {
        &self.belt
    }

    /// ω: a time of the system is that of the belt over it.
    pub fn rate(&self) -> f64 {
        self.rate
    }

    /// An amplitude of an input over that of its dither of the belt.
    pub fn amplitude(&self, target: &InputTarget) -> f64 {
        match target {
            InputTarget::Force(row) => (self.force * self.tangent / row[0]).abs(),
            InputTarget::NormalLoad { .. } | InputTarget::Friction { .. } => self.force,
        }
    }

    /// A force of the system over one of the belt.
    pub fn force(&self) -> f64 {
        self.force
    }

    /// The coordinate of the system over the displacement of the belt from [`OneMass::shift`], and its velocity over that of the belt.
    pub fn displacement(&self) -> f64 {
        1.0 / (self.rate * self.tangent)
    }

    /// Coordinate and velocity of the system in a state of the belt.
    pub fn state(&self, displacement: f64, velocity: f64) -> [f64; 2] {
        [(displacement + self.shift) * self.displacement(), velocity / self.tangent]
    }

    /// Displacement and velocity of the belt in a state of the system.
    ///
    /// # Panics
    /// If `state` has not two numbers at least.
    pub fn of_state(&self, state: &[f64]) -> (f64, f64) {
        let displacement = self.rate * self.tangent * state[0] - self.shift;
        (displacement, self.tangent * state[1])
    }

    /// The tangent t: a velocity of the belt is t times that of the coordinate.
    pub fn tangent(&self) -> f64 {
        self.tangent
    }

    /// −1 of a surface that moves backwards, whose mirror image the belt is: slip velocity, friction and t of the contact are those of the belt
    /// times this. Otherwise 1.
    pub fn direction(&self) -> f64 {
        self.direction
    }

    /// Displacement of the belt, from its unstretched spring, that the constant forces of the system cause.
    pub fn shift(&self) -> f64 {
        self.shift
    }
}

impl System {
    /// The belt that a system is: one coordinate with mass, spring and damper, one rigid contact under a prescribed load on a surface of
    /// constant velocity, and periodic or noisy forces and loads; of a surface that moves backwards its mirror image. `None` for every other
    /// system, and for loads that vanish.
    pub fn one_mass(&self) -> Option<OneMass> {
        let simulated = |one: &OneMass| {
            let belt = &one.belt;
            belt.friction.static_coefficient() >= LEAST_COEFFICIENT && belt.unsimulated().is_none()
        };
        let is_rigid = self.contacts.iter().all(|contact| !contact.has_state());
        self.as_belt().filter(|one| is_rigid && simulated(one))
    }

    /// The same for averages, which are stated for v ≥ 0, and which a state of the contact and a law that is not analytic at rest do not keep
    /// from having a value: the contact as a rigid one.
    pub fn one_averaged_mass(&self) -> Option<OneMass> {
        self.as_belt().filter(|one| one.direction > 0.0)
    }

    fn as_belt(&self) -> Option<OneMass> {
        let mechanical = self.structure.mechanical().filter(|one| one.by_speed().is_none())?;
        let [contact] = &self.contacts[..] else { return None };
        if mechanical.size() != 1 || !is_steady(contact) {
            return None;
        }
        let velocity = contact.surface_velocity.mean();
        let direction = if velocity < 0.0 { -1.0 } else { 1.0 };
        let tangent = direction * *contact.tangent.as_ref()?.first()?;
        let units = Units::of(mechanical, tangent)?;
        let (mut push, mut load) = (mechanical.force()[0] / tangent, contact.normal_load);
        let mut dithers = Vec::new();
        for Input { target, profile } in &self.inputs {
            let (direction, share) = match target {
                InputTarget::Force(row) => (Direction::Tangential, row[0] / tangent),
                InputTarget::NormalLoad { contact: 0, .. } => (Direction::Normal, 1.0),
                InputTarget::NormalLoad { .. } | InputTarget::Friction { .. } => return None,
            };
            match direction {
                Direction::Tangential => push += share * profile.mean(),
                Direction::Normal => load += profile.mean(),
            }
            dithers.extend(units.dithers(direction, share, profile)?);
        }
        let belt = Belt {
            damping_ratio: 0.5 * units.damping / units.force,
            normal_load: load / units.force,
            belt_velocity: velocity.abs(),
            friction: contact.friction.clone(),
            dithers,
            tangential_stiffness: None,
            normal_stiffness: 0.0,
            drive: None,
            load: None,
            scales: None,
        };
        let valid = belt.damping_ratio.is_finite()
            && belt.damping_ratio >= 0.0
            && belt.belt_velocity.is_finite()
            && belt.normal_load.is_finite()
            && belt.normal_load > 0.0
            && belt.total_amplitude(Direction::Normal) <= belt.normal_load;
        let (shift, Units { rate, force, .. }) = (push / units.force, units);
        (valid && shift.is_finite()).then_some(OneMass {
            belt,
            rate,
            tangent,
            direction,
            force,
            shift,
        })
    }
}

/// Whether a contact is as that of a belt, its load and its surface constant.
fn is_steady(contact: &Contact) -> bool {
    let surface = &contact.surface_velocity;
    contact.force.is_none()
        && contact.normal.is_none()
        && contact.slope.is_none()
        && contact.varying_load.is_none()
        && surface.is_steady()
        && surface.waves().is_empty()
}

/// What the numbers of a system are over those of its belt.
struct Units {
    rate: f64,
    force: f64,
    damping: f64,
}

impl Units {
    fn of(mechanical: &Mechanical, tangent: f64) -> Option<Self> {
        let square = tangent * tangent;
        let mass = mechanical.mass().matrix()[(0, 0)] / square;
        let stiffness = mechanical.stiffness()[(0, 0)] / square;
        let damping = mechanical.damping()[(0, 0)] / square;
        let (rate, force) = ((stiffness / mass).sqrt(), (stiffness * mass).sqrt());
        let usable = |value: f64| value.is_normal() && value > 0.0;
        [mass, stiffness, rate, force].into_iter().all(usable).then_some(Self {
            rate,
            force,
            damping,
        })
    }

    /// The waves of an input as dithers; `None` for one that a belt cannot have.
    fn dithers(&self, direction: Direction, share: f64, profile: &Profile) -> Option<Vec<Dither>> {
        if !profile.is_steady() {
            return None;
        }
        profile.waves().iter().map(|wave| self.dither(direction, share, wave)).collect()
    }

    fn dither(&self, direction: Direction, share: f64, wave: &Wave) -> Option<Dither> {
        let amplitude = share * wave.amplitude / self.force;
        let frequency_ratio = wave.frequency / self.rate;
        // A mirror image would be another waveform than that of the system.
        let is_own = amplitude >= 0.0 || wave.waveform.is_symmetric();
        let usable = amplitude.is_finite() && frequency_ratio.is_normal() && frequency_ratio > 0.0;
        (usable && is_own).then(|| dither_of(direction, amplitude, (frequency_ratio, wave)))?
    }
}

/// A wave as a dither; one that pushes backwards by half a period of a symmetric waveform, else by its mirror image. `None` where it has
/// none.
pub(super) fn dither_of(
    direction: Direction,
    amplitude: f64,
    (frequency_ratio, wave): (f64, &Wave),
) -> Option<Dither> {
    let (waveform, phase) = if amplitude >= 0.0 {
        (wave.waveform.clone(), wave.phase)
    } else if wave.waveform.is_symmetric() {
        (wave.waveform.clone(), wave.phase + PI)
    } else {
        (wave.waveform.negated()?, wave.phase)
    };
    let amplitude = amplitude.abs();
    Some(Dither { direction, waveform, amplitude, frequency_ratio, phase, envelope: None })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LawKind, Waveform};
    use quell_numerics::matrix::Matrix;

    fn belt() -> Belt {
        let law = LawKind::Stribeck.build(&[0.4, 0.2857, 0.2]).expect("valid");
        let dither = |direction, amplitude, phase| Dither {
            direction,
            waveform: Waveform::Sine,
            amplitude,
            frequency_ratio: 10.0,
            phase,
            envelope: None,
        };
        let dithers =
            vec![dither(Direction::Tangential, 0.3, 0.2), dither(Direction::Normal, 0.5, 0.0)];
        Belt::new(0.005, 1.0, 0.05, law, dithers).expect("valid")
    }

    #[test]
    fn a_system_in_other_units_is_the_same_belt() {
        let belt = belt();
        let mut system = belt.system();
        // Mass 2 and stiffness 50 along a tangent of 0.5: √(KM)/t² = 40, ω = 5.
        let one = |value: f64| Matrix::from_fn(1, 1, |_, _| value);
        let mass = crate::system::MassMatrix::dense(one(2.0));
        let structure = Mechanical::new(vec!["q".to_owned()], mass, one(0.1), one(50.0));
        system.structure = structure.under(vec![3.0]).into();
        system.contacts[0].tangent = Some(vec![0.5]);
        system.contacts[0].normal_load = 40.0;
        for (input, factor) in system.inputs.iter_mut().zip([-40.0, 40.0]) {
            input.profile = input.profile.scaled(factor).in_time_unit(0.2);
            if let InputTarget::Force(row) = &mut input.target {
                row[0] = 0.5;
            }
        }
        let same = system.one_mass().expect("one mass");
        let found = same.belt();
        assert_eq!((same.rate(), same.force(), same.tangent()), (5.0, 40.0, 0.5));
        assert!((same.shift() - 3.0 / 0.5 / 40.0).abs() < 1e-16);
        assert!((found.damping_ratio() - belt.damping_ratio()).abs() < 1e-17);
        assert_eq!(found.normal_load(), 1.0);
        for (found, given) in found.dithers().iter().zip(belt.dithers()) {
            assert!((found.amplitude - given.amplitude).abs() < 1e-16);
            assert_eq!(found.frequency_ratio, 10.0);
        }
        // The negative force is a dither of the opposite phase.
        assert_eq!(found.dithers()[0].phase, 0.2 + PI);
    }

    #[test]
    fn a_surface_that_moves_backwards_is_the_mirror_image() {
        let system = belt().system();
        let mut mirrored = system.clone();
        mirrored.contacts[0].surface_velocity = Profile::constant(-0.05);
        for input in &mut mirrored.inputs {
            if let InputTarget::Force(row) = &mut input.target {
                row[0] = -row[0];
            }
        }
        let (one, other) = (system.one_mass(), mirrored.one_mass());
        let [one, other] = [one, other].map(|one| one.expect("one mass"));
        assert_eq!(one.belt(), other.belt());
        assert_eq!([one.direction(), other.direction(), other.tangent()], [1.0, -1.0, -1.0]);
        assert_eq!(other.state(0.3, 0.2), one.state(-0.3, -0.2));
        // Averages are stated for surfaces that move forwards.
        assert!(mirrored.one_averaged_mass().is_none());
    }

    #[test]
    fn other_systems_are_not_one_mass() {
        let system = belt().system();
        let refused = |change: &dyn Fn(&mut System)| {
            let mut other = system.clone();
            change(&mut other);
            assert!(other.one_mass().is_none());
        };
        assert!(system.one_mass().is_some());
        refused(&|system| system.contacts[0].normal = Some(vec![1.0]));
        refused(&|system| system.contacts[0].tangential_stiffness = Some(3.0));
        refused(&|system| system.contacts[0].normal_load = 0.4);
        refused(&|system| system.inputs[0].target = InputTarget::Friction { contact: 0 });
        refused(&|system| system.contacts.push(system.contacts[0].clone()));
    }
}
