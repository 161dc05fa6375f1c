//! Dither frequencies that keep a range of speeds free of the tongues induced by the dither itself.
//!
//! At one speed Ω, a pair of waves of equal direction grows for the frequencies R between (w₁ − w₂ − δ)/h at the two edges δ of
//! its slow system (`pair`), if p > η₁η₂ there. Damping is linear in Ω, so the speeds with p > η₁η₂ are bounded by the roots of a
//! quadratic. Over each such interval of speeds the band of R is bounded by two smooth curves, and the union of the bands is the
//! interval from the minimum of the lower curve to the maximum of the upper one. The remaining frequencies of the requested range
//! are therefore an exact list of intervals, to the accuracy of first-order theory, without a grid of frequencies.
//!
//! At a harmonic h of another waveform, the band of hR replaces that of R. Of a burst, R stands for the frequency at which it
//! repeats itself, and its results are multiplied by the cycles of the carrier.
//!
//! Under tangential dither friction has zero mean, and the undithered tongues vanish at this order: they remain suppressed.
//! [`within`] lists the resonances in the range for a single frequency, including tongues revived at second order.
//! The dissertation ends with this question.

use core::ops::RangeInclusive;

use quell_numerics::order::{ascending, ascending_by};
use quell_numerics::roots::{Closeness, minimise, quadratic};

use super::meetings::MeetingFamily;
use super::pair::DetuningBand;
use super::tongue::{Resonance, Tongue};
use super::wave::TravellingWave;
use super::waves::{Order, Waves};
use quell_model::disc::DiscDither;

/// Dither frequencies that keep a range of speeds clear, and the pairs of waves that block the others.
#[derive(Debug, Clone, PartialEq)]
pub struct Clearance {
    /// Intervals [from, to] of R without an induced tongue in the range of speeds, in ascending order.
    pub clear: Vec<[f64; 2]>,
    /// The blocked intervals, in ascending order; they may overlap.
    pub blocked: Vec<Blocked>,
    /// Whether the dither suppresses the undithered tongues at first order: tangential dither does, normal dither does not.
    pub original_suppressed: bool,
}

/// Dither frequencies at which a pair of waves grows somewhere in the range of speeds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Blocked {
    /// Lowest frequency R.
    pub from: f64,
    /// Highest frequency R.
    pub to: f64,
    /// The two waves.
    pub waves: [TravellingWave; 2],
    /// Whether the second wave couples through its conjugate.
    pub sum: bool,
    /// Harmonic h of the dither at which they meet.
    pub harmonic: i32,
}

/// Why clear frequencies could not be determined.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ClearanceError {
    /// There is no dither whose frequency could be chosen.
    NoDither,
    /// A range is empty or not finite, or the frequencies are not positive.
    Range,
    /// This wave grows by itself in the range of speeds, so no dither frequency clears the range.
    WaveUnstable {
        /// The wave.
        wave: TravellingWave,
        /// A speed at which it is undamped or grows.
        speed: f64,
    },
}

impl core::fmt::Display for ClearanceError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::NoDither => f.write_str("there is no dither whose frequency could be chosen"),
            Self::Range => f.write_str(
                "a range must be from a smaller to a larger number, and frequencies must be above 0",
            ),
            Self::WaveUnstable { wave, speed } => {
                write!(
                    f,
                    "the {wave} wave is undamped or unstable by itself at speed {speed}: no dither frequency clears the range"
                )
            }
        }
    }
}

impl core::error::Error for ClearanceError {}

/// A resonance in or near a range of speeds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearby {
    /// The resonance.
    pub resonance: Resonance,
    /// Whether its tongue reaches into the range.
    pub reaches_in: bool,
}

/// Samples of an edge of the band over an interval of speeds, before an extremum is refined: the edges are smooth and
/// have at most a few extrema over all speeds.
const SAMPLES: usize = 64;

