//! What a run under a varying drive, load or dither does: when it vibrates, how soon the dither quenches it, and its spectrogram.

use quell_model::profile::Knots;
use quell_model::units::Quantity;
use quell_numerics::spectrum::Spectrum;

use crate::fields::Fields;
use crate::words::plural;

/// Share of the largest vibration at which vibration begins, and that at which it has ended.
const BEGINS: f64 = 0.2;
const ENDS: f64 = 0.1;

/// A pause of fewer natural periods belongs to the vibration: stick–slip at low speed rests between its slips.
const PAUSE: f64 = 6.0;

/// Vibration below this share of the largest displacement is none.
const LEAST: f64 = 1e-3;

/// A dither with a period below this share of the natural period is averaged out.
const FAST: f64 = 0.4;

/// Intervals of vibration that a sentence names.
const MOST_INTERVALS: usize = 4;

/// Windows per natural period in which vibration is measured.
const WINDOWS_PER_PERIOD: usize = 4;

/// Natural periods in a window of the spectrogram.
const PERIODS_PER_WINDOW: f64 = 6.0;

/// Largest numbers of columns and rows of a spectrogram.
const MOST_COLUMNS: usize = 240;
const MOST_ROWS: usize = 160;

/// A displacement at equal steps.
#[derive(Clone, Copy, Debug)]
pub struct SampledMotion<'a> {
    /// Time of the first sample.
    pub start: f64,
    /// Time between two samples.
    pub step: f64,
    /// The displacement.
    pub displacement: &'a [f64],
}

/// An interval of vibration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VibrationInterval {
    /// Its beginning; the start of the run if it vibrates there already.
    pub from: f64,
    /// Its end; the end of the run if it still vibrates there.
    pub to: f64,
    /// Largest vibration in it: half of the peak-to-peak displacement within one natural period, without its drift.
    pub level: f64,
}

/// When a run vibrates.
#[derive(Clone, Debug, PartialEq)]
pub struct Manoeuvre {
    /// The intervals of vibration, in order.
    pub vibration: Vec<VibrationInterval>,
    /// When the first dither is switched on, if one is.
    pub onset: Option<f64>,
    /// Time from there until the vibration has ended for the rest of the run; why it is unknown.
    pub time_to_quench: Result<f64, &'static str>,
    /// Largest vibration after the onset over the vibration at the onset, minus 1; why it is unknown.
    pub overshoot: Result<f64, &'static str>,
    /// Beginning and end of the run.
    pub whole: (f64, f64),
}

impl Manoeuvre {
    /// Of a displacement; `period` is the natural period, `fast` that of a dither, whose motion is no vibration, `onset` the time
    /// at which the dither is switched on.
    pub fn of(
        motion: SampledMotion<'_>,
        period: f64,
        fast: Option<f64>,
        onset: Option<f64>,
    ) -> Self {
        let slow = without_fast(motion, period, fast);
        let motion = SampledMotion {
            displacement: slow.as_deref().unwrap_or(motion.displacement),
            ..motion
        };
        let SampledMotion { start, step, displacement } = motion;
        let end = start + step * displacement.len().saturating_sub(1) as f64;
        let levels = levels(motion, period);
        let largest = levels.iter().fold(0.0, |most: f64, (_, level)| most.max(*level));
        let reach = displacement.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let vibration = if largest > LEAST * reach {
            intervals(&levels, largest, (start, end), period)
        } else {
            Vec::new()
        };
        let (time_to_quench, overshoot) = quenching(&vibration, &levels, onset, end);
        Self { vibration, onset, time_to_quench, overshoot, whole: (start, end) }
    }
}

/// The intervals in which the level rises above [`BEGINS`] of the largest one, until it falls below [`ENDS`] of it for longer than a
/// [`PAUSE`].
fn intervals(
    levels: &[(f64, f64)],
    largest: f64,
    (start, end): (f64, f64),
    period: f64,
) -> Vec<VibrationInterval> {
    let mut vibration: Vec<VibrationInterval> = Vec::new();
    let mut going = false;
    for (time, level) in levels {
        if going {
            going = *level > ENDS * largest;
        } else if *level > BEGINS * largest {
            going = true;
            let resumes = vibration.last().is_some_and(|last| time - last.to < PAUSE * period);
            let from = if vibration.is_empty() && *time <= start + period { start } else { *time };
            if !resumes {
                vibration.push(VibrationInterval { from, to: *time, level: *level });
            }
        }
        if let Some(last) = vibration.last_mut().filter(|_| going) {
            last.to = *time;
            last.level = last.level.max(*level);
        }
    }
    if let Some(last) = vibration.last_mut().filter(|_| going) {
        last.to = end;
    }
    vibration
}

