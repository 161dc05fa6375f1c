//! Dither forces along a run: local Taylor coefficients, exact values, breaks as time events.
//!
//! A harmonic piece D sin(Rτ + φ) has the coefficients D Rᵏ/k! · {s, c, −s, −c}: a table
//! times one sine and cosine per step. Triangle and square are straight between their breaks.
//! Break number n is at (θᵢ + 2πc − φ)/R with n = c·(breaks per period) + i, computed
//! from the integer each time, so that breaks do not drift. A sum of harmonics or of lines enters as its sines; samples are straight between
//! their breaks, and a burst is harmonic or straight by pieces. Knots of drives, loads and envelopes are breaks too; between them a
//! cubic is added to the dithers, or multiplies one.

use quell_model::profile::{KnotPiece, Knots, Profile};
use quell_model::waveform::Piece;
use quell_model::{Belt, Direction, Dither, Waveform};
use quell_numerics::elementary::sin_cos_of_phase;
use quell_numerics::interval::RealInterval;
use quell_numerics::lane::Lane;

use super::clock::{Clock, until};
use super::taylor::{ORDER, Series};

/// The structure of a forcing's series, which lanes side by side must share.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum ForcingShape {
    /// No dither.
    Constant,
    /// One dither, a pure sine.
    Harmonic,
    /// One dither, straight between its breaks.
    Straight,
    /// Anything else.
    Several,
}

/// Shapes of the tangential and of the normal forcing.
pub(super) type ForcingShapes = (ForcingShape, ForcingShape);

impl ForcingShape {
    /// Shape of the dithers of one direction.
    pub(super) fn of(dithers: &[Dither], direction: Direction) -> Self {
        let mut acting = dithers.iter().filter(|dither| acts(dither, direction));
        let (Some(only), None) = (acting.next(), acting.next()) else {
            let none = !dithers.iter().any(|dither| acts(dither, direction));
            return if none { Self::Constant } else { Self::Several };
        };
        if only.waveform.is_sum_of_sines() {
            Self::Several
        } else if only.waveform.breaks().is_empty() {
            Self::Harmonic
        } else if only.waveform.pieces().iter().any(|piece| matches!(piece, Piece::Harmonic)) {
            Self::Several
        } else {
            Self::Straight
        }
    }
}

/// Whether a dither acts in a direction.
fn acts(dither: &Dither, direction: Direction) -> bool {
    dither.direction == direction && dither.amplitude != 0.0
}

/// All dithers of one direction, in units of the law's velocity scale.
#[derive(Clone, Debug)]
pub(crate) struct Forcing {
    components: Vec<Component>,
    /// Constant part: the steady load for the normal direction, else 0.
    mean: f64,
    /// Courses given at knots, each at its current piece.
    courses: Vec<KnotTrack>,
    /// Σ|D|, a bound of the dither part.
    amplitude: f64,
    next_break: f64,
}

/// A straight piece of a dither, in one lane or in many.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct StraightPiece<V = f64> {
    /// Its start.
    pub(super) began: V,
    /// Value at its start.
    pub(super) value: V,
    /// Change per unit of time.
    pub(super) slope: V,
}

impl<V: Lane> StraightPiece<V> {
    /// Value at the moment `time` + `low`.
    #[inline(always)]
    pub(super) fn at(&self, time: V, low: V) -> V {
        self.slope.mul_add(-until(time, low, self.began), self.value)
    }
}

/// Knots along a run, at the current piece.
#[derive(Clone, Debug)]
struct KnotTrack {
    knots: Knots,
    /// Number of the current piece.
    number: usize,
    piece: KnotPiece,
}

impl KnotTrack {
    fn new(knots: &Knots, clock: Clock) -> Self {
        let number = knots.piece_at(clock.time());
        Self { knots: knots.clone(), number, piece: knots.piece(number) }
    }

    fn pass_breaks(&mut self, clock: Clock) {
        while clock.until(self.piece.ends) <= 0.0 {
            self.number += 1;
            self.piece = self.knots.piece(self.number);
        }
    }

    /// Time since the start of the piece; 0 before the first knot.
    #[inline(always)]
    fn since(&self, clock: Clock) -> f64 {
        if self.number == 0 { 0.0 } else { -clock.until(self.piece.began) }
    }

    #[inline(always)]
    fn value(&self, clock: Clock) -> f64 {
        self.piece.value(self.since(clock))
    }

    #[inline(always)]
    fn series(&self, clock: Clock) -> [f64; 4] {
        self.piece.shifted(self.since(clock))
    }
}

