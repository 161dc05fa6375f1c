//! The instability tongue at a meeting of two waves: edges, width, growth rate.

use core::ops::RangeInclusive;

use quell_numerics::order::ascending_by;

use super::meetings::{MeetingFamily, WaveMeeting};
use super::pair::{DetuningBand, WavePair};
use super::wave::TravellingWave;
use super::waves::{Order, Waves};

/// Effect of the meeting of two waves on their stability, at the order of the expansion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Coupling {
    /// The waves can grow.
    Destabilising,
    /// A forward and a backward wave under dither share their damping: the pair has no tongue.
    SharesDamping,
    /// No effect: a node at the load, a wave without nodal diameters under dither, no mean friction, or a load without effect.
    None,
}

/// Speeds at which a pair of waves grows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tongue {
    /// No speed.
    Absent,
    /// The speeds between two edges.
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
    /// One wave of the pair is unstable or undamped by itself: there are no edges.
    WaveUnstable {
        /// The larger of the two growth rates at the meeting.
        growth: f64,
    },
}

impl Tongue {
    /// Lower and upper edge, if there are edges.
    #[must_use]
    pub fn edges(&self) -> Option<[f64; 2]> {
        match self {
            Self::Between { lower, upper, .. } => Some([*lower, *upper]),
            Self::Absent | Self::WaveUnstable { .. } => None,
        }
    }

    /// Distance between the edges; 0 without a tongue, `None` where there are no edges.
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
    pub waves: [TravellingWave; 2],
    /// Whether the second wave couples through its conjugate: a sum of frequencies, not a difference.
    pub sum: bool,
    /// Harmonic h of the dither, w₁ = w₂ + hR; 0 without dither.
    pub harmonic: i32,
    /// Effect of the meeting.
    pub coupling: Coupling,
    /// Smallest friction f with a tongue, for the given other values; `None` where no friction has one.
    pub threshold: Option<f64>,
    /// The tongue at the given friction.
    pub tongue: Tongue,
}

impl Resonance {
    /// Whether the pair of waves can be unstable at the order of the expansion. Three waves and more can grow where no pair does.
    #[must_use]
    pub fn pair_can_be_unstable(&self) -> bool {
        self.coupling == Coupling::Destabilising
    }

    /// The two waves in words: "forward (1,1) with forward (1,2)".
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
    /// Meetings of waves without dither (5.55) with a speed in the range, in ascending order.
    #[must_use]
    pub fn undithered(&self, speeds: RangeInclusive<f64>) -> Vec<Resonance> {
        self.meetings(0, &speeds).iter().map(|meeting| self.resonance(meeting)).collect()
    }

    /// Meetings of waves induced by dither (5.56) with a speed in the range, in ascending order, at every harmonic of the dither;
    /// at second order also those at sums of its harmonics, of a sine at twice its frequency. Empty without dither.
    #[must_use]
    pub fn dithered(&self, speeds: RangeInclusive<f64>) -> Vec<Resonance> {
        let Some(repetition) = self.dither_frequency() else { return Vec::new() };
        let driven = self.driven(&speeds, repetition).into_iter();
        let mut meetings: Vec<WaveMeeting> =
            driven.flat_map(|h| self.meetings(h, &speeds)).collect();
        ascending_by(&mut meetings, |a| a.speed);
        meetings.iter().map(|meeting| self.resonance(meeting)).collect()
    }

    /// The resonance at one meeting.
    pub(super) fn resonance(&self, meeting: &WaveMeeting) -> Resonance {
        let coupling = self.coupling(meeting);
        let tongue =
            if coupling == Coupling::Destabilising { self.tongue(meeting) } else { Tongue::Absent };
        Resonance {
            speed: meeting.speed,
            waves: meeting.waves,
            sum: meeting.conjugate,
            harmonic: meeting.h,
            coupling,
            threshold: self.threshold(meeting, coupling),
            tongue,
        }
    }

    /// The slow system of the pair at a meeting.
    pub(super) fn pair(&self, meeting: &WaveMeeting) -> WavePair {
        let [first, second] = meeting.signed();
        let resonant = [first, second];
        WavePair {
            first: self.self_term(&first, meeting.speed, &resonant),
            second: self.self_term(&second, meeting.speed, &resonant),
            product: self.coupling_product(&first, &second, meeting.h, meeting.speed),
        }
    }

    pub(super) fn coupling(&self, meeting: &WaveMeeting) -> Coupling {
        let [first, second] = meeting.signed();
        let excited = self.coupling_squared(first.mode) * self.coupling_squared(second.mode) > 0.0;
        let revived = self.order == Order::Second;
        let amplitude = self.dither.mean_and_amplitude().1;
        let (mean, size) = self.friction_parts(1.0, meeting.h);
        if !excited || first.l == second.l {
            return Coupling::None;
        }
        if meeting.h == 0 {
            let w = self.signed_frequency(&first, meeting.speed);
            let elastic = self.impedance(w).re != 0.0;
            let driven = mean > 0.0 || (revived && amplitude > 0.0);
            return if elastic && driven { Coupling::Destabilising } else { Coupling::None };
        }
        // Sign of the product of the couplings: (σ₁l₁)(σ₂l₂).
        let sign = first.sigma * first.l * second.sigma * second.l;
        let driven = size > 0.0 || (revived && amplitude > 0.0);
        if driven && sign > 0.0 {
            Coupling::Destabilising
        } else if driven && sign < 0.0 {
            Coupling::SharesDamping
        } else {
            Coupling::None
        }
    }

    pub(super) fn tongue(&self, meeting: &WaveMeeting) -> Tongue {
        let [first, second] = meeting.signed();
        let slope = first.l - second.l;
        let pair = self.pair(meeting);
        let speed = |detuning: f64| meeting.speed + detuning / slope;
        match pair.band() {
            DetuningBand::Nowhere => Tongue::Absent,
            DetuningBand::Outside => Tongue::WaveUnstable { growth: pair.growth(0.0) },
            DetuningBand::Between(from, to) => {
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

    /// The meeting of a family at a speed, for whichever dither frequency that speed requires.
    pub(super) fn meeting_of(family: &MeetingFamily, speed: f64) -> WaveMeeting {
        WaveMeeting { waves: family.waves, conjugate: family.conjugate, h: family.h, speed }
    }
}
