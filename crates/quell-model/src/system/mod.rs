//! A linear structure with friction contacts and inputs: what every kind of study describes.
//!
//! ```text
//! M q̈ + C q̇ + K q = p + Σ_j b_j u_j(t) + Σ_c [ t_c T_c + n_c (T_c s_cᵀq − (N_c − N₀_c)) ]
//! ```
//!
//! or ẋ = A x + p + Σ_j b_j u_j(t) + Σ_c g_c T_c with γ_c = v_c(t) − t_cᵀx, where the structure comes with controllers.
//!
//! A belt is the case n = 1, one contact with t = 1, M = K = 1, C = 2ζ; a disc is its modes in the frame of the loads with a
//! contact at every load ([`Parametrisation::system`]).
//!
//! [`Parametrisation::system`]: crate::Parametrisation::system

mod contact;
mod input;
mod mass;
mod structure;

pub use contact::Contact;
pub use input::{Input, InputTarget};
pub use mass::MassMatrix;
pub use structure::{Mechanical, StateSpace, Structure};

/// A structure, its contacts and its inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct System {
    /// The linear structure.
    pub structure: Structure,
    /// The friction contacts.
    pub contacts: Vec<Contact>,
    /// What enters from outside.
    pub inputs: Vec<Input>,
}
