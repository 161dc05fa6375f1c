//! The cost of the dither, measured while integrating.
//!
//! * Mean friction from the momentum balance, exactly: ∫f dτ = [x′] + 2ζ[x] + ∫x dτ − Σ(D/R)[G].
//! * Dither power ⟨D_T g_T x′⟩: in stick v₀ times the impulse; in slip Gauss–Legendre on panels
//!   of at most one radian of the fastest dither.

use std::f64::consts::TAU;
use std::sync::LazyLock;

use quell_model::{Belt, Direction, Dither};
use quell_numerics::gauss_legendre::GaussLegendre;
use quell_numerics::roots::{Closeness, minimise};

use crate::simulation::{FinalState, Segment};

/// Nodes and weights on [0, 1] of the rule for an interval.
static RULE: LazyLock<[[f64; 8]; 2]> = LazyLock::new(|| GaussLegendre::new(8).on_unit_interval());

/// Samples per period of the fastest normal dither in the search for the smallest load.
const LOAD_SAMPLES: f64 = 64.0;

/// The meter of a record.
#[derive(Clone, Debug)]
pub(super) struct Meter {
    tangential: Vec<Dither>,
    fastest: f64,
    belt_velocity: f64,
    first_time: f64,
    stuck: f64,
    displacement_integral: f64,
    dither_work: f64,
    length: f64,
    friction_impulse: f64,
    with_power: bool,
    /// Whether a contact that sticks moves with the belt: an elastic slider that adheres does not.
    is_rigid: bool,
}

impl Meter {
    /// Starts at the state at the start of the record; measures the dither's power only if `with_power`.
    pub(super) fn new(belt: &Belt, start: &FinalState, with_power: bool) -> Self {
        let tangential: Vec<_> = belt
            .dithers_along(Direction::Tangential)
            .filter(|dither| dither.amplitude > 0.0)
            .cloned()
            .collect();
        Self {
            fastest: tangential.iter().fold(0.0, |rate, dither| rate.max(dither.resolved_ratio())),
            tangential,
            belt_velocity: belt.belt_velocity(),
            first_time: start.time,
            stuck: 0.0,
            displacement_integral: 0.0,
            dither_work: 0.0,
            length: 0.0,
            friction_impulse: 0.0,
            with_power,
            is_rigid: !belt.has_contact_state(),
        }
    }

    /// Closes the momentum balance.
    pub(super) fn finish(&mut self, belt: &Belt, start: &FinalState, end: &FinalState) {
        self.length = end.time - self.first_time;
        let damping = 2.0 * belt.damping_ratio();
        self.friction_impulse = (end.velocity - start.velocity)
            + damping * (end.displacement - start.displacement)
            + self.displacement_integral
            - self.impulse(start.time, end.time);
    }

    pub(super) fn stick_fraction(&self) -> f64 {
        self.stuck / self.length
    }

    pub(super) fn mean_friction(&self) -> f64 {
        self.friction_impulse / self.length
    }

    pub(super) fn dither_power(&self) -> f64 {
        self.dither_work / self.length
    }

    /// ∫ Σ D g dτ between two moments.
    fn impulse(&self, from: f64, to: f64) -> f64 {
        self.tangential
            .iter()
            .map(|dither| {
                let integral = |time| {
                    let phase = dither.frequency_ratio * time + dither.phase;
                    dither.waveform.integral(phase)
                };
                dither.amplitude_ratio() * (integral(to) - integral(from))
            })
            .sum()
    }

    fn force(&self, time: f64) -> f64 {
        force_of(&self.tangential, time)
    }

    /// ∫ Σ D g x′ dτ over a segment of slip.
    fn slip_work(&self, segment: &Segment<'_>) -> f64 {
        let duration = segment.duration();
        let start = segment.clock().time();
        let panels = (self.fastest * duration).ceil().max(1.0);
        let length = duration / panels;
        let [nodes, weights] = &*RULE;
        let mut work = 0.0;
        let mut panel = 0.0;
        while panel < panels {
            for (node, weight) in nodes.iter().zip(weights) {
                let since = (panel + node) * length;
                work += weight * length * self.force(start + since) * segment.velocity(since);
            }
            panel += 1.0;
        }
        work
    }
}

impl Meter {
    /// Adds one segment. To be called on the machine's best instruction set.
    #[inline(always)]
    pub(super) fn add_segment(&mut self, segment: &Segment<'_>) {
        self.displacement_integral += segment.displacement_integral();
        if segment.slip_sign() == 0 {
            self.stuck += segment.duration();
        }
        if self.tangential.is_empty() || !self.with_power {
            return;
        }
        self.dither_work += if self.is_rigid && segment.slip_sign() == 0 {
            let start = segment.clock().time();
            self.belt_velocity * self.impulse(start, start + segment.duration())
        } else {
            self.slip_work(segment)
        };
    }
}

fn force_of(dithers: &[Dither], time: f64) -> f64 {
    dithers
        .iter()
        .map(|dither| {
            let phase = dither.frequency_ratio * time + dither.phase;
            dither.amplitude * dither.waveform.value(phase)
        })
        .sum()
}

/// Smallest normal load F + Σ D_N g_N between τ = `from` and `from + length`.
///
/// Exact for a single normal dither (F − D_N, if a period fits); for several, the smallest of
/// a dense scan, refined.
pub(super) fn minimum_normal_load(belt: &Belt, from: f64, length: f64) -> f64 {
    let normal: Vec<Dither> = belt
        .dithers_along(Direction::Normal)
        .filter(|dither| dither.amplitude > 0.0)
        .cloned()
        .collect();
    let load = belt.normal_load();
    let fastest = normal.iter().fold(0.0_f64, |rate, dither| rate.max(dither.resolved_ratio()));
    match normal.as_slice() {
        [] => load,
        [only] if length * only.repetition_ratio() >= TAU => {
            load + only.amplitude * only.waveform.range().0
        }
        several => {
            let value = |time: f64| force_of(several, time);
            let step = TAU / (fastest * LOAD_SAMPLES);
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a positive count of samples"
            )]
            let count = (length / step).ceil() as usize;
            let (best, lowest) = (0..=count)
                .map(|k| from + step * k as f64)
                .map(|time| (time, value(time)))
                .fold((from, f64::INFINITY), |a, b| if b.1 < a.1 { b } else { a });
            let refined = minimise(value, best - step, best + step, Closeness::default());
            load + refined.map_or(lowest, |minimum| minimum.value.min(lowest))
        }
    }
}
