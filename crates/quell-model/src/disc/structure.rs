//! The disc as a structure with contacts: its modes in the frame of the loads.
//!
//! In the frame of the loads, w = Σ φ(r)(A cos qφ + B sin qφ):
//!
//! ```text
//! A″ − 2qΩB′ + (β² − q²Ω²)A + 2ξβ(A′ − qΩB) = −Σ_l φ cos qθ_l [m w″ + c w′ + k w − f(τ) w_φ] at load l
//! B″ + 2qΩA′ + (β² − q²Ω²)B + 2ξβ(B′ + qΩA) = −Σ_l φ sin qθ_l [the same]                    (5.18), (5.25), (5.32)
//! ```
//!
//! Load l is a contact with the normal row u_l (φ cos qθ_l for A, φ sin qθ_l for B), w = u_lᵀy, and the slope row
//! s_l (−qφ sin qθ_l, qφ cos qθ_l), w_φ = s_lᵀy: its spring and damper are those of the contact, its mass is attached to the
//! structure, and its friction force f acts along the slope. Where the load has a pad of its own (displacement p), the normal
//! row reads w − p: the contact's spring, damper and friction act on the pad with the opposite sign, and the pad has a spring and
//! a damper to its caliper, or to the ground. The mass of the load moves with the disc.
//!
//! Where the speed varies in time, −qΩ′B and +qΩ′A are added (`plate.rs`), and the terms in Ω, Ω² and Ω′ are a
//! [`SpeedDependence`](crate::system::SpeedDependence) of the structure. A given friction force f does not depend on the speed; under
//! a law every load slides at the speed of the moment.
//!
//! Corrections to the print. Inside the double sum of (5.18), (5.25) and (5.32) the accelerations and velocities carry the
//! indices of the equation (A_pq″, A_pq′); they must be those of the sum (A_ij″, A_ij′), as (5.15) has them. Taken
//! literally it is another system whose verdict differs (Ω = 0.2, m = c = k = 0.3, f = 0.1: −2.1·10⁻² instead of +9.3·10⁻⁵).
//! The dissertation drops the plate's damping from (5.14) on and uses ξ in figures 5.8–5.15 without a definition;
//! here it is a damper at rest in the disc, which brings the circulatory pair 2ξβqΩ.

use std::f64::consts::FRAC_PI_2;

use quell_numerics::matrix::Matrix;

use super::plate::SpeedFactors;
use super::{Carrier, Contribution, Contributions, Disc, Load, PatchPoint};
use crate::InvalidValues;
use crate::friction::{Coulomb, Friction, Surroundings};
use crate::profile::{KnotShape, Knots, Profile, Wave};
use crate::system::{Contact, Input, InputTarget, MassMatrix, Mechanical, System};
use crate::units::UnitValues;

impl Disc {
    /// The system of the whole disc.
    pub fn system(&self) -> System {
        self.system_of(Contributions::ALL)
    }

    /// The system of some contributions, the others switched off.
    ///
    /// The follower force of the dissertation depends neither on the speed nor on the load: it is a Coulomb contact of unit
    /// load with μ = |f| on a surface that moves, at unit speed, in the direction of f. Its dither is a factor on the
    /// friction force. A load over a patch is a contact at every quadrature point, which has its share of the load.
    /// A load over time is added to that of its contacts, so that it multiplies friction by its share; the amplitude of a dither is
    /// relative to it. In large motions friction follows the load, and a contact with a spring or damper opens where its load vanishes; lengths
    /// are then in N/(M_pω_ref²), N the normal load of every load.
    pub fn system_of(&self, parts: Contributions) -> System {
        let factors = match self.drive() {
            Some(_) => SpeedFactors::REST,
            None => SpeedFactors::at(self.speed()),
        };
        let (mut damping, mut stiffness) = self.plate(parts, factors);
        let mut mass = self.masses();
        let mut contacts = Vec::new();
        let mut inputs = Vec::new();
        let mut body = self.plate_coordinates();
        let on = |part, value: f64| if parts.contains(part) { value } else { 0.0 };
        for (l, load) in self.loads().iter().enumerate() {
            for (index, point) in load.quadrature().iter().enumerate() {
                let (surface, slope) = self.rows_at(l, point);
                let load_mass = on(Contribution::LoadMass, load.mass);
                mass = mass.attach(point.weight * load_mass, surface.clone());
                inputs.push(self.factor(parts, load, contacts.len()));
                let sliding = self.sliding(load, point, slope);
                inputs.extend(load.added(sliding.normal_load, contacts.len()));
                contacts.push(Contact {
                    name: load.contact_name(l, index),
                    tangent: sliding.tangent,
                    force: None,
                    normal: Some(load.approach(surface, body)),
                    slope: Some(sliding.slope),
                    normal_load: sliding.normal_load,
                    normal_stiffness: point.weight * on(Contribution::Spring, load.stiffness),
                    tangential_stiffness: None,
                    normal_damping: point.weight * on(Contribution::Damper, load.damping),
                    surface_velocity: sliding.velocity,
                    friction: sliding.law,
                    varying_load: None,
                });
            }
            load.carry(body, &mut damping, &mut stiffness);
            body += load.bodies();
        }
        if !self.loads().iter().all(Load::is_plain) {
            // A patch attaches more masses than there are coordinates.
            mass = MassMatrix::dense(mass.matrix());
        }
        let structure = Mechanical::new(self.coordinate_names(), mass, damping, stiffness);
        let structure = match self.drive() {
            Some(drive) => structure.at_speed(self.speed_dependence(parts, drive)),
            None => structure,
        };
        System { structure: structure.into(), contacts, inputs }
    }

