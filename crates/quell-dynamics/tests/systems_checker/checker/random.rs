//! Random systems, the same for a seed everywhere.

use std::f64::consts::TAU;

use quell_model::friction::{Coulomb, Decreasing, Friction, Stribeck};
use quell_model::profile::{Profile, Wave};
use quell_model::system::{
    Contact, Input, InputTarget, MassMatrix, Mechanical, StateSpace, Structure,
};
use quell_model::{System, Waveform};
use quell_numerics::matrix::Matrix;

use super::linear::dot;

/// Least sine of the angle between a tangent row and those before it, in the metric of M⁻¹.
const LEAST_SINE: f64 = 0.35;

/// A random system and a start: the same for the same seed.
///
/// One system in eight is first-order: one or two masses with a controller. The others have up to six coordinates and four
/// contacts with independent tangent rows.
pub(crate) fn random_system(seed: u64) -> (System, Vec<f64>) {
    let mut random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x5851_f42d_4c95_7f2d);
    if random.chance(0.125) { controlled(&mut random) } else { mechanical(&mut random) }
}

/// The generator SplitMix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform between two bounds, with three decimals so that a system can be written as a short study.
    fn within(&mut self, lower: f64, upper: f64) -> f64 {
        let unit = (self.next() >> 11) as f64 / (1_u64 << 53) as f64;
        (1000.0 * (lower + (upper - lower) * unit)).round() / 1000.0
    }

    fn chance(&mut self, probability: f64) -> bool {
        self.within(0.0, 1.0) < probability
    }

    /// One of 0, …, `count` − 1.
    fn index(&mut self, count: usize) -> usize {
        usize::try_from(self.next() % count as u64).expect("a small number")
    }

    fn row(&mut self, size: usize, reach: f64) -> Vec<f64> {
        (0..size).map(|_| self.within(-reach, reach)).collect()
    }

    /// A symmetric or a skew matrix.
    fn matrix(&mut self, size: usize, reach: f64, sign: f64) -> Matrix {
        let mut matrix = Matrix::zeros(size, size);
        for i in 0..size {
            for j in 0..i {
                let value = self.within(-reach, reach);
                matrix.row_mut(i)[j] = value;
                matrix.row_mut(j)[i] = sign * value;
            }
        }
        matrix
    }

    /// A symmetric matrix with a dominant diagonal.
    fn dominant(&mut self, size: usize, lower: f64, upper: f64, share: f64) -> Matrix {
        let reach = share * lower / (size as f64 - 1.0).max(1.0);
        let mut matrix = self.matrix(size, reach, 1.0);
        for i in 0..size {
            matrix.row_mut(i)[i] = self.within(lower, upper);
        }
        matrix
    }
}

/// A mechanical system.
fn mechanical(random: &mut Random) -> (System, Vec<f64>) {
    let n = 1 + random.index(6);
    let k = 1 + random.index(n.min(4));
    let mass = random.dominant(n, 0.7, 1.8, 0.6);
    let mut stiffness = random.dominant(n, 1.5, 4.0, 0.9);
    if random.chance(0.25) {
        stiffness.add_scaled(1.0, &random.matrix(n, 0.15, -1.0));
    }
    let mut damping = Matrix::zeros(n, n);
    for i in 0..n {
        damping.row_mut(i)[i] = random.within(0.0, 0.1);
    }
    if random.chance(0.25) {
        damping.add_scaled(1.0, &random.matrix(n, 0.3, -1.0));
    }
    let tangents = tangents(random, n, k, &mass);
    let contacts =
        tangents.into_iter().enumerate().map(|(c, tangent)| contact(random, c, tangent, true));
    let contacts: Vec<Contact> = contacts.collect();
    let inputs = (0..random.index(3)).map(|_| input(random, n, &contacts)).collect();
    let names = (0..n).map(|i| format!("q{i}")).collect();
    let mut structure = Mechanical::new(names, MassMatrix::dense(mass), damping, stiffness);
    if random.chance(0.2) {
        structure = structure.under(random.row(n, 0.5));
    }
    let mut start = random.row(n, 0.9);
    start.extend(random.row(n, 0.5));
    (System { structure: structure.into(), contacts, inputs }, start)
}

/// Independent tangent rows: unit rows and dense ones.
fn tangents(random: &mut Random, n: usize, k: usize, mass: &Matrix) -> Vec<Vec<f64>> {
    let inverse = mass.solve(&Matrix::identity(n)).expect("a dominant diagonal");
    let product =
        |a: &[f64], b: &[f64]| -> f64 { (0..n).map(|i| a[i] * dot(inverse.row(i), b)).sum() };
    // Orthonormal directions of the rows so far.
    let mut directions: Vec<Vec<f64>> = Vec::new();
    let mut rows = Vec::new();
    while rows.len() < k {
        let row = if random.chance(0.4) {
            let at = random.index(n);
            (0..n).map(|i| if i == at { 1.0 } else { 0.0 }).collect()
        } else {
            random.row(n, 1.0)
        };
        let mut rest = row.clone();
        for direction in &directions {
            let along = product(direction, &row);
            rest.iter_mut().zip(direction).for_each(|(rest, direction)| *rest -= along * direction);
        }
        let (own, length) = (product(&row, &row).sqrt(), product(&rest, &rest).sqrt());
        if own > 0.3 && length > LEAST_SINE * own {
            directions.push(rest.iter().map(|entry| entry / length).collect());
            rows.push(row);
        }
    }
    rows
}

