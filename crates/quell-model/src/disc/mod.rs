//! An annular disc under rotating loads, valid by construction.

use crate::parameter::disc::{CENTRIFUGAL, DISC_SPEED, MODE_CENTRIFUGAL};
use crate::profile::{Knots, Profile};
use crate::units::DiscScales;
use crate::{Friction, Invalid, InvalidValues, Waveform};

mod carrier;
mod complaint;
mod contributions;
mod dither;
mod drive;
mod law;
mod mode;
mod numbers;
mod patch;
mod plate;
mod structure;

pub use carrier::Carrier;
pub use contributions::{Contribution, Contributions};
pub use dither::{DiscDither, DitherShape};
pub use mode::{Load, Mode};
pub use patch::{Patch, PatchPoint, PatchRadius};

/// Modes of the plate, loads, dither and speed, in the numbers of the equations.
#[derive(Clone, Debug, PartialEq)]
pub struct Disc {
    modes: Vec<Mode>,
    loads: Vec<Load>,
    dither: DiscDither,
    shape: DitherShape,
    speed: f64,
    /// The speed over time, in place of the constant one.
    drive: Option<Profile>,
    law: Option<Friction>,
    /// κ of each mode; none where the disc is at rest.
    centrifugal: Vec<f64>,
    /// Scales and outer radius (m), where the study gives them.
    scales: Option<DiscScales>,
    outer_radius_m: Option<f64>,
}

impl Disc {
    /// From modes (at least one), loads (a disc without loads is free), dither and the speed Ω in ω_ref.
    ///
    /// # Errors
    /// All errors together, by the keys of a study file.
    pub fn new(
        modes: Vec<Mode>,
        loads: Vec<Load>,
        dither: DiscDither,
        speed: f64,
    ) -> Result<Self, InvalidValues> {
        Self::dithered_by(modes, loads, (dither, DitherShape::default()), speed)
    }

    /// As [`Disc::new`], with the waveform and the envelope of its dither.
    ///
    /// # Errors
    /// As [`Disc::new`]; an amplitude at which normal dither would pull a contact apart, an envelope of tangential dither.
    pub fn dithered_by(
        modes: Vec<Mode>,
        loads: Vec<Load>,
        (dither, shape): (DiscDither, DitherShape),
        speed: f64,
    ) -> Result<Self, InvalidValues> {
        let mut complaints = Vec::new();
        if modes.is_empty() {
            complaints.push(Invalid::new("disc.mode", "none", "at least one mode"));
        }
        for (index, mode) in modes.iter().enumerate() {
            complaints.extend(mode.complaints(index, modes.len()));
        }
        for (index, load) in loads.iter().enumerate() {
            complaints.extend(load.complaints(modes.len(), index, loads.len()));
        }
        complaints.extend(dither.complaints(&shape));
        complaints.extend(DISC_SPEED.check(speed).err());
        if complaints.is_empty() {
            let centrifugal = Vec::new();
            Ok(Self {
                modes,
                loads,
                dither,
                shape,
                speed,
                drive: None,
                law: None,
                centrifugal,
                scales: None,
                outer_radius_m: None,
            })
        } else {
            Err(InvalidValues::of(complaints))
        }
    }

    /// The same disc with its scales and its outer radius (m), so that its numbers have values in SI.
    #[must_use]
    pub fn in_si(self, scales: Option<DiscScales>, outer_radius_m: Option<f64>) -> Self {
        Self { scales, outer_radius_m, ..self }
    }

    /// Scales that convert dimensionless numbers to SI at a load, if the study determines them.
    pub fn scales(&self, load: usize) -> Option<DiscScales> {
        let radius_ratio = self.loads.get(load).and_then(|load| load.radius_ratio);
        let load_radius_m = radius_ratio.zip(self.outer_radius_m).map(|(ratio, a)| ratio * a);
        self.scales.map(|scales| DiscScales { load_radius_m, ..scales })
    }

    /// Mass M_p of the plate, kg, if the study determines it and its reference frequency in hertz.
    pub fn plate_mass_kg(&self) -> Option<f64> {
        self.scales?.plate_mass_kg
    }

    /// A valid disc of these parts in the scales of this one.
    fn rebuilt(
        &self,
        loads: Vec<Load>,
        dither: DiscDither,
        speed: f64,
    ) -> Result<Self, InvalidValues> {
        let shaped = (dither, self.shape.clone());
        let disc = Self::dithered_by(self.modes.clone(), loads, shaped, speed)?;
        let disc = Self { centrifugal: self.centrifugal.clone(), ..disc };
        let disc = match &self.drive {
            // Knots give the whole speed; an oscillation is about the constant one.
            Some(drive) if drive.knots().is_none() => disc.driven(drive.clone().about(speed))?,
            Some(drive) => disc.driven(drive.clone())?,
            None => disc,
        };
        let disc = match &self.law {
            Some(law) => disc.under_law(law.clone())?,
            None => disc,
        };
        Ok(disc.in_si(self.scales, self.outer_radius_m))
    }

