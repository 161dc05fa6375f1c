//! Every change of sign of a function of one parameter on a grid: roots, jumps, and pairs of roots in a dip.
//!
//! The function is sampled at given points. Between neighbours of opposite sign the change is located by a bracketing root
//! finder. Where three neighbours of equal sign show a dip towards zero, the minimum of the dip is located first, so that a
//! double crossing between two points is not lost. Declared `corners` (points at which the function may jump) are approached from
//! both sides and never crossed.
//!
//! A change is a jump if the function does not become small on both sides of it.

use quell_numerics::order::ascending_by;
use quell_numerics::roots::{Closeness, try_find_root, try_minimise};

/// How a function changes sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CrossingKind {
    /// Continuously, through zero.
    Root,
    /// By a jump, without passing zero.
    Jump,
}

/// One change of sign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SignChange {
    pub(crate) location: f64,
    pub(crate) error: f64,
    pub(crate) crossing: CrossingKind,
    /// Whether the function is positive beyond the location (for increasing parameter).
    pub(crate) becomes_positive: bool,
}

/// Relative distance from a corner at which its two sides are evaluated.
const BESIDE: f64 = 8.0 * f64::EPSILON;

/// Relative distances from a change of sign at which a root is distinguished from a jump.
const NEAR: [f64; 3] = [1e-9, 1e-11, 1e-13];

/// Sign changes of `f` over the ascending `points`, with `corners` among them.
///
/// # Errors
/// The first error of `f`.
pub(crate) fn sign_changes<E>(
    mut f: impl FnMut(f64) -> Result<f64, E>,
    points: &[f64],
    corners: &[f64],
) -> Result<Vec<SignChange>, E> {
    let (Some(&first), Some(&last)) = (points.first(), points.last()) else {
        return Ok(Vec::new());
    };
    let inside = both_sides(corners, (first, last));
    let mut changes = Vec::new();
    let mut from = first;
    for place in 0..=inside.len() {
        let corner = inside.get(place);
        let to = corner.map_or(last, |(before, _)| *before);
        let mut interval = vec![from];
        interval.extend(points.iter().copied().filter(|p| *p > from && *p < to));
        interval.push(to);
        smooth_interval(&mut f, &interval, &mut changes)?;
        if let Some(&(_, beyond)) = corner {
            from = beyond;
            let (before, after) = (f(to)?, f(from)?);
            if (before > 0.0) != (after > 0.0) {
                changes.push(SignChange {
                    location: f64::midpoint(to, from),
                    error: 0.5 * (from - to),
                    crossing: CrossingKind::Jump,
                    becomes_positive: after > 0.0,
                });
            }
        }
    }
    Ok(changes)
}

/// The points next to each corner within a range, ascending; corners that coincide but for rounding have one pair.
fn both_sides(corners: &[f64], (first, last): (f64, f64)) -> Vec<(f64, f64)> {
    let sides = corners.iter().map(|corner| (corner * (1.0 - BESIDE), corner * (1.0 + BESIDE)));
    let mut sides: Vec<_> =
        sides.filter(|(before, beyond)| *before > first && *beyond < last).collect();
    ascending_by(&mut sides, |a| a.0);
    sides.dedup_by(|next, known| {
        let coincide = next.0 <= known.1;
        if coincide {
            known.1 = next.1;
        }
        coincide
    });
    sides
}

/// Appends the sign changes of `f` over the ascending `points`, between which it is continuous.
fn smooth_interval<E>(
    f: &mut impl FnMut(f64) -> Result<f64, E>,
    points: &[f64],
    changes: &mut Vec<SignChange>,
) -> Result<(), E> {
    let mut values = Vec::with_capacity(points.len());
    for &p in points {
        values.push(f(p)?);
    }
    for i in 1..points.len() {
        if (values[i - 1] > 0.0) != (values[i] > 0.0) {
            changes.push(locate(f, points[i - 1], points[i], values[i] > 0.0)?);
            continue;
        }
        // A dip towards zero with its lowest sample at i, between neighbours of the same sign.
        let Some(&next) = values.get(i + 1) else {
            continue;
        };
        let sign = if values[i] > 0.0 { 1.0 } else { -1.0 };
        let dips = sign * values[i] <= sign * values[i - 1] && sign * values[i] < sign * next;
        if !dips || (next > 0.0) != (values[i] > 0.0) {
            continue;
        }
        let depth = |x: f64| Ok(sign * f(x)?);
        let closeness = Closeness { absolute: 0.0, relative: 1e-9 };
        let bottom = try_minimise(depth, points[i - 1], points[i + 1], closeness)?;
        if let Ok(bottom) = bottom
            && bottom.value < 0.0
        {
            changes.push(locate(f, points[i - 1], bottom.location, sign < 0.0)?);
            changes.push(locate(f, bottom.location, points[i + 1], sign > 0.0)?);
        }
    }
    Ok(())
}

