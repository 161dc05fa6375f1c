//! Values of a parameter at which the response that sliding becomes under dither gains or loses stability.
//!
//! The orbit is followed along the parameter by shooting from the last two. Where a multiplier passes the unit circle inside
//! one signature the value is the root of the modulus: a pair of complex ones is a Neimark–Sacker bifurcation, −1 a
//! flip, +1 a fold. Where a pure-slip orbit comes to touch v_r = 0 the value is the root of its least slip velocity, a
//! grazing: the multipliers jump there, so that a search for modulus 1, or differences that straddle
//! the touch, are wrong by up to 3·10⁻⁴. The root is approached from the side of pure slip alone.

use quell_model::Belt;
use quell_numerics::roots::{Closeness, find_root};

use super::{NoOrbit, Orbit, Verdict, from_sliding, near, predicted};
use crate::simulation::Start;

/// Relative closeness of a threshold.
const CLOSENESS: f64 = 1e-10;

/// Steps in which an orbit is first followed from sliding.
const FIRST_STEPS: u32 = 8;

/// Halvings of a step before the orbit counts as lost.
const HALVINGS: u32 = 40;

/// Relative distance beyond a touch at which the orbit with contact events is looked for.
const BEYOND: f64 = 1e-5;

/// What happens to the orbit at a threshold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// A complex pair of multipliers passes the unit circle.
    NeimarkSacker,
    /// A multiplier passes −1.
    Flip,
    /// A multiplier passes +1.
    Fold,
    /// The orbit touches v_r = 0.
    Grazing,
}

impl Kind {
    /// Word in outputs.
    pub fn name(self) -> &'static str {
        match self {
            Self::NeimarkSacker => "neimark-sacker",
            Self::Flip => "flip",
            Self::Fold => "fold",
            Self::Grazing => "grazing",
        }
    }
}

/// A value at which stability changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Threshold {
    /// The parameter.
    pub value: f64,
    /// What happens.
    pub kind: Kind,
    /// Verdict for slightly larger values.
    pub becomes: Verdict,
}

/// Why there are no thresholds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoThresholds {
    /// The parameter cannot take this value.
    Invalid {
        /// The value.
        value: f64,
    },
    /// The orbit at the first value was not found.
    Start(NoOrbit),
    /// The orbit was lost on the way.
    Lost {
        /// The last value at which it was found.
        at: f64,
        /// Why it was not found beyond.
        why: NoOrbit,
    },
}

/// An orbit at a value.
struct Place {
    value: f64,
    orbit: Orbit,
}

/// Follows the orbit of a belt along one parameter.
struct Walk<'a> {
    belt: &'a Belt,
    path: &'a str,
}

impl Walk<'_> {
    fn belt_at(&self, value: f64) -> Result<Belt, NoThresholds> {
        self.belt.with(self.path, value).map_err(|_| NoThresholds::Invalid { value })
    }

    /// The orbit at a value, from those known before.
    fn orbit(&self, value: f64, known: &[(f64, Start)]) -> Result<Orbit, NoOrbit> {
        let belt = self.belt_at(value).map_err(|_| NoOrbit::NoDither)?;
        near(&belt, predicted(known, value), 1)
    }
}

/// Every threshold of the orbit that sliding becomes, for `path` from `from` to `to` in `steps`.
///
/// # Errors
/// [`NoThresholds`].
pub fn local_thresholds(
    belt: &Belt,
    path: &str,
    from: f64,
    to: f64,
    steps: u32,
) -> Result<Vec<Threshold>, NoThresholds> {
    let walk = Walk { belt, path };
    let first = from_sliding(&walk.belt_at(from)?, FIRST_STEPS).map_err(NoThresholds::Start)?;
    let mut known = vec![(from, first.start)];
    let mut here = Place { value: from, orbit: first };
    let mut found = Vec::new();
    let whole = (to - from) / f64::from(steps.max(1));
    while (to - here.value) * whole > 0.0 {
        let mut step = whole;
        if (here.value + step - to) * whole > 0.0 {
            step = to - here.value;
        }
        let mut halvings = 0;
        let next = loop {
            let value = here.value + step;
            match walk.orbit(value, &known) {
                Ok(orbit) => break Place { value, orbit },
                Err(why) if halvings == HALVINGS => {
                    return Err(NoThresholds::Lost { at: here.value, why });
                }
                Err(_) => {
                    step *= 0.5;
                    halvings += 1;
                }
            }
        };
        found.extend(between(&walk, &here, &next, &known));
        known.push((next.value, next.orbit.start));
        here = next;
    }
    Ok(found)
}

/// Thresholds between two neighbouring orbits.
fn between(walk: &Walk<'_>, here: &Place, next: &Place, known: &[(f64, Start)]) -> Vec<Threshold> {
    if here.orbit.is_pure_slip() != next.orbit.is_pure_slip() {
        return touch(walk, here, next, known);
    }
    crossing(walk, here, next).into_iter().collect()
}

