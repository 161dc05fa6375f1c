//! Which contacts stick: the joint decision of all contacts whose slip velocity is zero at one moment.
//!
//! Among these γ̇ = w − G T. Our declared selection:
//!
//! 1. If forces within the static bounds μ_s N hold all of them, all stick.
//! 2. Otherwise the box problem with the static bounds: T inside its bounds where γ̇ = 0, at the upper one where γ̇ > 0, at the
//!    lower one where γ̇ < 0. It has one solution where G is a P-matrix.
//! 3. Contacts at their bound get the sliding level μ(0⁺)N as their new bound, and the problem is solved again, until no further
//!    contact reaches its bound. A contact whose force is inside its bound at the end sticks, the others slip.
//!
//! For symmetric G the box problem minimises ½TᵀGT − wᵀT over the box. It is solved by principal pivoting with Murty's rule (the
//! violated condition with the least index changes first), which ends after finitely many steps for every P-matrix: Murty (1974);
//! Júdice and Pires (1994) for bounds on both sides.
//!
//! Dependent rows make G singular: the forces are those of least norm ([`Gains`]). Where the rows do not agree, so that none take all
//! slip accelerations, a share [`LEAST_NORM`] of the diagonal is added, and the forces end at their bounds.

use quell_numerics::matrix::Matrix;

use super::few::Few;
use super::stuck::{DEPENDENT, Gains, is_diagonal, remainder};

/// Share of the diagonal that is added where rows are dependent: above rounding, so that the matrix can be inverted, and below
/// [`AT_BOUND`], so that no force changes its place by it.
const LEAST_NORM: f64 = 1e-13;

/// Slip accelerations below this share of their terms are zero to rounding: they are differences of forces solved to about 10⁻¹³,
/// with a margin for the condition of G. A release with less is treated as smooth, with a double zero of γ at its
/// start.
pub(super) const ZERO_ACCELERATION: f64 = 1e-9;

/// A force within this share of its bound is at it: the accuracy of solved forces with a margin. A contact released too early by it
/// has reached its bound within the time that this share of the force takes.
const AT_BOUND: f64 = 1e-10;

/// A force whose margin has a root at this moment is within this share of its bound unless other events have relieved it.
const NEAR_BOUND: f64 = 1e-7;

/// The contacts whose slip velocity is zero.
#[derive(Clone, Debug)]
pub(super) struct Moment {
    /// G.
    pub(super) coupling: Matrix,
    /// w.
    pub(super) accelerations: Few<f64>,
    /// μ_s N.
    pub(super) holding: Few<f64>,
    /// μ(0⁺) N.
    pub(super) sliding: Few<f64>,
    /// Direction in which the force of a sticking contact has just reached its bound; 0 for the others.
    pub(super) reached: Few<i8>,
    /// Whether rows are dependent.
    pub(super) is_dependent: bool,
}

/// What the contacts do.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Selected {
    /// 0 for stick, else the direction of slip.
    pub(super) directions: Few<i8>,
    /// Whether the slip acceleration vanishes: a smooth release.
    pub(super) is_smooth: Few<bool>,
    /// Bound at which the force of a sticking contact stands, carried along by contacts on which it depends.
    pub(super) saturated: Few<i8>,
}

/// A contact whose slip velocity is zero, and which no other of them moves at once: it decides alone, as [`Moment::decide`] does for such
/// contacts together.
#[derive(Clone, Copy, Debug)]
pub(super) struct LoneMoment {
    /// G of the contact.
    pub(super) coupling: f64,
    /// w.
    pub(super) acceleration: f64,
    /// μ_s N.
    pub(super) holding: f64,
    /// μ(0⁺) N.
    pub(super) sliding: f64,
    /// Direction in which its force has just reached its bound, or 0.
    pub(super) reached: i8,
}