/// The sign change between `a` and `b`, where the signs differ.
fn locate<E>(
    f: &mut impl FnMut(f64) -> Result<f64, E>,
    a: f64,
    b: f64,
    becomes_positive: bool,
) -> Result<SignChange, E> {
    let root = located(f, a, b, becomes_positive)?;
    let location = root.location;
    // Near a root the difference of the values decreases with the distance, near a branch point only close to the root;
    // across a jump it never does.
    let mut crossing = CrossingKind::Jump;
    for share in NEAR {
        let near = share * location.abs();
        let mut value = |x: f64| f(x.clamp(a, b));
        let wide = value(location + 8.0 * near)? - value(location - 8.0 * near)?;
        let narrow = value(location + near)? - value(location - near)?;
        if narrow.abs() <= 0.5 * wide.abs() {
            crossing = CrossingKind::Root;
            break;
        }
    }
    Ok(SignChange { crossing, ..root })
}

/// The root between `a` and `b`, where the signs differ, whether or not it is a jump.
pub(super) fn located<E>(
    f: &mut impl FnMut(f64) -> Result<f64, E>,
    a: f64,
    b: f64,
    becomes_positive: bool,
) -> Result<SignChange, E> {
    let root = try_find_root(&mut *f, a, b, Closeness::default())?;
    let location = root.map_or(a.midpoint(b), |root| root.location);
    let error = root.map_or(b - a, |root| root.width.max(4.0 * f64::EPSILON * location.abs()));
    Ok(SignChange { location, error, crossing: CrossingKind::Root, becomes_positive })
}

/// The next of a sequence of points that grow by a factor. The smallest numbers are unchanged by the factor; for them, the next
/// representable number.
pub(super) fn grown(point: f64, factor: f64) -> f64 {
    (point * factor).max(point.next_up())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn changes(f: impl Fn(f64) -> f64, points: &[f64], corners: &[f64]) -> Vec<SignChange> {
        sign_changes(|x| Ok::<f64, ()>(f(x)), points, corners).expect("no error")
    }

    #[test]
    fn corners_that_coincide_but_for_rounding_are_one_jump() {
        let corner = 1.402842146859331e-5;
        let f = |x: f64| if x < corner { -1.0 } else { 1.0 };
        let grid = [1e-5, 2e-5];
        let found = changes(f, &grid, &[corner.next_up(), corner, corner.next_down()]);
        let [only] = found.as_slice() else { panic!("{found:?}") };
        assert_eq!(only.crossing, CrossingKind::Jump);
        assert!((only.location - corner).abs() <= only.error);
        assert!(changes(f, &[1e-5, corner], &[corner.next_down()]).len() <= 1);
    }

    #[test]
    fn roots_jumps_and_double_crossings() {
        let grid: Vec<f64> = (0..=20).map(|k| 0.1 * f64::from(k)).collect();
        // A dip of width 0.02 between two points, a declared jump back, an undeclared jump.
        let f = |x: f64| match x {
            x if x < 1.0 => (x - 0.54) * (x - 0.54) - 1e-4,
            x if x < 1.55 => -1.0,
            _ => 2.0,
        };
        let found = changes(f, &grid, &[1.0]);
        let locations: Vec<f64> = found.iter().map(|c| c.location).collect();
        let expected = [0.53, 0.55, 1.0, 1.55];
        assert_eq!(locations.len(), 4, "{found:?}");
        for (location, exact) in locations.iter().zip(expected) {
            assert!((location - exact).abs() < 1e-12, "{found:?}");
        }
        let kinds: Vec<CrossingKind> = found.iter().map(|c| c.crossing).collect();
        assert_eq!(
            kinds,
            [CrossingKind::Root, CrossingKind::Root, CrossingKind::Jump, CrossingKind::Jump]
        );
        let signs: Vec<bool> = found.iter().map(|c| c.becomes_positive).collect();
        assert_eq!(signs, [false, true, false, true]);
    }

    #[test]
    fn nothing_to_find() {
        let grid: Vec<f64> = (0..=20).map(|k| 0.1 * f64::from(k)).collect();
        assert!(changes(|x| (x - 1.0) * (x - 1.0) + 1e-3, &grid, &[0.7]).is_empty());
        assert!(changes(|x| x, &[], &[]).is_empty());
    }
}
