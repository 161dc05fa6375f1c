//! An annular disc under rotating loads, valid by construction.

use crate::parameter::disc::{
    DISC, DISC_DITHER_AMPLITUDE, DISC_SPEED, LOAD_DAMPING, LOAD_FRICTION, LOAD_MASS,
    LOAD_STIFFNESS, MODAL_DAMPING,
};
use crate::parameter::{DITHER_FREQUENCY_RATIO, Parameter, split_index};
use crate::units::DiscScales;
use crate::{Invalid, InvalidValues};

mod contributions;
mod mode;
mod structure;

pub use contributions::{Contribution, Contributions};
pub use mode::{Load, Mode};

/// Dither of the friction force f(τ) of every load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DiscDither {
    /// f(τ) = f.
    None,
    /// f(τ) = f (1 + α cos Rτ), (5.22): the normal load varies.
    Normal {
        /// Amplitude ratio α, 0 ≤ α ≤ 1: beyond 1 the pad would separate from the disc.
        amplitude: f64,
        /// Frequency ratio R > 0.
        frequency_ratio: f64,
    },
    /// f(τ) = f α cos Rτ, (5.31): the direction of sliding alternates, the mean friction vanishes.
    Tangential {
        /// Amplitude ratio α ≥ 0; 1 in the dissertation.
        amplitude: f64,
        /// Frequency ratio R > 0.
        frequency_ratio: f64,
    },
}

impl DiscDither {
    /// Mean of f(τ)/f and amplitude of its cosine.
    pub fn mean_and_amplitude(self) -> (f64, f64) {
        match self {
            Self::None => (1.0, 0.0),
            Self::Normal { amplitude, .. } => (1.0, amplitude),
            Self::Tangential { amplitude, .. } => (0.0, amplitude),
        }
    }

    /// Frequency ratio R; `None` without dither.
    pub fn frequency_ratio(self) -> Option<f64> {
        match self {
            Self::None => None,
            Self::Normal { frequency_ratio, .. } | Self::Tangential { frequency_ratio, .. } => {
                Some(frequency_ratio)
            }
        }
    }

    fn complaints(self) -> Vec<Invalid> {
        let (Self::Normal { amplitude, frequency_ratio }
        | Self::Tangential { amplitude, frequency_ratio }) = self
        else {
            return Vec::new();
        };
        let mut complaints: Vec<Invalid> =
            [(DISC_DITHER_AMPLITUDE, amplitude), (DITHER_FREQUENCY_RATIO, frequency_ratio)]
                .iter()
                .filter_map(|(parameter, value)| parameter.check(*value).err())
                .collect();
        if matches!(self, Self::Normal { .. }) && amplitude > 1.0 {
            complaints.push(Invalid::new(
                DISC_DITHER_AMPLITUDE.path,
                amplitude,
                "at most 1: more normal dither would pull the contact apart, which this model \
                 does not describe",
            ));
        }
        complaints
    }
}

