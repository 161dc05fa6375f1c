//! A mass on a moving belt, valid by construction.
//!
//! x″ + 2ζx′ + x = μ(v₀ − x′)·(F + Σ D_N g_N) + Σ D_T g_T        (2.1, 3.1, 4.1)
use crate::dither::{Direction, Dither};
use crate::friction::{Friction, Surroundings};
use crate::parameter::{
    BELT_VELOCITY, DAMPING_RATIO, DITHER_AMPLITUDE, NORMAL_LOAD, NORMAL_STIFFNESS,
    TANGENTIAL_STIFFNESS, indexed,
};
use crate::profile::{Knots, Profile};
use crate::units::Scales;
use crate::{Invalid, InvalidValues};

mod free_mass;
mod one_mass;
mod system;

pub use one_mass::OneMass;

/// Mass, spring, damper, contact, friction law and dither, in the numbers of the equations.
#[derive(Clone, Debug, PartialEq)]
#[expect(
    clippy::struct_field_names,
    reason = "the velocity of the belt, as opposed to that of the mass"
)]
pub struct Belt {
    damping_ratio: f64,
    normal_load: f64,
    belt_velocity: f64,
    friction: Friction,
    dithers: Vec<Dither>,
    /// k_t/k of an elastic slider.
    tangential_stiffness: Option<f64>,
    /// k_n/k of the spring through which an actuator gives normal dither; 0 where it is not known.
    normal_stiffness: f64,
    /// Velocity of the belt over time, if it varies.
    drive: Option<Profile>,
    /// Normal load over time, if it varies.
    load: Option<Profile>,
    /// Mass and stiffness, in a study in SI.
    scales: Option<Scales>,
}

impl Belt {
    /// From ζ ≥ 0, F > 0, v₀ ≥ 0, a law and any number of dithers.
    ///
    /// # Errors
    /// All errors together: values out of bounds, and normal dither that would pull the
    /// contact apart (ΣD_N > F).
    pub fn new(
        damping_ratio: f64,
        normal_load: f64,
        belt_velocity: f64,
        friction: Friction,
        dithers: Vec<Dither>,
    ) -> Result<Self, InvalidValues> {
        let mut complaints: Vec<Invalid> = [
            (DAMPING_RATIO, damping_ratio),
            (NORMAL_LOAD, normal_load),
            (BELT_VELOCITY, belt_velocity),
        ]
        .into_iter()
        .filter_map(|(parameter, value)| parameter.check(value).err())
        .collect();
        for (index, dither) in dithers.iter().enumerate() {
            complaints.extend(dither.complaints(index, dithers.len()));
        }
        let belt = Self {
            damping_ratio,
            normal_load,
            belt_velocity,
            friction,
            dithers,
            tangential_stiffness: None,
            normal_stiffness: 0.0,
            drive: None,
            load: None,
            scales: None,
        };
        complaints.extend(belt.separation());
        if !complaints.is_empty() {
            return Err(InvalidValues::of(complaints));
        }
        let friction = belt.friction.placed(&belt.surroundings())?;
        Ok(Self { friction, ..belt })
    }

    /// The same belt with an elastic slider of the tangential stiffness k_t/k > 0 at the contact
    /// ([`Contact::tangential_stiffness`](crate::system::Contact::tangential_stiffness)); `None` for a rigid contact.
    ///
    /// # Errors
    /// A stiffness that is not finite and positive; a law with a state of its own, whose bristles are elastic themselves.
    pub fn with_tangential_stiffness(self, stiffness: Option<f64>) -> Result<Self, InvalidValues> {
        if let Some(stiffness) = stiffness {
            TANGENTIAL_STIFFNESS.check(stiffness).map_err(InvalidValues::from)?;
            if self.friction.bristles().is_some() {
                let allowed = "none with a law whose bristles are elastic themselves";
                return Err(Invalid::new(TANGENTIAL_STIFFNESS.path, stiffness, allowed).into());
            }
        }
        Ok(Self { tangential_stiffness: stiffness, ..self })
    }

    /// Tangential stiffness k_t/k of an elastic slider; `None` where the contact is rigid.
    pub fn tangential_stiffness(&self) -> Option<f64> {
        self.tangential_stiffness
    }