#[derive(Clone, Debug)]
struct Component {
    rate: f64,
    phase: f64,
    waveform: Waveform,
    /// Period of the waveform, radians.
    period: f64,
    /// D Rᵏ/k!.
    table: Series,
    /// Share of the amplitude over time.
    envelope: Option<KnotTrack>,
    /// Number of the break that ends the current piece; meaningless without breaks.
    ending: i64,
    /// Start and end of the current piece.
    began: f64,
    ends: f64,
}

impl Forcing {
    /// Dithers of `direction` divided by `unit`, set to the moment `clock`.
    pub(super) fn new(
        dithers: &[Dither],
        direction: Direction,
        mean: f64,
        unit: f64,
        clock: Clock,
    ) -> Self {
        let components: Vec<_> = dithers
            .iter()
            .filter(|dither| acts(dither, direction))
            .flat_map(Dither::by_harmonics)
            .map(|dither| Component::new(&dither, unit, clock))
            .collect();
        let bound = |component: &Component| {
            let share = component.envelope.as_ref().map_or(1.0, |course| largest(&course.knots));
            share * component.table[0].abs() * component.waveform.peak()
        };
        let mut forcing = Self {
            mean,
            courses: Vec::new(),
            amplitude: components.iter().map(bound).sum(),
            next_break: f64::INFINITY,
            components,
        };
        forcing.pass_breaks(clock);
        forcing
    }

    /// The tangential dithers of a belt and its normal load, in units of `unit`, at the moment `clock`.
    #[inline(always)]
    pub(crate) fn acting(belt: &Belt, unit: f64, clock: Clock) -> (Self, Self) {
        let load = belt.normal_load() / unit;
        let forcing = |direction, mean| Self::new(belt.dithers(), direction, mean, unit, clock);
        (forcing(Direction::Tangential, 0.0), forcing(Direction::Normal, load))
    }

    /// The sum of profiles, set to the moment `clock`.
    pub(crate) fn of_profiles(profiles: &[&Profile], clock: Clock) -> Self {
        if profiles.iter().all(|profile| profile.waves().is_empty() && profile.knots().is_none()) {
            return Self {
                components: Vec::new(),
                mean: profiles.iter().map(|profile| profile.mean()).sum(),
                courses: Vec::new(),
                amplitude: 0.0,
                next_break: f64::INFINITY,
            };
        }
        let waves = profiles.iter().flat_map(|profile| profile.waves());
        let dithers: Vec<Dither> = waves
            .map(|wave| Dither {
                direction: Direction::Tangential,
                waveform: wave.waveform.clone(),
                amplitude: wave.amplitude,
                frequency_ratio: wave.frequency,
                phase: wave.phase,
                envelope: wave.envelope.clone(),
            })
            .collect();
        let mean = profiles.iter().map(|profile| profile.mean()).sum();
        let mut forcing = Self::new(&dithers, Direction::Tangential, mean, 1.0, clock);
        let courses = profiles.iter().filter_map(|profile| profile.knots());
        forcing.courses = courses.map(|knots| KnotTrack::new(knots, clock)).collect();
        forcing.amplitude +=
            forcing.courses.iter().map(|course| largest(&course.knots)).sum::<f64>();
        forcing.pass_breaks(clock);
        forcing
    }

    /// Whether the forcing is one harmonic wave and a constant part.
    pub(crate) fn is_harmonic(&self) -> bool {
        let has_one = matches!(&self.components[..], [only]
            if only.waveform.breaks().is_empty() && only.envelope.is_none());
        has_one && self.courses.is_empty()
    }

    /// Rate, phase and D Rᵏ/k! of the first dither; zeros without one.
    pub(crate) fn wave(&self) -> (f64, f64, Series) {
        match self.components.first() {
            Some(component) => (component.rate, component.phase, component.table),
            None => (0.0, 0.0, [0.0; ORDER + 1]),
        }
    }

    /// The straight piece of the first dither, without the constant part.
    #[inline(always)]
    pub(super) fn straight_piece(&self) -> StraightPiece {
        self.components.first().and_then(Component::straight_piece).unwrap_or_default()
    }

    /// Whether there is no dither in this direction.
    #[inline(always)]
    pub(crate) fn is_constant(&self) -> bool {
        self.components.is_empty() && self.courses.is_empty()
    }

    /// Σ|D|.
    #[inline(always)]
    pub(crate) fn amplitude(&self) -> f64 {
        self.amplitude
    }

    /// The constant part.
    #[inline(always)]
    pub(crate) fn mean(&self) -> f64 {
        self.mean
    }

    /// Highest frequency ratio, or 0 without dither.
    pub(crate) fn highest_rate(&self) -> f64 {
        self.components.iter().fold(0.0, |rate, component| rate.max(component.rate))
    }