impl LoneMoment {
    /// The direction in which it slips, 0 for stick, and whether its slip acceleration vanishes; `None` where that is not decided.
    pub(super) fn decide(&self) -> Option<(i8, bool)> {
        let (force, _, place) = self.boxed(self.holding)?;
        let at_bound = side(force, self.holding, place);
        let near = force * f64::from(self.reached) >= self.holding * (1.0 - NEAR_BOUND);
        if at_bound == 0 && !(self.reached != 0 && near) {
            return Some((0, false));
        }
        let (force, rate, place) = self.boxed(self.sliding)?;
        let direction = side(force, self.sliding, place);
        Some((direction, direction != 0 && self.is_at_rest(rate)))
    }

    fn is_at_rest(&self, rate: f64) -> bool {
        let terms = (self.coupling * self.holding).abs() + self.acceleration.abs();
        rate.abs() <= ZERO_ACCELERATION * terms
    }

    /// Force, γ̇ and place of the box problem |T| ≤ `bound`.
    fn boxed(&self, bound: f64) -> Option<(f64, f64, i8)> {
        let mut place = 0_i8;
        // Rounding may make two places alternate.
        for _ in 0..MOST_CHANGES {
            let inside = self.acceleration / self.coupling;
            let force = if place == 0 { inside } else { f64::from(place) * bound };
            if !force.is_finite() {
                return None;
            }
            let rate = self.acceleration - self.coupling * force;
            place = match place {
                0 if force > bound => 1,
                0 if force < -bound => -1,
                1 if rate < 0.0 && !self.is_at_rest(rate) => 0,
                -1 if rate > 0.0 && !self.is_at_rest(rate) => 0,
                _ => return Some((force, rate, place)),
            };
        }
        None
    }
}

/// Bound at which a force stands; 0 inside.
fn side(force: f64, bound: f64, place: i8) -> i8 {
    if place != 0 {
        return place;
    }
    match (force.abs() >= bound * (1.0 - AT_BOUND), force >= 0.0) {
        (false, _) => 0,
        (true, true) => 1,
        (true, false) => -1,
    }
}

/// Changes of places in a box problem of few contacts.
const MOST_CHANGES: usize = 64;

/// Solution of a box problem.
#[derive(Clone, Debug)]
struct Boxed {
    forces: Few<f64>,
    /// γ̇.
    rates: Few<f64>,
    /// −1, 0 or 1: at the lower bound, inside, at the upper bound.
    places: Few<i8>,
}

impl Boxed {
    /// Bound at which a force stands; 0 inside.
    fn side(&self, c: usize, bounds: &[f64]) -> i8 {
        side(self.forces[c], bounds[c], self.places[c])
    }
}

impl Moment {
    fn size(&self) -> usize {
        self.accelerations.len()
    }

    /// Whether a slip acceleration is zero to rounding.
    fn is_at_rest(&self, contact: usize, rate: f64) -> bool {
        let row = self.coupling.row(contact).iter().zip(&self.holding);
        let terms: f64 = row.map(|(g, bound)| (g * bound).abs()).sum();
        rate.abs() <= ZERO_ACCELERATION * (terms + self.accelerations[contact].abs())
    }

    /// The decision; `None` where it is not unique.
    pub(super) fn decide(&self) -> Option<Selected> {
        let size = self.size();
        let mut bounds = self.holding.clone();
        let mut released = Few::from_elem(false, size);
        let mut solved = self.boxed(&bounds)?;
        for round in 0..=size {
            let sides: Few<i8> =
                (0..size).map(|c| self.side(c, &solved, &bounds, round == 0)).collect();
            let newly: Few<usize> = (0..size)
                .filter(|&c| sides[c] != 0 && !released[c] && !self.is_carried(c, &sides, &solved))
                .collect();
            if newly.is_empty() {
                break;
            }
            for c in newly {
                released[c] = true;
                bounds[c] = self.sliding[c];
            }
            solved = self.boxed(&bounds)?;
        }
        let mut selected = Selected {
            directions: Few::from_elem(0, size),
            is_smooth: Few::from_elem(false, size),
            saturated: Few::from_elem(0, size),
        };
        let is_first = !released.contains(&true);
        for (c, released) in released.into_iter().enumerate() {
            let side = self.side(c, &solved, &bounds, is_first);
            if released && side != 0 {
                selected.directions[c] = side;
                selected.is_smooth[c] = self.is_at_rest(c, solved.rates[c]);
            } else if side != 0 && self.is_dependent {
                selected.saturated[c] = side;
            }
        }
        Some(selected)
    }

