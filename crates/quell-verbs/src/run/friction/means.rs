//! Friction of a contact at a slip velocity: of the law, on average, and on a steady response.
//!
//! The mean at a slip velocity v is that of steady sliding with the surface of this contact at v and those of the others unchanged,
//! with the fast motion that the structure makes of the dither there. The fast motion depends on v only where friction takes part in
//! it: at contacts with normals or slopes, and under dither of a load or of friction. Otherwise it is computed once.

use quell_dynamics::mean_friction::mean_friction;
use quell_dynamics::response::steady_effective_friction;
use quell_dynamics::simulation::DEFAULT_TOLERANCE;
use quell_linear::averaging::{
    AveragedLaw, Averaging, AveragingError, DitheredContact, DitheredSystem, Effective,
};
use quell_model::profile::Profile;
use quell_model::system::{Contact, Input, InputTarget};
use quell_model::{Belt, Friction, System};
use quell_numerics::order::ascending;

use super::curve::FrictionPoint;
use super::unknown::{
    LimitMean, MeasuredFriction, NoCoefficient, NoMeanOfContact, NoMeasuredFriction, NotFinite,
    NotFreeMass,
};
use crate::parallel::Parallel;

/// Points of the default grid on each side of v_r = 0.
const POINTS: u32 = 200;

/// Points clustered at the corner of the effective friction, each at half the distance of the one before.
const CORNER: i32 = 16;

/// A contact whose friction is asked for at slip velocities.
pub(super) struct ContactAverages<'a> {
    system: &'a System,
    index: usize,
    /// Its averaged law and its mean load in the study's own sliding.
    own: Result<(AveragedLaw, f64), AveragingError>,
    /// The contact in the limit of high frequency.
    pub(super) limit: Result<Belt, NotFreeMass>,
}

/// Every contact of a system.
pub(super) fn contacts(system: &System) -> Vec<ContactAverages<'_>> {
    let laws = averaged(system);
    let of = |index: usize| ContactAverages {
        system,
        index,
        own: laws.as_ref().map_err(Clone::clone).map(|laws| laws[index].clone()),
        limit: system.free_mass(index).map_err(NotFreeMass::from),
    };
    (0..system.contacts.len()).map(of).collect()
}

/// The averaged law of every contact in the study's own sliding, and its mean load.
fn averaged(system: &System) -> Result<Vec<(AveragedLaw, f64)>, AveragingError> {
    let prepared = DitheredSystem::new(system)?;
    let average = prepared.average()?;
    let contacts = average.contacts.iter().enumerate();
    let law = |(index, contact): (usize, &DitheredContact)| {
        let load = contact.normal_load;
        prepared.fast().law(system, (index, load), None).map(|law| (law, load))
    };
    contacts.map(law).collect()
}

impl ContactAverages<'_> {
    fn contact(&self) -> &Contact {
        &self.system.contacts[self.index]
    }

    /// Largest fast slip velocity in the study's own sliding.
    pub(super) fn fast_velocity(&self) -> Result<f64, AveragingError> {
        if !self.system.is_dithered() {
            return Ok(0.0);
        }
        let (law, _) = self.own.as_ref().map_err(Clone::clone)?;
        law.fast_velocity()
    }

    /// The load over which the averages are; where they are unknown, that of the study.
    pub(super) fn normal_load(&self) -> f64 {
        self.own.as_ref().map_or(self.contact().normal_load, |(_, load)| *load)
    }

    /// Slip velocities of a picture: beyond the velocities of the law, the surface and the fast motion, up to where slip including
    /// dither leaves the law's range.
    pub(super) fn grid(&self) -> Vec<f64> {
        let limit = || self.limit.as_ref().map_or(0.0, Belt::fast_velocity);
        let fast = self.fast_velocity().unwrap_or_else(|_| limit());
        let contact = self.contact();
        grid_of(&contact.friction, contact.surface_velocity.mean(), fast)
    }

    /// The law and its average at slip velocities.
    pub(super) fn points(&self, at: &[f64]) -> Vec<FrictionPoint> {
        at.in_parallel(|&v| self.point(v)).collect()
    }

    /// The law and its average at a slip velocity.
    pub(super) fn point(&self, v: f64) -> FrictionPoint {
        FrictionPoint {
            slip_velocity: v,
            coefficient: coefficient_at(&self.contact().friction, v),
            effective: self.mean_at(v).and_then(finite),
        }
    }

    fn mean_at(&self, v: f64) -> Result<Effective, NoMeanOfContact> {
        if self.contact().has_state() {
            return self.mean_of_state(v);
        }
        if !self.system.is_dithered() {
            // The law itself, whether or not the surface of the study moves.
            let law = AveragedLaw::undithered(&self.contact().friction);
            return Ok(law.at(v)?);
        }
        if !depends_on_friction(self.system) {
            let (law, _) = self.own.as_ref().map_err(Clone::clone)?;
            return Ok(law.at(v)?);
        }
        let mut there = self.system.clone();
        there.contacts[self.index].surface_velocity = Profile::constant(v);
        Ok(averaged(&there)?[self.index].0.at(v)?)
    }

    fn mean_of_state(&self, v: f64) -> Result<Effective, NoMeanOfContact> {
        let belt = self.limit.as_ref().map_err(Clone::clone)?;
        if belt.dithers().iter().any(|dither| !dither.waveform.is_periodic()) {
            return Err(NoMeanOfContact::UnderNoise);
        }
        Ok(mean_friction(belt, v)?)
    }

    /// The averages in the limit of high frequency; `None` without dither and of a contact with a state.
    pub(super) fn limits(&self, at: &[f64]) -> Option<Result<Vec<LimitMean>, NotFreeMass>> {
        if self.system.waves().next().is_none() || self.contact().has_state() {
            return None;
        }
        let in_the_limit = |belt: &Belt, v: f64| {
            let law = AveragedLaw::of_one_mass(belt, v, Averaging::Limit);
            finite(law.and_then(|law| law.at(v))?)
        };
        let belt = self.limit.as_ref().map_err(Clone::clone);
        Some(belt.map(|belt| at.in_parallel(|&v| in_the_limit(belt, v)).collect()))
    }
}