    /// The next kink or jump.
    #[inline(always)]
    pub(crate) fn next_break(&self) -> f64 {
        self.next_break
    }

    /// Advances past every break that is not after `clock`.
    #[inline(always)]
    pub(crate) fn pass_breaks(&mut self, clock: Clock) {
        let mut next = f64::INFINITY;
        for component in &mut self.components {
            if component.ends < f64::INFINITY {
                component.pass_breaks(clock);
                next = if component.ends < next { component.ends } else { next };
            }
            if let Some(envelope) = &mut component.envelope {
                envelope.pass_breaks(clock);
                next = next.min(envelope.piece.ends);
            }
        }
        for course in &mut self.courses {
            course.pass_breaks(clock);
            next = next.min(course.piece.ends);
        }
        self.next_break = next;
    }

    /// Taylor coefficients at `clock`.
    #[inline(always)]
    pub(crate) fn series(&self, clock: Clock) -> Series {
        let mut out = match self.components.split_first() {
            None => [0.0; ORDER + 1],
            Some((first, rest)) => {
                let mut out = first.series(clock);
                for component in rest {
                    let series = component.series(clock);
                    for k in 0..=ORDER {
                        out[k] += series[k];
                    }
                }
                out
            }
        };
        for course in &self.courses {
            for (term, coefficient) in out.iter_mut().zip(course.series(clock)) {
                *term += coefficient;
            }
        }
        out[0] += self.mean;
        out
    }

    /// Value at `clock`, with the same bits as the first coefficient of [`Forcing::series`].
    #[inline(always)]
    pub(crate) fn value(&self, clock: Clock) -> f64 {
        let mut sum = match self.components.split_first() {
            None => 0.0,
            Some((first, rest)) => {
                let mut sum = first.value(clock);
                for component in rest {
                    sum += component.value(clock);
                }
                sum
            }
        };
        for course in &self.courses {
            sum += course.value(clock);
        }
        sum + self.mean
    }
}

/// Largest magnitude of a course.
fn largest(knots: &Knots) -> f64 {
    let RealInterval { lower: least, upper: most } = knots.range();
    least.abs().max(most.abs())
}

impl Component {
    fn new(dither: &Dither, unit: f64, clock: Clock) -> Self {
        let mut table = [dither.amplitude / unit; ORDER + 1];
        for k in 1..=ORDER {
            table[k] = table[k - 1] * dither.frequency_ratio / k as f64;
        }
        let mut component = Self {
            rate: dither.frequency_ratio,
            phase: dither.phase,
            period: dither.waveform.period(),
            waveform: dither.waveform.clone(),
            table,
            envelope: dither.envelope.as_ref().map(|knots| KnotTrack::new(knots, clock)),
            ending: 0,
            began: f64::NEG_INFINITY,
            ends: f64::INFINITY,
        };
        if !dither.waveform.breaks().is_empty() {
            component.seek(clock);
        }
        component
    }

    /// Finds the piece that contains `clock`.
    fn seek(&mut self, clock: Clock) {
        let count = self.waveform.breaks().len() as f64;
        let cycles = (self.rate * clock.time() + self.phase) / self.period;
        #[expect(
            clippy::cast_possible_truncation,
            reason = "the number of dither cycles of a run is far below 2⁶³"
        )]
        {
            self.ending = ((cycles - 1.0) * count).floor() as i64;
        }
        self.set_piece();
        self.pass_breaks(clock);
    }

    #[inline(always)]
    fn pass_breaks(&mut self, clock: Clock) {
        while clock.until(self.ends) <= 0.0 {
            self.ending += 1;
            self.set_piece();
        }
    }

    #[inline(always)]
    fn set_piece(&mut self) {
        self.began = self.break_time(self.ending - 1);
        self.ends = self.break_time(self.ending);
    }

    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_possible_wrap,
        reason = "a remainder by the number of breaks, which are few"
    )]
    #[inline(always)]
    fn break_time(&self, number: i64) -> f64 {
        let breaks = self.waveform.breaks();
        let count = breaks.len() as i64;
        let phase = breaks[number.rem_euclid(count) as usize];
        let cycle = number.div_euclid(count) as f64;
        (cycle.mul_add(self.period, phase) - self.phase) / self.rate
    }

    /// The current straight piece, or `None` if harmonic.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_possible_wrap,
        reason = "a remainder by the number of pieces, which are few"
    )]
    #[inline(always)]
    fn straight_piece(&self) -> Option<StraightPiece> {
        if self.ends == f64::INFINITY {
            return None;
        }
        let pieces = self.waveform.pieces();
        let index = (self.ending - 1).rem_euclid(pieces.len() as i64) as usize;
        match pieces[index] {
            Piece::Harmonic => None,
            Piece::Affine { value, slope } => Some(StraightPiece {
                began: self.began,
                value: self.table[0] * value,
                slope: self.table[0] * slope * self.rate,
            }),
        }
    }

    /// Value and slope (per unit time) of a straight piece at `clock`, or `None` if harmonic.
    #[inline(always)]
    fn straight(&self, clock: Clock) -> Option<(f64, f64)> {
        let piece = self.straight_piece()?;
        Some((piece.at(clock.time(), clock.low()), piece.slope))
    }

    #[inline(always)]
    fn sin_cos(&self, clock: Clock) -> (f64, f64) {
        sin_cos_of_phase(self.rate, clock.time(), clock.low(), self.phase)
    }

    #[inline(always)]
    fn value(&self, clock: Clock) -> f64 {
        let whole = match self.straight(clock) {
            Some((value, _)) => value,
            None => self.table[0] * self.sin_cos(clock).0,
        };
        match &self.envelope {
            Some(envelope) => envelope.value(clock) * whole,
            None => whole,
        }
    }

    #[inline(always)]
    fn series(&self, clock: Clock) -> Series {
        let whole = match self.straight(clock) {
            Some((value, slope)) => {
                let mut out = [0.0; ORDER + 1];
                out[0] = value;
                out[1] = slope;
                out
            }
            None => {
                harmonic_series(&self.table, (self.rate, self.phase), clock.time(), clock.low())
            }
        };
        match &self.envelope {
            Some(envelope) => product(&envelope.series(clock), &whole),
            None => whole,
        }
    }
}

