//! Least and largest displacement and velocity of a run.
//!
//! Extremes are at the ends of segments, or inside them where the derivative vanishes: x′ = v₀ − v_r for the
//! displacement, x″ = −v_r′ for the velocity. The roots of both are those of the segment's own Taylor polynomial, isolated in the
//! same way as events. None is missed, and the values are those of the trajectory, not of a grid of samples.

use quell_numerics::dispatch::{Work, with_fused_multiply_add};

use super::observer::{Observer, Segment, each_crossing};
use super::taylor::ORDER;

/// Least and largest displacement x and velocity x′ of a run, each as (least, largest).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremes {
    /// Of the displacement x.
    pub displacement: (f64, f64),
    /// Of the velocity x′.
    pub velocity: (f64, f64),
}

impl Default for Extremes {
    fn default() -> Self {
        let nothing = (f64::INFINITY, f64::NEG_INFINITY);
        Self { displacement: nothing, velocity: nothing }
    }
}

impl Extremes {
    fn take(&mut self, segment: &Segment<'_>, since: f64) {
        let widen = |range: &mut (f64, f64), value: f64| {
            *range = (range.0.min(value), range.1.max(value));
        };
        widen(&mut self.displacement, segment.displacement(since));
        widen(&mut self.velocity, segment.velocity(since));
    }
}

impl Observer for Extremes {
    fn segment(&mut self, segment: &Segment<'_>) {
        self.take(segment, 0.0);
        self.take(segment, segment.duration());
        with_fused_multiply_add(ExtremeSearch { extremes: self, segment });
    }
}

/// The search for extremes inside one segment.
struct ExtremeSearch<'a, 'b> {
    extremes: &'a mut Extremes,
    segment: &'a Segment<'b>,
}

impl Work for ExtremeSearch<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { extremes, segment } = self;
        let velocity = segment.negative_velocity();
        let mut acceleration = [0.0; ORDER + 1];
        for (k, coefficient) in velocity.iter().enumerate().skip(1) {
            acceleration[k - 1] = k as f64 * coefficient;
        }
        for mut series in [velocity, acceleration] {
            each_crossing(&mut series, segment.duration, |since, _| extremes.take(segment, since));
        }
    }
}

#[cfg(test)]
mod tests {
    use quell_model::{Belt, LawKind};

    use super::*;
    use crate::simulation::{DEFAULT_TOLERANCE, Start, simulate};

    #[test]
    fn a_free_oscillator_reaches_its_amplitude() {
        // Without friction x = cos τ: from an extreme of x to beyond every other one.
        let law = LawKind::Stribeck.build(&[0.0, 0.0, 1.0]).expect("valid");
        let belt = Belt::new(0.0, 1.0, 10.0, law, Vec::new()).expect("valid");
        let start = Start { time: 0.0, displacement: 1.0, velocity: 0.0 };
        let mut extremes = Extremes::default();
        simulate(&belt, start, 7.0, DEFAULT_TOLERANCE, &mut extremes).expect("runs");
        for (low, high) in [extremes.displacement, extremes.velocity] {
            assert!((low + 1.0).abs() < 1e-11 && (high - 1.0).abs() < 1e-11, "{low} {high}");
        }
        // Over a part of the period the ends count, and the extremes between them.
        let mut extremes = Extremes::default();
        simulate(&belt, start, 2.0, DEFAULT_TOLERANCE, &mut extremes).expect("runs");
        assert!((extremes.displacement.0 - 2.0_f64.cos()).abs() < 1e-11);
        assert!((extremes.velocity.0 + 1.0).abs() < 1e-11 && extremes.velocity.1.abs() < 1e-11);
    }
}
