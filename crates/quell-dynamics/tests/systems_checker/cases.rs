//! Systems of the reference trajectories, copied from their study texts.

use quell_model::friction::{Coulomb, Decreasing, Friction, Stribeck};
use quell_model::profile::{Profile, Wave};
use quell_model::system::{
    Contact, Input, InputTarget, MassMatrix, Mechanical, StateSpace, Structure,
};
use quell_model::{System, Waveform};
use quell_numerics::matrix::Matrix;

/// The systems and their starts, in the order of the expected trajectories.
pub(crate) fn systems() -> Vec<(System, Vec<f64>)> {
    vec![
        two_blocks(),
        mode_coupling(),
        two_mass_drive(),
        three_blocks(),
        pid_drive(),
        coupled_by_mass(),
        modulated_load(),
        random_1598(),
        selection_133(),
        follower_force(),
    ]
}

/// A square matrix from its rows.
fn matrix(rows: &[&[f64]]) -> Matrix {
    Matrix::from_fn(rows.len(), rows.len(), |i, j| rows[i][j])
}

/// Names of coordinates or states.
fn names(size: usize) -> Vec<String> {
    (0..size).map(|i| format!("q{i}")).collect()
}

/// A structure from M, C and K.
fn mechanical(mass: Matrix, damping: Matrix, stiffness: Matrix) -> Structure {
    let names = names(mass.rows());
    Mechanical::new(names, MassMatrix::dense(mass), damping, stiffness).into()
}

/// First-order equations from A.
fn first_order(matrix: Matrix) -> Structure {
    StateSpace::new(names(matrix.rows()), matrix).into()
}

/// A constant sliding coefficient and a static one.
fn coulomb(sliding: f64, at_rest: f64) -> Friction {
    Friction::Coulomb(Coulomb::new(sliding, Some(at_rest), 0.0).expect("a law"))
}

/// The decreasing law.
fn decreasing(at_rest: f64, minimum: f64, velocity: f64) -> Friction {
    Friction::Decreasing(Decreasing::new(at_rest, minimum, velocity).expect("a law"))
}

/// The Stribeck law.
fn stribeck(at_rest: f64, minimum: f64, velocity: f64) -> Friction {
    Friction::Stribeck(Stribeck::new(at_rest, minimum, velocity).expect("a law"))
}

/// A contact with a prescribed load.
fn contact(tangent: Vec<f64>, normal_load: f64, velocity: f64, friction: Friction) -> Contact {
    Contact {
        name: "contact".to_owned(),
        tangent: Some(tangent),
        force: None,
        normal: None,
        slope: None,
        normal_load,
        normal_stiffness: 0.0,
        tangential_stiffness: None,
        normal_damping: 0.0,
        surface_velocity: Profile::constant(velocity),
        friction,
        varying_load: None,
    }
}

/// The same contact with a normal row, stiffness and damping.
fn compliant(
    contact: Contact,
    normal: Vec<f64>,
    normal_stiffness: f64,
    normal_damping: f64,
) -> Contact {
    Contact { normal: Some(normal), normal_stiffness, normal_damping, ..contact }
}

/// A sine A sin(ωt + φ) on a target.
fn sine(target: InputTarget, amplitude: f64, frequency: f64, phase: f64) -> Input {
    let wave = Wave { waveform: Waveform::Sine, amplitude, frequency, phase, envelope: None };
    Input { target, profile: Profile::constant(0.0).with(wave) }
}

/// Two blocks, static and sliding level.
fn two_blocks() -> (System, Vec<f64>) {
    let structure = mechanical(
        matrix(&[&[1.0, 0.0], &[0.0, 1.0]]),
        matrix(&[&[0.0, 0.0], &[0.0, 0.0]]),
        matrix(&[&[2.2, -1.2], &[-1.2, 2.2]]),
    );
    let c0 = contact(vec![1.0, 0.0], 1.0, 0.1, coulomb(0.25, 0.4));
    let c1 = contact(vec![0.0, 1.0], 1.0, 0.1, coulomb(0.3, 0.45));
    let system = System { structure, contacts: vec![c0, c1], inputs: vec![] };
    (system, vec![0.1, -0.05, 0.0, 0.0])
}

