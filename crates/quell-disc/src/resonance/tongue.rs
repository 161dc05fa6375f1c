//! The tongue at a meeting of two waves: edges, width, growth.

use core::ops::RangeInclusive;

use super::pair::{Band, Pair};
use super::places::{Family, Place};
use super::wave::Wave;
use super::waves::{Order, Waves};

/// What the meeting of two waves does to their stability, at the order of the expansion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Coupling {
    /// It can make them grow.
    Destabilising,
    /// Forward with backward under dither: they share their damping, and a tongue cannot arise.
    SharesDamping,
    /// None: a node at the load, a wave without diameters under dither, no mean friction, or a load without effect.
    None,
}

/// Speeds at which a pair of waves grows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tongue {
    /// None.
    Absent,
    /// Between two speeds.
    Between {
        /// Lower edge.
        lower: f64,
        /// Upper edge.
        upper: f64,
        /// Speed of the largest growth.
        peak_speed: f64,
        /// Largest growth rate per unit τ.
        peak_growth: f64,
    },
    /// A wave of the pair is unstable, or undamped, by itself: there are no edges.
    WaveUnstable {
        /// Larger growth rate at the meeting.
        growth: f64,
    },
}

impl Tongue {
    /// Lower and upper edge, where there are edges.
    #[must_use]
    pub fn edges(&self) -> Option<[f64; 2]> {
        match self {
            Self::Between { lower, upper, .. } => Some([*lower, *upper]),
            Self::Absent | Self::WaveUnstable { .. } => None,
        }
    }

    /// Distance of the edges; 0 without a tongue, `None` where there are no edges.
    #[must_use]
    pub fn width(&self) -> Option<f64> {
        match self {
            Self::Absent => Some(0.0),
            Self::Between { lower, upper, .. } => Some(upper - lower),
            Self::WaveUnstable { .. } => None,
        }
    }

    /// Largest growth rate, where the pair grows.
    #[must_use]
    pub fn peak_growth(&self) -> Option<f64> {
        match self {
            Self::Absent => None,
            Self::Between { peak_growth, .. } => Some(*peak_growth),
            Self::WaveUnstable { growth } => Some(*growth),
        }
    }
}

/// The meeting of two waves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resonance {
    /// Speed Ω of the load in ω_ref at which the free waves meet.
    pub speed: f64,
    /// The two waves.
    pub waves: [Wave; 2],
    /// Whether the second wave takes part with its conjugate: a sum of frequencies, not a difference.
    pub sum: bool,
    /// Harmonic h of the dither, w₁ = w₂ + hR; 0 undithered.
    pub harmonic: i32,
    /// What the meeting does.
    pub coupling: Coupling,
    /// Smallest friction f with a tongue, the other values as given; `None` where there is none.
    pub threshold: Option<f64>,
    /// The tongue at the given friction.
    pub tongue: Tongue,
}

impl Resonance {
    /// Whether the meeting can be unstable at all.
    #[must_use]
    pub fn can_be_unstable(&self) -> bool {
        self.coupling == Coupling::Destabilising
    }

    /// "forward (1,1) with forward (1,2)".
    #[must_use]
    pub fn label(&self) -> String {
        let [first, second] = &self.waves;
        if first == second {
            format!("{first} with its own conjugate")
        } else {
            format!("{first} with {second}")
        }
    }
}

impl Waves {
    /// Meetings of waves with a speed in the range that need no dither, (5.55), ascending.
    #[must_use]
    pub fn undithered(&self, speeds: RangeInclusive<f64>) -> Vec<Resonance> {
        self.places(0, &speeds).iter().map(|place| self.resonance(place)).collect()
    }

    /// Meetings of waves with a speed in the range that the dither makes, (5.56), ascending; in the second order those of
    /// twice its frequency too. Empty without dither.
    #[must_use]
    pub fn dithered(&self, speeds: RangeInclusive<f64>) -> Vec<Resonance> {
        let mut places = self.places(1, &speeds);
        if self.order == Order::Second {
            places.extend(self.places(2, &speeds));
            places.sort_by(|a, b| a.speed.total_cmp(&b.speed));
        }
        places.iter().map(|place| self.resonance(place)).collect()
    }

    /// Everything about one meeting.
    pub(super) fn resonance(&self, place: &Place) -> Resonance {
        let coupling = self.coupling(place);
        let tongue =
            if coupling == Coupling::Destabilising { self.tongue(place) } else { Tongue::Absent };
        Resonance {
            speed: place.speed,
            waves: place.waves,
            sum: place.conjugate,
            harmonic: place.h,
            coupling,
            threshold: self.threshold(place, coupling),
            tongue,
        }
    }

    /// The slow system of a pair at a speed.
    pub(super) fn pair(&self, place: &Place) -> Pair {
        let [first, second] = place.signed();
        let resonant = [first, second];
        Pair {
            first: self.self_term(&first, place.speed, &resonant),
            second: self.self_term(&second, place.speed, &resonant),
            product: self.coupling_product(&first, &second, place.h, place.speed),
        }
    }

    pub(super) fn coupling(&self, place: &Place) -> Coupling {
        let [first, second] = place.signed();
        let touched = self.coupling_squared(first.mode) * self.coupling_squared(second.mode) > 0.0;
        let (mean, half) = self.friction_parts(1.0);
        if !touched || first.l == second.l {
            return Coupling::None;
        }
        if place.h == 0 {
            let w = self.signed_frequency(&first, place.speed);
            let elastic = self.impedance(w).re != 0.0;
            let driven = mean > 0.0 || (self.order == Order::Second && half > 0.0);
            return if elastic && driven { Coupling::Destabilising } else { Coupling::None };
        }
        // Sign of the product of the couplings: (σ₁l₁)(σ₂l₂).
        let sign = first.sigma * first.l * second.sigma * second.l;
        if half > 0.0 && sign > 0.0 {
            Coupling::Destabilising
        } else if half > 0.0 && sign < 0.0 {
            Coupling::SharesDamping
        } else {
            Coupling::None
        }
    }

    pub(super) fn tongue(&self, place: &Place) -> Tongue {
        let [first, second] = place.signed();
        let slope = first.l - second.l;
        let pair = self.pair(place);
        let speed = |detuning: f64| place.speed + detuning / slope;
        match pair.band() {
            Band::Nowhere => Tongue::Absent,
            Band::Outside => Tongue::WaveUnstable { growth: pair.growth(0.0) },
            Band::Between(from, to) => {
                let (peak, peak_growth) = pair.peak();
                let (one, other) = (speed(from), speed(to));
                Tongue::Between {
                    lower: one.min(other),
                    upper: one.max(other),
                    peak_speed: speed(peak),
                    peak_growth,
                }
            }
        }
    }

    /// A place of a family at a speed, whatever the dither's frequency would have to be.
    pub(super) fn place_of(family: &Family, speed: f64) -> Place {
        Place { waves: family.waves, conjugate: family.conjugate, h: family.h, speed }
    }
}