    /// The system of some contributions in kilograms, metres, seconds and newtons: M_p, the radius r₀ of the first load and 1/ω_ref are
    /// its units. `None` where the study does not determine them. Under a law a modulation of the normal load adds αN₀g to the load there,
    /// as an actuator behind the spring of the load does; to first order in the deflection that is the factor 1 + αg on friction.
    ///
    /// # Errors
    /// A law whose numbers are out of their bounds in metres per second.
    pub fn system_in_si(&self, parts: Contributions) -> Option<Result<System, InvalidValues>> {
        let scales = self.scales(0)?;
        let (mass, length) = (scales.plate_mass_kg?, scales.load_radius_m?);
        let rate = scales.angular_frequency();
        let velocity = length * rate;
        let force = mass * velocity * rate;
        let unit = UnitValues { mass, length, time: rate.recip(), force, velocity };
        let mut own = self.system_of(parts);
        if self.law().is_none() {
            own.contacts.iter_mut().for_each(|contact| given_force(contact, self.speed()));
        }
        Some(own.in_units(&unit).and_then(|system| {
            let has_law = self.law().is_some();
            let mut system = if has_law { system.with_loads_modulated() } else { system };
            for number in 0..system.contacts.len() {
                // A law without a velocity of its own is counted in that of the disc.
                let normal_load = system.contacts[number].surface_velocity.bounds().magnitude();
                let around = Surroundings { normal_load, ..system.surroundings(number) };
                let friction = system.contacts[number].friction.placed(&around)?;
                system.contacts[number].friction = friction;
            }
            Ok(system)
        }))
    }

    /// Friction at a point of a load: as a given follower force, or by the law.
    fn sliding(&self, load: &Load, point: &PatchPoint<'_>, slope: Vec<f64>) -> Sliding {
        let Some(law) = self.law() else {
            return Sliding {
                tangent: None,
                slope,
                normal_load: point.weight,
                velocity: Profile::constant(1f64.copysign(load.friction)),
                law: Friction::Coulomb(Coulomb::constant(point.lever * load.friction.abs())),
            };
        };
        let share = point.weight * point.lever;
        // Radius of the point over that of the first load.
        let radius = self.radius_over_first(load) / point.lever;
        let lever = load.half_thickness * point.lever;
        let tangent = (lever > 0.0).then(|| slope.iter().map(|slope| -lever * slope).collect());
        Sliding {
            tangent,
            normal_load: share * radius * load.normal_load.unwrap_or(1.0),
            velocity: match self.drive() {
                Some(drive) => drive.scaled(radius),
                None => Profile::constant(radius * self.speed()),
            },
            slope: slope.into_iter().map(|slope| slope / radius).collect(),
            law: law.clone(),
        }
    }