/// Mode coupling, static level, contact damping.
fn mode_coupling() -> (System, Vec<f64>) {
    let structure = mechanical(
        matrix(&[&[1.0, 0.0], &[0.0, 1.0]]),
        matrix(&[&[0.06, 0.0], &[0.0, 0.15]]),
        matrix(&[&[2.0, 1.0], &[1.0, 0.6666666666666667]]),
    );
    let c0 = compliant(
        contact(vec![1.0, 0.0], 1.0, 0.25, coulomb(0.95, 1.1)),
        vec![0.0, 1.0],
        1.3333333333333333,
        0.02,
    );
    let system = System { structure, contacts: vec![c0], inputs: vec![] };
    (system, vec![0.9, -0.4, 0.0, 0.0])
}

/// Two-mass drive, dither 8 with reversals.
fn two_mass_drive() -> (System, Vec<f64>) {
    let structure = mechanical(
        matrix(&[&[0.5, 0.0], &[0.0, 1.0]]),
        matrix(&[&[0.03, -0.01], &[-0.01, 0.01]]),
        matrix(&[&[5.0, -4.0], &[-4.0, 4.0]]),
    );
    let c0 = contact(vec![0.0, 1.0], 1.0, 0.05, stribeck(0.4, 0.2857, 0.2));
    let system = System {
        structure,
        contacts: vec![c0],
        inputs: vec![sine(InputTarget::Force(vec![1.0, 0.0]), 8.0, 10.0, 0.0)],
    };
    (system, vec![0.0, 0.0, 0.0, 0.0])
}

/// Three blocks, symmetric start.
fn three_blocks() -> (System, Vec<f64>) {
    let structure = mechanical(
        matrix(&[&[1.0, 0.0, 0.0], &[0.0, 1.0, 0.0], &[0.0, 0.0, 1.0]]),
        matrix(&[&[0.0, 0.0, 0.0], &[0.0, 0.0, 0.0], &[0.0, 0.0, 0.0]]),
        matrix(&[&[1.4, -1.0, 0.0], &[-1.0, 2.4, -1.0], &[0.0, -1.0, 1.4]]),
    );
    let c0 = contact(vec![1.0, 0.0, 0.0], 1.0, 0.1, coulomb(0.3, 0.5));
    let c1 = contact(vec![0.0, 1.0, 0.0], 1.0, 0.1, coulomb(0.3, 0.5));
    let c2 = contact(vec![0.0, 0.0, 1.0], 1.0, 0.1, coulomb(0.3, 0.5));
    let system = System { structure, contacts: vec![c0, c1, c2], inputs: vec![] };
    (system, vec![0.1, -0.3, 0.1, 0.0, 0.0, 0.0])
}

/// PID hunting.
fn pid_drive() -> (System, Vec<f64>) {
    let structure = first_order(matrix(&[&[0.0, 1.0, 0.0], &[0.0, 0.0, 1.0], &[-1.0, -4.0, -1.0]]));
    let c0 = Contact {
        force: Some(vec![0.0, 0.0, 1.0]),
        ..contact(vec![0.0, 0.0, 1.0], 1.0, 0.0, coulomb(0.3, 0.5))
    };
    let system = System { structure, contacts: vec![c0], inputs: vec![] };
    (system, vec![0.0, -1.0, 0.0])
}

/// Contacts coupled by the mass matrix, dithered.
fn coupled_by_mass() -> (System, Vec<f64>) {
    let structure = mechanical(
        matrix(&[&[1.0, 0.6], &[0.6, 1.2]]),
        matrix(&[&[0.02, 0.0], &[0.0, 0.03]]),
        matrix(&[&[2.0, -0.5], &[-0.5, 3.0]]),
    );
    let c0 = contact(vec![1.0, 0.0], 1.0, 0.2, coulomb(0.3, 0.45));
    let c1 = contact(vec![-0.3, 1.0], 1.2, 0.2, coulomb(0.25, 0.5));
    let system = System {
        structure,
        contacts: vec![c0, c1],
        inputs: vec![sine(InputTarget::Force(vec![1.0, 0.0]), 0.8, 3.0, 0.4)],
    };
    (system, vec![0.2, -0.3, 0.0, 0.0])
}

/// Load modulated until the contact opens.
fn modulated_load() -> (System, Vec<f64>) {
    let structure = mechanical(
        matrix(&[&[1.0, 0.0], &[0.0, 1.0]]),
        matrix(&[&[0.05, 0.0], &[0.0, 0.05]]),
        matrix(&[&[2.0, 1.0], &[1.0, 0.6666666666666667]]),
    );
    let c0 = compliant(
        contact(vec![1.0, 0.0], 1.0, 0.15, coulomb(0.5, 0.5)),
        vec![0.0, 1.0],
        1.3333333333333333,
        0.03,
    );
    let system = System {
        structure,
        contacts: vec![c0],
        inputs: vec![sine(InputTarget::NormalLoad { contact: 0, reaction: true }, 1.6, 4.0, 0.3)],
    };
    (system, vec![0.4, -0.2, 0.0, 0.0])
}