/// Frequencies R in `frequencies` for which no tongue induced by the dither of `waves` reaches into `speeds`.
///
/// The dither frequency of `waves` itself is ignored.
///
/// # Errors
/// [`ClearanceError`] where no frequency can be chosen, a range is invalid, or a wave grows by itself.
pub fn clear_frequencies(
    waves: &Waves,
    speeds: RangeInclusive<f64>,
    frequencies: RangeInclusive<f64>,
) -> Result<Clearance, ClearanceError> {
    let waves = waves.clone().with_order(Order::First);
    let original_suppressed = match waves.dither {
        DiscDither::None => return Err(ClearanceError::NoDither),
        DiscDither::Normal { .. } => false,
        DiscDither::Tangential { .. } => true,
    };
    let proper = |range: &RangeInclusive<f64>| {
        range.start() <= range.end() && range.start().is_finite() && range.end().is_finite()
    };
    if !(proper(&speeds) && proper(&frequencies) && *frequencies.start() > 0.0) {
        return Err(ClearanceError::Range);
    }
    // Damping is linear in the speed, so checking both ends is sufficient.
    for wave in waves.waves().iter().filter(|wave| waves.coupling_squared(wave.mode) > 0.0) {
        for speed in [*speeds.start(), *speeds.end()] {
            if waves.growth_rate(wave, speed) >= 0.0 {
                return Err(ClearanceError::WaveUnstable { wave: *wave, speed });
            }
        }
    }
    let mut blocked = Vec::new();
    let cycles = waves.harmonics.cycles();
    for h in waves.driven(&speeds, *frequencies.start() / cycles) {
        for family in waves.families(h) {
            for part in grown_speeds(&waves, &family, &speeds) {
                let [from, to] = swept(&waves, &family, part).map(|end| cycles * end);
                if to >= *frequencies.start() && from <= *frequencies.end() {
                    let (sum, harmonic) = (family.conjugate, family.h);
                    blocked.push(Blocked { from, to, waves: family.waves, sum, harmonic });
                }
            }
        }
    }
    ascending_by(&mut blocked, |a| a.from);
    let mut clear = Vec::new();
    let mut reached = *frequencies.start();
    for block in &blocked {
        if block.from > reached {
            clear.push([reached, block.from]);
        }
        reached = reached.max(block.to);
    }
    // A single frequency is an interval too.
    let alone = frequencies.start() == frequencies.end() && blocked.is_empty();
    if reached < *frequencies.end() || alone {
        clear.push([reached, *frequencies.end()]);
    }
    Ok(Clearance { clear, blocked, original_suppressed })
}

/// Resonances in a range of speeds at the dither frequency of `waves`: every induced resonance whose meeting or tongue is in the
/// range, and the undithered ones; under tangential dither, these as revived at second order.
#[must_use]
pub fn within(waves: &Waves, speeds: RangeInclusive<f64>) -> Vec<Nearby> {
    let (start, end) = (*speeds.start(), *speeds.end());
    let first = waves.clone().with_order(Order::First);
    let mut found = Vec::new();
    if let Some(frequency) = first.dither_frequency() {
        let driven = first.driven(&speeds, frequency).into_iter();
        let families: Vec<MeetingFamily> = driven.flat_map(|h| first.families(h)).collect();
        for family in families.iter().filter(|family| family.slope != 0.0) {
            let speed = (family.offset + f64::from(family.h) * frequency) / family.slope;
            let inside = speeds.contains(&speed);
            let mut reaches_in = reaches(&first, family, &speeds, frequency);
            if reaches_in || inside {
                let resonance = first.resonance(&Waves::meeting_of(family, speed));
                // A wave that grows by itself has no band of detunings.
                if matches!(resonance.tongue, Tongue::WaveUnstable { .. }) {
                    reaches_in = inside;
                }
                found.push(Nearby { resonance, reaches_in });
            }
        }
    }
    let still = match waves.dither {
        DiscDither::Tangential { .. } => waves.clone().with_order(Order::Second),
        DiscDither::None | DiscDither::Normal { .. } => first,
    };
    // Undithered tongues are much narrower than half a unit of speed, so this margin includes every one that can reach in.
    let wide = start - 0.5..=end + 0.5;
    found.extend(still.undithered(wide).into_iter().filter_map(|resonance| {
        let inside = speeds.contains(&resonance.speed);
        let reaches_in = match resonance.tongue {
            Tongue::Absent => false,
            Tongue::Between { lower, upper, .. } => lower <= end && upper >= start,
            Tongue::WaveUnstable { .. } => inside,
        };
        (inside || reaches_in).then_some(Nearby { resonance, reaches_in })
    }));
    ascending_by(&mut found, |a| a.resonance.speed);
    found
}