    /// The factor on the friction of a contact of a load.
    fn factor(&self, parts: Contributions, load: &Load, contact: usize) -> Input {
        let on = |part, value: f64| if parts.contains(part) { value } else { 0.0 };
        let (mean, amplitude) = self.dither().mean_and_amplitude();
        let mut factor = Profile::constant(on(Contribution::FollowerForce, mean));
        if let Some(frequency) = self.dither().frequency_ratio() {
            // cos(Rτ + φ) is a sine, and sgn cos a square wave, that leads by a quarter of a cycle; so does every waveform.
            factor = factor.with(Wave {
                waveform: self.waveform().clone(),
                amplitude: on(Contribution::Dither, amplitude),
                frequency,
                phase: load.dither_phase + FRAC_PI_2,
                envelope: self.envelope().cloned(),
            });
        }
        Input { target: InputTarget::Friction { contact }, profile: factor }
    }

    /// The mass matrix without the masses of the loads: I for modes of unit norm, and the pads and calipers.
    fn masses(&self) -> MassMatrix {
        let n = self.coordinates();
        let plate = self.plate_coordinates();
        if n == plate {
            return MassMatrix::identity(n);
        }
        let mut matrix = Matrix::identity(n);
        let bodies = self.loads().iter().flat_map(Load::carriers);
        for (at, body) in (plate..n).zip(bodies) {
            matrix[(at, at)] = body.mass;
        }
        MassMatrix::dense(matrix)
    }

    /// Names of the coordinates: A and B of each mode, counted from 0.
    fn coordinate_names(&self) -> Vec<String> {
        let modes = self.modes().iter().enumerate();
        let plate = modes.flat_map(|(index, mode)| {
            let second = (mode.diameters > 0).then(|| format!("B{index}"));
            [Some(format!("A{index}")), second].into_iter().flatten()
        });
        let bodies = self.loads().iter().enumerate().flat_map(|(l, load)| {
            let names = [format!("pad {l}"), format!("caliper {l}")];
            names.into_iter().take(load.bodies())
        });
        plate.chain(bodies).collect()
    }

    /// Row of the deflection under a load, averaged over its patch by the shares of the points.
    pub fn surface_row(&self, load: usize) -> Vec<f64> {
        let mut row = vec![0.0; self.coordinates()];
        for point in self.loads()[load].quadrature() {
            let (surface, _) = self.rows_at(load, &point);
            for (sum, entry) in row.iter_mut().zip(surface) {
                *sum += point.weight * entry;
            }
        }
        row
    }

    /// Rows of the deflection w and of its slope w_φ at a point of a load.
    fn rows_at(&self, l: usize, point: &PatchPoint<'_>) -> (Vec<f64>, Vec<f64>) {
        let (mut normal, mut slope) = (Vec::new(), Vec::new());
        for (index, mode) in self.modes().iter().enumerate() {
            let q = mode.diameters as f64;
            let (sine, cosine) = libm::sincos(q * point.angle);
            let shape = point.shapes.map_or_else(|| self.shape(index, l), |shapes| shapes[index]);
            normal.push(shape * cosine);
            if mode.diameters > 0 {
                normal.push(shape * sine);
                slope.push(-q * shape * sine);
                slope.push(q * shape * cosine);
            } else {
                slope.push(0.0);
            }
        }
        normal.resize(self.coordinates(), 0.0);
        slope.resize(self.coordinates(), 0.0);
        (normal, slope)
    }
}

/// Writes a contact whose friction is given as a force as one of this load with the coefficient 1, at the speed of the disc: of load and
/// coefficient only the product is known, and the contact has the direction of the force.
fn given_force(contact: &mut Contact, speed: f64) {
    let coefficient = contact.friction.coefficient(1.0);
    if coefficient > 0.0 {
        contact.normal_load *= coefficient;
        contact.friction = Friction::Coulomb(Coulomb::constant(1.0));
    }
    if speed != 0.0 {
        contact.surface_velocity = contact.surface_velocity.scaled(speed.abs());
    }
}

impl System {
    /// The same with factors 1 + αg on friction as loads αN₀g, which guides bear.
    fn with_loads_modulated(mut self) -> Self {
        let loads: Vec<f64> = self.contacts.iter().map(|contact| contact.normal_load).collect();
        for input in &mut self.inputs {
            if let InputTarget::Friction { contact } = input.target
                && input.profile.mean() == 1.0
            {
                let varied = input.profile.scaled(loads[contact]);
                input.profile = varied.about(0.0);
                input.target = InputTarget::NormalLoad { contact, reaction: false };
            }
        }
        self.inputs.retain(|input| input.profile != Profile::constant(0.0));
        self
    }
}

