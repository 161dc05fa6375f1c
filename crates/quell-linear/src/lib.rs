//! Linear questions about structures with friction contacts: pure functions of valid values.
//!
//! * [`linearised`]: steady sliding of any system and the equations of small motions about it;
//! * [`eigenvalues`], [`floquet`]: growth rates with bounds, without and with dither of the friction forces;
//! * [`criticality`]: whether the vibration beyond a Hopf bifurcation of steady sliding grows from zero, or jumps;
//! * [`growth`]: growth rate, its error and the verdict that they allow;
//! * [`spectrum`], [`rigid`]: every small motion with its shape; rigid motions of free structures, each once;
//! * [`receptance`]: displacement over force between rows, with the contacts in a given state;
//! * [`patch`]: few contacts that stand for a surface of many;
//! * [`driven_point`]: the motion of the point on which a dither acts;
//! * [`linear_cost`]: stroke, velocity and power of a dither on the structure of one mass without friction;
//! * [`input_cost`]: the same of any sliding system at the driven point;
//! * [`periodic_response`]: what any wave does to a linear structure, exactly;
//! * [`series_actuator`]: stroke and power of normal dither through the spring of a contact;
//! * [`averaging`]: effective friction under fast dither, stability of steady sliding, critical amplitudes, of one mass.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod averaging;
pub mod critical_slopes;
pub mod criticality;
pub mod driven_point;
pub mod eigenvalues;
pub mod floquet;
pub mod growth;
pub mod harmonic;
pub mod input_cost;
pub mod linear_cost;
pub mod linearised;
pub mod measured;
pub mod patch;
pub mod periodic_response;
pub mod pure_slip;
pub mod receptance;
pub mod rigid;
pub mod series_actuator;
pub mod spectrum;
pub mod steady;
pub mod tracking;
