//! The time of a map of exact verdicts: the base responses of two systems of two masses on two contacts over dither amplitude and belt
//! velocity.
//!
//! `cargo run --release --package quell-dynamics --example verdict_map -- 20` prints one JSON line for each system and 20 × 20 points:
//! milliseconds per point, and the number of points with each verdict. With a second argument it also prints every point.

use std::time::Instant;

use quell_dynamics::orbit::{Orbit, OrbitVerdict, base_response};
use quell_model::friction::Friction;
use quell_model::profile::{Profile, Wave};
use quell_model::system::{Contact, Input, InputTarget, MassMatrix, Mechanical};
use quell_model::{LawKind, System, Waveform};
use quell_numerics::matrix::Matrix;

/// Steps of the continuation, as `quell map` takes them.
const STEPS: u32 = 8;

/// Two masses of 1 joined by a spring of 1.2 on surfaces of the same velocity, with dither of ω = 10.
struct TwoMasses {
    name: &'static str,
    /// Stiffness of the second mass; that of the first is 2.2.
    stiffness: f64,
    laws: [(LawKind, [f64; 3]); 2],
    /// Row of the dither.
    dither: [f64; 2],
    /// Axes of the map: dither amplitude and belt velocity.
    amplitudes: (f64, f64),
    velocities: (f64, f64),
}

const SYSTEMS: [TwoMasses; 2] = [
    TwoMasses {
        name: "dither on one mass, Stribeck law",
        stiffness: 2.2,
        laws: [(LawKind::Stribeck, [0.4, 0.2857, 0.2]); 2],
        dither: [1.0, 0.0],
        amplitudes: (0.02, 1.5),
        velocities: (0.02, 0.3),
    },
    TwoMasses {
        name: "dither on both masses, decreasing laws",
        stiffness: 2.5,
        laws: [(LawKind::Decreasing, [0.4, 0.2, 0.15]), (LawKind::Decreasing, [0.5, 0.2, 0.2])],
        dither: [1.0, 0.8],
        amplitudes: (0.05, 3.0),
        velocities: (0.03, 0.3),
    },
];

impl TwoMasses {
    fn system(&self, amplitude: f64, velocity: f64) -> System {
        let stiffness = Matrix::from_fn(2, 2, |i, j| match (i, j) {
            (0, 0) => 2.2,
            (1, 1) => self.stiffness,
            _ => -1.2,
        });
        let damping = Matrix::from_fn(2, 2, |i, j| if i == j { 0.02 } else { 0.0 });
        let names = ["x", "y"].map(str::to_owned).to_vec();
        let mass = MassMatrix::dense(Matrix::identity(2));
        let wave = Wave {
            waveform: Waveform::Sine,
            amplitude,
            frequency: 10.0,
            phase: 0.0,
            envelope: None,
        };
        let contact = |place: usize| {
            let (law, values) = &self.laws[place];
            let friction: Friction = law.build(values).expect("valid law");
            Contact {
                name: format!("pad {place}"),
                tangent: Some((0..2).map(|i| f64::from(u8::from(i == place))).collect()),
                force: None,
                normal: None,
                slope: None,
                normal_load: 1.0,
                normal_stiffness: 0.0,
                tangential_stiffness: None,
                normal_damping: 0.0,
                surface_velocity: Profile::constant(velocity),
                friction,
                varying_load: None,
            }
        };
        System {
            structure: Mechanical::new(names, mass, damping, stiffness).into(),
            contacts: (0..2).map(contact).collect(),
            inputs: vec![Input {
                target: InputTarget::Force(self.dither.to_vec()),
                profile: Profile::default().with(wave),
            }],
        }
    }
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let points: u32 = arguments.next().and_then(|count| count.parse().ok()).unwrap_or(10);
    let prints = arguments.next().is_some();
    let at = |(from, to): (f64, f64), place: u32| {
        from + (to - from) * f64::from(place) / f64::from((points - 1).max(1))
    };
    for masses in &SYSTEMS {
        // Stable, unstable, undecided, without a base response.
        let mut counts = [0_u32; 4];
        let mut slowest: f64 = 0.0;
        let begin = Instant::now();
        for (i, j) in (0..points).flat_map(|i| (0..points).map(move |j| (i, j))) {
            let (amplitude, velocity) = (at(masses.amplitudes, i), at(masses.velocities, j));
            let since = Instant::now();
            let found = base_response(&masses.system(amplitude, velocity), STEPS);
            let took = since.elapsed().as_secs_f64();
            slowest = slowest.max(took);
            let place = match &found {
                Ok(orbit) => match orbit.verdict() {
                    OrbitVerdict::Stable => 0,
                    OrbitVerdict::Unstable => 1,
                    OrbitVerdict::Undecided => 2,
                },
                Err(_) => 3,
            };
            counts[place] += 1;
            if prints {
                let radius = found.as_ref().map_or(f64::NAN, Orbit::radius);
                println!("{amplitude:.6} {velocity:.6} {place} {radius:.13} {:.3} ms", 1e3 * took);
            }
        }
        let each = 1e3 * begin.elapsed().as_secs_f64() / f64::from(points * points);
        let [stable, unstable, undecided, none] = counts;
        println!(
            "{{\"system\": \"{}\", \"points\": {}, \"ms_per_point\": {each:.3}, \"slowest_ms\": {:.1}, \"stable\": {stable}, \
             \"unstable\": {unstable}, \"undecided\": {undecided}, \"no_base_response\": {none}}}",
            masses.name,
            points * points,
            1e3 * slowest
        );
    }
}