/// The displacement without the motion under a fast dither; `None` without one.
fn without_fast(motion: SampledMotion<'_>, period: f64, fast: Option<f64>) -> Option<Vec<f64>> {
    fast.filter(|fast| *fast < FAST * period).map(|fast| averaged(motion, fast))
}

/// Half of the peak-to-peak slow displacement within one natural period, at the middle of each window.
pub(crate) fn vibration_levels(
    motion: SampledMotion<'_>,
    period: f64,
    fast: Option<f64>,
) -> Vec<(f64, f64)> {
    let slow = without_fast(motion, period, fast);
    let displacement = slow.as_deref().unwrap_or(motion.displacement);
    levels(SampledMotion { displacement, ..motion }, period)
}

/// The displacement averaged over a fast period about each sample; over less at the ends.
fn averaged(motion: SampledMotion<'_>, period: f64) -> Vec<f64> {
    let SampledMotion { step, displacement, .. } = motion;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a count of samples"
    )]
    let half = (0.5 * period / step).round() as usize;
    let mut sums = Vec::with_capacity(displacement.len() + 1);
    sums.push(0.0);
    let mut sum = 0.0;
    for value in displacement {
        sum += value;
        sums.push(sum);
    }
    (0..displacement.len())
        .map(|at| {
            let half = half.min(at).min(displacement.len() - 1 - at);
            // The samples at both ends of a whole period count half.
            let inner = sums[at + half] - sums[at - half]
                + 0.5 * (displacement[at + half] - displacement[at - half]);
            if half == 0 { displacement[at] } else { inner / (2 * half) as f64 }
        })
        .collect()
}

impl Manoeuvre {
    /// When the run vibrates, in one or two sentences; `in_words` writes a quantity with its unit, `what` vibrates.
    pub fn sentence(&self, what: &str, in_words: impl Fn(Quantity, f64) -> String) -> String {
        let moment = |time: f64| in_words(Quantity::Time, time);
        let (begins, ends) = self.whole;
        let each = self.vibration.iter().take(MOST_INTERVALS).map(|interval| {
            let from = if interval.from <= begins {
                "the start".to_owned()
            } else {
                moment(interval.from)
            };
            let to = if interval.to >= ends { "the end".to_owned() } else { moment(interval.to) };
            let size = in_words(Quantity::Displacement, interval.level);
            format!("from {from} to {to} (amplitude up to {size})")
        });
        let listed = each.collect::<Vec<_>>().join(", ");
        let more = match self.vibration.len().saturating_sub(MOST_INTERVALS) {
            0 => String::new(),
            more => format!(" and in {more} more interval{}", plural(more as u64)),
        };
        let vibrates = if listed.is_empty() {
            format!("{what} does not vibrate.")
        } else {
            format!("{what} vibrates {listed}{more}.")
        };
        let quench = self.time_to_quench.ok().map(|time| {
            format!(" The vibration ends {} after the dither is switched on.", moment(time))
        });
        format!("{vibrates}{}", quench.unwrap_or_default())
    }

    /// When the run vibrates, as fields; `empty` makes fields in the units of the study.
    pub(crate) fn fields(&self, empty: impl Fn() -> Fields) -> Fields {
        let mut fields = empty();
        let intervals = self.vibration.iter().map(|interval| {
            let mut inner = empty();
            inner
                .number("from", Quantity::Time, interval.from)
                .number("to", Quantity::Time, interval.to)
                .number("amplitude", Quantity::Displacement, interval.level);
            inner
        });
        fields.list("vibration", intervals.collect::<Vec<_>>());
        let onset = self.onset.ok_or_else(|| "no dither is switched on during the run".to_owned());
        fields
            .known("dither_onset", Quantity::Time, onset)
            .known("time_to_quench", Quantity::Time, self.time_to_quench.map_err(str::to_owned))
            .known("overshoot", Quantity::Ratio, self.overshoot.map_err(str::to_owned));
        fields
    }
}

