//! The tests of motions, orbits and attractors.
//!
//! One program: each links the whole workspace, and its tests share the processors.

mod actuator_in_series;
mod attractors;
mod averaging_errata;
#[path = "shared/orbits.rs"]
mod belt_orbits;
mod branch_thresholds;
mod contact_states;
mod criticality;
mod curves;
mod cycles;
mod disc_at_varying_speed;
mod isocline;
mod judge;
mod lengths;
mod load_over_time;
mod lyapunov;
mod measured_friction;
mod motion_energy;
mod motion_errata;
mod motion_refusals;
mod one_mass;
mod orbits;
mod own_laws;
mod reasons;
mod reference_trajectories;
mod response;
mod side_by_side;
mod sliders_at_rest;
mod state_variation;
mod threshold_windows;
mod traps;
mod work_balance;

use quell_dynamics::orbit::{BranchEnding, SystemAt, Threshold, branch_thresholds};
use quell_dynamics::response::{ResponsePlan, Solver, SteadyResponse, respond};
use quell_dynamics::simulation::Start;
use quell_model::Belt;
use quell_numerics::interval::RealInterval;

/// Every threshold of the base response, whose branch must not be lost.
fn local_thresholds(at: &SystemAt<'_>, window: RealInterval, steps: u32) -> Vec<Threshold> {
    let found = branch_thresholds(at, window.lower, window.upper, steps, None).expect("a response");
    let is_lost =
        matches!(found.ending, BranchEnding::Lost { .. } | BranchEnding::LostTurning { .. });
    assert!(!is_lost, "{:?}", found.ending);
    found.thresholds
}

/// The steady response of a belt from a start.
fn response_of(belt: &Belt, start: Start, solver: &Solver) -> SteadyResponse {
    respond(&belt.system(), &start.into(), &ResponsePlan::from(solver)).expect("no stall")
}
