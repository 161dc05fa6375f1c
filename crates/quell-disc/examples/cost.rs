//! Time per point against the number of modes N = (N_r, N_θ), up to (4, 12).
//!
//! `cargo run --release --package quell-disc --example cost` prints one line of CSV per mode set: number of states, time in µs of
//! one growth rate with its error bound without dither, and time in µs of one Floquet exponent with its error bound (normal
//! dither, α = 1, R = 2.7). Of several passes over a few points the fastest counts, in processor time, because other work on the
//! machine can only slow a pass down.

#[path = "clock/mod.rs"]
mod clock;

use std::hint::black_box;

use quell_disc::dithered;
use quell_disc::equations::linearised;
use quell_disc::plate::{ModeSet, Plate, Reference};
use quell_linear::eigenvalues;
use quell_model::Disc;
use quell_model::disc::Contributions;
use quell_model::disc::{DiscDither, Load, Mode};
use quell_numerics::floquet::Effort;

/// Passes over the points.
const PASSES: u32 = 5;

/// Number of frictions, one per point.
const FRICTIONS: usize = 8;

const SPEED: f64 = 0.37;

fn modes(radial: usize, diameters: u32) -> Vec<Mode> {
    let plate = Plate::new(0.5, 0.3).expect("valid");
    let set = ModeSet::new(&plate, radial, diameters, Reference::Critical);
    set.expect("modes with a critical speed").at_radius(0.75, 1e-4).expect("on the plate")
}

fn disc(modes: &[Mode], dither: DiscDither) -> Disc {
    let load = Load::new(0.3, 0.3, 0.3, 1.0);
    Disc::new(modes.to_vec(), vec![load], dither, SPEED).expect("valid")
}

/// Time of the fastest pass, in µs per point.
fn fastest(mut point: impl FnMut(f64)) -> f64 {
    let mut fastest = f64::INFINITY;
    for _ in 0..PASSES {
        let began = clock::seconds();
        for index in 0..FRICTIONS {
            point(0.02 + 0.07 * index as f64);
        }
        fastest = fastest.min(clock::seconds() - began);
    }
    1e6 * fastest / FRICTIONS as f64
}

fn main() {
    println!("radial_modes,nodal_diameters,states,eigenvalues_us,exponents_us");
    let sets = [(1, 1), (1, 2), (1, 4), (2, 5), (2, 8), (3, 8), (3, 10), (3, 12), (4, 12)];
    for (radial, diameters) in sets {
        let modes = modes(radial, diameters);
        let system =
            linearised(&disc(&modes, DiscDither::None), Contributions::ALL).expect("finite");
        let eigenvalues = fastest(|friction| {
            black_box(eigenvalues::growth(&system, &[friction]).expect("finite"));
        });
        let dither = DiscDither::Normal { amplitude: 1.0, frequency_ratio: 2.7 };
        let prepared =
            dithered::prepared(&disc(&modes, dither)).expect("finite").expect("dithered");
        let exponents = fastest(|friction| {
            black_box(prepared.exponent(friction, Effort::default()).expect("finite"));
        });
        let states = 2 * system.coordinates();
        println!("{radial},{diameters},{states},{eigenvalues:.1},{exponents:.1}");
    }
}
