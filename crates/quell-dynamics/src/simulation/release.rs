//! The release under a single sine: a straight line plus a sine, solved without a series.
//!
//! With one harmonic dither, tangential or normal, both margins ±f_s − μ_s N of a stick are
//!
//! ```text
//! g(t) = a + w t + S sin ψ,   ψ = ψ₀ + R t,   S > 0,   w = ±ν
//! ```
//!
//! The contact releases where g first rises through zero. g rises where cos ψ > −κ, κ = w/(SR): nowhere for κ ≤ −1, everywhere
//! for κ ≥ 1, otherwise on the arcs |ψ| < h, cos h = −κ, one per revolution; it is largest at their crests ψ = h. The heights of
//! the crests are equally spaced, so that the first one above zero is found directly, however distant. The only root on its arc
//! is that of
//!
//! ```text
//! κψ + sin ψ = −α,    g = S (α + κψ + sin ψ),
//! ```
//!
//! odd in ψ and concave for ψ > 0: Newton's method from below always converges to it, and with the curvature (Halley)
//! in two or three iterations. No root can be missed: there is no step, no series and no tolerance.
//!
//! Accuracy: some units in the last place of ψ, so that a release is known to 10⁻¹⁵/R unless its crest grazes zero.

use std::f64::consts::{PI, TAU};

use quell_numerics::elementary::{reduced_phase, sin_cos_of_phase};

use super::clock::Clock;
use super::forcing::{Forcing, ForcingShape};
use super::stick::{StickSearch, Stiction};

/// Most iterations of a root search. Three are usual; near grazing they double the digits at worst.
const MAX_ITERATIONS: u32 = 80;

/// The constants of a run that every stick shares.
#[derive(Clone, Copy, Debug)]
pub(super) struct Release {
    rate: f64,
    phase: f64,
    /// +f_s and −f_s.
    margins: [StickMargin; 2],
    /// μ_s F.
    limit: f64,
}

/// One of the two margins.
#[derive(Clone, Copy, Debug)]
struct StickMargin {
    /// w.
    slope: f64,
    /// S.
    amplitude: f64,
    /// Whether ψ is half a revolution behind the dither's phase.
    behind: bool,
    /// κ.
    steepness: f64,
    /// h and its sine; `None` where |κ| ≥ 1.
    crest: Option<(f64, f64)>,
}

/// A release: its time, its rate, and whether the threshold was already exceeded at the start.
type ReleaseFound = (f64, f64, bool);

impl StickMargin {
    fn new(slope: f64, amplitude: f64, rate: f64, behind: bool) -> Self {
        let steepness = slope / (amplitude * rate);
        let crest = (steepness.abs() < 1.0).then(|| {
            let sine = ((1.0 - steepness) * (1.0 + steepness)).sqrt();
            (libm::acos(-steepness), sine)
        });
        Self { slope, amplitude, behind, steepness, crest }
    }

    /// The first release within `room`, from the margin's constant part a and the dither's phase.
    #[inline(always)]
    fn first(&self, a: f64, phase: f64, rate: f64, room: f64) -> Option<ReleaseFound> {
        let start = match (self.behind, phase > 0.0) {
            (false, _) => phase,
            (true, true) => phase - PI,
            (true, false) => phase + PI,
        };
        let (sine, cosine) = sin_cos_of_phase(1.0, start, 0.0, 0.0);
        let now = self.amplitude.mul_add(sine, a);
        let rising = (self.amplitude * rate).mul_add(cosine, self.slope);
        if now > 0.0 || (now == 0.0 && rising >= 0.0) {
            return Some((0.0, rising, now > 0.0));
        }
        let Some((crest, crest_sine)) = self.crest else {
            return if self.slope > 0.0 { self.monotonic(a, start, rate, room) } else { None };
        };
        // The crest ahead, and by how much each following one is higher.
        let ahead = if start < crest { crest - start } else { (crest - start) + TAU };
        let revolution = TAU / rate;
        let height = self.amplitude.mul_add(crest_sine, self.slope.mul_add(ahead / rate, a));
        let gain = self.slope * revolution;
        let revolutions = if height >= 0.0 {
            0.0
        } else if gain > 0.0 {
            (-height / gain).ceil()
        } else {
            return None;
        };
        // ψ = 0 of that arc, in time.
        let middle = revolutions.mul_add(revolution, (ahead - crest) / rate);
        if middle - crest / rate > room {
            return None;
        }
        let alpha = self.slope.mul_add(middle, a) / self.amplitude;
        let root = self.on_arc(alpha.abs(), crest, crest_sine).copysign(-alpha);
        let after = revolutions.mul_add(revolution, ((ahead - crest) + root) / rate).max(0.0);
        let (_, cosine) = sin_cos_of_phase(1.0, root, 0.0, 0.0);
        let rate = (self.amplitude * rate).mul_add(cosine, self.slope);
        (after <= room).then_some((after, rate, false))
    }

