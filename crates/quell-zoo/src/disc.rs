//! Discs.

use std::f64::consts::PI;

use quell_model::Disc;
use quell_model::disc::{DiscDither, Load, Mode};

use crate::NamedModel;

/// Normal dither of full amplitude at R = 2.7.
pub const NORMAL: DiscDither = DiscDither::Normal { amplitude: 1.0, frequency_ratio: 2.7 };

/// Tangential dither of the dissertation, α = 1, R = 2.7.
pub const TANGENTIAL: DiscDither = DiscDither::Tangential { amplitude: 1.0, frequency_ratio: 2.7 };

/// A set of modes of the annular plate b/a = 0.5, ν = 0.3 at r₀/a = 0.75, as in `reference/disc_eigenvalues.json`:
/// radial families, largest number of nodal diameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ZooModes {
    /// N = (1, 2): three modes, ω_ref of chapter 5.
    N12,
    /// N = (1, 5): six modes.
    N15,
    /// N = (2, 5): twelve modes.
    N25,
}

/// β, q, φ(r₀) of N = (1, 2).
const N12: [(f64, usize, f64); 3] = [
    (1.7715482549454453, 0, 0.65875445677796),
    (1.8076647041409195, 1, 0.933051069689499),
    (2.0, 2, 0.934699921735261),
];

/// β, q, φ(r₀) of N = (2, 5), of which N = (1, 5) is the first half.
const N25: [(f64, usize, f64); 12] = [
    (2.1049883413532802, 0, 0.65875445677796),
    (2.1479026138125943, 1, 0.933051069689499),
    (2.3764391802221647, 2, 0.934699921735261),
    (3.0, 3, 0.930869380030987),
    (4.1368116573772027, 4, 0.916799457181122),
    (5.7747192871038728, 5, 0.890682598473148),
    (13.743057339280388, 0, -1.43103252071965),
    (14.013449580497451, 1, -2.02319009033238),
    (14.826776768417764, 2, -2.02260542893234),
    (16.189125525929598, 3, -2.02464786168498),
    (18.109525779611632, 4, -2.03147634566082),
    (20.598011901090862, 5, -2.04368782383033),
];

impl ZooModes {
    /// Every set.
    pub const ALL: [Self; 3] = [Self::N12, Self::N15, Self::N25];

    /// Name in `reference/disc_eigenvalues.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::N12 => "1,2",
            Self::N15 => "1,5",
            Self::N25 => "2,5",
        }
    }

    /// Its modes, all with the same damping ratio ξ.
    pub fn modes(self, damping: f64) -> Vec<Mode> {
        let rows = match self {
            Self::N12 => &N12[..],
            Self::N15 => &N25[..6],
            Self::N25 => &N25[..],
        };
        let mode = |&(ratio, diameters, shape_at_load): &(f64, usize, f64)| Mode {
            diameters,
            ratio,
            shape_at_load,
            damping,
        };
        rows.iter().map(mode).collect()
    }
}

/// Variations of a disc. A single number is changed by a setter of [`Disc`], the speed by [`Disc::at_speed`].
pub trait DiscExt: Sized {
    /// The same disc with another dither.
    #[must_use]
    fn with_dither(&self, dither: DiscDither) -> Self;
    /// The same disc with these loads instead of its own.
    #[must_use]
    fn with_loads(&self, loads: Vec<Load>) -> Self;
}

impl DiscExt for Disc {
    fn with_dither(&self, dither: DiscDither) -> Self {
        disc(self.modes().to_vec(), self.loads().to_vec(), dither, self.speed())
    }

    fn with_loads(&self, loads: Vec<Load>) -> Self {
        disc(self.modes().to_vec(), loads, self.dither(), self.speed())
    }
}

/// A disc of any modes.
///
/// # Panics
/// On values out of bounds.
pub fn disc(modes: Vec<Mode>, loads: Vec<Load>, dither: DiscDither, speed: f64) -> Disc {
    let disc = Disc::new(modes, loads, dither, speed);
    disc.unwrap_or_else(|why| panic!("an invalid disc: {why:?}"))
}

/// A disc of one of the sets, under one load.
///
/// # Panics
/// On values out of bounds.
pub fn loaded(set: ZooModes, damping: f64, load: Load, dither: DiscDither, speed: f64) -> Disc {
    disc(set.modes(damping), vec![load], dither, speed)
}

/// A disc of one of the sets without any load.
///
/// # Panics
/// On values out of bounds.
pub fn free(set: ZooModes, damping: f64, speed: f64) -> Disc {
    disc(set.modes(damping), Vec::new(), DiscDither::None, speed)
}

/// m* = c* = k* = `strength`, and a friction f*.
pub fn equal_load(strength: f64, friction: f64) -> Load {
    Load::new(strength, strength, strength, friction)
}

/// Every disc without dither.
pub fn undithered() -> Vec<NamedModel<Disc>> {
    let none = DiscDither::None;
    let two_loads = vec![
        Load::new(0.1, 0.1, 0.2, 0.2),
        Load::new(0.2, 0.1, 0.1, 0.1).at_angle(1.1).dithered_at(0.4),
    ];
    let half = Load::new(0.15, 0.1, 0.125, 0.2);
    let pads = vec![half.clone(), half.at_angle(PI)];
    let one = |set, damping, strength, friction, speed| {
        loaded(set, damping, equal_load(strength, friction), none, speed)
    };
    vec![
        NamedModel::new("free disc", "chosen: no load", free(ZooModes::N12, 1e-3, 1.3)),
        NamedModel::new("one load", "figure 5.3", one(ZooModes::N12, 0.0, 0.1, 0.1, 0.3)),
        NamedModel::new(
            "one load, tongue",
            "table 5.1: the middle of the tongue that begins at Ω = 0.064",
            one(ZooModes::N12, 0.0, 0.1, 0.04, 0.07),
        ),
        NamedModel::new(
            "one load, damped",
            "chosen: ξ = 10⁻³",
            one(ZooModes::N12, 1e-3, 0.1, 0.1, 0.3),
        ),
        NamedModel::new("six modes", "figure 5.4", one(ZooModes::N15, 1e-4, 0.3, 0.6, 0.7)),
        NamedModel::new("twelve modes", "figure 5.5", one(ZooModes::N25, 1e-4, 0.2, 0.4, 0.37)),
        NamedModel::new(
            "two loads",
            "chosen: unequal, with a phase between their dithers",
            disc(ZooModes::N15.modes(1e-3), two_loads, none, 0.4),
        ),
        NamedModel::new(
            "two pads",
            "chosen: opposite halves of one load",
            disc(ZooModes::N12.modes(1e-4), pads, none, 0.85),
        ),
    ]
}

/// Every disc: each of [`undithered`] alone, with normal and with tangential dither.
pub fn all_discs() -> Vec<NamedModel<Disc>> {
    let mut all = Vec::new();
    for base in undithered() {
        for (suffix, dither) in [
            ("", DiscDither::None),
            (" + normal dither", NORMAL),
            (" + tangential dither", TANGENTIAL),
        ] {
            let name = format!("{}{suffix}", base.name);
            all.push(NamedModel::new(name, base.source, base.model.with_dither(dither)));
        }
    }
    all
}