    /// The same disc with the centrifugal stiffening κ of each mode, β² + κΩ²: the disc rotates at the speed Ω and its loads are
    /// at rest. All zero is a disc at rest under loads that rotate.
    ///
    /// # Errors
    /// A number out of bounds, or not one for each mode.
    pub fn stiffened(self, centrifugal: Vec<f64>) -> Result<Self, InvalidValues> {
        let count = self.modes.len();
        if centrifugal.len() != count {
            let allowed = format!("one number for each of the {count} modes");
            let wrong = Invalid::new(CENTRIFUGAL.path, centrifugal.len(), allowed);
            return Err(InvalidValues::from(wrong));
        }
        let complaints: Vec<Invalid> = centrifugal
            .iter()
            .enumerate()
            .filter_map(|(index, value)| {
                complaint::complain(&MODE_CENTRIFUGAL, *value, index, count)
            })
            .collect();
        if !complaints.is_empty() {
            return Err(InvalidValues::of(complaints));
        }
        let none = centrifugal.iter().all(|value| *value == 0.0);
        Ok(Self { centrifugal: if none { Vec::new() } else { centrifugal }, ..self })
    }

    /// Centrifugal stiffening κ of a mode.
    pub fn centrifugal(&self, mode: usize) -> f64 {
        self.centrifugal.get(mode).copied().unwrap_or(0.0)
    }

    /// Whether centrifugal stress stiffens a mode.
    pub fn is_stiffened(&self) -> bool {
        !self.centrifugal.is_empty()
    }

    /// Frequency √(β² + κΩ²) of a mode of the rotating disc, in ω_ref, seen from the disc.
    pub fn ratio_at_speed(&self, mode: usize) -> f64 {
        let ratio = self.modes[mode].ratio;
        match self.centrifugal(mode) {
            0.0 => ratio,
            centrifugal => self.square_at_speed(ratio, centrifugal).sqrt(),
        }
    }

    /// Critical speed of a mode, at which its forward wave stands still under the loads: β/√(q² − κ) in ω_ref, that is β/q without
    /// centrifugal stress; `None` without nodal diameters, or if the stress lets the wave run ahead at any speed.
    pub fn critical_speed(&self, mode: usize) -> Option<f64> {
        let Mode { diameters, ratio, .. } = self.modes[mode];
        let q = diameters as f64;
        match self.centrifugal(mode) {
            _ if diameters == 0 => None,
            0.0 => Some(ratio / q),
            centrifugal if centrifugal < q * q => Some(ratio / (q * q - centrifugal).sqrt()),
            _ => None,
        }
    }

    /// β² + κΩ².
    fn square_at_speed(&self, ratio: f64, centrifugal: f64) -> f64 {
        f64::mul_add(centrifugal * self.speed, self.speed, ratio * ratio)
    }

    /// Modes of the plate.
    pub fn modes(&self) -> &[Mode] {
        &self.modes
    }

    /// Loads.
    pub fn loads(&self) -> &[Load] {
        &self.loads
    }

    /// Dither of the friction force.
    pub fn dither(&self) -> DiscDither {
        self.dither
    }

    /// The same disc with another wave in place of the cosine of its dither: g(Rτ + π/2), g the waveform as it is defined for
    /// every kind of study. For [`Waveform::Square`] it is sgn cos Rτ.
    ///
    /// # Errors
    /// A waveform so large that normal dither would pull a contact apart.
    pub fn shaped(self, waveform: Waveform) -> Result<Self, InvalidValues> {
        let next = Self { shape: DitherShape { waveform, ..self.shape.clone() }, ..self };
        next.rebuilt(next.loads.clone(), next.dither, next.speed)
    }

    /// Waveform of the dither.
    pub fn waveform(&self) -> &Waveform {
        &self.shape.waveform
    }

    /// Share of the amplitude of the dither over time; `None` for the whole amplitude at all times.
    pub fn envelope(&self) -> Option<&Knots> {
        self.shape.envelope.as_ref()
    }

    /// Whether speed, loads and dither are steady: neither the speed nor a load varies in time, and the dither has no envelope.
    pub fn is_steady(&self) -> bool {
        let steady_loads = self.loads.iter().all(|load| load.share.is_none());
        self.drive.is_none() && self.envelope().is_none() && steady_loads
    }

    /// The steady disc of a time: it has the speed of that moment, and loads, with their friction, and dither have their shares.
    #[must_use]
    pub fn steady_at(&self, time: f64) -> Self {
        let loads = self.loads.iter().map(|load| {
            let share = load.share.as_ref().map_or(1.0, |share| share.value(time));
            Load {
                friction: share * load.friction,
                normal_load: load.normal_load.map(|normal| share * normal),
                share: None,
                ..load.clone()
            }
        });
        let share = self.envelope().map_or(1.0, |envelope| envelope.value(time));
        let shape = DitherShape { waveform: self.waveform().clone(), envelope: None };
        let dither = self.dither.with_amplitude_times(share);
        let speed = self.speed_at(time);
        Self { loads: loads.collect(), dither, shape, speed, drive: None, ..self.clone() }
    }