/// Random system 1598.
fn random_1598() -> (System, Vec<f64>) {
    let structure = mechanical(
        matrix(&[
            &[1.151, 0.051, 0.0, 0.164],
            &[0.051, 1.589, -0.208, 0.129],
            &[0.0, -0.208, 1.0290000000000001, -0.047],
            &[0.164, 0.129, -0.047, 1.696],
        ]),
        matrix(&[
            &[0.006, 0.0, 0.0, 0.0],
            &[0.0, 0.045, 0.0, 0.0],
            &[0.0, 0.0, 0.024, 0.0],
            &[0.0, 0.0, 0.0, 0.06],
        ]),
        matrix(&[
            &[2.669, -0.248, 0.328, 0.116],
            &[-0.248, 1.757, -0.251, -0.336],
            &[0.328, -0.251, 1.8119999999999998, -0.575],
            &[0.116, -0.336, -0.575, 1.8800000000000001],
        ]),
    );
    let c0 = compliant(
        contact(vec![1.0, 0.0, 0.0, 0.0], 0.952, 0.074, decreasing(0.571, 0.371, 0.393)),
        vec![0.273, -0.559, 0.139, -0.953],
        1.859,
        0.029,
    );
    let c1 = contact(vec![-0.144, 0.673, 0.108, -0.856], 0.795, 0.1, coulomb(0.344, 0.344));
    let c2 = contact(vec![0.0, 0.0, 1.0, 0.0], 0.435, 0.267, stribeck(0.607, 0.507, 1.657));
    let system = System {
        structure,
        contacts: vec![c0, c1, c2],
        inputs: vec![sine(InputTarget::Force(vec![0.0, 1.0, 0.0, 0.0]), 1.3, 1.177, 1.829)],
    };
    (system, vec![-0.109, -0.925, 1.284, -0.562, 0.648, 0.405, -0.03, -0.126])
}

/// Selection 133.
fn selection_133() -> (System, Vec<f64>) {
    let structure = mechanical(
        matrix(&[&[1.29, 0.0, 0.0], &[0.0, 0.812, 0.0], &[0.0, 0.0, 1.221]]),
        matrix(&[&[0.016, 0.0, 0.0], &[0.0, 0.09, 0.0], &[0.0, 0.0, 0.094]]),
        matrix(&[
            &[2.811, -0.298, 0.058],
            &[-0.298, 1.3610000000000002, 0.679],
            &[0.058, 0.679, 3.3030000000000004],
        ]),
    );
    let c0 = contact(vec![1.771, 0.217, -0.028], 0.767, 0.0, coulomb(0.578, 0.72));
    let c1 = contact(vec![-0.206, 1.785, -1.285], 1.215, 0.136, coulomb(0.28, 0.28));
    let c2 = compliant(
        contact(vec![0.0, 0.0, 1.0], 1.308, 0.091, coulomb(0.531, 0.804)),
        vec![-0.591, 0.346, -0.338],
        2.083,
        0.024,
    );
    let system = System {
        structure,
        contacts: vec![c0, c1, c2],
        inputs: vec![sine(InputTarget::Force(vec![0.0, 0.0, 1.0]), 1.071, 6.644, 0.984)],
    };
    (system, vec![0.48, 0.042, -0.777, -0.016, 0.152, -0.096])
}

/// Follower force, slip only.
fn follower_force() -> (System, Vec<f64>) {
    let structure = mechanical(
        matrix(&[&[1.0, 0.0], &[0.0, 1.2]]),
        matrix(&[&[0.05, 0.0], &[0.0, 0.05]]),
        matrix(&[&[2.0, 1.0], &[1.0, 0.8]]),
    );
    let c0 = Contact {
        slope: Some(vec![0.4, -0.3]),
        ..compliant(contact(vec![1.0, 0.0], 1.0, 3.0, coulomb(0.9, 0.9)), vec![0.0, 1.0], 1.4, 0.02)
    };
    let system = System { structure, contacts: vec![c0], inputs: vec![] };
    (system, vec![1.2, -1.2, 0.0, 0.0])
}
