//! An observer that checks the balance of work on every segment of a run.
//!
//! Δ(x′² + x²)/2 = ∫ (f − 2ζx′ + p) x′ dτ with the friction force f from the law itself (slip) or from the sticking contact
//! and the dither p from its waveform: values, not the series that the engine integrates, so that the two are independent.

use quell_dynamics::simulation::{Observer, Segment, Start, simulate};
use quell_model::{Belt, Direction};

/// Tolerance of the runs.
const TOLERANCE: f64 = 1e-12;

/// Nodes and weights of the 10-point Gauss–Legendre rule on [−1, 1] (positive half).
const GAUSS: [(f64, f64); 5] = [
    (0.148_874_338_981_631_21, 0.295_524_224_714_752_87),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_36),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
];

/// What a run leaves open of the balance of work.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Balanced {
    /// Segments of the run.
    pub(crate) steps: u64,
    /// Largest residual of a segment, in units of TOLERANCE · F · (largest speed or length).
    pub(crate) worst: f64,
}

/// Simulates `belt` from `start` until τ = `until` and balances every segment to `allowed` units of [`Balanced::worst`].
pub(crate) fn balanced(belt: &Belt, start: Start, until: f64, allowed: f64) -> Balanced {
    let fastest =
        belt.dithers().iter().fold(1.0_f64, |rate, dither| rate.max(dither.frequency_ratio));
    let mut balance = Balance { belt, fastest, steps: 0, worst: 0.0, end: start.time };
    let end = simulate(belt, start, until, TOLERANCE, &mut balance)
        .unwrap_or_else(|stalled| panic!("{stalled}\n{belt:?}\n{start:?}"));
    assert_eq!(end.time, until);
    // The segments join without a gap; the last addition may round.
    assert!((balance.end - until).abs() <= f64::EPSILON * until);
    assert!(end.displacement.is_finite() && end.velocity.is_finite());
    let (steps, worst) = (balance.steps, balance.worst);
    assert!(worst < allowed, "residual {worst:.1} tolerances\n{belt:?}\n{start:?}");
    Balanced { steps, worst }
}

/// Checks every segment.
struct Balance<'a> {
    belt: &'a Belt,
    fastest: f64,
    steps: u64,
    worst: f64,
    end: f64,
}

impl Balance<'_> {
    fn dither(&self, direction: Direction, time: f64) -> f64 {
        self.belt
            .dithers_along(direction)
            .map(|d| d.amplitude * d.waveform.value(d.frequency_ratio * time + d.phase))
            .sum()
    }

    fn power(&self, segment: &Segment<'_>, since: f64) -> f64 {
        let time = segment.clock().time() + since;
        let velocity = segment.velocity(since);
        let damping = 2.0 * self.belt.damping_ratio() * velocity;
        let dither = self.dither(Direction::Tangential, time);
        let friction = if segment.slip_sign() == 0 {
            damping + segment.displacement(since) - dither
        } else {
            let slip = segment.slip_velocity(since);
            let load = self.belt.normal_load() + self.dither(Direction::Normal, time);
            let sign = f64::from(segment.slip_sign());
            // At the ends of a slip v_r is 0 up to rounding, on either side.
            sign * self.belt.friction().coefficient((sign * slip).max(0.0)) * load
        };
        (friction - damping + dither) * velocity
    }
}

impl Observer for Balance<'_> {
    fn segment(&mut self, segment: &Segment<'_>) {
        self.steps += 1;
        let duration = segment.duration();
        assert!(duration > 0.0, "a segment of no length");
        self.end = segment.clock().after(duration).time();
        let energy = |since: f64| {
            let (x, v) = (segment.displacement(since), segment.velocity(since));
            0.5 * (x * x + v * v)
        };
        let gained = energy(duration) - energy(0.0);
        if segment.slip_sign() == 0 && duration * self.fastest > 3.0 {
            // A long sure stick crosses kinks of the dither; its motion is a straight line.
            return;
        }
        let panels = (4.0 * self.fastest * duration).ceil().clamp(8.0, 64.0);
        let half = 0.5 * duration / panels;
        let mut work = 0.0;
        let mut panel = 0.0;
        while panel < panels {
            let middle = (2.0 * panel + 1.0) * half;
            for (node, weight) in GAUSS {
                for since in [middle - node * half, middle + node * half] {
                    work += weight * half * self.power(segment, since);
                }
            }
            panel += 1.0;
        }
        let speed = segment.velocity(0.0).abs().max(segment.velocity(duration).abs());
        let size = segment.displacement(0.0).abs().max(speed).max(self.belt.normal_load());
        // The phase of the dither is one number here, Rτ: its rounding is work that the engine, which counts time in two numbers,
        // does not do.
        let phase = self.fastest * segment.clock().time();
        let force = self.belt.total_amplitude(Direction::Tangential);
        let rounding = f64::EPSILON * phase * force * speed * duration;
        let residual = ((gained - work).abs() - rounding) / (TOLERANCE * size * size);
        assert!(residual.is_finite());
        self.worst = self.worst.max(residual);
    }
}
