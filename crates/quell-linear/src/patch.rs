//! A surface of many contacts, replaced by few of them with larger loads and stiffnesses.
//!
//! What contacts of one law and one surface do to small motions are sums over them,
//!
//! ```text
//! Σ k t nᵀ,  Σ k n nᵀ,  Σ N t tᵀ,  Σ N t,  Σ N n,  Σ N,  and those of d, k_t and s
//! ```
//!
//! so that a surface is an integral, and a few of its points with weights w ≥ 0 are a quadrature of it: the sums Σ w_c … are to be those of
//! all contacts. The weights are the least squares under w ≥ 0, by the active set of Lawson and Hanson (1974), which adds one contact at a
//! time; in finite elements this is the empirical cubature of An, Kim and James (2008). Positive weights keep loads and stiffnesses
//! positive. Each sum is measured in the norm of kinetic energy, ‖t nᵀ‖² = (tᵀM⁻¹t)(nᵀM⁻¹n), relative to the sum of the norms of
//! its terms.

use quell_model::System;
use quell_model::system::{Contact, Structure};
use quell_numerics::matrix::Matrix;

/// Shares below this are left to rounding.
const ROUNDING: f64 = 1e-14;

/// Relative errors below this are not known: the products of which they are made keep half of their digits.
const KNOWN: f64 = 1e-8;

/// Contacts that stand for all of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Quadrature {
    /// Places among the contacts of the system, ascending, each with the factor of its load, stiffnesses and damping.
    pub kept: Vec<(usize, f64)>,
    /// Root mean square of the relative errors of the sums, at least 10⁻⁸, below which it is not known.
    pub error: f64,
}

/// Groups of contacts of one law on one surface, as places among the contacts of a system: those whose load is constant and their own.
pub fn patches(system: &System) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (place, contact) in system.contacts.iter().enumerate() {
        let own_input = system.inputs.iter().any(|input| input.target.contact() == Some(place));
        if own_input || contact.varying_load.is_some() || contact.force.is_some() {
            continue;
        }
        let like = |group: &&mut Vec<usize>| {
            let first = &system.contacts[group[0]];
            first.friction == contact.friction
                && first.surface_velocity == contact.surface_velocity
                && first.tangential_stiffness.is_some() == contact.tangential_stiffness.is_some()
        };
        match groups.iter_mut().find(like) {
            Some(group) => group.push(place),
            None => groups.push(vec![place]),
        }
    }
    groups
}

/// The contacts of a group that stand for all of it: as few as this error allows, and at most so many. `None` for first-order equations
/// and where the mass is singular.
pub fn quadrature(system: &System, group: &[usize], most: usize, error: f64) -> Option<Quadrature> {
    let Structure::Mechanical(mechanical) = &system.structure else { return None };
    let contacts: Vec<&Contact> = group.iter().map(|place| &system.contacts[*place]).collect();
    let n = system.structure.size();
    let products = |row: &dyn Fn(&Contact) -> Option<&Vec<f64>>| -> Option<Matrix> {
        let entry = |i: usize, c: usize| row(contacts[c]).map_or(0.0, |row| row[i]);
        let rows = Matrix::from_fn(n, contacts.len(), entry);
        let moved = mechanical.mass().solve(&rows)?;
        let along = |a: usize, b: usize| (0..n).map(|i| rows[(i, a)] * moved[(i, b)]).sum();
        Some(Matrix::from_fn(contacts.len(), contacts.len(), along))
    };
    let tangents = products(&|contact| contact.tangent.as_ref())?;
    let normals = products(&|contact| contact.normal.as_ref())?;
    let slopes = products(&|contact| contact.slope.as_ref())?;
    let gram = gram(&contacts, [&tangents, &normals, &slopes]);
    let (weights, error) = least_squares(&gram, most, error);
    let kept = weights.into_iter().map(|(place, weight)| (group[place], weight)).collect();
    Some(Quadrature { kept, error })
}

