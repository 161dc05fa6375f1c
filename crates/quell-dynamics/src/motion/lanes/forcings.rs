//! What varies in time, in every lane.

use quell_numerics::lane::Lane;

use super::super::contact_series::{ContactSeries, SeriesOf};
use super::super::equations::Forcings;
use super::super::series::StepSeries;
use crate::simulation::{Clock, Forcing, ORDER, harmonic_series};

/// How a number varies in time, which lanes side by side share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Varying {
    /// It is constant: its series is written when a run begins.
    Constant,
    /// One harmonic wave and a constant part.
    Harmonic,
    /// Anything else: each run writes its own series for each step.
    Other,
}

impl Varying {
    pub(super) fn of(forcing: &Forcing) -> Self {
        if forcing.is_constant() {
            Self::Constant
        } else if forcing.is_harmonic() {
            Self::Harmonic
        } else {
            Self::Other
        }
    }
}

/// The numbers of a harmonic wave and its constant part, in every lane.
struct LaneWave<V> {
    varying: Varying,
    mean: V,
    rate: V,
    phase: V,
    table: SeriesOf<V>,
}

impl<V: Lane> LaneWave<V> {
    fn like(forcing: &Forcing) -> Self {
        let zero = V::splat(0.0);
        let varying = Varying::of(forcing);
        Self { varying, mean: zero, rate: zero, phase: zero, table: [zero; ORDER + 1] }
    }

    /// Writes the wave of a run, and its series at the start.
    fn admit(&mut self, lane: usize, forcing: &Forcing, clock: Clock, series: &mut SeriesOf<V>) {
        let (rate, phase, table) = forcing.wave();
        self.mean.set_lane(lane, forcing.mean());
        self.rate.set_lane(lane, rate);
        self.phase.set_lane(lane, phase);
        for (numbers, entry) in self.table.iter_mut().zip(table) {
            numbers.set_lane(lane, entry);
        }
        set_series(lane, forcing, clock, series);
    }

    /// Writes the series of a step in every lane, from its start at `time` + `low`.
    #[inline(always)]
    fn write(&self, time: V, low: V, series: &mut SeriesOf<V>) {
        if self.varying == Varying::Harmonic {
            *series = harmonic_series(&self.table, (self.rate, self.phase), time, low);
            series[0] = series[0] + self.mean;
        }
    }

    /// Writes the series of a step of one run.
    #[inline(always)]
    fn load(&self, lane: usize, forcing: &Forcing, clock: Clock, series: &mut SeriesOf<V>) {
        if self.varying == Varying::Other {
            set_series(lane, forcing, clock, series);
        }
    }
}

#[inline(always)]
fn set_series<V: Lane>(lane: usize, forcing: &Forcing, clock: Clock, series: &mut SeriesOf<V>) {
    for (numbers, entry) in series.iter_mut().zip(forcing.series(clock)) {
        numbers.set_lane(lane, entry);
    }
}

/// Everything that varies in time.
pub(super) struct LaneForcings<V> {
    pushes: Vec<LaneWave<V>>,
    /// Surface, load, guided part of the load, and factor.
    contacts: Vec<[Option<LaneWave<V>>; 4]>,
    /// Whether a run writes any series of its own.
    has_others: bool,
}

/// The series of a contact in the order of its waves.
#[inline(always)]
fn series_of<V>(contact: &mut ContactSeries<V>) -> [&mut SeriesOf<V>; 4] {
    [&mut contact.surface, &mut contact.given, &mut contact.guided, &mut contact.factor]
}

impl<V: Lane> LaneForcings<V> {
    /// Zeros, for forcings like these.
    pub(super) fn like(forcings: &Forcings) -> Self {
        let contacts = forcings
            .contacts
            .iter()
            .map(|contact| contact.all().map(|forcing| forcing.map(LaneWave::like)));
        let pushes = forcings.pushes.iter().map(LaneWave::like);
        let has_others = forcings.all().any(|forcing| Varying::of(forcing) == Varying::Other);
        Self { pushes: pushes.collect(), contacts: contacts.collect(), has_others }
    }

    /// Writes the forcings of a run.
    pub(super) fn admit(
        &mut self,
        lane: usize,
        forcings: &Forcings,
        clock: Clock,
        out: &mut StepSeries<V>,
    ) {
        self.each(forcings, out, |wave, forcing, series| wave.admit(lane, forcing, clock, series));
    }

    /// Writes the series of a step of one run where its lane cannot.
    #[inline(always)]
    pub(super) fn load(
        &mut self,
        lane: usize,
        forcings: &Forcings,
        clock: Clock,
        out: &mut StepSeries<V>,
    ) {
        if self.has_others {
            self.each(forcings, out, |wave, forcing, series| {
                wave.load(lane, forcing, clock, series);
            });
        }
    }

    /// Calls `write` with every wave, the forcing of a run that it is in a lane, and its series.
    #[inline(always)]
    fn each(
        &mut self,
        forcings: &Forcings,
        out: &mut StepSeries<V>,
        mut write: impl FnMut(&mut LaneWave<V>, &Forcing, &mut SeriesOf<V>),
    ) {
        let pushes = self.pushes.iter_mut().zip(&forcings.pushes).zip(&mut out.pushes);
        pushes.for_each(|((wave, forcing), series)| write(wave, forcing, series));
        let contacts = self.contacts.iter_mut().zip(&forcings.contacts).zip(&mut out.contacts);
        for ((waves, forcing), contact) in contacts {
            let all = waves.iter_mut().zip(forcing.all()).zip(series_of(contact));
            for ((wave, forcing), series) in all {
                if let (Some(wave), Some(forcing)) = (wave, forcing) {
                    write(wave, forcing, series);
                }
            }
        }
    }

    /// Writes the series of a step in every lane, from its start at `time` + `low`.
    #[inline(always)]
    pub(super) fn write(&self, time: V, low: V, out: &mut StepSeries<V>) {
        for (wave, series) in self.pushes.iter().zip(&mut out.pushes) {
            wave.write(time, low, series);
        }
        for (waves, contact) in self.contacts.iter().zip(&mut out.contacts) {
            for (wave, series) in waves.iter().zip(series_of(contact)) {
                if let Some(wave) = wave {
                    wave.write(time, low, series);
                }
            }
        }
    }
}