    /// ψ in [0, h] with κψ + sin ψ = s; h where s exceeds the value there (grazing, to rounding).
    #[inline(always)]
    fn on_arc(&self, s: f64, crest: f64, crest_sine: f64) -> f64 {
        let kappa = self.steepness;
        let height = kappa.mul_add(crest, crest_sine);
        if s >= height {
            return crest;
        }
        // A lower bound of the root; and the parabola through the crest, which is accurate near it.
        let least = s / (1.0 + kappa);
        let parabola = crest - (2.0 * (height - s) / crest_sine).sqrt();
        let (mut low, mut high) = (least.min(crest), crest);
        let mut psi = if parabola > low { parabola } else { low };
        for _ in 0..MAX_ITERATIONS {
            let (sine, cosine) = sin_cos_of_phase(1.0, psi, 0.0, 0.0);
            let value = kappa.mul_add(psi, sine - s);
            let slope = kappa + cosine;
            if value > 0.0 {
                high = psi;
            } else {
                low = psi;
            }
            let newton = value / slope;
            // Halley's step: the curvature is −sin ψ.
            let bent = 0.5 * newton * sine / slope;
            let step = newton / (1.0 + bent);
            let next = psi - step;
            if !(next > low && next < high) {
                let other = psi - newton;
                let next = if other > low && other < high { other } else { 0.5 * (low + high) };
                if next == psi || high - low <= f64::EPSILON * high {
                    return psi;
                }
                psi = next;
                continue;
            }
            psi = next;
            // The next step would be smaller than this one by about the same factor again.
            if step.abs() * (step * step + bent * bent) <= 1e-17 {
                return psi;
            }
        }
        psi
    }

    /// The root of a margin that rises everywhere.
    #[inline(always)]
    fn monotonic(&self, a: f64, start: f64, rate: f64, room: f64) -> Option<ReleaseFound> {
        // a + S sin ψ₀ < 0; at `high` the line alone is above S.
        let (mut low, mut high) = (0.0, (self.amplitude - a) / self.slope);
        let mut after = -self.amplitude.mul_add(start / PI, a).min(0.0) / self.slope;
        let mut rising = self.slope;
        for _ in 0..MAX_ITERATIONS {
            let (sine, cosine) = sin_cos_of_phase(rate, after, 0.0, start);
            let value = self.amplitude.mul_add(sine, self.slope.mul_add(after, a));
            rising = (self.amplitude * rate).mul_add(cosine, self.slope);
            if value > 0.0 {
                high = after;
            } else {
                low = after;
            }
            let next = after - value / rising;
            let inside = next > low && next < high;
            let last = inside && (next - after).abs() <= 1e-9 * next;
            let middle = 0.5 * (low + high);
            let narrow = high - low <= f64::EPSILON * high;
            after = if inside { next } else { middle };
            if last || narrow {
                break;
            }
        }
        (after <= room).then_some((after, rising, false))
    }
}

impl Release {
    /// For a run whose dither is a single sine in one direction; `None` for any other.
    pub(super) fn of(
        stiction: &Stiction,
        (tangential, normal): (&Forcing, &Forcing),
        shapes: (ForcingShape, ForcingShape),
    ) -> Option<Self> {
        let forward = stiction.belt_velocity;
        let (wave, margins) = match shapes {
            (ForcingShape::Harmonic, ForcingShape::Constant) => {
                let (rate, _, table) = tangential.wave();
                let margin = |slope, behind| StickMargin::new(slope, table[0], rate, behind);
                (tangential, [margin(forward, true), margin(-forward, false)])
            }
            (ForcingShape::Constant, ForcingShape::Harmonic) => {
                let (rate, _, table) = normal.wave();
                let amplitude = stiction.static_coefficient * table[0];
                let margin = |slope| StickMargin::new(slope, amplitude, rate, true);
                (normal, [margin(forward), margin(-forward)])
            }
            _ => return None,
        };
        let (rate, phase, _) = wave.wave();
        let is_valid =
            |margin: &StickMargin| margin.amplitude > 0.0 && margin.steepness.is_finite();
        let limit = stiction.static_coefficient * normal.mean();
        margins.iter().all(is_valid).then_some(Self { rate, phase, margins, limit })
    }

    /// The first release within `room`.
    #[inline(always)]
    pub(super) fn search(
        &self,
        stiction: &Stiction,
        clock: Clock,
        y: f64,
        room: f64,
    ) -> StickSearch {
        let phase = reduced_phase(self.rate, clock.time(), clock.low(), self.phase);
        let force = stiction.force(y, 0.0);
        let [up, down] = &self.margins;
        let up = up.first(force - self.limit, phase, self.rate, room);
        // After a release at the upper threshold the lower one does not matter.
        let until = up.map_or(room, |(after, ..)| after);
        let down = down.first(-force - self.limit, phase, self.rate, until);
        let (sign, (after, rate, at_once)) = match (up, down) {
            (None, None) => return StickSearch::Holds(room),
            (Some(up), Some(down)) if up.0 <= down.0 => (1.0, up),
            (_, Some(down)) => (-1.0, down),
            (Some(up), None) => (1.0, up),
        };
        StickSearch::Releases { after, sign, rate, at_once }
    }
}

#[cfg(test)]
mod tests {
    use quell_model::{Direction, Dither, Waveform};

    use super::*;