    /// Bound at which a force stands. In the first round a force that has just reached its bound is there, if the others leave it
    /// near: a simultaneous event may have relieved it.
    fn side(&self, c: usize, solved: &Boxed, bounds: &[f64], is_first: bool) -> i8 {
        let side = solved.side(c, bounds);
        if side != 0 || !is_first || self.reached[c] == 0 {
            return side;
        }
        let force = solved.forces[c] * f64::from(self.reached[c]);
        if force >= bounds[c] * (1.0 - NEAR_BOUND) { self.reached[c] } else { 0 }
    }

    /// Whether a contact at its bound is held by others that are not at theirs, because its row depends on theirs.
    fn is_carried(&self, c: usize, sides: &[i8], solved: &Boxed) -> bool {
        if !self.is_dependent || !self.is_at_rest(c, solved.rates[c]) {
            return false;
        }
        let others: Few<usize> = (0..self.size()).filter(|d| *d != c && sides[*d] == 0).collect();
        let basis = super::stuck::independent(&self.coupling, &others);
        !others.is_empty()
            && remainder(&self.coupling, c, &basis).is_some_and(|rest| rest.abs() < DEPENDENT)
    }

    /// The box problem |T| ≤ bounds.
    fn boxed(&self, bounds: &[f64]) -> Option<Boxed> {
        let size = self.size();
        let mut places: Few<i8> = Few::from_elem(0, size);
        // Murty's rule ends; the count only guards against rounding that makes two sets alternate.
        for _ in 0..(1_usize << size.min(12)).saturating_mul(8).max(MOST_CHANGES) {
            let forces = self.forces(bounds, &places)?;
            let rates: Few<f64> = (0..size)
                .map(|c| {
                    let row = self.coupling.row(c).iter().zip(&forces);
                    self.accelerations[c] - row.map(|(g, force)| g * force).sum::<f64>()
                })
                .collect();
            let violated = (0..size).find_map(|c| match places[c] {
                0 if forces[c] > bounds[c] => Some((c, 1)),
                0 if forces[c] < -bounds[c] => Some((c, -1)),
                1 if rates[c] < 0.0 && !self.is_at_rest(c, rates[c]) => Some((c, 0)),
                -1 if rates[c] > 0.0 && !self.is_at_rest(c, rates[c]) => Some((c, 0)),
                _ => None,
            });
            match violated {
                Some((c, place)) => places[c] = place,
                None => return Some(Boxed { forces, rates, places }),
            }
        }
        None
    }

    /// Forces with those at their bounds given.
    fn forces(&self, bounds: &[f64], places: &[i8]) -> Option<Few<f64>> {
        let mut forces: Few<f64> =
            places.iter().zip(bounds).map(|(place, bound)| f64::from(*place) * bound).collect();
        let inside: Few<usize> = (0..places.len()).filter(|c| places[*c] == 0).collect();
        if inside.is_empty() {
            return Some(forces);
        }
        if is_diagonal(&self.coupling) {
            // With the bits of the general solution.
            for c in inside {
                forces[c] = self.accelerations[c] / self.coupling[(c, c)];
            }
            return forces.iter().all(|force| force.is_finite()).then_some(forces);
        }
        let matrix = Matrix::from_fn(inside.len(), inside.len(), |i, j| {
            self.coupling[(inside[i], inside[j])]
        });
        let right: Few<f64> = inside
            .iter()
            .map(|c| {
                let row = self.coupling.row(*c).iter().zip(&forces);
                self.accelerations[*c] - row.map(|(g, force)| g * force).sum::<f64>()
            })
            .collect();
        let solved = self.solved(&matrix, &right, &inside)?;
        for (c, force) in inside.iter().zip(solved) {
            forces[*c] = force;
        }
        Some(forces)
    }

