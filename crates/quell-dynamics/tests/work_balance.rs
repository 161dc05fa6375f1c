//! A million random steps of valid parameters: no panic, no NaN, no endless loop, and the balance of work closes on every
//! one of them (`shared/balance.rs`).

use std::collections::BTreeMap;

use quell_dynamics::simulation::Start;
use quell_model::{Belt, Direction, Dither, Friction, LawKind, Waveform};

#[path = "shared/balance.rs"]
mod balance;

use balance::balanced;

/// Steps in all.
const STEPS: u64 = 1_000_000;

/// Largest residual of one segment, in units of TOLERANCE · F · (largest speed or length).
/// The last retained term is below TOLERANCE·F; what a step leaves out is of its order, and
/// rounding of the sums adds a few hundred ε.
const RESIDUAL: f64 = 30.0;

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
    let laws: Vec<LawKind> =
        LawKind::NUMERIC.iter().copied().filter(|law| !law.has_state()).collect();
    let law = random.pick(&laws);
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
                // Sometimes the full load: N then reaches zero.
                Direction::Normal => left * random.pick(&[0.1, 0.5, 1.0]),
            };
            if direction == Direction::Normal {
                // Rounded down: all of them together may not exceed the load.
                left = ((left - amplitude) * (1.0 - f64::EPSILON)).max(0.0);
            }
            Dither {
                direction,
                waveform: Waveform::NAMED[random.pick(&[0, 1, 2])].clone(),
                amplitude,
                frequency_ratio: random.pick(&[1.0, 2.0, 3.3, 10.0, 10.0, 47.0]),
                phase: random.pick(&[0.0, 0.0, 1.0, -2.0]),
                envelope: None,
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

#[test]
fn a_million_random_steps_close_the_balance_of_work() {
    let mut random = Random(2005);
    let (mut steps, mut runs, mut worst) = (0, 0, BTreeMap::new());
    while steps < STEPS {
        let (belt, start) = random_belt(&mut random);
        let fastest =
            belt.dithers().iter().fold(1.0_f64, |rate, dither| rate.max(dither.frequency_ratio));
        let balanced = balanced(&belt, start, start.time + 400.0 / fastest, RESIDUAL);
        let of_law = worst.entry(belt.friction().kind().name()).or_insert(0.0_f64);
        *of_law = of_law.max(balanced.worst);
        steps += balanced.steps;
        runs += 1;
    }
    println!("{steps} steps in {runs} runs, largest residual in tolerances, by law: {worst:.1?}");
}