/// Product of a cubic and a series.
fn product(cubic: &[f64; 4], series: &Series) -> Series {
    let mut out = [0.0; ORDER + 1];
    for (k, term) in out.iter_mut().enumerate() {
        for (j, coefficient) in cubic.iter().enumerate().take(k + 1) {
            *term = coefficient.mul_add(series[k - j], *term);
        }
    }
    out
}

/// Taylor coefficients of D sin(Rτ + φ) at the moment `time` + `low` in every lane, from the table D Rᵏ/k! and (R, φ).
#[inline(always)]
pub(crate) fn harmonic_series<V: Lane>(
    table: &[V; ORDER + 1],
    (rate, phase): (V, V),
    time: V,
    low: V,
) -> [V; ORDER + 1] {
    let (sine, cosine) = sin_cos_of_phase(rate, time, low, phase);
    let phasor = [sine, cosine, -sine, -cosine];
    let mut out = [V::splat(0.0); ORDER + 1];
    // Four by four, which the compiler makes one vector of.
    let orders = out.chunks_mut(4).zip(table.chunks(4));
    for (out, table) in orders {
        for ((out, entry), part) in out.iter_mut().zip(table).zip(&phasor) {
            *out = *entry * *part;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dither(waveform: Waveform, phase: f64) -> Dither {
        Dither {
            direction: Direction::Tangential,
            waveform,
            amplitude: 0.7,
            frequency_ratio: 3.0,
            phase,
            envelope: None,
        }
    }

    #[test]
    fn series_value_and_waveform_agree_over_many_periods() {
        for waveform in Waveform::NAMED {
            for phase in [0.0, 1.0, -2.5, 7.0] {
                let dithers = [dither(waveform.clone(), phase)];
                let mut forcing =
                    Forcing::new(&dithers, Direction::Tangential, 0.0, 0.5, Clock::at(0.0));
                for i in 1..2000 {
                    let clock = Clock::at(f64::from(i) * 0.031_7);
                    forcing.pass_breaks(clock);
                    let exact = 1.4 * waveform.value(3.0 * clock.time() + phase);
                    assert!((forcing.value(clock) - exact).abs() < 1e-13, "{waveform:?}");
                    assert_eq!(forcing.series(clock)[0], forcing.value(clock));
                    let to_break = clock.until(forcing.next_break());
                    assert!(to_break > 0.0);
                    let step = to_break.min(0.2) * 0.5;
                    let ahead = quell_numerics::lane::horner(&forcing.series(clock), step);
                    let exact = 1.4 * waveform.value(3.0 * (clock.time() + step) + phase);
                    assert!((ahead - exact).abs() < 1e-13, "{waveform:?}");
                }
            }
        }
    }

    #[test]
    fn a_run_that_starts_on_a_jump_takes_the_value_after_it() {
        let dithers = [dither(Waveform::Square, 0.0)];
        let forcing = Forcing::new(&dithers, Direction::Tangential, 0.0, 1.0, Clock::at(0.0));
        assert_eq!(forcing.value(Clock::at(0.0)), 0.7);
        assert_eq!(forcing.next_break(), std::f64::consts::PI / 3.0);
    }
}
