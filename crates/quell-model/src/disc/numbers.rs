//! A disc with one of its numbers changed.

use super::{Disc, DiscDither, Load};
use crate::{Invalid, InvalidValues};

impl Disc {
    /// The damping ratio ξ of the modes; `None` where they differ.
    pub fn modal_damping(&self) -> Option<f64> {
        let (first, rest) = self.modes().split_first()?;
        rest.iter().all(|mode| mode.damping == first.damping).then_some(first.damping)
    }

    /// The same disc with another friction of a load, counted from 0.
    ///
    /// # Errors
    /// A friction out of bounds; a load that the disc does not have.
    pub fn with_friction_of(&self, load: usize, friction: f64) -> Result<Self, InvalidValues> {
        let mut loads: Vec<Load> = self.loads().to_vec();
        let changed = loads.get_mut(load).ok_or_else(|| {
            let allowed = format!("one of the {} loads of this disc", self.loads().len());
            Invalid::new("disc.load", load, allowed)
        })?;
        changed.friction = friction;
        self.rebuilt(loads, self.dither(), self.speed())
    }

    /// The same disc with another amplitude of its dither.
    ///
    /// # Errors
    /// An amplitude out of bounds; a disc without dither.
    pub fn with_amplitude(&self, amplitude: f64) -> Result<Self, InvalidValues> {
        self.redithered(|own, _| *own = amplitude)
    }

    /// The same disc with another frequency ratio of its dither.
    ///
    /// # Errors
    /// A ratio out of bounds; a disc without dither.
    pub fn with_frequency_ratio(&self, ratio: f64) -> Result<Self, InvalidValues> {
        self.redithered(|_, own| *own = ratio)
    }

    fn redithered(&self, change: impl Fn(&mut f64, &mut f64)) -> Result<Self, InvalidValues> {
        let mut dither = self.dither();
        match &mut dither {
            DiscDither::None => {
                return Err(Invalid::new("dither", "none", "a dither of this disc").into());
            }
            DiscDither::Normal { amplitude, frequency_ratio }
            | DiscDither::Tangential { amplitude, frequency_ratio } => {
                change(amplitude, frequency_ratio);
            }
        }
        self.rebuilt(self.loads().to_vec(), dither, self.speed())
    }
}