    /// The forces that take these slip accelerations from the contacts `inside` their bounds.
    fn solved(&self, matrix: &Matrix, right: &[f64], inside: &[usize]) -> Option<Few<f64>> {
        let size = right.len();
        let column = |numbers: &[f64]| Matrix::from_fn(size, 1, |i, _| numbers[i]);
        if !self.is_dependent {
            return Some(Few::from_slice(matrix.solve(&column(right))?.as_slice()));
        }
        // To rounding, where the rows agree: a share of the diagonal would amplify the rounding of G by its reciprocal.
        if let Some(forces) = Gains::of(matrix).map(|gains| gains.forces(right)) {
            let left = matrix.times(&column(&forces));
            let mut rates = right.iter().zip(left.as_slice()).map(|(w, held)| w - held);
            let agree =
                inside.iter().all(|c| rates.next().is_some_and(|rate| self.is_at_rest(*c, rate)));
            if agree {
                return Some(forces);
            }
        }
        let shifted = Matrix::from_fn(size, size, |i, j| {
            if i == j { matrix[(i, j)] * (1.0 + LEAST_NORM) } else { matrix[(i, j)] }
        });
        Some(Few::from_slice(shifted.solve(&column(right))?.as_slice()))
    }
}

/// Whether every principal minor of a matrix is positive, with the members of the first that is not.
pub(super) fn first_minor_not_positive(matrix: &Matrix) -> Option<Vec<usize>> {
    let size = matrix.rows().min(12);
    (1_u32..1 << size).find_map(|set| {
        let members: Vec<usize> = (0..size).filter(|c| set >> c & 1 == 1).collect();
        (determinant(matrix, &members) <= 0.0).then_some(members)
    })
}

/// Determinant of a principal submatrix, relative to the product of its diagonal; within rounding of zero it is zero.
fn determinant(matrix: &Matrix, members: &[usize]) -> f64 {
    let size = members.len();
    let mut rows: Vec<Vec<f64>> =
        members.iter().map(|i| members.iter().map(|j| matrix[(*i, *j)]).collect()).collect();
    let mut product = 1.0;
    for column in 0..size {
        let pivot = (column..size)
            .max_by(|a, b| rows[*a][column].abs().total_cmp(&rows[*b][column].abs()))
            .unwrap_or(column);
        if rows[pivot][column] == 0.0 {
            return 0.0;
        }
        if pivot != column {
            rows.swap(pivot, column);
            product = -product;
        }
        product *= rows[column][column];
        for row in column + 1..size {
            let factor = rows[row][column] / rows[column][column];
            let head = rows[column].clone();
            for (entry, head) in rows[row].iter_mut().zip(&head).skip(column) {
                *entry -= factor * head;
            }
        }
    }
    let scale: f64 = members.iter().map(|i| matrix[(*i, *i)].abs()).product();
    if product.abs() <= DEPENDENT * scale { 0.0 } else { product }
}

#[cfg(test)]
mod tests {
    use quell_numerics::random::SplitMix;

    use super::*;

    fn moment(
        coupling: [[f64; 2]; 2],
        accelerations: [f64; 2],
        holding: [f64; 2],
        sliding: [f64; 2],
    ) -> Moment {
        Moment {
            coupling: Matrix::from_fn(2, 2, |i, j| coupling[i][j]),
            accelerations: Few::from_slice(&accelerations),
            holding: Few::from_slice(&holding),
            sliding: Few::from_slice(&sliding),
            reached: Few::from_elem(0, 2),
            is_dependent: false,
        }
    }

    #[test]
    fn a_released_contact_is_not_moved_against_its_own_acceleration() {
        // The smallest example of the reference: G, bounds 1 and 1, sliding .9 and .5, w = (−.6, .55).
        let moment = moment([[1.0, 0.5], [0.5, 1.0]], [-0.6, 0.55], [1.0, 1.0], [0.9, 0.5]);
        let selected = moment.decide().expect("a P-matrix");
        assert_eq!(selected.directions[..], [0, 1]);
        let bounds = [0.9, 0.5];
        let solved = moment.boxed(&bounds).expect("a P-matrix");
        assert!((solved.forces[0] + 0.85).abs() < 1e-15 && solved.forces[1] == 0.5);
        assert!((solved.rates[1] - 0.475).abs() < 1e-15);
    }