    /// The same belt with a normal stiffness k_n/k > 0 of the contact, through which an actuator that lengthens by u gives the normal dither
    /// k_n u; `None` where the load is prescribed. It changes no motion, as the mass does not move in the normal direction.
    ///
    /// # Errors
    /// A stiffness that is not finite and positive.
    pub fn with_normal_stiffness(self, stiffness: Option<f64>) -> Result<Self, InvalidValues> {
        if let Some(stiffness) = stiffness {
            NORMAL_STIFFNESS.check(stiffness).map_err(InvalidValues::from)?;
        }
        Ok(Self { normal_stiffness: stiffness.unwrap_or(0.0), ..self })
    }

    /// Normal stiffness k_n/k of the contact; `None` where the load is prescribed.
    pub fn normal_stiffness(&self) -> Option<f64> {
        (self.normal_stiffness > 0.0).then_some(self.normal_stiffness)
    }

    /// Whether friction has a state of its own: an elastic slider, or a law with one ([`Friction::bristles`]).
    pub fn has_contact_state(&self) -> bool {
        self.tangential_stiffness.is_some() || self.friction.bristles().is_some()
    }

    /// Why the engine for belts cannot simulate it; `None` if it can. The engine for systems simulates contacts with states.
    pub fn unsimulated(&self) -> Option<&'static str> {
        if self.has_contact_state() {
            return Some(
                "friction has a state of its own (an elastic slider, or the law \"lugre\"), which this question about a \
                 belt does not take into account",
            );
        }
        self.friction.unsimulated()
    }

    /// The same belt driven at a velocity that varies in time, in place of its constant one. The belt may stand still and turn round.
    /// Its belt velocity, which scales what is drawn and proven, becomes the largest speed of the drive.
    ///
    /// # Errors
    /// A drive that jumps, or a law that has no value at the speeds of the drive.
    pub fn driven(self, drive: Profile) -> Result<Self, InvalidValues> {
        if let Some(place) = drive.knots().and_then(Knots::first_jump) {
            let time = drive.knots().map_or(0.0, |knots| knots.times()[place]);
            let allowed = "later than the time before it: the velocity of the belt cannot jump, no force could make a sticking mass follow";
            return Err(Invalid::new(format!("belt.drive.time[{place}]"), time, allowed).into());
        }
        let belt_velocity = drive.bounds().magnitude();
        let belt = Self { belt_velocity, drive: Some(drive), ..self };
        let friction = belt.friction.placed(&belt.surroundings())?;
        Ok(Self { friction, ..belt })
    }

    /// The same belt under a normal load that varies in time, in place of its constant one. Its normal load becomes that at τ = 0.
    ///
    /// # Errors
    /// A load that reaches zero together with normal dither.
    pub fn loaded(self, load: Profile) -> Result<Self, InvalidValues> {
        let least = load.bounds().lower;
        if least <= 0.0 {
            let allowed = "such that the load stays greater than 0: a belt without normal load has no contact";
            return Err(Invalid::new("belt.load", least, allowed).into());
        }
        let dither = self.total_amplitude(Direction::Normal);
        if dither > least {
            let index = self.dithers.iter().position(|one| one.direction == Direction::Normal);
            let allowed = format!(
                "at most the least normal load {least}: more normal dither would pull the contact apart, which this model \
                 does not describe"
            );
            let key = self.dither_path(index.unwrap_or(0), "amplitude");
            return Err(Invalid::new(key, dither, allowed).into());
        }
        let belt = Self { normal_load: load.value(0.0), load: Some(load), ..self };
        let friction = belt.friction.placed(&belt.surroundings())?;
        Ok(Self { friction, ..belt })
    }

    /// Velocity of the belt over time, if it varies.
    pub fn drive(&self) -> Option<&Profile> {
        self.drive.as_ref()
    }

    /// Velocity of the belt at the time τ.
    pub fn belt_velocity_at(&self, time: f64) -> f64 {
        self.drive.as_ref().map_or(self.belt_velocity, |drive| drive.value(time))
    }

    /// Normal load over time, if it varies; without dither.
    pub fn load(&self) -> Option<&Profile> {
        self.load.as_ref()
    }

    /// Whether drive, load and amplitudes are constant. Averages, orbits and thresholds are those of a steady belt.
    pub fn is_steady(&self) -> bool {
        let full = |dither: &Dither| dither.envelope.is_none();
        self.drive.is_none() && self.load.is_none() && self.dithers.iter().all(full)
    }

    /// The steady belt with the drive, load and amplitudes of a time.
    ///
    /// # Errors
    /// A belt that stands still or moves backwards then, or more normal dither than load.
    pub fn steady_at(&self, time: f64) -> Result<Self, InvalidValues> {
        let at = |profile: &Option<Profile>, own: f64| {
            profile.as_ref().map_or(own, |profile| profile.value(time))
        };
        let dithers = self.dithers.iter().map(|dither| {
            let amplitude = dither.amplitude * dither.wave().share(time);
            Dither { amplitude, envelope: None, ..dither.clone() }
        });
        let (load, velocity) =
            (at(&self.load, self.normal_load), at(&self.drive, self.belt_velocity));
        let friction = self.friction.clone();
        Self::new(self.damping_ratio, load, velocity, friction, dithers.collect())?
            .with_tangential_stiffness(self.tangential_stiffness)
            .map(|belt| Self { normal_stiffness: self.normal_stiffness, ..belt })
            .map(|belt| belt.in_si(self.scales))
    }

    /// The same belt with mass and stiffness, so that its numbers have values in SI.
    #[must_use]
    pub fn in_si(self, scales: Option<Scales>) -> Self {
        Self { scales, ..self }
    }

    /// Mass and stiffness, where they are known.
    pub fn scales(&self) -> Option<Scales> {
        self.scales
    }

    /// The properties of the belt that the friction law depends on.
    fn surroundings(&self) -> Surroundings {
        let slip = self.belt_velocity + self.fast_velocity();
        Surroundings { normal_load: self.normal_load, slip }
    }

    /// The largest fast velocity of the mass under all dithers in the limit of high frequency: Σ α max|G| of tangential
    /// dithers, μ_s times that of normal ones. Slip reaches v₀ plus this, under noise but for 10⁻⁴ of the time.
    pub fn fast_velocity(&self) -> f64 {
        self.dithers.iter().map(|dither| self.fast_velocity_of(dither)).sum()
    }

    /// The part of [`Belt::fast_velocity`] due to one dither.
    pub fn fast_velocity_of(&self, dither: &Dither) -> f64 {
        let level = match dither.direction {
            Direction::Tangential => 1.0,
            Direction::Normal => self.friction.static_coefficient(),
        };
        level * dither.amplitude_ratio() * dither.waveform.peak_integral()
    }

    /// The error for normal dither that exceeds the normal load, if those numbers are
    /// themselves valid.
    fn separation(&self) -> Option<Invalid> {
        let judged = NORMAL_LOAD.bounds.contains(self.normal_load)
            && self
                .dithers_along(Direction::Normal)
                .all(|dither| DITHER_AMPLITUDE.bounds.contains(dither.amplitude));
        if !judged {
            return None;
        }
        let total = self.total_amplitude(Direction::Normal);
        let index = self
            .dithers
            .iter()
            .position(|dither| dither.direction == Direction::Normal && dither.amplitude > 0.0)?;
        (total > self.normal_load).then(|| {
            let key = self.dither_path(index, "amplitude");
            Invalid::new(
                key,
                total,
                format!(
                    "at most the normal load F = {}: more normal dither would pull the contact \
                     apart, which this model does not describe",
                    self.normal_load
                ),
            )
        })
    }

    /// Damping ratio ζ.
    pub fn damping_ratio(&self) -> f64 {
        self.damping_ratio
    }

    /// Normal load F = N₀/k, a length.
    pub fn normal_load(&self) -> f64 {
        self.normal_load
    }

    /// Belt velocity v₀ = V₀/ω₀, a length.
    pub fn belt_velocity(&self) -> f64 {
        self.belt_velocity
    }

    /// Friction law.
    pub fn friction(&self) -> &Friction {
        &self.friction
    }

    /// Dithers, tangential and normal.
    pub fn dithers(&self) -> &[Dither] {
        &self.dithers
    }

    /// Dithers of one direction.
    pub fn dithers_along(&self, direction: Direction) -> impl Iterator<Item = &Dither> {
        self.dithers.iter().filter(move |dither| dither.direction == direction)
    }

    /// Whether any dither is normal, regardless of its amplitude.
    pub fn has_normal_dither(&self) -> bool {
        self.dithers.iter().any(|dither| dither.direction == Direction::Normal)
    }

    /// The largest force that the dithers of one direction can reach together: ΣD max|g|, of the normal ones −ΣD min g, by which
    /// they can reduce the load; of a dither with an envelope with its largest share. It is ΣD for the waveforms of the dissertation.
    pub fn total_amplitude(&self, direction: Direction) -> f64 {
        let most = |dither: &Dither| match direction {
            Direction::Tangential => dither.waveform.peak(),
            Direction::Normal => -dither.waveform.range().lower,
        };
        let share =
            |dither: &Dither| dither.envelope.as_ref().map_or(1.0, |knots| knots.range().upper);
        self.dithers_along(direction)
            .map(|dither| most(dither) * share(dither) * dither.amplitude)
            .sum()
    }

    /// The same belt without dither.
    #[must_use]
    pub fn undithered(&self) -> Self {
        Self { dithers: Vec::new(), ..self.clone() }
    }

    /// The same belt in which the seeds of all noise are greater by a number; beyond the largest seed they continue from 0.
    #[must_use]
    pub fn reseeded(&self, by: u64) -> Self {
        let dithers = self.dithers.iter().map(|dither| dither.reseeded(by));
        Self { dithers: dithers.collect(), ..self.clone() }
    }

    /// Displacement of steady sliding without dither, x = μ(v₀)F. At v₀ = 0 the static level.
    pub fn steady_sliding(&self) -> f64 {
        self.friction.coefficient(self.belt_velocity) * self.normal_load
    }

    /// Σ D g(Rτ + φ) of the dithers of one direction at the time τ.
    #[inline]
    pub fn dither_force(&self, direction: Direction, time: f64) -> f64 {
        self.dithers_along(direction)
            .map(|dither| {
                let phase = f64::mul_add(dither.frequency_ratio, time, dither.phase);
                let whole = dither.amplitude * dither.waveform.value(phase);
                dither.envelope.as_ref().map_or(whole, |envelope| envelope.value(time) * whole)
            })
            .sum()
    }

    /// N = F + Σ D_N g_N(R_Nτ + φ) at the time τ.
    #[inline]
    pub fn normal_load_at(&self, time: f64) -> f64 {
        let steady = self.load.as_ref().map_or(self.normal_load, |load| load.value(time));
        steady + self.dither_force(Direction::Normal, time)
    }

    /// 2ζ + μ′N: the rate at which areas of nearby states shrink in slip, for a slope of friction and a normal load.
    #[inline]
    pub fn damping_rate(&self, slope: f64, normal_load: f64) -> f64 {
        slope.mul_add(normal_load, 2.0 * self.damping_ratio)
    }

    /// The same belt with another damping ratio ζ.
    ///
    /// # Errors
    /// As [`Belt::new`].
    pub fn with_damping_ratio(&self, damping_ratio: f64) -> Result<Self, InvalidValues> {
        Self { damping_ratio, ..self.clone() }.valid()
    }

    /// The same belt under another steady normal load F.
    ///
    /// # Errors
    /// As [`Belt::new`].
    pub fn with_normal_load(&self, normal_load: f64) -> Result<Self, InvalidValues> {
        Self { normal_load, ..self.clone() }.valid()
    }

    /// The same belt at another velocity v₀; a drive that oscillates does so about it.
    ///
    /// # Errors
    /// As [`Belt::new`].
    pub fn with_belt_velocity(&self, belt_velocity: f64) -> Result<Self, InvalidValues> {
        let drive = self.drive.clone().map(|drive| drive.about(belt_velocity));
        Self { belt_velocity, drive, ..self.clone() }.valid()
    }

    /// The same belt under another friction law.
    ///
    /// # Errors
    /// As [`Belt::new`].
    pub fn with_friction(&self, friction: Friction) -> Result<Self, InvalidValues> {
        Self { friction, ..self.clone() }.valid()
    }

    /// The same belt with another amplitude of a dither, counted from 0.
    ///
    /// # Errors
    /// As [`Belt::new`]; a dither that the belt does not have.
    pub fn with_amplitude(&self, dither: usize, amplitude: f64) -> Result<Self, InvalidValues> {
        self.with_dither(dither, |dither| dither.amplitude = amplitude)
    }

    /// The same belt with another frequency ratio of a dither, counted from 0.
    ///
    /// # Errors
    /// As [`Belt::new`]; a dither that the belt does not have.
    pub fn with_frequency_ratio(&self, dither: usize, ratio: f64) -> Result<Self, InvalidValues> {
        self.with_dither(dither, |dither| dither.frequency_ratio = ratio)
    }

    fn with_dither(
        &self,
        index: usize,
        change: impl FnOnce(&mut Dither),
    ) -> Result<Self, InvalidValues> {
        let mut next = self.clone();
        let dither = next.dithers.get_mut(index).ok_or_else(|| {
            let allowed = format!("one of the {} dithers of this belt", self.dithers.len());
            Invalid::new("dither", index, allowed)
        })?;
        change(dither);
        next.valid()
    }

    /// The same belt with other dithers.
    ///
    /// # Errors
    /// As [`Belt::new`].
    pub fn dithered_by(&self, dithers: Vec<Dither>) -> Result<Self, InvalidValues> {
        Self { dithers, ..self.clone() }.valid()
    }

    /// Path of a key of dither `index`, as the study file names it.
    pub fn dither_path(&self, index: usize, key: &str) -> String {
        indexed("dither", index, self.dithers.len(), key)
    }

    /// The belt of these numbers, if they form one.
    fn valid(self) -> Result<Self, InvalidValues> {
        let (drive, load, stiffness) = (self.drive, self.load, self.tangential_stiffness);
        let belt = Self::new(
            self.damping_ratio,
            self.normal_load,
            self.belt_velocity,
            self.friction,
            self.dithers,
        )?;
        let belt = match drive {
            Some(drive) => belt.driven(drive)?,
            None => belt,
        };
        let belt = match load {
            Some(load) => belt.loaded(load)?,
            None => belt,
        };
        let belt = Self { normal_stiffness: self.normal_stiffness, ..belt };
        Ok(belt.with_tangential_stiffness(stiffness)?.in_si(self.scales))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LawKind, Waveform};

    fn belt(dithers: Vec<Dither>) -> Result<Belt, InvalidValues> {
        let law = LawKind::Stribeck.build(&[0.4, 0.2857, 0.2])?;
        Belt::new(0.005, 1.0, 0.05, law, dithers)
    }

    fn dither(direction: Direction, amplitude: f64) -> Dither {
        Dither {
            direction,
            waveform: Waveform::Sine,
            amplitude,
            frequency_ratio: 10.0,
            phase: 0.0,
            envelope: None,
        }
    }

    #[test]
    fn the_system_of_a_belt_has_its_numbers() {
        let belt = belt(vec![dither(Direction::Tangential, 0.3), dither(Direction::Normal, 0.5)])
            .expect("valid");
        let system = belt.system();
        assert_eq!(
            system.structure.mechanical().expect("a mass").damping()[(0, 0)],
            2.0 * belt.damping_ratio()
        );
        assert_eq!(system.contacts[0].normal_load, belt.normal_load());
        for time in [0.0, 0.37, 2.1] {
            let value = |index: usize| system.inputs[index].profile.value(time);
            assert_eq!(value(0), belt.dither_force(Direction::Tangential, time));
            assert_eq!(belt.normal_load() + value(1), belt.normal_load_at(time));
        }
    }

    #[test]
    fn the_system_in_si_has_the_forces_of_the_scaled_one() {
        let scales = Scales::new(2.0, 200.0).expect("valid");
        let belt = belt(vec![dither(Direction::Tangential, 0.3), dither(Direction::Normal, 0.5)])
            .and_then(|belt| belt.with_tangential_stiffness(Some(40.0)))
            .expect("valid")
            .in_si(Some(scales));
        let (scaled, si) = (belt.system(), belt.system_in_units().expect("in SI").expect("a law"));
        let close = |found: f64, expected: f64| {
            assert!((found - expected).abs() <= 1e-14 * expected.abs(), "{found} {expected}");
        };
        let [one, other] =
            [&scaled, &si].map(|system| system.structure.mechanical().expect("masses"));
        close(other.mass().matrix()[(0, 0)], 2.0 * one.mass().matrix()[(0, 0)]);
        close(other.damping()[(0, 0)], 20.0 * one.damping()[(0, 0)]);
        close(other.stiffness()[(0, 0)], 200.0);
        let [one, other] = [&scaled, &si].map(|system| &system.contacts[0]);
        close(other.normal_load, 200.0 * one.normal_load);
        close(other.tangential_stiffness.expect("elastic"), 8000.0);
        for slip in [0.0, 0.013, 0.4, 3.0] {
            close(other.friction.coefficient(10.0 * slip), one.friction.coefficient(slip));
            close(10.0 * other.friction.slope(10.0 * slip), one.friction.slope(slip));
        }
        for time in [0.0, 0.37, 2.1] {
            close(
                other.surface_velocity.value(time / 10.0),
                10.0 * one.surface_velocity.value(time),
            );
            for (input, scaled) in si.inputs.iter().zip(&scaled.inputs) {
                let expected = 200.0 * scaled.profile.value(time);
                assert!((input.profile.value(time / 10.0) - expected).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn a_changed_belt_keeps_its_scales() {
        let scales = Scales::new(2.0, 200.0).expect("valid");
        let belt = belt(Vec::new()).expect("valid").in_si(Some(scales));
        assert_eq!(belt.with_normal_load(2.0).expect("valid").scales(), Some(scales));
    }

    #[test]
    fn separation_is_refused_by_name() {
        let normal = dither(Direction::Normal, 0.6);
        let complaints =
            belt(vec![dither(Direction::Tangential, 9.0), normal.clone(), normal.clone()])
                .expect_err("1.2 > F = 1");
        assert_eq!(complaints.len(), 1);
        assert_eq!(complaints[0].key, "dither[1].amplitude");
        assert!(belt(vec![normal]).is_ok());
    }

    #[test]
    fn separation_is_reported_with_other_errors() {
        let law = LawKind::Stribeck.build(&[0.4, 0.2857, 0.2]).expect("valid");
        let complaints =
            Belt::new(-1.0, 1.0, 0.05, law, vec![dither(Direction::Normal, 1.5)]).expect_err("two");
        assert_eq!(complaints.len(), 2);
        let complaints = LawKind::Stribeck.build(&[0.1, 0.2, -1.0]).expect_err("two");
        assert_eq!(complaints.len(), 2);
    }

    #[test]
    fn one_number_changes_and_the_others_stay() {
        let belt = belt(vec![dither(Direction::Tangential, 0.3), dither(Direction::Normal, 0.5)])
            .expect("valid");
        assert_eq!(belt.with_damping_ratio(0.1).map(|belt| belt.damping_ratio()), Ok(0.1));
        assert_eq!(belt.with_belt_velocity(0.3).map(|belt| belt.belt_velocity()), Ok(0.3));
        let louder = belt.with_amplitude(1, 0.9).expect("valid");
        assert_eq!((louder.dithers()[0].amplitude, louder.dithers()[1].amplitude), (0.3, 0.9));
        let slower = belt.with_frequency_ratio(0, 3.0).expect("valid");
        assert_eq!((slower.dithers()[0].frequency_ratio, slower.dithers()[1].phase), (3.0, 0.0));
        assert!(belt.with_amplitude(2, 0.1).is_err() && belt.with_amplitude(1, 1.1).is_err());
        assert!(belt.with_normal_load(0.4).is_err());
        assert!(belt.friction().with("friction.minimum_coefficient", 0.41).is_err());
    }
}