    fn random(state: &mut u64) -> f64 {
        *state ^= *state << 13;
        *state ^= *state >> 7;
        *state ^= *state << 17;
        (*state >> 11) as f64 / (1u64 << 53) as f64
    }

    /// |f_s| − μ_s N, from the waveform itself.
    fn margins(stiction: &Stiction, y: f64, mean: f64, dither: &Dither, time: f64) -> [f64; 2] {
        let wave = dither.amplitude * libm::sin(dither.frequency_ratio * time + dither.phase);
        let (push, load) = match dither.direction {
            Direction::Tangential => (wave, mean),
            Direction::Normal => (0.0, mean + wave),
        };
        let force = stiction.force(y + stiction.belt_velocity * time, push);
        [force, -force].map(|force| force - stiction.static_coefficient * load)
    }

    #[test]
    fn the_release_is_the_first_one_of_a_dense_scan() {
        let mut state = 0x9e37_79b9_7f4a_7c15;
        let mut counts = [0; 4];
        for round in 0..3000 {
            let mut draw = |low: f64, high: f64| low + (high - low) * random(&mut state);
            let normal = round % 3 == 0;
            let stiction = Stiction {
                damper: draw(0.0, 0.01),
                belt_velocity: draw(0.01, 0.4) * if round % 5 == 0 { 10.0 } else { 1.0 },
                static_coefficient: 0.4,
            };
            let dither = Dither {
                direction: if normal { Direction::Normal } else { Direction::Tangential },
                waveform: Waveform::Sine,
                amplitude: draw(0.01, 0.9),
                frequency_ratio: draw(1.5, 20.0),
                phase: draw(-4.0, 4.0),
                envelope: None,
            };
            let clock = Clock::at(0.0);
            let make = |direction, mean| {
                Forcing::new(std::slice::from_ref(&dither), direction, mean, 1.0, clock)
            };
            let (tangential, load) =
                (make(Direction::Tangential, 0.0), make(Direction::Normal, 1.0));
            let shapes = [Direction::Tangential, Direction::Normal]
                .map(|direction| ForcingShape::of(std::slice::from_ref(&dither), direction));
            let release = Release::of(&stiction, (&tangential, &load), (shapes[0], shapes[1]))
                .expect("one sine");
            let y = draw(-0.5, 0.4);
            let room = draw(0.5, 12.0);
            let at = |time: f64| {
                let [up, down] = margins(&stiction, y, 1.0, &dither, time);
                up.max(down)
            };
            let steps = 20_000;
            let scan = (0..=steps).map(|i| room * f64::from(i) / f64::from(steps));
            let seen = scan.into_iter().find(|&time| at(time) > 0.0);
            let step = room / f64::from(steps);
            match release.search(&stiction, clock, y, room) {
                StickSearch::Holds(length) => {
                    assert_eq!(length, room);
                    assert_eq!(seen, None, "round {round}: a release was missed");
                    counts[0] += 1;
                }
                StickSearch::Releases { after, sign, rate, at_once } => {
                    let [up, down] = margins(&stiction, y, 1.0, &dither, after);
                    let margin = if sign > 0.0 { up } else { down };
                    if at_once {
                        assert!(after == 0.0 && margin > 0.0);
                        counts[1] += 1;
                        continue;
                    }
                    assert!(margin.abs() < 2e-14, "round {round}: {margin:e} at {after}");
                    if let Some(seen) = seen {
                        assert!(after <= seen && after >= seen - 1.01 * step, "{after} {seen}");
                    } else {
                        // Between two samples, or with the last one.
                        assert!(at(after + 0.5 * step) < 1e-3);
                    }
                    let h = 1e-6;
                    let later = margins(&stiction, y, 1.0, &dither, after + h);
                    let earlier = margins(&stiction, y, 1.0, &dither, after - h);
                    let side = usize::from(sign < 0.0);
                    let slope = (later[side] - earlier[side]) / (2.0 * h);
                    assert!((slope - rate).abs() < 1e-6 * (1.0 + rate.abs()), "{slope} {rate}");
                    counts[if sign > 0.0 { 2 } else { 3 }] += 1;
                }
            }
        }
        assert!(counts.iter().all(|&count| count > 100), "{counts:?}");
    }

    #[test]
    fn a_crest_that_just_reaches_zero_is_found_and_one_below_is_not() {
        // κψ + sin ψ at the crest, slightly raised and lowered.
        let margin = StickMargin::new(-0.05, 0.4, 10.0, false);
        let (crest, sine) = margin.crest.expect("arcs");
        let start = -1.0;
        let height = 0.4 * sine - 0.05 * (crest - start) / 10.0;
        for lift in [1e-4, 1e-8, 1e-12] {
            let (after, rate, _) =
                margin.first(-height + lift, start, 10.0, 50.0).expect("a release");
            let at_crest = (crest - start) / 10.0;
            assert!(after <= at_crest && at_crest - after < 2.0 * (lift / 15.0).sqrt(), "{lift}");
            assert!(rate >= 0.0);
            assert!(margin.first(-height - lift, start, 10.0, 50.0).is_none());
        }
    }
}
