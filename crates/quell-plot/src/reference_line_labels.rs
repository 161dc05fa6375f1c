//! Placement of the label of a reference line: next to the line, where it covers least.

use super::axis::Mapping;
use super::canvas::Rectangle;
use super::font_sizes::FontSizes;
use super::layer::{Orientation, ReferenceLine};
use super::obstacles::Obstacles;
use super::projection::reference_line_ends;
use super::typeset::{LINE_HEIGHT, RichText, wrap};

/// Space around a label that other labels leave free (pixels).
const HALO: f64 = 3.0;

/// Cost of a label outside the frame, above that of covering anything.
const OUTSIDE: usize = 1000;

/// The rectangle of the label and its lines, which are no wider than the room next to the line; `None` if the line lies
/// outside the frame, or if every place next to it would cover another text.
pub(super) fn place(
    rule: &ReferenceLine,
    (x, y): (&Mapping, &Mapping),
    frame: Rectangle,
    obstacles: &Obstacles,
    sizes: FontSizes,
) -> Option<(Rectangle, Vec<RichText>)> {
    const GAP: f64 = 5.0;
    let at = *reference_line_ends(rule.orientation, rule.value, x, y, frame)?.first()?;
    let size = f64::from(sizes.note);
    let room = match rule.orientation {
        Orientation::Vertical => (frame.right - at.x).max(at.x - frame.left) - 2.0 * GAP,
        Orientation::Horizontal => frame.width() - 4.0 * GAP,
    };
    let lines = wrap(&rule.label, size, false, room);
    let width = lines.iter().map(|line| line.width(size, false)).fold(0.0, f64::max);
    let height = (0.95 + LINE_HEIGHT * lines.len().saturating_sub(1) as f64) * size;
    let (lefts, tops) = match rule.orientation {
        Orientation::Vertical => (
            vec![at.x + GAP, at.x - GAP - width],
            vec![
                frame.top + 2.0 * GAP,
                frame.bottom - 2.0 * GAP - height,
                frame.top + 0.25 * frame.height(),
                frame.top + 0.5 * frame.height(),
                frame.top + 0.75 * frame.height(),
            ],
        ),
        Orientation::Horizontal => (
            vec![
                frame.right - 2.0 * GAP - width,
                frame.left + 2.0 * GAP,
                0.5 * (frame.left + frame.right - width),
            ],
            vec![at.y - 0.6 * GAP - height, at.y + 0.6 * GAP],
        ),
    };
    let best = |tops: &[f64]| {
        let areas = tops.iter().flat_map(|&top| {
            lefts.iter().map(move |&left| Rectangle {
                left,
                top,
                right: left + width,
                bottom: top + height,
            })
        });
        let cost = |area: &Rectangle| {
            let outside = area.left < frame.left
                || area.right > frame.right
                || area.top < frame.top
                || area.bottom > frame.bottom;
            obstacles.covered_by(area.grown(HALO)) + if outside { OUTSIDE } else { 0 }
        };
        areas.map(|area| (cost(&area), area)).min_by_key(|(cost, _)| *cost)
    };
    let mut found = best(&tops)?;
    if obstacles.covers_text(found.1) && rule.orientation == Orientation::Vertical {
        // Many lines: every row of the frame.
        let rows = (0..).map(|row: u32| f64::from(row).mul_add(height + GAP, frame.top + GAP));
        let rows: Vec<f64> = rows.take_while(|top| top + height < frame.bottom).collect();
        found = best(&rows).unwrap_or(found);
    }
    (!obstacles.covers_text(found.1)).then_some((found.1, lines))
}
