//! Meetings of two waves: (5.55), (5.56).
//!
//! β₁ + s₁Ω = σ(β₂ + s₂Ω) + hR with s = ∓q, over all pairs of waves, σ = ±1 (the second wave or its conjugate) and h. Each has
//! one speed unless the slopes are equal. The sums and differences in (5.55), (5.56) are σ = ∓1; several of the printed sign
//! choices never give a speed in (0, 1].

use core::ops::RangeInclusive;

use quell_numerics::order::ascending_by;

use super::wave::{SignedWave, TravellingWave};
use super::waves::{COINCIDENCE, Waves};

/// A meeting of two waves at a speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct WaveMeeting {
    pub(super) waves: [TravellingWave; 2],
    pub(super) conjugate: bool,
    pub(super) h: i32,
    pub(super) speed: f64,
}

/// The meetings of a pair of waves at a harmonic of the dither, with the speed as a function of R: Ω = (offset + hR)/slope.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct MeetingFamily {
    pub(super) waves: [TravellingWave; 2],
    pub(super) conjugate: bool,
    pub(super) h: i32,
    /// σβ₂ − β₁.
    pub(super) offset: f64,
    /// l₁ − l₂ in the complex form.
    pub(super) slope: f64,
}

impl MeetingFamily {
    /// The two waves in the complex form.
    pub(super) fn signed(&self) -> [SignedWave; 2] {
        signed(&self.waves, self.conjugate)
    }
}

impl WaveMeeting {
    /// The two waves in the complex form.
    pub(super) fn signed(&self) -> [SignedWave; 2] {
        signed(&self.waves, self.conjugate)
    }
}

fn signed(waves: &[TravellingWave; 2], conjugate: bool) -> [SignedWave; 2] {
    [SignedWave::new(&waves[0], false), SignedWave::new(&waves[1], conjugate)]
}

impl Waves {
    /// All pairs of waves at the harmonics ±h.
    pub(super) fn families(&self, h: i32) -> Vec<MeetingFamily> {
        let mut families = Vec::new();
        let harmonics: &[i32] = if h == 0 { &[0] } else { &[h, -h] };
        for (i, first) in self.list.iter().enumerate() {
            for second in &self.list[i..] {
                for conjugate in [false, true] {
                    if first == second && !conjugate {
                        continue;
                    }
                    let [one, two] = signed(&[*first, *second], conjugate);
                    let offset =
                        two.sigma * self.modes[two.mode].ratio - self.modes[one.mode].ratio;
                    for h in harmonics {
                        families.push(MeetingFamily {
                            waves: [*first, *second],
                            conjugate,
                            h: *h,
                            offset,
                            slope: one.l - two.l,
                        });
                    }
                }
            }
        }
        families
    }

    /// Meetings at the harmonics ±h with a speed in the range, in ascending order.
    pub(super) fn meetings(&self, h: i32, speeds: &RangeInclusive<f64>) -> Vec<WaveMeeting> {
        let dither = match (h, self.dither_frequency()) {
            (0, _) => 0.0,
            (_, Some(frequency)) => frequency,
            (_, None) => return Vec::new(),
        };
        let mut meetings: Vec<WaveMeeting> = self
            .families(h)
            .into_iter()
            .filter(|family| family.slope != 0.0)
            .map(|MeetingFamily { waves, conjugate, h, offset, slope }| {
                let speed = (offset + f64::from(h) * dither) / slope;
                WaveMeeting { waves, conjugate, h, speed }
            })
            // A meeting at the end of the range counts as inside, regardless of rounding.
            .filter(|meeting| {
                meeting.speed >= speeds.start() - COINCIDENCE
                    && meeting.speed <= speeds.end() + COINCIDENCE
            })
            .collect();
        ascending_by(&mut meetings, |a| a.speed);
        meetings
    }
}