/// Half of the peak-to-peak displacement within one natural period, without its drift, at the middle of each window.
fn levels(motion: SampledMotion<'_>, period: f64) -> Vec<(f64, f64)> {
    let SampledMotion { start, step, displacement } = motion;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a count of samples"
    )]
    let length = ((period / step).round() as usize).max(8);
    let hop = (length / WINDOWS_PER_PERIOD).max(1);
    let count = displacement.len();
    let firsts = (0..count.saturating_sub(length)).step_by(hop);
    firsts
        .map(|first| {
            let window = &displacement[first..=first + length];
            let drift = (window[length] - window[0]) / length as f64;
            let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
            for (place, x) in window.iter().enumerate() {
                let rest = x - drift * place as f64;
                least = least.min(rest);
                most = most.max(rest);
            }
            (step.mul_add(first as f64 + 0.5 * length as f64, start), 0.5 * (most - least))
        })
        .collect()
}

type Known = Result<f64, &'static str>;

fn quenching(
    vibration: &[VibrationInterval],
    levels: &[(f64, f64)],
    onset: Option<f64>,
    end: f64,
) -> (Known, Known) {
    let Some(onset) = onset else {
        let why = "no dither is switched on during the run";
        return (Err(why), Err(why));
    };
    let at_onset = vibration.iter().any(|interval| interval.from <= onset && onset <= interval.to);
    if !at_onset {
        let why = "nothing vibrates when the dither is switched on";
        return (Err(why), Err(why));
    }
    let last = vibration.last().map_or(onset, |interval| interval.to);
    let quench =
        if last >= end { Err("it still vibrates at the end of the run") } else { Ok(last - onset) };
    let level_at = levels.iter().take_while(|(time, _)| *time <= onset).last();
    let after = levels.iter().filter(|(time, _)| *time > onset);
    let most = after.fold(0.0, |most: f64, (_, level)| most.max(*level));
    let overshoot = level_at.map_or(Err("the dither is on from the start"), |(_, level)| {
        Ok((most / level - 1.0).max(0.0))
    });
    (quench, overshoot)
}

/// When an envelope first rises from zero, or from its least share.
pub fn onset(envelope: &Knots) -> Option<f64> {
    let values = envelope.values();
    let rise = (1..values.len()).find(|place| values[*place].abs() > values[place - 1].abs())?;
    Some(envelope.times()[rise - 1])
}

/// Spectral amplitude over time and angular frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrogram {
    /// Middles of the windows.
    pub times: Vec<f64>,
    /// Angular frequencies.
    pub frequencies: Vec<f64>,
    /// Amplitudes, row by row: those of the lowest frequency first.
    pub amplitudes: Vec<f64>,
}

