//! Orbits of belts.

use quell_dynamics::attractor::{MotionKind, end_of_run};
use quell_dynamics::orbit::{FreeEnd, NoOrbit, Orbit, free_end, near};
use quell_dynamics::simulation::{Start, Variation, simulate};
use quell_model::Belt;

/// The orbit near a state.
pub(crate) fn orbit_near(belt: &Belt, guess: Start, periods: u32) -> Result<Orbit, NoOrbit> {
    near(&belt.system(), &[guess.displacement, guess.velocity], periods)
}

/// The orbit on which a run ends, by the judge of runs; or what it ends on instead.
pub(crate) fn orbit_reached(belt: &Belt, start: Start) -> Result<Orbit, String> {
    let state = [start.displacement, start.velocity];
    let end = end_of_run(&belt.system(), &[1.0], &state).map_err(|why| why.to_string())?;
    match end.attractor.kind {
        MotionKind::Periodic { periods, .. } => {
            near(&belt.system(), &end.attractor.state, periods).map_err(|why| why.to_string())
        }
        MotionKind::Cycle { .. } => match free_end(belt, start) {
            Ok(FreeEnd::Cycle(cycle)) => Ok(cycle),
            other => Err(format!("{other:?}")),
        },
        kind => Err(format!("{kind:?}")),
    }
}

/// The start of an orbit of a belt.
pub(crate) fn start_of(orbit: &Orbit) -> Start {
    Start::of_state(&orbit.state)
}

/// What is met along a period of an orbit.
pub(crate) fn along<'a>(belt: &'a Belt, orbit: &Orbit) -> Variation<'a> {
    let mut variation = Variation::new(belt);
    simulate(belt, start_of(orbit), orbit.period, 1e-14, &mut variation).expect("no stall");
    variation
}

/// The derivative of the period map of an orbit of a belt.
pub(crate) fn monodromy(orbit: &Orbit) -> [[f64; 2]; 2] {
    let matrix = orbit.monodromy.as_ref().expect("a period of the dither");
    [0, 1].map(|i| [0, 1].map(|j| matrix[(i, j)]))
}
