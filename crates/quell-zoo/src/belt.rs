//! Belts.

use std::borrow::Borrow;

use quell_model::{
    Belt, Dither, Friction, InvalidValues, LawKind, RefusedNumbers, System, Waveform,
};

use crate::dither::{normal, tangential};
use crate::{NamedModel, law};

/// Damping ratio ζ of the dissertation.
pub const DAMPING_RATIO: f64 = 0.005;

/// Belt velocity v₀ of figures 2.3 and 3.9.
pub const VELOCITY: f64 = 0.05;

/// Variations of a belt.
pub trait BeltExt: Sized {
    /// The same belt with one more dither.
    #[must_use]
    fn with_dither(&self, dither: Dither) -> Self;
    /// The same belt with these dithers instead of its own.
    #[must_use]
    fn with_dithers(&self, dithers: Vec<Dither>) -> Self;
    /// The same belt at another belt velocity v₀.
    #[must_use]
    fn at_speed(&self, belt_velocity: f64) -> Self;
    /// The same belt with another damping ratio ζ.
    #[must_use]
    fn damped(&self, damping_ratio: f64) -> Self;
    /// The same belt with another number of its law, by its path in the registry.
    #[must_use]
    fn with_law_number(&self, path: &str, value: f64) -> Self;
    /// The same belt with every length and velocity multiplied by `factor`.
    #[must_use]
    fn scaled(&self, factor: f64) -> Self;
}

/// The belt over the amplitude of its first dither.
pub fn over_amplitudes(belt: &Belt) -> impl Fn(&[f64]) -> Result<System, RefusedNumbers> {
    |values| as_system(belt.with_amplitude(0, values[0]))
}

/// The belt over its velocity.
pub fn over_velocities(belt: &Belt) -> impl Fn(&[f64]) -> Result<System, RefusedNumbers> {
    |values| as_system(belt.with_belt_velocity(values[0]))
}

/// The belt over the amplitude of its first dither and its velocity.
pub fn over_amplitude_and_velocity(
    belt: &Belt,
) -> impl Fn(&[f64]) -> Result<System, RefusedNumbers> {
    |values| as_system(belt.with_belt_velocity(values[1])?.with_amplitude(0, values[0]))
}

fn as_system(belt: Result<Belt, InvalidValues>) -> Result<System, RefusedNumbers> {
    Ok(belt?.system())
}

impl BeltExt for Belt {
    fn with_dither(&self, dither: Dither) -> Self {
        let mut dithers = self.dithers().to_vec();
        dithers.push(dither);
        self.with_dithers(dithers)
    }

    fn with_dithers(&self, dithers: Vec<Dither>) -> Self {
        let friction = self.friction().clone();
        valid(Self::new(
            self.damping_ratio(),
            self.normal_load(),
            self.belt_velocity(),
            friction,
            dithers,
        ))
    }

    fn at_speed(&self, belt_velocity: f64) -> Self {
        valid(self.with_belt_velocity(belt_velocity))
    }

    fn damped(&self, damping_ratio: f64) -> Self {
        valid(self.with_damping_ratio(damping_ratio))
    }

    fn with_law_number(&self, path: &str, value: f64) -> Self {
        valid(self.friction().with(path, value).and_then(|law| self.with_friction(law)))
    }

    fn scaled(&self, factor: f64) -> Self {
        let longer =
            |dither: &Dither| Dither { amplitude: factor * dither.amplitude, ..dither.clone() };
        let mut belt = valid(Self::new(
            self.damping_ratio(),
            factor * self.normal_load(),
            factor * self.belt_velocity(),
            law::scaled(self.friction(), factor),
            self.dithers().iter().map(longer).collect(),
        ));
        if let Some(drive) = self.drive() {
            belt = valid(belt.driven(drive.scaled(factor)));
        }
        if let Some(load) = self.load() {
            belt = valid(belt.loaded(load.scaled(factor)));
        }
        // k_t/k is a ratio.
        valid(belt.with_tangential_stiffness(self.tangential_stiffness()))
    }
}

fn valid(belt: Result<Belt, InvalidValues>) -> Belt {
    belt.unwrap_or_else(|why| panic!("an invalid belt: {why:?}"))
}

/// A belt with F = 1.
///
/// # Panics
/// On values out of bounds.
pub fn belt(
    damping_ratio: f64,
    belt_velocity: f64,
    law: impl Borrow<Friction>,
    dithers: Vec<Dither>,
) -> Belt {
    valid(Belt::new(damping_ratio, 1.0, belt_velocity, law.borrow().clone(), dithers))
}

