//! Deflection under a static load: closed forms, and the critical speed.

use quell_disc::static_load::{critical_speeds, deflections};
use quell_model::Disc;
use quell_model::disc::{Contributions, DiscDither, Load, Mode, Patch};

fn disc(load: Load, damping: f64, speed: f64) -> Disc {
    let shapes = [(0, 1.771_548, 0.658_8), (1, 1.807_665, 0.933_1), (2, 2.0, 0.934_7)];
    let mode =
        |(diameters, ratio, shape_at_load)| Mode { diameters, ratio, shape_at_load, damping };
    Disc::new(shapes.map(mode).to_vec(), vec![load], DiscDither::None, speed).expect("valid")
}

fn pressed(mut load: Load) -> Load {
    load.static_load = 0.02;
    load
}

fn deflection(disc: &Disc) -> f64 {
    deflections(disc, Contributions::ALL).expect("finite").expect("an equilibrium")[0]
}

/// Σ P φ²/(β² − q²Ω²) of the free disc, and springs in series with its compliance.
#[test]
fn compliances_of_the_modes_add_up() {
    for speed in [0.0, 0.4, 0.9, 1.2] {
        let free = disc(pressed(Load::new(0.3, 0.2, 0.0, 0.0)), 0.0, speed);
        let compliance: f64 = free
            .modes()
            .iter()
            .map(|mode| {
                let turn = mode.diameters as f64 * speed;
                mode.shape_at_load.powi(2) / (mode.ratio * mode.ratio - turn * turn)
            })
            .sum();
        assert!((deflection(&free) - 0.02 * compliance).abs() < 1e-14, "{speed}");
        let sprung = disc(pressed(Load::new(0.3, 0.2, 0.7, 0.0)), 0.0, speed);
        let expected = 0.02 * compliance / (1.0 + 0.7 * compliance);
        assert!((deflection(&sprung) - expected).abs() < 1e-14, "{speed}");
    }
    let narrow =
        disc(pressed(Load::new(0.0, 0.0, 0.7, 0.3)).over(Patch::sector(1e-5, 3)), 0.0, 0.4);
    let point = disc(pressed(Load::new(0.0, 0.0, 0.7, 0.3)), 0.0, 0.4);
    assert!((deflection(&narrow) - deflection(&point)).abs() < 1e-11);
}

#[test]
fn only_damping_bounds_the_deflection_at_a_critical_speed() {
    let load = || pressed(Load::new(0.1, 0.1, 0.0, 0.0));
    let undamped = disc(load(), 0.0, 1.0);
    assert_eq!(deflections(&undamped, Contributions::ALL), Ok(None));
    let at = |damping: f64| deflection(&disc(load(), damping, 1.0)).abs();
    let rest = deflection(&disc(load(), 0.0, 0.0));
    // The deflection at the load itself stays finite: the damped wave leans by a quarter of a wave.
    assert!(at(1e-3) < 100.0 * rest && at(1e-3) > 0.0);
    let near = disc(load(), 0.0, 0.99);
    assert!(deflection(&near) > 10.0 * rest);
    let found = critical_speeds(&near);
    let speeds: Vec<f64> = found.iter().map(|critical| critical.speed).collect();
    assert_eq!(speeds, [1.0, 1.807_665]);
    assert!(found[0].is_near() && !found[1].is_near());
    assert!((found[0].amplification - 1.0 / (1.0 - 0.99f64.powi(2))).abs() < 1e-10);
    assert!(critical_speeds(&undamped)[0].amplification.is_infinite());
}
