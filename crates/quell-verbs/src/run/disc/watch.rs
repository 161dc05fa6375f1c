//! The deflection under the first load while a motion is integrated: its growth as long as the motion is small, and its amplitude at
//! the end.
//!
//! An extreme of a motion e^{σt} cos(ωt + φ) is followed by the next after π/ω, with e^{σπ/ω} times its size, so that ln|x| of the
//! extremes is a straight line of slope σ over their times. The slope of the least-squares line is the observed growth rate.

use quell_dynamics::motion::{ContactPhase, MotionObserver, MotionSegment};

use crate::reasons::reasons;

/// Largest relative change of load and slip velocity of a small motion.
const SMALL: f64 = 0.01;

/// Fewest extremes that give a growth rate.
const LEAST_EXTREMES: u64 = 6;

/// Parts of a step at whose ends loads and slip velocities are looked at: a step is shorter than the period of the fastest motion.
const PARTS: u32 = 8;

reasons! {
    /// Why the growth rate of a motion of a disc is unknown.
    pub enum NoObservedGrowth {
        ;
        /// The deflection has too few extremes.
        FewExtremes => &format!(
            "the deflection has fewer than {LEAST_EXTREMES} extremes while loads and slip velocities differ by less than {} % from \
             steady sliding",
            100.0 * SMALL
        ),
        /// The system varies in time.
        Varies => "the speed, a load or the dither varies in time: the growth rate is that of no moment",
    }
}

/// Load and slip velocity of a contact in steady sliding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SteadyLevel {
    pub(super) normal_load: f64,
    pub(super) slip_velocity: f64,
}

/// Sums of a least-squares line.
#[derive(Clone, Copy, Debug, Default)]
struct LineSums {
    count: u64,
    time: f64,
    value: f64,
    time_squared: f64,
    product: f64,
}

impl LineSums {
    fn add(&mut self, time: f64, value: f64) {
        self.count += 1;
        self.time += time;
        self.value += value;
        self.time_squared += time * time;
        self.product += time * value;
    }

    fn slope(&self) -> f64 {
        let count = self.count as f64;
        let spread = f64::mul_add(count, self.time_squared, -(self.time * self.time));
        f64::mul_add(count, self.product, -(self.time * self.value)) / spread
    }
}

/// Observes a row over the coordinates of a mechanical system.
pub(super) struct RowWatch {
    row: Vec<f64>,
    /// Observed value in steady sliding.
    middle: f64,
    levels: Vec<SteadyLevel>,
    /// Time from which the amplitude is measured.
    from: f64,
    least: f64,
    most: f64,
    /// Largest distance from steady sliding in the whole run.
    largest: f64,
    is_small: bool,
    line: LineSums,
}

impl RowWatch {
    /// For a motion about steady sliding, whose amplitude is that from the time `from` on.
    pub(super) fn new(row: Vec<f64>, middle: f64, levels: Vec<SteadyLevel>, from: f64) -> Self {
        let (least, most) = (f64::INFINITY, f64::NEG_INFINITY);
        let line = LineSums::default();
        Self { row, middle, levels, from, least, most, largest: 0.0, is_small: true, line }
    }

    /// Half the difference between the largest and the least value from the given time on.
    pub(super) fn amplitude(&self) -> f64 {
        (0.5 * (self.most - self.least)).max(0.0)
    }

    /// Largest distance from steady sliding in the whole run.
    pub(super) fn largest(&self) -> f64 {
        self.largest
    }

    /// The growth rate, or why it is unknown.
    pub(super) fn growth(&self) -> Result<f64, NoObservedGrowth> {
        if self.line.count >= LEAST_EXTREMES {
            return Ok(self.line.slope());
        }
        Err(NoObservedGrowth::FewExtremes)
    }

    /// Whether every contact slips near its steady load and slip velocity at a moment of a step.
    fn stays_small(&self, segment: &MotionSegment<'_>, since: f64) -> bool {
        self.levels.iter().enumerate().all(|(contact, level)| {
            let load = MotionSegment::value(segment.normal_load(contact), since);
            let slip = MotionSegment::value(segment.slip_velocity(contact), since);
            let is_near = |value: f64, steady: f64| (value - steady).abs() <= SMALL * steady.abs();
            matches!(segment.phase(contact), ContactPhase::Slip(_))
                && is_near(load, level.normal_load)
                && is_near(slip, level.slip_velocity)
        })
    }

    fn take(&mut self, time: f64, value: f64) {
        self.largest = self.largest.max((value - self.middle).abs());
        if time >= self.from {
            self.least = self.least.min(value);
            self.most = self.most.max(value);
        }
    }
}

impl MotionObserver for RowWatch {
    fn segment(&mut self, segment: &MotionSegment<'_>) {
        let series = segment.row(&self.row, 0);
        let mut turns = segment.turning_points(&series).into_iter().peekable();
        let part = segment.duration() / f64::from(PARTS);
        for number in 1..=PARTS {
            let high = f64::from(number) * part;
            self.is_small = self.is_small && self.stays_small(segment, high);
            while let Some(since) = turns.next_if(|since| *since <= high || number == PARTS) {
                let time = segment.clock().after(since).time();
                let extreme = MotionSegment::value(&series, since);
                self.take(time, extreme);
                let size = (extreme - self.middle).abs();
                if self.is_small && size > 0.0 {
                    self.line.add(time, libm::log(size));
                }
            }
            self.take(segment.clock().after(high).time(), MotionSegment::value(&series, high));
        }
    }
}