/// A belt with F = 1 without dither.
///
/// # Panics
/// On values out of bounds.
pub fn undithered_belt(damping_ratio: f64, belt_velocity: f64, law: impl Borrow<Friction>) -> Belt {
    belt(damping_ratio, belt_velocity, law, Vec::new())
}

/// The dissertation's belt with one of its laws: ζ = 0.005, F = 1, v₀ = 0.05.
///
/// # Panics
/// On a law that is not the dissertation's.
pub fn dissertation(kind: LawKind) -> Belt {
    with_law(law::dissertation(kind))
}

/// The dissertation's belt with any law: ζ = 0.005, F = 1, v₀ = 0.05.
///
/// # Panics
/// On a law that is invalid on this belt.
pub fn with_law(law: impl Borrow<Friction>) -> Belt {
    undithered_belt(DAMPING_RATIO, VELOCITY, law)
}

/// Figure 2.3: ζ = 0.005, F = 1, v₀ = 0.05, (2.7) with μ_s = 0.4, μ_m = 0.2857, v_m = 0.2.
pub fn stribeck() -> Belt {
    dissertation(LawKind::Stribeck)
}

/// Figure 2.10: as [`stribeck`], with (2.8) at v₀ = 1, where stable sliding coexists with a stick-slip cycle.
pub fn decreasing() -> Belt {
    dissertation(LawKind::Decreasing).at_speed(1.0)
}

/// Figure 2.3 or 3.9: [`stribeck`] under tangential dither with R = 10.
///
/// # Panics
/// On an amplitude out of bounds.
pub fn stribeck_under(waveform: Waveform, amplitude: f64) -> Belt {
    stribeck().with_dither(tangential(waveform, amplitude, 10.0))
}

/// Figure 2.10: [`decreasing`] under tangential dither with R = 10.
///
/// # Panics
/// On an amplitude out of bounds.
pub fn decreasing_under(waveform: Waveform, amplitude: f64) -> Belt {
    decreasing().with_dither(tangential(waveform, amplitude, 10.0))
}

/// Figure 4.11: (2.8), ζ = 0.2, v₀ = 0.075, meant for normal dither with R = 5.
pub fn chapter_4() -> Belt {
    undithered_belt(0.2, 0.075, law::decreasing())
}

/// Every belt without dither.
pub fn undithered() -> Vec<NamedModel<Belt>> {
    let mut belts = vec![
        NamedModel::new("stribeck belt", "figure 2.3", stribeck()),
        NamedModel::new("decreasing belt", "figure 2.10", decreasing()),
        NamedModel::new("chapter 4 belt", "figure 4.11", chapter_4()),
    ];
    let velocities = [
        ("coulomb", 0.05, 0.3),
        ("coulomb with a static level", 0.02, 0.1),
        ("stribeck-exponential", 0.05, 0.25),
        ("expression", 0.25, 0.3),
        ("samples", 0.1, 0.3),
    ];
    for named in law::all() {
        let chosen = velocities.iter().find(|(name, ..)| *name == named.name);
        if let Some(&(name, damping_ratio, velocity)) = chosen {
            let belt = undithered_belt(damping_ratio, velocity, named.model);
            belts.push(NamedModel::new(format!("{name} belt"), named.source, belt));
        }
    }
    belts
}

/// Every belt: each of [`undithered`] alone, with a tangential and with a normal dither of each waveform, and with both.
pub fn all_belts() -> Vec<NamedModel<Belt>> {
    let mut all = Vec::new();
    for base in undithered() {
        // Tangential dither that reaches the belt's velocity about half way, and normal dither of half the load.
        let reach = base.model.belt_velocity();
        let mut add = |name: String, dithers: Vec<Dither>| {
            all.push(NamedModel::new(name, base.source, base.model.with_dithers(dithers)));
        };
        add(base.name.clone(), Vec::new());
        for waveform in Waveform::NAMED {
            let dither = tangential(waveform.clone(), 10.0 * 0.5 * reach, 10.0);
            add(format!("{} + tangential {}", base.name, waveform.name()), vec![dither]);
            let dither = normal(waveform.clone(), 0.5, 5.0);
            add(format!("{} + normal {}", base.name, waveform.name()), vec![dither]);
        }
        let both = vec![
            tangential(Waveform::Sine, 10.0 * 0.8 * reach, 10.0),
            normal(Waveform::Square, 0.4, 5.0),
        ];
        add(format!("{} + both", base.name), both);
    }
    all
}