/// Friction of steady responses of one mass at slip velocities (4.30), (4.31), in parallel on all cores.
pub(super) fn measured(belt: &Belt, at: &[f64]) -> Vec<MeasuredFriction> {
    let measured = at.in_parallel(|&v| {
        if v == 0.0 {
            return Err(NoMeasuredFriction::SurfaceAtRest);
        }
        Ok(steady_effective_friction(belt, v, DEFAULT_TOLERANCE)?)
    });
    measured.collect()
}

/// Whether the fast motion depends on friction, and so on slip velocities.
fn depends_on_friction(system: &System) -> bool {
    let couples = |contact: &Contact| contact.normal.is_some() || contact.slope.is_some();
    let modulates = |input: &Input| !matches!(input.target, InputTarget::Force(_));
    system.contacts.iter().any(couples) || system.inputs.iter().any(modulates)
}

/// Slip velocities of a law at a surface velocity under a fast slip velocity.
fn grid_of(law: &Friction, velocity: f64, fast: f64) -> Vec<f64> {
    let reached = 1.5 * velocity.abs().max(fast);
    let scale = law.velocity_scale();
    let own = if law.has_velocity() || reached == 0.0 { 2.0 * scale } else { 0.0 };
    // The average at a slip velocity reaches that velocity plus the fast velocity.
    let within = law.range().map_or(f64::INFINITY, |range| range.upper);
    let within = match within - fast {
        // Rounding must not leave the range again.
        rest if rest > 0.0 && rest + fast > within => rest.next_down(),
        rest if rest > 0.0 => rest,
        _ => within,
    };
    let end = within.min(own.max(reached));
    let mut side: Vec<f64> =
        (1..=POINTS).map(|k| (end * f64::from(k) / f64::from(POINTS)).min(end)).collect();
    // The effective friction has a corner at the largest fast velocity.
    if fast > 0.0 {
        let crowd = (1..=CORNER).map(|k| fast * (1.0 - 0.5f64.powi(k))).chain([fast]);
        side.extend(crowd.filter(|&v| v <= end));
    }
    ascending(&mut side);
    side.dedup();
    let left = side.iter().rev().map(|v| -v);
    left.chain([0.0]).chain(side.iter().copied()).collect()
}

/// The friction coefficient of a law, with the sign of the slip velocity; or why it has no single value.
fn coefficient_at(law: &Friction, v: f64) -> Result<f64, NoCoefficient> {
    if v == 0.0 {
        return Err(NoCoefficient::AtRest { static_coefficient: law.static_coefficient() });
    }
    let coefficient = v.signum() * law.coefficient(v.abs());
    if coefficient.is_finite() { Ok(coefficient) } else { Err(NoCoefficient::NotFinite(NotFinite)) }
}

/// A mean whose numbers are finite.
fn finite(found: Effective) -> Result<Effective, NoMeanOfContact> {
    let numbers = [found.coefficient, found.coefficient_error, found.slope, found.slope_error];
    if numbers.iter().all(|number| number.is_finite()) { Ok(found) } else { Err(NotFinite.into()) }
}
