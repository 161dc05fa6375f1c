//! The loop of the contacts with a measured structure: steady sliding, fast response, and the turns of its determinant.

use num_complex::Complex64;
use quell_model::System;
use quell_model::system::{Contact, InputTarget};
use quell_numerics::matrix::Matrix;
use quell_numerics::polar::{argument, modulus};

use super::no_verdict::{NoMeasuredVerdict, NoTurns};
use super::receptance::Receptance;
use crate::averaging::AveragingError;
use crate::harmonic::ContactResponse;
use crate::linearised::FrictionLine;
use crate::steady::{NoSteadySliding, SteadyContact, mean_factor};

/// Newton steps after which steady sliding is given up.
const MOST_STEPS: usize = 50;

/// Largest turn of the determinant between two neighbouring frequencies, radians: beyond, the band is too coarse.
const LARGEST_TURN: f64 = 1.6;

/// Turn of the determinant, radians, beyond which it is followed between two measured frequencies, where it may pass close to zero.
const SMALL_TURN: f64 = 0.3;

/// Halvings of an interval between two measured frequencies.
const HALVINGS: u32 = 24;

/// Largest distance of the turns from a whole number of motions that the end of the band may leave.
const OPEN_END: f64 = 0.35;

/// The turns of the determinant along the band.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turns {
    /// Number of characteristic roots with positive real part; an oscillating motion has two.
    pub unstable: usize,
    /// Half turns of the determinant, clockwise.
    pub half_turns: f64,
    /// Angular frequency at which the determinant is smallest.
    pub closest: f64,
    /// The determinant there, its magnitude: the distance from a marginal motion.
    pub distance: f64,
}

/// A row of a contact, or no row.
fn row(row: Option<&Vec<f64>>) -> &[f64] {
    row.map_or(&[], Vec::as_slice)
}

/// Rows t, n and s of every contact.
fn outputs(system: &System) -> impl Iterator<Item = &[f64]> {
    system
        .contacts
        .iter()
        .flat_map(|at| [row(at.tangent.as_ref()), row(at.normal.as_ref()), row(at.slope.as_ref())])
}

/// Displacements (t, n, s) of every contact over forces (t, n) of every contact.
fn contact_receptance(
    system: &System,
    receptance: &Receptance,
    frequency: f64,
) -> Vec<Vec<Complex64>> {
    let outputs = system
        .contacts
        .iter()
        .flat_map(|at| [row(at.tangent.as_ref()), row(at.normal.as_ref()), row(at.slope.as_ref())]);
    outputs
        .map(|out| {
            let inputs = system
                .contacts
                .iter()
                .flat_map(|at| [row(at.tangent.as_ref()), row(at.normal.as_ref())]);
            inputs.map(|into| receptance.between(out, into, frequency)).collect()
        })
        .collect()
}

/// Contact forces over contact displacements, for a contact: rows t and n, columns t, n, s. `sliding` includes T_γ.
fn contact_law(
    contact: &Contact,
    steady: &SteadyContact,
    frequency: f64,
    sliding: bool,
) -> [[Complex64; 3]; 2] {
    let s = Complex64::new(0.0, frequency);
    let spring = s * contact.normal_damping + contact.normal_stiffness;
    let SteadyContact { line, normal_load, friction, factor, tilt } = *steady;
    let by_velocity = if sliding { factor * line.slope_under(normal_load) } else { 0.0 };
    let along = [-s * by_velocity, spring * (factor * line.coefficient), Complex64::ZERO];
    let turned = Complex64::new(factor * friction, 0.0);
    let across = [along[0] * tilt, along[1] * tilt - spring, turned];
    [along, across]
}

/// I − B G.
fn loop_matrix(
    system: &System,
    receptance: &Receptance,
    contacts: &[SteadyContact],
    frequency: f64,
    sliding: bool,
) -> Vec<Vec<Complex64>> {
    let g = contact_receptance(system, receptance, frequency);
    let size = 2 * contacts.len();
    let mut matrix = vec![vec![Complex64::ZERO; size]; size];
    for (c, (contact, steady)) in system.contacts.iter().zip(contacts).enumerate() {
        let law = contact_law(contact, steady, frequency, sliding);
        for (r, forces) in law.iter().enumerate() {
            for column in 0..size {
                let sum: Complex64 = (0..3).map(|y| forces[y] * g[3 * c + y][column]).sum();
                matrix[2 * c + r][column] = -sum;
            }
        }
    }
    for (i, row) in matrix.iter_mut().enumerate() {
        row[i] += 1.0;
    }
    matrix
}

