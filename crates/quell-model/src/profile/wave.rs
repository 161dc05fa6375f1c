//! One wave of a profile.

use quell_numerics::interval::RealInterval;

use super::Knots;
use crate::waveform::Waveform;

/// One wave: A e(t) g(ωt + φ), with an envelope e if it has one.
#[derive(Clone, Debug, PartialEq)]
pub struct Wave {
    /// Waveform g.
    pub waveform: Waveform,
    /// Peak amplitude A.
    pub amplitude: f64,
    /// Angular frequency ω > 0, per unit of time; of noise that of the middle of its band.
    pub frequency: f64,
    /// Phase φ at t = 0, radians.
    pub phase: f64,
    /// Share e of the amplitude over time; `None` for the whole amplitude at all times.
    pub envelope: Option<Knots>,
}

impl Wave {
    /// Angular frequency at which the wave repeats itself: ω, of a burst ω over its cycles of the carrier.
    pub fn repetition(&self) -> f64 {
        self.frequency / f64::from(self.waveform.cycles())
    }

    /// The highest angular frequency of the wave: ω, of a sum of harmonics or lines that of the highest one.
    pub fn highest(&self) -> f64 {
        self.frequency * self.waveform.highest_multiple()
    }

    /// The lowest angular frequency of the wave: that at which it repeats itself, of noise the lower end of its band.
    pub fn lowest(&self) -> f64 {
        let band = self.waveform.noise().map(|noise| noise.band(self.frequency));
        band.map_or_else(|| self.repetition(), |[low, _]| low)
    }

    /// Bounds of the wave at all times: its waveform may fall further than it rises.
    pub fn range(&self) -> RealInterval {
        let share = self.envelope.as_ref().map_or(RealInterval::point(1.0), Knots::range);
        let shape = self.waveform.range();
        [share.lower, share.upper]
            .map(|share| {
                let size = share * self.amplitude;
                let ends = [size * shape.lower, size * shape.upper];
                RealInterval::new(ends[0].min(ends[1]), ends[0].max(ends[1]))
            })
            .into_iter()
            .reduce(RealInterval::hull)
            .unwrap_or_default()
    }

    /// Share of the amplitude at the time t.
    pub fn share(&self, time: f64) -> f64 {
        self.envelope.as_ref().map_or(1.0, |knots| knots.value(time))
    }

    /// The wave with the amplitude of a time, and no envelope.
    #[must_use]
    pub fn steady_at(&self, time: f64) -> Self {
        Self { amplitude: self.share(time) * self.amplitude, envelope: None, ..self.clone() }
    }

    /// A e(t) g(ωt + φ) at the time t.
    pub fn value(&self, time: f64) -> f64 {
        let phase = f64::mul_add(self.frequency, time, self.phase);
        self.share(time) * self.amplitude * self.waveform.value(phase)
    }
}