/// A contact with a given tangent row.
fn contact(random: &mut Random, index: usize, tangent: Vec<f64>, compliant: bool) -> Contact {
    let n = tangent.len();
    let compliant = compliant && n > 1 && random.chance(0.5);
    let (mut normal, mut slope) = (None, None);
    let (mut normal_stiffness, mut normal_damping) = (0.0, 0.0);
    if compliant {
        normal = Some(random.row(n, 1.0));
        normal_stiffness = random.within(0.8, 3.0);
        normal_damping = random.within(0.0, 0.1);
        if random.chance(0.1) {
            slope = Some(random.row(n, 0.15));
        }
    }
    let velocity = match random.index(10) {
        0 => 0.0,
        1 | 2 => -random.within(0.03, 0.4),
        _ => random.within(0.03, 0.4),
    };
    Contact {
        name: format!("c{index}"),
        tangent: Some(tangent),
        force: None,
        normal,
        slope,
        normal_load: random.within(0.4, 1.4),
        normal_stiffness,
        tangential_stiffness: None,
        normal_damping,
        surface_velocity: Profile::constant(velocity),
        friction: law(random),
        varying_load: None,
    }
}

/// A law: constant coefficients with and without a static level, falling ones, and cubic ones over a wide range of slip.
fn law(random: &mut Random) -> Friction {
    let level = random.within(0.2, 0.8);
    match random.index(5) {
        0 => Friction::Coulomb(Coulomb::constant(level)),
        1 | 2 => {
            let static_level = level + random.within(0.02, 0.3);
            Friction::Coulomb(Coulomb::new(level, Some(static_level), 0.0).expect("a law"))
        }
        3 => {
            let minimum = level * random.within(0.5, 0.95);
            let velocity = random.within(0.1, 0.5);
            Friction::Decreasing(Decreasing::new(level, minimum, velocity).expect("a law"))
        }
        _ => {
            let minimum = level - random.within(0.02, 0.15);
            let velocity = random.within(3.0, 4.0);
            Friction::Stribeck(Stribeck::new(level, minimum, velocity).expect("a law"))
        }
    }
}

/// A force on the structure or a modulation of a load.
fn input(random: &mut Random, rows: usize, contacts: &[Contact]) -> Input {
    let waveform = [Waveform::Sine, Waveform::Sine, Waveform::Triangle, Waveform::Square]
        [random.index(4)]
    .clone();
    let frequency = random.within(1.0, 8.0);
    let phase = random.within(0.0, TAU);
    let (target, amplitude) = if random.chance(0.5) {
        (InputTarget::Force(random.row(rows, 1.0)), random.within(0.2, 1.5))
    } else {
        let contact = random.index(contacts.len());
        let given = &contacts[contact];
        // Two modulations together leave a prescribed load positive.
        let share = if given.normal.is_some() { 0.8 } else { 0.45 };
        let amplitude = given.normal_load * random.within(0.1, share);
        (InputTarget::NormalLoad { contact, reaction: random.chance(0.7) }, amplitude)
    };
    let wave = Wave { waveform, amplitude, frequency, phase, envelope: None };
    Input { target, profile: Profile::constant(0.0).with(wave) }
}

/// One or two masses, the first under a PID controller whose actuator lags.
///
/// The states are the integral of the error, the force of the actuator, then displacements and velocities.
fn controlled(random: &mut Random) -> (System, Vec<f64>) {
    let k = 1 + random.index(2);
    let size = 2 + 2 * k;
    let (integral, proportional, derivative) =
        (random.within(0.2, 1.0), random.within(1.5, 4.0), random.within(0.5, 1.5));
    let lag = random.within(0.05, 0.3);
    let masses: Vec<f64> = (0..k).map(|_| random.within(0.6, 1.6)).collect();
    let spring = random.within(0.5, 3.0);
    let mut matrix = Matrix::zeros(size, size);
    let (x, v) = (2, 2 + k);
    matrix.row_mut(0)[x] = 1.0;
    for (column, gain) in [(0, -integral), (1, -1.0), (x, -proportional), (v, -derivative)] {
        matrix.row_mut(1)[column] = gain / lag;
    }
    for (i, mass) in masses.iter().enumerate() {
        matrix.row_mut(x + i)[v + i] = 1.0;
        for j in (0..k).filter(|_| k > 1) {
            let sign = if i == j { -1.0 } else { 1.0 };
            matrix.row_mut(v + i)[x + j] += sign * spring / mass;
        }
    }
    matrix.row_mut(v)[1] = 1.0 / masses[0];
    let unit = |at: usize, value: f64| -> Vec<f64> {
        (0..size).map(|i| if i == at { value } else { 0.0 }).collect()
    };
    let mut contacts = Vec::new();
    for (i, mass) in masses.iter().enumerate() {
        let mut own = contact(random, i, unit(v + i, 1.0), false);
        own.force = Some(unit(v + i, 1.0 / mass));
        contacts.push(own);
    }
    let inputs = (0..random.index(2)).map(|_| input(random, size, &contacts)).collect();
    let names = (0..size).map(|i| format!("z{i}")).collect();
    let mut start = random.row(size, 0.8);
    start[1] = 0.0;
    let structure: Structure = StateSpace::new(names, matrix).into();
    (System { structure, contacts, inputs }, start)
}