/// The value at which the modulus of the larger multiplier passes 1, both orbits of one signature.
fn crossing(walk: &Walk<'_>, here: &Place, next: &Place) -> Option<Threshold> {
    let excess = |orbit: &Orbit| libm::log(orbit.radius());
    let (before, after) = (excess(&here.orbit), excess(&next.orbit));
    if before == 0.0 || before * after > 0.0 {
        return None;
    }
    let ends = [(here.value, here.orbit.start), (next.value, next.orbit.start)];
    let value_of = |value: f64| walk.orbit(value, &ends).map_or(f64::NAN, |orbit| excess(&orbit));
    let closeness = Closeness { absolute: 0.0, relative: CLOSENESS };
    let root = find_root(value_of, here.value, next.value, closeness).ok()?;
    let orbit = walk.orbit(root.location, &ends).ok()?;
    let kind = match orbit.multipliers[0] {
        (_, im) if im != 0.0 => Kind::NeimarkSacker,
        (re, _) if re < 0.0 => Kind::Flip,
        _ => Kind::Fold,
    };
    let becomes = if (after > 0.0) == (next.value > here.value) {
        Verdict::Unstable
    } else {
        Verdict::Stable
    };
    Some(Threshold { value: root.location, kind, becomes })
}

/// The value at which a pure-slip orbit touches v_r = 0, and a crossing before it.
fn touch(walk: &Walk<'_>, here: &Place, next: &Place, known: &[(f64, Start)]) -> Vec<Threshold> {
    let (slip, contact) = if here.orbit.is_pure_slip() { (here, next) } else { (next, here) };
    // The last orbits in pure slip, nearest last; the least slip velocity falls to zero in proportion to the distance.
    let mut inside: Vec<(f64, Orbit)> = vec![(slip.value, slip.orbit.clone())];
    let mut states: Vec<(f64, Start)> = if here.orbit.is_pure_slip() {
        known.to_vec()
    } else {
        vec![(slip.value, slip.orbit.start)]
    };
    let (mut near_side, mut far_side) = (slip.value, contact.value);
    let mut value = 0.5 * (near_side + far_side);
    for _ in 0..80 {
        match walk.orbit(value, &states) {
            Ok(orbit) if orbit.is_pure_slip() => {
                near_side = value;
                states.push((value, orbit.start));
                inside.push((value, orbit));
            }
            _ => far_side = value,
        }
        if (far_side - near_side).abs() <= CLOSENESS * near_side.abs() {
            break;
        }
        let guess = extrapolated(&inside);
        let width = far_side - near_side;
        value = match guess {
            // A little on the safe side of the guess, then the rest is bisected.
            Some(guess)
                if ((guess - near_side) / width) > 0.0 && (guess - near_side) / width < 1.0 =>
            {
                near_side + (guess - near_side) * (1.0 - 1e-3)
            }
            _ => near_side + 0.5 * width,
        };
        if let Some(guess) = guess
            && (guess - near_side).abs() <= 1e-7 * near_side.abs()
            && inside.len() > 3
        {
            near_side = guess;
            break;
        }
    }
    let mut found = Vec::new();
    if let Some((last, orbit)) = inside.last() {
        let place = Place { value: *last, orbit: orbit.clone() };
        let ordered = if here.orbit.is_pure_slip() { (here, &place) } else { (&place, next) };
        found.extend(crossing(walk, ordered.0, ordered.1));
        let (in_slip, in_contact) = (orbit.verdict(), beyond(walk, near_side, &place, contact));
        let upwards = contact.value > slip.value;
        if in_slip != in_contact {
            let becomes = if upwards { in_contact } else { in_slip };
            found.push(Threshold { value: near_side, kind: Kind::Grazing, becomes });
        }
    }
    found.sort_by(|a, b| a.value.total_cmp(&b.value));
    found
}

/// Verdict of the orbit with contact events just beyond a touch.
fn beyond(walk: &Walk<'_>, touch: f64, slip: &Place, contact: &Place) -> Verdict {
    let side = (contact.value - touch).signum();
    let mut distance = BEYOND * touch.abs();
    while distance < (contact.value - touch).abs() {
        let known = [(slip.value, slip.orbit.start)];
        if let Ok(orbit) = walk.orbit(touch + side * distance, &known)
            && !orbit.is_pure_slip()
        {
            return orbit.verdict();
        }
        distance *= 4.0;
    }
    contact.orbit.verdict()
}

/// Root of the parabola, or line, through the least slip velocities of the last orbits.
fn extrapolated(inside: &[(f64, Orbit)]) -> Option<f64> {
    let least = |index: usize| -> Option<(f64, f64)> {
        let (value, orbit) = &inside[inside.len().checked_sub(index)?];
        Some((*value, orbit.least_slip?.0))
    };
    let ((b, at_b), (a, at_a)) = (least(1)?, least(2)?);
    let slope = (at_b - at_a) / (b - a);
    let line = b - at_b / slope;
    let Some((c, at_c)) = least(3) else { return line.is_finite().then_some(line) };
    // Newton's divided differences, one step from the root of the line.
    let bend = (slope - (at_a - at_c) / (a - c)) / (b - c);
    let value = at_b + (line - b) * (slope + (line - a) * bend);
    let steep = slope + (line - a) * bend + (line - b) * bend;
    let root = line - value / steep;
    root.is_finite().then_some(root)
}
