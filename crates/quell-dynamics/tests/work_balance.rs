//! A million random steps of valid parameters: no panic, no NaN, no endless loop, and the
//! balance of work closes on every one of them.
//!
//! Δ(x′² + x²)/2 = ∫ (f − 2ζx′ + p) x′ dτ with the friction force f from the law itself (slip)
//! or from the bond (stick) and the dither p from its waveform: values, not the series that
//! the engine integrates, so that the two are independent.

use std::collections::BTreeMap;

use quell_dynamics::simulation::{Observer, Segment, Start, simulate};
use quell_model::{Belt, Direction, Dither, Friction, LawKind, Waveform};

/// Steps in all.
const STEPS: u64 = 1_000_000;

/// Tolerance of the runs.
const TOLERANCE: f64 = 1e-12;

/// Largest residual of one segment, in units of TOLERANCE · F · (largest speed or length).
/// The last retained term is below TOLERANCE·F; what a step leaves out is of its order, and
/// rounding of the sums adds a few hundred ε.
const RESIDUAL: f64 = 30.0;

/// Nodes and weights of the 10-point Gauss–Legendre rule on [−1, 1] (positive half).
const GAUSS: [(f64, f64); 5] = [
    (0.148_874_338_981_631_21, 0.295_524_224_714_752_87),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_36),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
];

struct Random(u64);

impl Random {
    /// Uniform in [0, 1).
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Log-uniform.
    fn decades(&mut self, low: f64, high: f64) -> f64 {
        (self.between(low.ln(), high.ln())).exp()
    }

    fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index")]
        let index = (self.unit() * from.len() as f64) as usize;
        from[index]
    }
}

fn random_belt(random: &mut Random) -> (Belt, Start) {
    let scale = random.decades(1e-7, 1e3);
    let static_coefficient = random.between(0.05, 1.2);
    let minimum = static_coefficient * random.pick(&[0.0, 0.3, 0.7, 0.95, 1.0]);
    let reference = scale * random.decades(0.02, 3.0);
    let law = random.pick(LawKind::NUMERIC);
    let values = match law {
        LawKind::Coulomb => vec![minimum, static_coefficient, 0.03 / scale],
        LawKind::StribeckExponential => {
            let exponent = random.pick(&[1.0, 2.0, 3.0, 4.0]);
            vec![minimum, static_coefficient, reference, exponent, 0.03 / scale]
        }
        _ => vec![static_coefficient, minimum, reference],
    };
    let friction: Friction = law.build(&values).expect("valid law");
    let mut left = scale;
    let count = random.pick(&[0, 1, 1, 1, 2, 3]);
    let dithers = (0..count)
        .map(|_| {
            let direction = random.pick(Direction::ALL);
            let amplitude = match direction {
                Direction::Tangential => scale * random.decades(1e-3, 10.0),
                // The full load now and then: N then touches zero.
                Direction::Normal => left * random.pick(&[0.1, 0.5, 1.0]),
            };
            if direction == Direction::Normal {
                // Rounded down: all of them together may not exceed the load.
                left = ((left - amplitude) * (1.0 - f64::EPSILON)).max(0.0);
            }
            Dither {
                direction,
                waveform: random.pick(Waveform::ALL),
                amplitude,
                frequency_ratio: random.pick(&[1.0, 2.0, 3.3, 10.0, 10.0, 47.0]),
                phase: random.pick(&[0.0, 0.0, 1.0, -2.0]),
            }
        })
        .collect();
    let damping = random.pick(&[0.0, 0.005, 0.05, 0.3, 1.5]);
    let velocity = random.pick(&[0.0, 0.05, 0.3, 1.0]) * scale;
    let belt = Belt::new(damping, scale, velocity, friction, dithers).expect("valid belt");
    let anywhere = scale * random.between(-1.0, 1.0);
    let start = Start {
        time: random.pick(&[0.0, 0.0, 12.5, 1e4]),
        displacement: scale * random.between(-2.0, 2.0),
        velocity: random.pick(&[0.0, velocity, anywhere]),
    };
    (belt, start)
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

#[test]
fn a_million_random_steps_close_the_balance_of_work() {
    let mut random = Random(2005);
    let (mut steps, mut runs, mut worst) = (0, 0, BTreeMap::new());
    while steps < STEPS {
        let (belt, start) = random_belt(&mut random);
        let fastest =
            belt.dithers().iter().fold(1.0_f64, |rate, dither| rate.max(dither.frequency_ratio));
        let until = start.time + 400.0 / fastest;
        let mut balance = Balance { belt: &belt, fastest, steps: 0, worst: 0.0, end: start.time };
        let end = simulate(&belt, start, until, TOLERANCE, &mut balance)
            .unwrap_or_else(|stalled| panic!("{stalled}\n{belt:?}\n{start:?}"));
        assert_eq!(end.time, until);
        // The segments join without a gap; the last addition may round.
        assert!((balance.end - until).abs() <= f64::EPSILON * until);
        assert!(end.displacement.is_finite() && end.velocity.is_finite());
        assert!(
            balance.worst < RESIDUAL,
            "residual {:.1} tolerances\n{belt:?}\n{start:?}",
            balance.worst
        );
        let of_law = worst.entry(belt.friction().kind().name()).or_insert(0.0_f64);
        *of_law = of_law.max(balance.worst);
        steps += balance.steps;
        runs += 1;
    }
    println!("{steps} steps in {runs} runs, largest residual in tolerances, by law: {worst:.1?}");
}
