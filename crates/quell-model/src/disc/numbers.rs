//! The numbers of a disc by their paths.

use super::{Carrier, Disc, DiscDither, Load};
use crate::parameter::disc::{
    CALIPER_DAMPING, CALIPER_MASS, CALIPER_STIFFNESS, CENTRIFUGAL, DISC, DISC_DITHER_AMPLITUDE,
    DISC_SPEED, LOAD_DAMPING, LOAD_FRICTION, LOAD_MASS, LOAD_NORMAL, LOAD_STATIC, LOAD_STIFFNESS,
    MODAL_DAMPING, PAD_DAMPING, PAD_MASS, PAD_STIFFNESS,
};
use crate::parameter::{DITHER_FREQUENCY_RATIO, Parameter, split_index};
use crate::{Invalid, InvalidValues};

impl Disc {
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
        if path == CENTRIFUGAL.path {
            let count = next.modes.len();
            return next.stiffened(vec![value; count]);
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
            return self.has_speed().then_some(&mut self.speed);
        }
        if path == MODAL_DAMPING.path {
            let (first, rest) = self.modes.split_first_mut()?;
            let same = rest.iter().all(|mode| mode.damping == first.damping);
            return same.then_some(&mut first.damping);
        }
        if path == CENTRIFUGAL.path {
            let (first, rest) = self.centrifugal.split_first_mut()?;
            let same = rest.iter().all(|value| value == first);
            return same.then_some(first);
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
            return self.has_speed().then_some(&mut self.speed);
        }
        let load = self.loads.get_mut(index)?;
        load.number(key)
    }
}

impl Load {
    fn number(&mut self, key: &str) -> Option<&mut f64> {
        let own = [
            (LOAD_MASS, &mut self.mass),
            (LOAD_DAMPING, &mut self.damping),
            (LOAD_STIFFNESS, &mut self.stiffness),
            (LOAD_FRICTION, &mut self.friction),
            (LOAD_STATIC, &mut self.static_load),
        ];
        let pad =
            self.pad.as_mut().map(|body| body.numbers(&[PAD_MASS, PAD_DAMPING, PAD_STIFFNESS]));
        let caliper = self
            .caliper
            .as_mut()
            .map(|body| body.numbers(&[CALIPER_MASS, CALIPER_DAMPING, CALIPER_STIFFNESS]));
        let normal = self.normal_load.as_mut().map(|load| (LOAD_NORMAL, load));
        let bodies = pad.into_iter().chain(caliper).flatten();
        let mut all = own.into_iter().chain(normal).chain(bodies);
        all.find(|(parameter, _)| parameter.key() == key).map(|(_, number)| number)
    }
}

impl Carrier {
    fn numbers(&mut self, names: &[Parameter; 3]) -> [(Parameter, &mut f64); 3] {
        let [mass, damping, stiffness] = *names;
        [(mass, &mut self.mass), (damping, &mut self.damping), (stiffness, &mut self.stiffness)]
    }
}
