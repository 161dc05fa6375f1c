//! Which dither frequency keeps a range of speeds free of the tongues that dither itself makes?
//!
//! At one speed Ω a pair of waves of equal direction grows for the frequencies R between
//! (w₁ − w₂ − δ)/h at the two edges δ of its slow system (`pair`), if p > η₁η₂ there. Damping is linear in Ω, so the
//! speeds with p > η₁η₂ are bounded by the roots of a quadratic; over each such interval of speeds the band of R is swept out by
//! two smooth curves, and its union is the interval between the least and the largest of them. What is left of the wanted
//! frequencies is an exact list of intervals, to the accuracy of first-order theory: no grid of frequencies.
//! With tangential dither friction has no mean, and the undithered tongues vanish at this order: they stay suppressed.
//! [`within`] tells for one frequency what lies in the range, tongues revived at second order included.
//! The dissertation closes with this question.

use core::ops::RangeInclusive;

use quell_numerics::roots::{Closeness, minimise, quadratic};

use super::meetings::MeetingFamily;
use super::pair::DetuningBand;
use super::tongue::{Resonance, Tongue};
use super::wave::Wave;
use super::waves::{Order, Waves};
use quell_model::disc::DiscDither;

/// Dither frequencies that keep a range of speeds clear, and what blocks the others.
#[derive(Debug, Clone, PartialEq)]
pub struct Clearance {
    /// Intervals [from, to] of R without an induced tongue in the range of speeds, ascending.
    pub clear: Vec<[f64; 2]>,
    /// What blocks the rest, ascending; they may overlap.
    pub blocked: Vec<Blocked>,
    /// Whether the dither takes away the undithered tongues (at first order): tangential does, normal does not.
    pub original_suppressed: bool,
}

/// Dither frequencies at which a pair of waves grows somewhere in the range of speeds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Blocked {
    /// Lowest frequency R.
    pub from: f64,
    /// Highest frequency R.
    pub to: f64,
    /// The pair.
    pub waves: [Wave; 2],
    /// Whether the second wave takes part with its conjugate.
    pub sum: bool,
}

/// Why there is no answer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ClearanceError {
    /// There is no dither whose frequency could be chosen.
    NoDither,
    /// A range is empty, not finite, or the frequencies are not positive.
    Range,
    /// This wave grows by itself in the range of speeds: no frequency clears it.
    WaveUnstable {
        /// The wave.
        wave: Wave,
        /// A speed at which it is undamped or grows.
        speed: f64,
    },
}

impl core::fmt::Display for ClearanceError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::NoDither => f.write_str("there is no dither whose frequency could be chosen"),
            Self::Range => f.write_str(
                "a range must go from a smaller to a larger number, frequencies from above 0",
            ),
            Self::WaveUnstable { wave, speed } => {
                write!(
                    f,
                    "the {wave} wave is not damped by itself at speed {speed}: no dither frequency clears it"
                )
            }
        }
    }
}

impl core::error::Error for ClearanceError {}

/// A resonance in or beside a range of speeds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearby {
    /// The resonance.
    pub resonance: Resonance,
    /// Whether its tongue reaches into the range.
    pub reaches_in: bool,
}

/// Samples of the band's edges over an interval of speeds before an extreme is refined: the edges are smooth, and
/// have at most a few turns over all speeds.
const SAMPLES: usize = 64;

/// Frequencies R in `frequencies` for which no tongue induced by the dither of `waves` reaches into `speeds`.
///
/// The frequency in `waves` itself does not matter.
///
/// # Errors
/// [`ClearanceError`] where no frequency can be chosen, a range is none, or a wave grows by itself.
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
    // Damping is linear in the speed: the ends decide.
    for wave in waves.waves().iter().filter(|wave| waves.coupling_squared(wave.mode) > 0.0) {
        for speed in [*speeds.start(), *speeds.end()] {
            if waves.growth_rate(wave, speed) >= 0.0 {
                return Err(ClearanceError::WaveUnstable { wave: *wave, speed });
            }
        }
    }
    let mut blocked = Vec::new();
    for family in waves.families(1) {
        for part in grown_speeds(&waves, &family, &speeds) {
            let [from, to] = swept(&waves, &family, part);
            if to >= *frequencies.start() && from <= *frequencies.end() {
                blocked.push(Blocked { from, to, waves: family.waves, sum: family.conjugate });
            }
        }
    }
    blocked.sort_by(|a, b| a.from.total_cmp(&b.from));
    let mut clear = Vec::new();
    let mut reached = *frequencies.start();
    for block in &blocked {
        if block.from > reached {
            clear.push([reached, block.from]);
        }
        reached = reached.max(block.to);
    }
    // One frequency alone is an interval, too.
    let alone = frequencies.start() == frequencies.end() && blocked.is_empty();
    if reached < *frequencies.end() || alone {
        clear.push([reached, *frequencies.end()]);
    }
    Ok(Clearance { clear, blocked, original_suppressed })
}

/// What lies in a range of speeds at the dither frequency of `waves`: every induced resonance whose place or tongue is in it, and,
/// under tangential dither, the undithered ones as revived at second order.
#[must_use]
pub fn within(waves: &Waves, speeds: RangeInclusive<f64>) -> Vec<Nearby> {
    let (start, end) = (*speeds.start(), *speeds.end());
    let first = waves.clone().with_order(Order::First);
    let mut found = Vec::new();
    if let Some(frequency) = first.dither_frequency() {
        for family in first.families(1).iter().filter(|family| family.slope != 0.0) {
            let speed = (family.offset + f64::from(family.h) * frequency) / family.slope;
            let inside = speeds.contains(&speed);
            let mut reaches_in = reaches(&first, family, &speeds, frequency);
            if reaches_in || inside {
                let resonance = first.resonance(&Waves::meeting_of(family, speed));
                // A wave that grows alone has no band: it grows wherever it is.
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
    // Undithered tongues are narrow beside their distance from Ω = 0 … 1; half a unit of speed reaches every one.
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
    found.sort_by(|a, b| a.resonance.speed.total_cmp(&b.resonance.speed));
    found
}

/// Parts of the range of speeds at which the pair grows for some frequency: p > η₁η₂.
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
    // The quadratic e₀ + e₁x + e₂x², x = (Ω − middle)/half, through three of its values.
    let (low, centre, high) = (excess(start), excess(middle), excess(end));
    let (slope, bend) = (0.5 * (high - low), 0.5 * (high + low) - centre);
    let mut cuts = vec![-1.0];
    if let Some(mut roots) = quadratic(centre, slope, bend) {
        roots.sort_by(f64::total_cmp);
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
        // An end of the interval of speeds, where the band closes to a point.
        DetuningBand::Nowhere | DetuningBand::Outside => (centre, centre),
    };
    let h = f64::from(family.h);
    let (one, other) = ((apart - from) / h, (apart - to) / h);
    [one.min(other), one.max(other)]
}

/// Least value of a smooth function over an interval of speeds.
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