    #[test]
    fn contacts_that_do_not_move_each_other_decide_alone() {
        let mut generator = SplitMix::new(7);
        let mut random = || generator.share() - 0.5;
        let mut counts = [0; 3];
        for number in 0..4000 {
            let coupling = [0, 1].map(|_| 1.0 + random());
            let holding = [0, 1].map(|_| 0.4 + 0.2 * random());
            let sliding = holding.map(|bound| if number % 3 == 0 { bound } else { 0.8 * bound });
            // Many forces at their bounds, to rounding or next to it.
            let accelerations: [f64; 2] = std::array::from_fn(|c| {
                let shares = [random() * 3.0, 1.0, -1.0, 1.0 + 1e-11, 1.0 - 1e-8, 0.8];
                shares[(number + 3 * c) % shares.len()] * coupling[c] * holding[c]
            });
            let reached: [i8; 2] = std::array::from_fn(|c| [0, 1, -1][(number / 6 + c) % 3]);
            let mut both =
                moment([[coupling[0], 0.0], [0.0, coupling[1]]], accelerations, holding, sliding);
            both.reached = Few::from_slice(&reached);
            let selected = both.decide().expect("a P-matrix");
            for c in 0..2 {
                let alone = LoneMoment {
                    coupling: coupling[c],
                    acceleration: accelerations[c],
                    holding: holding[c],
                    sliding: sliding[c],
                    reached: reached[c],
                };
                let together = (selected.directions[c], selected.is_smooth[c]);
                assert_eq!(alone.decide(), Some(together), "{alone:?}");
                counts[usize::from(together.0 != 0) + usize::from(together.1)] += 1;
            }
        }
        assert!(counts.iter().all(|count| *count > 300), "{counts:?}");
    }

    #[test]
    fn two_dependent_contacts_release_together_at_the_sum_of_their_bounds() {
        for (force, expected) in [(0.3, [0, 0]), (0.45, [0, 0]), (0.51, [1, 1])] {
            let mut pads = moment([[1.0, 1.0], [1.0, 1.0]], [force; 2], [0.2, 0.3], [0.12, 0.18]);
            pads.is_dependent = true;
            let selected = pads.decide().expect("solvable");
            assert_eq!(selected.directions[..], expected, "{force}");
            assert_eq!(selected.saturated[..], if force == 0.45 { [1, 0] } else { [0, 0] });
        }
    }

    #[test]
    fn the_box_problem_agrees_with_every_set() {
        let mut generator = SplitMix::new(7);
        let mut random = || generator.share() - 0.5;
        for _ in 0..500 {
            let entries: Vec<f64> = (0..20).map(|_| random()).collect();
            let root = Matrix::from_fn(4, 5, |i, j| entries[5 * i + j]);
            let coupling = root.times(&root.transpose());
            let moment = Moment {
                coupling,
                accelerations: (0..4).map(|_| random()).collect(),
                holding: (0..4).map(|_| 0.3 + 0.4 * random()).collect(),
                sliding: Few::from_elem(0.0, 4),
                reached: Few::from_elem(0, 4),
                is_dependent: false,
            };
            let solved = moment.boxed(&moment.holding).expect("positive definite");
            for c in 0..4 {
                let (force, rate, bound) = (solved.forces[c], solved.rates[c], moment.holding[c]);
                assert!(force.abs() <= bound * (1.0 + 1e-12));
                match solved.places[c] {
                    0 => assert!(rate.abs() < 1e-12),
                    place => assert!(rate * f64::from(place) >= -1e-12),
                }
            }
        }
    }

    #[test]
    fn matrices_that_decide_nothing_are_recognised() {
        let unique = Matrix::from_fn(2, 2, |i, j| [[1.0, 3.0], [-1.0, 1.0]][i][j]);
        assert_eq!(first_minor_not_positive(&unique), None);
        let twice = Matrix::from_fn(2, 2, |i, j| [[1.0, 2.0], [2.0, 1.0]][i][j]);
        assert_eq!(first_minor_not_positive(&twice), Some(vec![0, 1]));
    }
}
