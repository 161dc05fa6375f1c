//! Periodic responses by Newton shooting: near a given state, or continued from steady sliding.

use quell_model::Belt;
use quell_numerics::continuation::branch::{End, Follow, follow};
use quell_numerics::continuation::shooting::{Shooting, fixed_point};

use super::accuracy::accuracy;
use super::family::{FamilyParameters, Forced};
use super::no_orbit::NoOrbit;
use super::period_map::{multipliers_of, shoot};
use super::periodic_orbit::Orbit;
use crate::simulation::Start;

/// The orbit of `periods` common periods near a state at τ = 0.
///
/// # Errors
/// [`NoOrbit`].
pub fn near(belt: &Belt, guess: Start, periods: u32) -> Result<Orbit, NoOrbit> {
    let forced = Forced { belt, parameters: FamilyParameters::Unchanged, periods: periods.max(1) };
    let longest = (belt.belt_velocity() / belt.normal_load()).max(1.0);
    let shooting = Shooting { longest_step: longest, ..Shooting::default() };
    let guess = [guess.displacement, guess.velocity];
    let found = fixed_point(&forced, &guess, &[], None, &shooting)?;
    orbit_at(belt, &found.state, forced.period_of(belt)?, false)
}

/// The orbit through a state that closes; `is_free` for a limit cycle without dither.
pub(super) fn orbit_at(
    belt: &Belt,
    state: &[f64],
    period: f64,
    is_free: bool,
) -> Result<Orbit, NoOrbit> {
    let start = Start::of_state(state);
    let (end, variation) = shoot(belt, start, period)?;
    let mismatch = [end.displacement - start.displacement, end.velocity - start.velocity];
    let residual = mismatch[0].abs().max(mismatch[1].abs());
    let errors = accuracy(belt, start, period, residual, &variation, is_free);
    Ok(Orbit {
        start,
        period,
        residual,
        state_error: errors.state,
        multiplier_error: errors.multiplier,
        monodromy: variation.matrix,
        multipliers: multipliers_of(&variation.matrix),
        events: variation.events,
        damping: variation.damping,
        // A run stays on its side of v_r = 0: values below are rounding at an event.
        least_slip: variation.least.map(|(least, time)| (least.max(0.0), time)),
        stick_fraction: variation.stuck / period,
        slip_sign: end.slip_sign,
        is_free,
    })
}

/// The base response: the orbit that continues steady sliding as the dither grows from zero. It is followed in the common
/// factor of all amplitudes in at least `steps` steps, around folds and through grazings of v_r = 0.
///
/// # Errors
/// [`NoOrbit::Ends`] if the branch ends before the amplitudes are reached, [`NoOrbit::LostOnTheWay`] if it is lost.
pub fn from_sliding(belt: &Belt, steps: u32) -> Result<Orbit, NoOrbit> {
    let forced = Forced { belt, parameters: FamilyParameters::CommonFactor, periods: 1 };
    let period = forced.period_of(belt)?;
    let options = Follow::window(0.0, 1.0, steps).only_forwards();
    let branch = follow(&forced, &[belt.steady_sliding(), 0.0], 0.0, true, options)?;
    // Where the branch turns back the base response ends, wherever the branch continues to.
    let fold = branch.special_points.iter().find(|point| point.is_turn());
    if let Some(fold) = fold {
        return Err(NoOrbit::Ends { share: fold.parameter });
    }
    match branch.end {
        End::Window { at: 1.0 } => {}
        End::Grazing { at } | End::TurnsBack { at } => return Err(NoOrbit::Ends { share: at }),
        End::Lost { at } | End::TooLong { at } => {
            return Err(NoOrbit::LostOnTheWay { share: at });
        }
        End::Window { .. } | End::Closed => return Err(NoOrbit::Ends { share: 0.0 }),
    }
    let last = branch.points.last().ok_or(NoOrbit::Ends { share: 0.0 })?;
    orbit_at(belt, &last.state, period, false)
}

/// The base response; without dither steady sliding itself, as the fixed point of the flow over unit time.
pub(super) fn base_response(belt: &Belt, steps: u32) -> Result<Orbit, NoOrbit> {
    if !belt.dithers().is_empty() {
        return from_sliding(belt, steps);
    }
    orbit_at(belt, &[belt.steady_sliding(), 0.0], 1.0, false)
}
