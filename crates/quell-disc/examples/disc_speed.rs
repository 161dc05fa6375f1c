//! Time per point of a stability map of the disc, with and without dither.
//!
//! `cargo run --release --package quell-disc --example disc_speed` prints one line of JSON; `benches/peers/compare_disc.py` runs
//! it alongside NumPy and prints the ratios. Each workload is repeated and the fastest pass counts, in processor time, because
//! other work on the machine can only slow a pass down.

#[path = "clock/mod.rs"]
mod clock;

use std::hint::black_box;

use quell_disc::dithered;
use quell_disc::equations::linearised;
use quell_linear::linearised::Linearised;
use quell_model::Disc;
use quell_model::disc::Contributions;
use quell_model::disc::{DiscDither, Load, Mode};
use quell_numerics::eigen::eigenvalues;
use quell_numerics::floquet::Effort;

/// Passes over a workload.
const PASSES: u32 = 30;

/// (q, β, φ(r₀)) of b/a = 0.5, r₀/a = 0.75, ν = 0.3, N = (1,2).
const SMALL: [(usize, f64, f64); 3] = [
    (0, 1.7715482549454453, 0.65875445677796),
    (1, 1.8076647041409195, 0.933051069689499),
    (2, 2.0, 0.934699921735261),
];

/// The same for N = (2,5).
const LARGE: [(usize, f64, f64); 12] = [
    (0, 2.10498834135328, 0.65875445677796),
    (1, 2.147902613812594, 0.933051069689499),
    (2, 2.3764391802221647, 0.934699921735261),
    (3, 3.0, 0.930869380030987),
    (4, 4.136811657377203, 0.916799457181122),
    (5, 5.774719287102873, 0.890682598473148),
    (0, 13.743057339280387, -1.43103252071965),
    (1, 14.01344958049745, -2.02319009033238),
    (2, 14.826776768417763, -2.02260542893234),
    (3, 16.1891255259296, -2.02464786168498),
    (4, 18.109525779611632, -2.03147634566082),
    (5, 20.59801190109086, -2.04368782383033),
];

/// Numbers of speeds and frictions of the maps.
const SPEEDS: usize = 10;
const FRICTIONS: usize = 20;

fn disc(modes: &[(usize, f64, f64)], dither: DiscDither, speed: usize) -> Disc {
    let modes = modes
        .iter()
        .map(|&(diameters, ratio, shape_at_load)| Mode {
            diameters,
            ratio,
            shape_at_load,
            damping: 1e-4,
        })
        .collect();
    let speed = 0.05 + 0.09 * speed as f64;
    Disc::new(modes, vec![Load::new(0.3, 0.3, 0.3, 1.0)], dither, speed)
        .expect("the workload is valid")
}

fn friction(index: usize) -> f64 {
    0.02 + 0.03 * index as f64
}

/// Time of the fastest pass over all points, in µs per point.
fn fastest(mut pass: impl FnMut()) -> f64 {
    let mut fastest = f64::INFINITY;
    for _ in 0..PASSES {
        let began = clock::seconds();
        pass();
        fastest = fastest.min(clock::seconds() - began);
    }
    1e6 * fastest / (SPEEDS * FRICTIONS) as f64
}

fn equations(disc: &Disc) -> Linearised {
    linearised(disc, Contributions::ALL).expect("finite")
}

fn main() {
    // The argument `1_2` or `2_5` runs only one of the two mode sets.
    let only = std::env::args().nth(1);
    let mut fields = Vec::new();
    for (name, modes) in [("1_2", &SMALL[..]), ("2_5", &LARGE[..])] {
        if only.as_deref().is_some_and(|only| only != name) {
            continue;
        }
        let systems: Vec<Linearised> =
            (0..SPEEDS).map(|speed| equations(&disc(modes, DiscDither::None, speed))).collect();
        let matrices: Vec<_> = systems
            .iter()
            .flat_map(|system| (0..FRICTIONS).map(|f| system.state_matrix(&[friction(f)])))
            .collect();
        let values = fastest(|| {
            for matrix in &matrices {
                black_box(eigenvalues(matrix).expect("finite"));
            }
        });
        fields.push((format!("eigenvalues_{name}"), values));
        let growth = fastest(|| {
            for speed in 0..SPEEDS {
                let system = equations(&disc(modes, DiscDither::None, speed));
                for f in 0..FRICTIONS {
                    black_box(
                        quell_linear::eigenvalues::growth(&system, &[friction(f)]).expect("finite"),
                    );
                }
            }
        });
        fields.push((format!("growth_with_bound_{name}"), growth));
        for (kind, dither) in [
            ("normal", DiscDither::Normal { amplitude: 1.0, frequency_ratio: 2.7 }),
            ("tangential", DiscDither::Tangential { amplitude: 1.0, frequency_ratio: 2.7 }),
        ] {
            let exponents = fastest(|| {
                for speed in 0..SPEEDS {
                    let disc = dithered::prepared(&disc(modes, dither, speed)).expect("finite");
                    let disc = disc.expect("dithered");
                    for f in 0..FRICTIONS {
                        black_box(disc.exponent(friction(f), Effort::default()).expect("finite"));
                    }
                }
            });
            fields.push((format!("exponents_{kind}_{name}"), exponents));
        }
    }
    let fields: Vec<String> =
        fields.iter().map(|(name, value)| format!("\"{name}\": {value:.2}")).collect();
    println!("{{{}}}", fields.join(", "));
}