/// Eliminates in place with partial pivoting; returns the determinant, and the solution of the right side.
fn eliminate(mut a: Vec<Vec<Complex64>>, mut x: Vec<Complex64>) -> (Complex64, Vec<Complex64>) {
    let n = a.len();
    let mut determinant = Complex64::ONE;
    for k in 0..n {
        let pivot =
            (k..n).max_by(|&i, &j| modulus(a[i][k]).total_cmp(&modulus(a[j][k]))).unwrap_or(k);
        if pivot != k {
            a.swap(k, pivot);
            x.swap(k, pivot);
            determinant = -determinant;
        }
        determinant *= a[k][k];
        if a[k][k] == Complex64::ZERO {
            return (Complex64::ZERO, x);
        }
        let (above, below) = a.split_at_mut(k + 1);
        let (own, solved) = (&above[k], x[k]);
        for (i, row) in below.iter_mut().enumerate() {
            let factor = row[k] / own[k];
            for (entry, term) in row[k..].iter_mut().zip(&own[k..]) {
                *entry -= factor * term;
            }
            x[k + 1 + i] -= factor * solved;
        }
    }
    for k in (0..n).rev() {
        let sum: Complex64 = (k + 1..n).map(|j| a[k][j] * x[j]).sum();
        x[k] = (x[k] - sum) / a[k][k];
    }
    (determinant, x)
}

/// Steady sliding: contact displacements y = G(0) f(y), by Newton's method from y = 0.
pub(super) fn steady(
    system: &System,
    receptance: &Receptance,
    lines: &[FrictionLine],
) -> Result<Vec<SteadyContact>, NoSteadySliding> {
    let g = contact_receptance(system, receptance, 0.0);
    let k = lines.len();
    let factors: Vec<f64> = (0..k).map(|index| mean_factor(system, index)).collect();
    let constant = system.structure.force();
    let pushed: Vec<f64> =
        outputs(system).map(|out| receptance.between(out, constant, 0.0).re).collect();
    let mut y = vec![0.0; 3 * k];
    let mut settled = false;
    for _ in 0..MOST_STEPS {
        let mut forces = vec![0.0; 2 * k];
        let mut slopes = Matrix::zeros(2 * k, 3 * k);
        for (c, (contact, line)) in system.contacts.iter().zip(lines).enumerate() {
            let (approach, tilt) = (y[3 * c + 1], y[3 * c + 2]);
            let spring = contact.normal_stiffness;
            let friction = factors[c]
                * (line.coefficient * (contact.normal_load + spring * approach) + line.constant);
            let by_approach = factors[c] * line.coefficient * spring;
            forces[2 * c] = friction;
            forces[2 * c + 1] = tilt * friction - spring * approach;
            slopes[(2 * c, 3 * c + 1)] = by_approach;
            slopes[(2 * c + 1, 3 * c + 1)] = tilt * by_approach - spring;
            slopes[(2 * c + 1, 3 * c + 2)] = friction;
        }
        let flexibility = Matrix::from_fn(3 * k, 2 * k, |i, j| g[i][j].re);
        let moved = flexibility.times(&Matrix::from_fn(2 * k, 1, |i, _| forces[i]));
        let right = Matrix::from_fn(3 * k, 1, |i, _| pushed[i] + moved[(i, 0)] - y[i]);
        let mut jacobian = Matrix::identity(3 * k);
        jacobian.add_scaled(-1.0, &flexibility.times(&slopes));
        let step =
            jacobian.solve(&right).filter(Matrix::is_finite).ok_or(NoSteadySliding::Singular)?;
        let size = y.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        for (y, step) in y.iter_mut().zip(step.as_slice()) {
            *y += step;
        }
        if step.largest() <= 4.0 * f64::EPSILON * size || step.largest() == 0.0 {
            settled = true;
            break;
        }
    }
    if !settled {
        return Err(NoSteadySliding::Singular);
    }
    let contacts = system.contacts.iter().zip(lines).zip(factors).enumerate();
    contacts
        .map(|(c, ((contact, &line), factor))| {
            let normal_load = contact.normal_load + contact.normal_stiffness * y[3 * c + 1];
            if normal_load <= 0.0 {
                return Err(NoSteadySliding::Open { contact: contact.name.clone(), normal_load });
            }
            let friction = line.coefficient * normal_load + line.constant;
            Ok(SteadyContact { line, normal_load, friction, factor, tilt: y[3 * c + 2] })
        })
        .collect()
}

