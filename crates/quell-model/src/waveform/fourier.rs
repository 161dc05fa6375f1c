//! A sum of harmonics: g = Σ (s_n sin nθ + c_n cos nθ).

use std::f64::consts::TAU;

use quell_numerics::interval::RealInterval;

use super::WaveformError;

/// Most harmonics of a sum, and the highest order: every harmonic is a wave of its own in each step of a run.
pub(super) const MOST_HARMONICS: usize = 1000;

/// One harmonic: s sin nθ + c cos nθ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Harmonic {
    /// Order n ≥ 1.
    pub order: u32,
    /// Coefficient s of the sine.
    pub sine: f64,
    /// Coefficient c of the cosine.
    pub cosine: f64,
}

impl Harmonic {
    /// Amplitude √(s² + c²).
    pub fn amplitude(&self) -> f64 {
        libm::hypot(self.sine, self.cosine)
    }

    /// Phase φ of a sin(nθ + φ), radians.
    pub fn phase(&self) -> f64 {
        libm::atan2(self.cosine, self.sine)
    }
}

/// A waveform as a sum of harmonics, each order once.
#[derive(Clone, Debug, PartialEq)]
pub struct FourierWave {
    harmonics: Vec<Harmonic>,
    range: RealInterval,
    integral_range: RealInterval,
}

impl FourierWave {
    /// The sum of these harmonics.
    ///
    /// # Errors
    /// No harmonic, an order of 0 or that occurs twice, a coefficient that is not finite, or coefficients that are all zero.
    pub fn new(mut known: Vec<Harmonic>) -> Result<Self, WaveformError> {
        let wrong = |allowed: String| Err(WaveformError { key: "harmonics", allowed });
        known.sort_by_key(|harmonic| harmonic.order);
        if known.is_empty() || known.len() > MOST_HARMONICS {
            return wrong(format!(
                "1 to {MOST_HARMONICS} harmonics, such as {{ order = 1, sine = 1.0 }}"
            ));
        }
        for (place, harmonic) in known.iter().enumerate() {
            let order = harmonic.order;
            if order == 0 || order as usize > MOST_HARMONICS {
                return wrong(format!("of an order from 1 to {MOST_HARMONICS}; got {order}"));
            }
            if place > 0 && known[place - 1].order == order {
                return wrong(format!("of different orders; {order} occurs twice"));
            }
            if !(harmonic.sine.is_finite() && harmonic.cosine.is_finite()) {
                return wrong(format!("of finite coefficients; those of order {order} are not"));
            }
        }
        known.retain(|harmonic| harmonic.sine != 0.0 || harmonic.cosine != 0.0);
        if known.is_empty() {
            return wrong("of coefficients that are not all zero".to_owned());
        }
        let none = RealInterval::point(0.0);
        let mut wave = Self { harmonics: known, range: none, integral_range: none };
        wave.range = wave.extremes(|wave, at| (wave.value(at), wave.slope(at), wave.curvature(at)));
        wave.integral_range =
            wave.extremes(|wave, at| (wave.integral(at), wave.value(at), wave.slope(at)));
        Ok(wave)
    }

    /// The harmonics in ascending order, those of zero amplitude left out.
    pub fn harmonics(&self) -> &[Harmonic] {
        &self.harmonics
    }

    /// −g.
    pub(super) fn negated(&self) -> Self {
        let negated = |h: &Harmonic| Harmonic { order: h.order, sine: -h.sine, cosine: -h.cosine };
        Self {
            harmonics: self.harmonics.iter().map(negated).collect(),
            range: -self.range,
            integral_range: -self.integral_range,
        }
    }

    /// Sum over the harmonics of a function of order, sine and cosine of nθ, and the coefficients.
    fn sum(&self, phase: f64, term: impl Fn(f64, (f64, f64), &Harmonic) -> f64) -> f64 {
        let phase = phase.rem_euclid(TAU);
        let each = self.harmonics.iter().map(|harmonic| {
            let order = f64::from(harmonic.order);
            let (sine, cosine) = (libm::sin(order * phase), libm::cos(order * phase));
            term(order, (sine, cosine), harmonic)
        });
        each.sum()
    }

    pub(super) fn value(&self, phase: f64) -> f64 {
        self.sum(phase, |_, (sine, cosine), h| h.sine * sine + h.cosine * cosine)
    }

    pub(super) fn slope(&self, phase: f64) -> f64 {
        self.sum(phase, |n, (sine, cosine), h| n * (h.sine * cosine - h.cosine * sine))
    }

    fn curvature(&self, phase: f64) -> f64 {
        self.sum(phase, |n, (sine, cosine), h| -n * n * (h.sine * sine + h.cosine * cosine))
    }

    pub(super) fn integral(&self, phase: f64) -> f64 {
        self.sum(phase, |n, (sine, cosine), h| (h.cosine * sine - h.sine * cosine) / n)
    }

    pub(super) fn range(&self) -> RealInterval {
        self.range
    }

    pub(super) fn integral_range(&self) -> RealInterval {
        self.integral_range
    }

    pub(super) fn root_mean_square(&self) -> f64 {
        let squares = self.harmonics.iter().map(|h| h.sine * h.sine + h.cosine * h.cosine);
        (0.5 * squares.sum::<f64>()).sqrt()
    }

    pub(super) fn mean_square_integral(&self) -> f64 {
        let squares = self.harmonics.iter().map(|h| {
            let order = f64::from(h.order);
            (h.sine * h.sine + h.cosine * h.cosine) / (order * order)
        });
        0.5 * squares.sum::<f64>()
    }

    /// Least and largest value of a function of the phase that is given with its first two derivatives: the extremes of a fine
    /// grid, improved by Newton's method.
    fn extremes(&self, function: impl Fn(&Self, f64) -> (f64, f64, f64)) -> RealInterval {
        const POINTS: u32 = 32;
        const STEPS: u32 = 30;
        let highest = self.harmonics.last().map_or(1, |harmonic| harmonic.order);
        let count = POINTS * highest;
        let step = TAU / f64::from(count);
        let grid: Vec<f64> = (0..count).map(|k| function(self, step * f64::from(k)).0).collect();
        let best = |sign: f64| {
            let place = |k: usize| sign * grid[k % grid.len()];
            let mut best = f64::NEG_INFINITY;
            for k in 0..grid.len() {
                if place(k) < place(k + 1) || place(k) < place(k + grid.len() - 1) {
                    continue;
                }
                let mut at = step * k as f64;
                let (from, to) = (at - step, at + step);
                best = best.max(place(k));
                for _ in 0..STEPS {
                    let (value, slope, curvature) = function(self, at);
                    best = best.max(sign * value);
                    let next = at - slope / curvature;
                    if !(from..=to).contains(&next) || (next - at).abs() < 1e-15 {
                        break;
                    }
                    at = next;
                }
            }
            sign * best
        };
        RealInterval::new(best(-1.0), best(1.0))
    }
}