/// Modes of the plate, loads, dither and speed, in the numbers of the equations.
#[derive(Clone, Debug, PartialEq)]
pub struct Disc {
    modes: Vec<Mode>,
    loads: Vec<Load>,
    dither: DiscDither,
    speed: f64,
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
        complaints.extend(dither.complaints());
        complaints.extend(DISC_SPEED.check(speed).err());
        if complaints.is_empty() {
            Ok(Self { modes, loads, dither, speed, scales: None, outer_radius_m: None })
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

    /// A valid disc of these parts in the scales of this one.
    fn rebuilt(
        &self,
        loads: Vec<Load>,
        dither: DiscDither,
        speed: f64,
    ) -> Result<Self, InvalidValues> {
        let disc = Self::new(self.modes.clone(), loads, dither, speed)?;
        Ok(disc.in_si(self.scales, self.outer_radius_m))
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

    /// Speed Ω of the loads over the disc, in ω_ref.
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

    /// Number of coordinates: one for a mode without nodal diameters, two for every other. The
    /// state has twice as many numbers.
    pub fn coordinates(&self) -> usize {
        self.modes.iter().map(|mode| if mode.diameters == 0 { 1 } else { 2 }).sum()
    }

    /// The same disc at another speed.
    ///
    /// # Errors
    /// A speed out of bounds.
    pub fn at_speed(&self, speed: f64) -> Result<Self, InvalidValues> {
        self.rebuilt(self.loads.clone(), self.dither, speed)
    }

    /// The same disc with every load's friction times `factor`.
    ///
    /// # Errors
    /// A friction out of bounds.
    pub fn with_friction_times(&self, factor: f64) -> Result<Self, InvalidValues> {
        let scaled = |load: &Load| Load { friction: factor * load.friction, ..load.clone() };
        let loads = self.loads.iter().map(scaled).collect();
        self.rebuilt(loads, self.dither, self.speed)
    }

    /// The same disc without dither: f(τ) = f.
    #[must_use]
    pub fn undithered(&self) -> Self {
        Self { dither: DiscDither::None, ..self.clone() }
    }

    /// Value of a parameter by its path: `disc.load.speed`, `disc.modal_damping` (where all modes
    /// agree), `disc.load.mass`, `disc.load[1].friction`, `dither.amplitude`,
    /// `dither.frequency_ratio`; `None` if there is no such number here.
    pub fn get(&self, path: &str) -> Option<f64> {
        let mut copy = self.clone();
        copy.number(path).map(|number| *number)
    }

    /// The entry of the registry for a path, or `None` if there is no such number here.
    pub fn parameter(&self, path: &str) -> Option<Parameter> {
        self.get(path)?;
        let key = match split_index(path, "disc.load") {
            Some((_, key)) => format!("disc.load.{key}"),
            None => path.to_owned(),
        };
        DISC.iter().find(|parameter| parameter.path == key).copied()
    }

    /// The load that a path names, counted from 0.
    pub(crate) fn load_of(path: &str) -> Option<usize> {
        split_index(path, "disc.load").map(|(index, _)| index)
    }

    /// The same disc with one parameter changed.
    ///
    /// # Errors
    /// An unknown path, a value out of bounds, a relation that no longer holds.
    pub fn with(&self, path: &str, value: f64) -> Result<Self, InvalidValues> {
        let mut next = self.clone();
        if path == MODAL_DAMPING.path {
            MODAL_DAMPING.check(value).map_err(InvalidValues::from)?;
            for mode in &mut next.modes {
                mode.damping = value;
            }
            return Ok(next);
        }
        match next.number(path) {
            Some(number) => *number = value,
            None => {
                return Err(InvalidValues::from(Invalid::new(
                    path,
                    value,
                    "a parameter of this disc",
                )));
            }
        }
        next.rebuilt(next.loads.clone(), next.dither, next.speed)
    }

    fn number(&mut self, path: &str) -> Option<&mut f64> {
        if path == DISC_SPEED.path {
            return Some(&mut self.speed);
        }
        if path == MODAL_DAMPING.path {
            let (first, rest) = self.modes.split_first_mut()?;
            let same = rest.iter().all(|mode| mode.damping == first.damping);
            return same.then_some(&mut first.damping);
        }
        if path == DISC_DITHER_AMPLITUDE.path || path == DITHER_FREQUENCY_RATIO.path {
            return match &mut self.dither {
                DiscDither::None => None,
                DiscDither::Normal { amplitude, frequency_ratio }
                | DiscDither::Tangential { amplitude, frequency_ratio } => {
                    Some(if path == DISC_DITHER_AMPLITUDE.path {
                        amplitude
                    } else {
                        frequency_ratio
                    })
                }
            };
        }
        let (index, key) = split_index(path, "disc.load")?;
        if key == DISC_SPEED.key() {
            return Some(&mut self.speed);
        }
        let load = self.loads.get_mut(index)?;
        if key == LOAD_MASS.key() {
            Some(&mut load.mass)
        } else if key == LOAD_DAMPING.key() {
            Some(&mut load.damping)
        } else if key == LOAD_STIFFNESS.key() {
            Some(&mut load.stiffness)
        } else if key == LOAD_FRICTION.key() {
            Some(&mut load.friction)
        } else {
            None
        }
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
    fn parameters_are_reached_by_their_paths() {
        let loads = vec![Load::new(0.1, 0.2, 0.3, 0.4), Load::new(0.5, 0.6, 0.7, 0.8)];
        let dither = DiscDither::Normal { amplitude: 0.5, frequency_ratio: 2.7 };
        let disc = Disc::new(vec![mode(), mode()], loads, dither, 0.3).expect("valid");
        assert_eq!(disc.parameter("disc.load[1].friction").map(|found| found.symbol), Some("f*"));
        for (path, value) in [
            ("disc.load.speed", 0.3),
            ("disc.modal_damping", 0.0),
            ("disc.load.damping", 0.2),
            ("disc.load[1].stiffness", 0.7),
            ("disc.load[1].friction", 0.8),
            ("disc.load[0].mass", 0.1),
            ("dither.amplitude", 0.5),
            ("dither.frequency_ratio", 2.7),
        ] {
            assert_eq!(disc.get(path), Some(value), "{path}");
            let changed = disc.with(path, 0.9).expect(path);
            assert_eq!(changed.get(path), Some(0.9), "{path}");
        }
        for path in ["disc.load[2].mass", "disc.colour", "disc.load.colour"] {
            assert!(disc.get(path).is_none() && disc.with(path, 1.0).is_err(), "{path}");
        }
        assert!(disc.with("dither.amplitude", 1.1).is_err());
    }
}