/// Friction at a point.
struct Sliding {
    tangent: Option<Vec<f64>>,
    slope: Vec<f64>,
    normal_load: f64,
    velocity: Profile,
    law: Friction,
}

impl Load {
    /// The load over time less the constant one, (s − 1)N, of a contact whose constant load is N. Guides bear it: a load presses the
    /// disc from both sides.
    fn added(&self, normal_load: f64, contact: usize) -> Option<Input> {
        let varied = self.share.as_ref()?.scaled(normal_load);
        let mean = varied.mean() - normal_load;
        // An envelope of 1 marks an oscillation as part of a load that varies, which no verb about a steady disc may take as dither.
        let always = Knots::new(vec![0.0], vec![1.0], KnotShape::Linear).ok();
        let waves =
            varied.waves().iter().map(|wave| Wave { envelope: always.clone(), ..wave.clone() });
        let profile = waves.fold(varied.without_waves().about(mean), Profile::with);
        Some(Input { target: InputTarget::NormalLoad { contact, reaction: false }, profile })
    }

    /// The pad and the caliper, as far as they are given.
    fn carriers(&self) -> impl Iterator<Item = &Carrier> {
        let caliper = self.pad.as_ref().and(self.caliper.as_ref());
        self.pad.iter().chain(caliper)
    }

    /// The points at which it acts: one, or those of its patch.
    fn quadrature(&self) -> Vec<PatchPoint<'_>> {
        match &self.patch {
            None => vec![PatchPoint { weight: 1.0, angle: self.angle, lever: 1.0, shapes: None }],
            Some(patch) => patch.around(self.angle),
        }
    }

    /// Name of the contact at a point.
    fn contact_name(&self, load: usize, point: usize) -> String {
        match self.patch {
            None => format!("load {load}"),
            Some(_) => format!("load {load}, point {point}"),
        }
    }

    /// The approach w − p of disc and pad, p the coordinate `at`; w without a pad.
    fn approach(&self, surface: Vec<f64>, at: usize) -> Vec<f64> {
        let mut row = surface;
        if self.pad.is_some() {
            row[at] = -1.0;
        }
        row
    }

    /// Adds the springs and dampers of pad and caliper, whose coordinates begin `at`.
    fn carry(&self, at: usize, damping: &mut Matrix, stiffness: &mut Matrix) {
        let last = self.bodies();
        for (index, body) in self.carriers().enumerate() {
            let own = at + index;
            for (matrix, strength) in
                [(&mut *damping, body.damping), (&mut *stiffness, body.stiffness)]
            {
                matrix[(own, own)] += strength;
                if index + 1 < last {
                    matrix[(own + 1, own + 1)] += strength;
                    matrix[(own, own + 1)] -= strength;
                    matrix[(own + 1, own)] -= strength;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{DiscDither, Load, Mode};
    use super::*;

    #[test]
    fn contributions_can_be_switched_one_by_one() {
        let mut set = Contributions::ALL;
        for &part in Contribution::ALL {
            assert!(set.contains(part));
            set = set.without(part);
            assert!(!set.contains(part));
            assert_eq!(Contribution::from_name(part.name()), Some(part));
        }
        assert_eq!(
            Contribution::ALL.iter().fold(set, |set, &part| set.with(part)),
            Contributions::ALL
        );
    }

    #[test]
    fn the_factor_of_the_friction_force_is_the_dither() {
        let mode = Mode { diameters: 2, ratio: 2.0, shape_at_load: 0.93, damping: 0.0 };
        let load = Load::new(0.1, 0.2, 0.3, -0.4).dithered_at(0.7);
        let dither = DiscDither::Normal { amplitude: 0.5, frequency_ratio: 2.7 };
        let system = Disc::new(vec![mode], vec![load], dither, 0.3).expect("valid").system();
        let factor = &system.inputs[0].profile;
        for time in [0.0f64, 0.4, 1.9] {
            let wanted = 0.5f64.mul_add((2.7 * time + 0.7).cos(), 1.0);
            assert!((factor.value(time) - wanted).abs() < 1e-14);
        }
        let contact = &system.contacts[0];
        let speed = contact.surface_velocity.mean();
        assert_eq!(speed.signum() * contact.friction.coefficient(speed.abs()), -0.4);
    }
}