/// Parts of the range of speeds in which the pair grows for some frequency: p > η₁η₂.
fn grown_speeds(
    waves: &Waves,
    family: &MeetingFamily,
    speeds: &RangeInclusive<f64>,
) -> Vec<[f64; 2]> {
    let (start, end) = (*speeds.start(), *speeds.end());
    let excess = |speed: f64| {
        let pair = waves.pair(&Waves::meeting_of(family, speed));
        pair.product.re - pair.first.re * pair.second.re
    };
    let middle = 0.5 * (start + end);
    let half = 0.5 * (end - start);
    if half == 0.0 {
        return if excess(middle) > 0.0 { vec![[start, end]] } else { Vec::new() };
    }
    // The quadratic e₀ + e₁x + e₂x², x = (Ω − middle)/half, from three of its values.
    let (low, centre, high) = (excess(start), excess(middle), excess(end));
    let (slope, bend) = (0.5 * (high - low), 0.5 * (high + low) - centre);
    let mut cuts = vec![-1.0];
    if let Some(mut roots) = quadratic(centre, slope, bend) {
        ascending(&mut roots);
        cuts.extend(roots.into_iter().filter(|x| x.abs() < 1.0));
    }
    cuts.push(1.0);
    cuts.windows(2)
        .filter(|part| excess(middle + half * 0.5 * (part[0] + part[1])) > 0.0)
        .map(|part| [middle + half * part[0], middle + half * part[1]])
        .collect()
}

/// Lowest and highest frequency at which the pair grows at one speed.
fn band(waves: &Waves, family: &MeetingFamily, speed: f64) -> [f64; 2] {
    let pair = waves.pair(&Waves::meeting_of(family, speed));
    let [first, second] = family.signed();
    let apart = waves.signed_frequency(&first, speed) - waves.signed_frequency(&second, speed);
    let centre = pair.second.im - pair.first.im;
    let (from, to) = match pair.band() {
        DetuningBand::Between(from, to) => (from, to),
        // At an end of the interval of speeds the band closes to a point.
        DetuningBand::Nowhere | DetuningBand::Outside => (centre, centre),
    };
    let h = f64::from(family.h);
    let (one, other) = ((apart - from) / h, (apart - to) / h);
    [one.min(other), one.max(other)]
}

/// Smallest value of a smooth function over an interval of speeds.
fn least([start, end]: [f64; 2], f: impl Fn(f64) -> f64) -> f64 {
    let speed = |i: usize| start + (end - start) * (i as f64 / SAMPLES as f64);
    let best = (0..=SAMPLES).min_by(|a, b| f(speed(*a)).total_cmp(&f(speed(*b)))).unwrap_or(0);
    let (low, high) = (speed(best.saturating_sub(1)), speed((best + 1).min(SAMPLES)));
    let refined = minimise(&f, low, high, Closeness { absolute: 0.0, relative: 1e-9 });
    f(speed(best)).min(refined.map_or(f64::INFINITY, |minimum| minimum.value))
}

/// Lowest and highest frequency at which the pair grows at some speed of the interval.
fn swept(waves: &Waves, family: &MeetingFamily, part: [f64; 2]) -> [f64; 2] {
    let lowest = least(part, |speed| band(waves, family, speed)[0]);
    [lowest, -least(part, |speed| -band(waves, family, speed)[1])]
}

/// Whether the pair grows at this frequency somewhere in the range of speeds.
fn reaches(
    waves: &Waves,
    family: &MeetingFamily,
    speeds: &RangeInclusive<f64>,
    frequency: f64,
) -> bool {
    grown_speeds(waves, family, speeds).into_iter().any(|part| {
        let outside = |speed: f64| {
            let [from, to] = band(waves, family, speed);
            (from - frequency).max(frequency - to)
        };
        least(part, outside) < 0.0
    })
}