/// Fast slip and load at every contact, for an input of û = 1.
pub(super) fn response(
    system: &System,
    receptance: &Receptance,
    contacts: &[SteadyContact],
    target: &InputTarget,
    frequency: f64,
) -> Result<Vec<ContactResponse>, NoMeasuredVerdict> {
    let last = receptance.frequencies().last().copied().unwrap_or(0.0);
    if frequency > last {
        return Err(NoMeasuredVerdict::OutsideBand { frequency });
    }
    let g = contact_receptance(system, receptance, frequency);
    let k = contacts.len();
    // Displacements by the input alone, and forces that it applies at the contacts.
    let mut given = vec![Complex64::ZERO; 3 * k];
    let mut applied = vec![Complex64::ZERO; 2 * k];
    let mut direct = vec![0.0; k];
    match target {
        InputTarget::Force(into) => {
            for (value, out) in given.iter_mut().zip(outputs(system)) {
                *value = receptance.between(out, into, frequency);
            }
        }
        InputTarget::NormalLoad { contact, reaction } => {
            let steady = &contacts[*contact];
            let along = steady.factor * steady.line.coefficient;
            direct[*contact] = 1.0;
            applied[2 * contact] = along.into();
            let pushed = if *reaction { 1.0 } else { 0.0 };
            applied[2 * contact + 1] = (steady.tilt * along - pushed).into();
        }
        InputTarget::Friction { contact } => {
            let steady = &contacts[*contact];
            applied[2 * contact] = steady.friction.into();
            applied[2 * contact + 1] = (steady.tilt * steady.friction).into();
        }
    }
    // f = B(y₀ + G f) + applied.
    let mut right = applied;
    for (c, (contact, steady)) in system.contacts.iter().zip(contacts).enumerate() {
        let law = contact_law(contact, steady, frequency, false);
        for (r, forces) in law.iter().enumerate() {
            right[2 * c + r] += (0..3).map(|y| forces[y] * given[3 * c + y]).sum::<Complex64>();
        }
    }
    let (determinant, forces) =
        eliminate(loop_matrix(system, receptance, contacts, frequency, false), right);
    if determinant == Complex64::ZERO {
        return Err(AveragingError::Resonance { frequency }.into());
    }
    let s = Complex64::new(0.0, frequency);
    let moved = |index: usize| {
        given[index] + g[index].iter().zip(&forces).map(|(g, f)| g * f).sum::<Complex64>()
    };
    let found = system.contacts.iter().enumerate().map(|(c, contact)| ContactResponse {
        slip: -s * moved(3 * c),
        load: (s * contact.normal_damping + contact.normal_stiffness) * moved(3 * c + 1)
            + direct[c],
    });
    Ok(found.collect())
}

/// Receptances of every contact along its own tangent and its own normal.
fn driving_points(system: &System, receptance: &Receptance, frequency: f64) -> Vec<Complex64> {
    let rows =
        system.contacts.iter().flat_map(|at| [row(at.tangent.as_ref()), row(at.normal.as_ref())]);
    rows.map(|own| receptance.between(own, own, frequency)).collect()
}

/// Turns of det(I − B G) from the static value to the end of the band.
pub(super) fn turns(
    system: &System,
    receptance: &Receptance,
    contacts: &[SteadyContact],
) -> Result<Turns, NoTurns> {
    let determinant = |frequency: f64| {
        let matrix = loop_matrix(system, receptance, contacts, frequency, true);
        let size = matrix.len();
        eliminate(matrix, vec![Complex64::ZERO; size]).0
    };
    let mut last = determinant(0.0);
    let start = argument(last);
    let mut path = DeterminantPath { angle: start, closest: 0.0, distance: modulus(last) };
    let mut direct = driving_points(system, receptance, 0.0);
    for pair in receptance.frequencies().windows(2) {
        // A resonance between two frequencies turns the response of a point to a force at that point by half a turn.
        let here = driving_points(system, receptance, pair[1]);
        let turned = here.iter().zip(&direct).any(|(next, last)| {
            *last != Complex64::ZERO && argument(next / last).abs() > LARGEST_TURN
        });
        if turned {
            return Err(NoTurns::TooCoarse { frequency: pair[0] });
        }
        direct = here;
        let next = determinant(pair[1]);
        if !path.follow(&determinant, [(pair[0], last), (pair[1], next)], HALVINGS) {
            return Err(NoTurns::TooCoarse { frequency: pair[0] });
        }
        last = next;
    }
    let DeterminantPath { angle, closest, distance } = path;
    // det → 1 for ω → ∞: what is left of the last angle belongs to the part beyond the band.
    let half_turns = (start - angle) / std::f64::consts::PI;
    let whole = half_turns.round();
    if (half_turns - whole).abs() > OPEN_END {
        return Err(NoTurns::BandTooShort { half_turns });
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a small whole number that is not negative"
    )]
    let unstable = whole.max(0.0) as usize;
    Ok(Turns { unstable, half_turns, closest, distance })
}

/// The determinant followed along the band.
struct DeterminantPath {
    /// Its angle, continuous.
    angle: f64,
    /// The angular frequency at which it was smallest.
    closest: f64,
    /// Its magnitude there.
    distance: f64,
}

impl DeterminantPath {
    /// Follows the determinant from one frequency to the next, by halves where it turns far; `false` where it still does.
    fn follow(
        &mut self,
        determinant: &impl Fn(f64) -> Complex64,
        [from, to]: [(f64, Complex64); 2],
        halvings: u32,
    ) -> bool {
        let turn = argument(to.1 / from.1);
        if turn.abs() > SMALL_TURN && halvings > 0 {
            let middle = 0.5 * (from.0 + to.0);
            let middle = (middle, determinant(middle));
            return self.follow(determinant, [from, middle], halvings - 1)
                && self.follow(determinant, [middle, to], halvings - 1);
        }
        if modulus(to.1) < self.distance {
            (self.closest, self.distance) = (to.0, modulus(to.1));
        }
        self.angle += turn;
        turn.abs() <= LARGEST_TURN
    }
}