/// The products of what two contacts add to all sums, each sum relative to the norms of its terms.
fn gram(contacts: &[&Contact], [t, n, s]: [&Matrix; 3]) -> Matrix {
    type Size = fn(&Contact) -> f64;
    type Product<'p> = &'p dyn Fn(usize, usize) -> f64;
    let load: Size = |contact| contact.normal_load;
    let stiffness: Size = |contact| contact.normal_stiffness;
    let damping: Size = |contact| contact.normal_damping;
    let spring: Size = |contact| contact.tangential_stiffness.unwrap_or(0.0);
    let one = |_: usize, _: usize| 1.0;
    let (tt, nn, ss) =
        (|a, b| t[(a, b)], |a: usize, b: usize| n[(a, b)], |a: usize, b: usize| s[(a, b)]);
    let sums: [(Size, Product<'_>); 10] = [
        (stiffness, &|a, b| tt(a, b) * nn(a, b)),
        (stiffness, &|a, b| nn(a, b) * nn(a, b)),
        (damping, &|a, b| tt(a, b) * nn(a, b)),
        (damping, &|a, b| nn(a, b) * nn(a, b)),
        (load, &|a, b| tt(a, b) * tt(a, b)),
        (load, &|a, b| nn(a, b) * ss(a, b)),
        (load, &tt),
        (load, &nn),
        (load, &one),
        (spring, &|a, b| tt(a, b) * tt(a, b)),
    ];
    let count = contacts.len();
    let mut gram = Matrix::zeros(count, count);
    let mut terms = 0.0;
    for (size, product) in sums {
        let at = |a: usize, b: usize| size(contacts[a]) * size(contacts[b]) * product(a, b);
        let whole: f64 = (0..count).map(|c| at(c, c).max(0.0).sqrt()).sum();
        if whole == 0.0 || !whole.is_finite() {
            continue;
        }
        terms += 1.0;
        for a in 0..count {
            for b in 0..count {
                gram[(a, b)] += at(a, b) / (whole * whole);
            }
        }
    }
    let mean = if terms == 0.0 { 1.0 } else { 1.0 / terms };
    Matrix::from_fn(count, count, |a, b| mean * gram[(a, b)])
}

/// Weights w ≥ 0 of as few as possible for which ‖Σ w c − Σ c‖ is at most `error`, with that norm, from the products of the terms c.
fn least_squares(gram: &Matrix, most: usize, error: f64) -> (Vec<(usize, f64)>, f64) {
    let count = gram.rows();
    let goal: Vec<f64> = (0..count).map(|a| (0..count).map(|b| gram[(a, b)]).sum()).collect();
    let distance = |weights: &[f64]| {
        let apart = |a: usize| weights[a] - 1.0;
        let along = |a: usize| (0..count).map(|b| gram[(a, b)] * apart(b)).sum::<f64>() * apart(a);
        (0..count).map(along).sum::<f64>().max(KNOWN * KNOWN).sqrt()
    };
    let mut weights = vec![0.0; count];
    let mut active: Vec<usize> = Vec::new();
    // Every round but those that give up a contact adds one.
    for _ in 0..3 * count {
        if distance(&weights) <= error || active.len() >= most.min(count) {
            break;
        }
        let gradient =
            |a: usize| goal[a] - (0..count).map(|b| gram[(a, b)] * weights[b]).sum::<f64>();
        let free = (0..count).filter(|a| !active.contains(a));
        let steepest = free.map(|a| (a, gradient(a))).max_by(|a, b| a.1.total_cmp(&b.1));
        let Some((next, slope)) = steepest else { break };
        if slope <= ROUNDING * goal[next].abs() {
            break;
        }
        active.push(next);
        if !settle(gram, &goal, &mut active, &mut weights) {
            break;
        }
    }
    let mut kept: Vec<(usize, f64)> = active.iter().map(|a| (*a, weights[*a])).collect();
    kept.sort_unstable_by_key(|(place, _)| *place);
    (kept, distance(&weights))
}

/// Moves the weights to the least squares over the active terms, and gives up terms whose weight would be negative; `false` where they
/// depend on each other, and the newest one is left out again.
fn settle(gram: &Matrix, goal: &[f64], active: &mut Vec<usize>, weights: &mut [f64]) -> bool {
    loop {
        let inner =
            Matrix::from_fn(active.len(), active.len(), |i, k| gram[(active[i], active[k])]);
        let right = Matrix::from_fn(active.len(), 1, |i, _| goal[active[i]]);
        let solved = inner.solve(&right).filter(Matrix::is_finite);
        let Some(solved) = solved else {
            active.pop();
            return false;
        };
        let wanted: Vec<f64> = solved.as_slice().to_vec();
        if wanted.iter().all(|weight| *weight > 0.0) {
            weights.fill(0.0);
            active.iter().zip(wanted).for_each(|(a, weight)| weights[*a] = weight);
            return true;
        }
        // As far towards them as no weight becomes negative; the one that reaches zero is given up.
        let steps = active.iter().zip(&wanted).filter(|(_, wanted)| **wanted <= 0.0);
        let steps = steps.map(|(a, wanted)| (*a, weights[*a] / (weights[*a] - wanted)));
        let Some((given_up, step)) = steps.min_by(|a, b| a.1.total_cmp(&b.1)) else { return true };
        let is_newest = active.last() == Some(&given_up);
        for (a, wanted) in active.iter().zip(&wanted) {
            weights[*a] += step * (wanted - weights[*a]);
        }
        weights[given_up] = 0.0;
        active.retain(|a| *a != given_up);
        // The newest weight grows unless rounding says otherwise.
        if is_newest && step == 0.0 {
            return false;
        }
    }
}

#[cfg(test)]
mod tests {
    use quell_model::profile::Profile;
    use quell_model::system::{MassMatrix, Mechanical};
    use quell_model::{Coulomb, Friction};

    use super::*;
    use crate::linearised::Linearised;
    use crate::spectrum::spectrum;

    /// A rigid pad with displacements x and y and a rotation about its centre, pressed on a surface along its length by many contacts.
    fn pad(count: usize) -> System {
        let names = ["x", "y", "turn"].map(str::to_owned).to_vec();
        let structure =
            Mechanical::new(
                names,
                MassMatrix::dense(Matrix::from_fn(3, 3, |i, j| {
                    if i == j { [1.0, 1.0, 0.1][i] } else { 0.0 }
                })),
                Matrix::from_fn(3, 3, |i, j| if i == j { 0.02 } else { 0.0 }),
                Matrix::from_fn(3, 3, |i, j| if i == j { [2.0, 1.0, 0.3][i] } else { 0.1 }),
            );
        let contact = |k: usize| {
            let along = (k as f64 + 0.5) / count as f64 - 0.5;
            let share = 1.0 / count as f64;
            Contact {
                name: format!("p{k}"),
                tangent: Some(vec![1.0, 0.0, 0.2]),
                force: None,
                normal: Some(vec![0.0, 1.0, along]),
                slope: None,
                normal_load: 3.0 * share,
                normal_stiffness: 4.0 * share * (1.0 + along),
                tangential_stiffness: None,
                normal_damping: 0.0,
                surface_velocity: Profile::constant(0.05),
                friction: Friction::Coulomb(Coulomb::constant(0.4)),
                varying_load: None,
            }
        };
        let contacts = (0..count).map(contact).collect();
        System { structure: structure.into(), contacts, inputs: Vec::new() }
    }

    /// The normals of a rigid pad are linear in the place: its sums are moments up to the second order, of which there are few.
    #[test]
    fn a_rigid_pad_has_few_contacts() {
        let system = pad(40);
        let group = patches(&system).pop().expect("one patch");
        assert_eq!(group.len(), 40);
        let found = quadrature(&system, &group, 40, 1e-7).expect("a structure with mass");
        assert!(found.kept.len() <= 6 && found.error <= 1e-7, "{found:?}");
        assert!(found.kept.iter().all(|(_, weight)| *weight > 0.0));
        let kept = found.kept.iter().map(|(place, weight)| {
            let contact = system.contacts[*place].clone();
            Contact {
                normal_load: weight * contact.normal_load,
                normal_stiffness: weight * contact.normal_stiffness,
                ..contact
            }
        });
        let few = System { contacts: kept.collect(), ..system.clone() };
        let rates = |system: &System| {
            let linear = Linearised::new(system).expect("slides");
            let motions = spectrum(&linear, &linear.friction()).expect("finite").motions;
            motions.into_iter().map(|motion| motion.eigenvalue).collect::<Vec<_>>()
        };
        for (whole, few) in rates(&system).into_iter().zip(rates(&few)) {
            assert!((whole - few).norm() < 1e-6, "{whole} {few}");
        }
    }

    #[test]
    fn fewer_contacts_have_a_larger_error() {
        let system = pad(40);
        let group: Vec<usize> = (0..40).collect();
        let error = |most| quadrature(&system, &group, most, 0.0).expect("a mass").error;
        assert!(error(1) > error(2) && error(2) > 10.0 * error(6), "{} {}", error(1), error(2));
    }

    #[test]
    fn contacts_of_another_law_or_surface_are_another_patch() {
        let mut system = pad(6);
        system.contacts[1].surface_velocity = Profile::constant(0.06);
        system.contacts[2].friction = Friction::Coulomb(Coulomb::constant(0.3));
        assert_eq!(patches(&system), vec![vec![0, 3, 4, 5], vec![1], vec![2]]);
    }
}