impl Spectrogram {
    /// Of a displacement up to an angular frequency; `None` if the run is shorter than a window.
    pub fn of(motion: SampledMotion<'_>, period: f64, highest: f64) -> Option<Self> {
        let SampledMotion { start, step, displacement } = motion;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a count of samples"
        )]
        let length = (PERIODS_PER_WINDOW * period / step).round() as usize;
        if length < 16 || displacement.len() < 2 * length {
            return None;
        }
        let free = displacement.len() - length;
        let hop = (length / 8).max(free / MOST_COLUMNS).max(1);
        let (mut times, mut columns) = (Vec::new(), Vec::new());
        let mut frequencies = Vec::new();
        // Lines of the spectrum in one row; all windows have the same lines.
        let mut each = 1;
        for first in (0..=free).step_by(hop) {
            let spectrum = Spectrum::of(&displacement[first..first + length], step).ok()?;
            if frequencies.is_empty() {
                let shown =
                    spectrum.frequencies().take_while(|frequency| *frequency <= highest).count();
                each = shown.div_ceil(MOST_ROWS).max(1);
                frequencies = (0..shown / each)
                    .map(|row| spectrum.frequency(row * each + each / 2))
                    .collect();
            }
            let rows = spectrum.amplitudes().chunks(each).take(frequencies.len());
            columns.push(
                rows.map(|row| row.iter().fold(0.0, |most: f64, a| most.max(*a)))
                    .collect::<Vec<f64>>(),
            );
            times.push(step.mul_add(first as f64 + 0.5 * length as f64, start));
        }
        let amplitudes = (0..frequencies.len())
            .flat_map(|row| columns.iter().map(move |column| column[row]))
            .collect();
        (times.len() > 1 && frequencies.len() > 1).then_some(Self {
            times,
            frequencies,
            amplitudes,
        })
    }

    /// The largest amplitude.
    pub fn largest(&self) -> f64 {
        self.amplitudes.iter().fold(0.0, |most: f64, a| most.max(*a))
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use quell_model::profile::KnotShape;

    use super::*;

    const STEP: f64 = 0.02;

    fn motion(value: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..15_000).map(|sample| value(STEP * f64::from(sample))).collect()
    }

    fn sampled(displacement: &[f64]) -> SampledMotion<'_> {
        SampledMotion { start: 0.0, step: STEP, displacement }
    }

    #[test]
    fn a_vibration_that_is_quenched_has_its_times() {
        // A drift that is no vibration, a vibration from 50 to 150, growing at first after the onset.
        let displacement = motion(|time| {
            let amplitude = if (50.0..150.0).contains(&time) {
                if time > 120.0 { 1.5 } else { 1.0 }
            } else {
                0.0
            };
            0.01 * time + amplitude * time.sin()
        });
        let found = Manoeuvre::of(sampled(&displacement), TAU, None, Some(110.0));
        assert_eq!(found.vibration.len(), 1);
        let only = found.vibration[0];
        assert!((only.from - 50.0).abs() < TAU && (only.to - 150.0).abs() < TAU, "{only:?}");
        assert!((only.level - 1.5).abs() < 0.05, "{only:?}");
        assert!((found.time_to_quench.expect("quenched") - 40.0).abs() < TAU);
        assert!((found.overshoot.expect("known") - 0.5).abs() < 0.1);
        let quiet = motion(|time| 0.3 + 1e-7 * time.sin());
        let found = Manoeuvre::of(sampled(&quiet), TAU, None, None);
        assert!(found.vibration.is_empty() && found.time_to_quench.is_err());
        let on = motion(f64::sin);
        let found = Manoeuvre::of(sampled(&on), TAU, None, Some(20.0));
        assert_eq!((found.vibration[0].from, found.vibration[0].to), found.whole);
        assert!(found.time_to_quench.is_err());
    }

    /// A dither that moves the mass fast is no vibration.
    #[test]
    fn the_fast_motion_under_dither_does_not_count() {
        let displacement =
            motion(|time| if time < 100.0 { time.sin() } else { 0.3 * (10.0 * time).sin() });
        let found = |fast| Manoeuvre::of(sampled(&displacement), TAU, fast, Some(90.0));
        assert!(found(None).time_to_quench.is_err());
        let quench = found(Some(TAU / 10.0)).time_to_quench.expect("quenched");
        assert!((quench - 10.0).abs() < TAU, "{quench}");
    }

    /// Slips of one natural period with rests of `rest` natural periods between them, ten times.
    fn with_rests(rest: f64) -> usize {
        let displacement = motion(|time| {
            let (whole, repeat) = (time / TAU, rest + 1.0);
            let slips = whole < 10.0 * repeat && whole.rem_euclid(repeat) < 1.0;
            if slips { time.sin() } else { 0.0 }
        });
        Manoeuvre::of(sampled(&displacement), TAU, None, None).vibration.len()
    }

    #[test]
    fn short_rests_belong_to_a_vibration() {
        assert_eq!(with_rests(3.0), 1);
        assert!(with_rests(9.0) > 4);
    }

    #[test]
    fn a_chirp_moves_through_the_spectrogram() {
        let displacement = motion(|time| (time + 0.005 * time * time).sin());
        let found = Spectrogram::of(sampled(&displacement), TAU, 6.0).expect("a spectrogram");
        let columns = found.times.len();
        for (column, time) in found.times.iter().enumerate() {
            let at = |row: usize| found.amplitudes[row * columns + column];
            let peak = (0..found.frequencies.len())
                .max_by(|a, b| at(*a).total_cmp(&at(*b)))
                .expect("rows");
            let exact = 1.0 + 0.01 * time;
            assert!(
                (found.frequencies[peak] - exact).abs() < 0.12,
                "{time}: {}",
                found.frequencies[peak]
            );
            assert!(at(peak) > 0.7 && at(peak) < 1.05);
        }
    }

    #[test]
    fn the_onset_is_where_the_share_begins_to_rise() {
        let knots = |times: &[f64], values: &[f64]| {
            Knots::new(times.to_vec(), values.to_vec(), KnotShape::Linear).expect("valid")
        };
        assert_eq!(onset(&knots(&[0.0, 5.0, 9.0], &[0.0, 0.0, 1.0])), Some(5.0));
        assert_eq!(onset(&knots(&[3.0, 3.0], &[0.0, 1.0])), Some(3.0));
        assert_eq!(onset(&knots(&[0.0, 5.0], &[1.0, 0.0])), None);
    }
}