    /// Frequency ratio at which the dither repeats itself: R, of a burst R over its cycles of the carrier; `None` without dither.
    pub fn repetition_ratio(&self) -> Option<f64> {
        self.dither.frequency_ratio().map(|ratio| ratio / f64::from(self.waveform().cycles()))
    }

    /// Speed Ω of the loads over the disc, in ω_ref; where it varies, the mean of an oscillation, or the speed at t = 0.
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// Shape of mode `mode` at load `load`.
    pub fn shape(&self, mode: usize, load: usize) -> f64 {
        match &self.loads[load].shapes {
            Some(shapes) => shapes[mode],
            None => self.modes[mode].shape_at_load,
        }
    }

    /// Number of coordinates: those of the plate and one for each pad and caliper. The state has twice as many numbers.
    pub fn coordinates(&self) -> usize {
        self.plate_coordinates() + self.loads.iter().map(Load::bodies).sum::<usize>()
    }

    /// Number of coordinates of the plate: one for a mode without nodal diameters, two for every other.
    pub fn plate_coordinates(&self) -> usize {
        self.modes.iter().map(|mode| if mode.diameters == 0 { 1 } else { 2 }).sum()
    }

    /// The same disc at another, constant speed.
    ///
    /// # Errors
    /// A speed out of bounds.
    pub fn at_speed(&self, speed: f64) -> Result<Self, InvalidValues> {
        let steady = Self { drive: None, ..self.clone() };
        steady.rebuilt(self.loads.clone(), self.dither, speed)
    }

    /// The same disc with every load's friction times `factor`.
    ///
    /// # Errors
    /// A friction out of bounds.
    pub fn with_friction_times(&self, factor: f64) -> Result<Self, InvalidValues> {
        self.with_each_load(|load| Load { friction: factor * load.friction, ..load.clone() })
    }

    /// The same disc with every load changed.
    ///
    /// # Errors
    /// A load out of bounds.
    pub fn with_each_load(&self, change: impl Fn(&Load) -> Load) -> Result<Self, InvalidValues> {
        self.rebuilt(self.loads.iter().map(change).collect(), self.dither, self.speed)
    }

    /// The same disc without dither: f(τ) = f.
    #[must_use]
    pub fn undithered(&self) -> Self {
        Self { dither: DiscDither::None, shape: DitherShape::default(), ..self.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mode() -> Mode {
        Mode { diameters: 2, ratio: 2.0, shape_at_load: 0.93, damping: 0.0 }
    }

    #[test]
    fn every_complaint_comes_at_once() {
        let bad_mode = Mode { ratio: -1.0, damping: -0.1, ..mode() };
        let bad_load = Load { shapes: Some(vec![1.0]), ..Load::new(-0.1, 0.1, 0.1, f64::NAN) };
        let dither = DiscDither::Normal { amplitude: 1.5, frequency_ratio: 0.0 };
        let complaints = Disc::new(vec![mode(), bad_mode], vec![bad_load], dither, f64::INFINITY)
            .expect_err("all of it is wrong");
        let keys: Vec<&str> = complaints.iter().map(|complaint| complaint.key.as_str()).collect();
        assert_eq!(
            keys,
            [
                "disc.mode[1].ratio",
                "disc.mode[1].damping",
                "disc.load.mass",
                "disc.load.friction",
                "disc.load[0].shapes",
                "dither.frequency_ratio",
                "dither.amplitude",
                "disc.load.speed",
            ]
        );
        assert!(Disc::new(Vec::new(), Vec::new(), DiscDither::None, 0.0).is_err());
        let tangential = DiscDither::Tangential { amplitude: 1.5, frequency_ratio: 2.7 };
        assert!(Disc::new(vec![mode()], Vec::new(), tangential, 0.0).is_ok());
    }

    #[test]
    fn one_number_changes_and_the_others_stay() {
        let loads = vec![Load::new(0.1, 0.2, 0.3, 0.4), Load::new(0.5, 0.6, 0.7, 0.8)];
        let dither = DiscDither::Normal { amplitude: 0.5, frequency_ratio: 2.7 };
        let disc = Disc::new(vec![mode(), mode()], loads, dither, 0.3).expect("valid");
        assert_eq!(disc.modal_damping(), Some(0.0));
        let changed = disc.with_friction_of(1, 0.9).expect("in bounds");
        assert_eq!((changed.loads()[0].friction, changed.loads()[1].friction), (0.4, 0.9));
        assert!(disc.with_friction_of(2, 0.9).is_err());
        assert_eq!(
            disc.with_amplitude(0.9).map(|disc| disc.dither().mean_and_amplitude().1),
            Ok(0.9)
        );
        assert!(disc.with_amplitude(1.1).is_err());
        let faster = disc.with_frequency_ratio(0.9).expect("in bounds");
        assert_eq!(faster.dither().frequency_ratio(), Some(0.9));
        assert!(disc.undithered().with_amplitude(0.1).is_err());
    }
}
