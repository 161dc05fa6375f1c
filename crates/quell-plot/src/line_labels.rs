//! Labels on isolines: on a straight section, upright, clear of other strokes and texts.
//!
//! An occupancy map records the pixels of the frame that are drawn on. Along each line, candidate positions are tried in
//! order of increasing cost (bend, slope, distance from the middle); the label is placed at the first one that covers
//! nothing else, and the line is interrupted there. A level for which no such position exists has one label over other strokes,
//! or next to its line where the line is too close to the frame: a level without its number would be of no use.

use super::canvas::Rectangle;
use super::geometry::{FrameSize, PlotPoint};
use super::typeset::RichText;

/// The lines of one level (pixels).
#[derive(Debug, Clone)]
pub(super) struct LevelLines {
    pub(super) text: RichText,
    pub(super) pieces: Vec<Vec<PlotPoint>>,
}

/// A label on a line.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PlacedLabel {
    pub(super) level: usize,
    /// Centre of the text.
    pub(super) centre: PlotPoint,
    /// Rotation, clockwise in degrees, from −90 to 90.
    pub(super) rotation: f64,
    piece: usize,
    /// Section of the line under the text (arc length in pixels).
    from: f64,
    to: f64,
}

/// Space before and after a label (pixels).
const MARGIN: f64 = 3.0;
/// Space between a line and a label next to it (pixels).
const BESIDE: f64 = 1.5;
/// Distance between candidates along a line (pixels).
const STEP: f64 = 3.0;
/// Maximum number of labels of one level.
const MOST: usize = 5;
/// Line length per label (pixels).
const ONE_EACH: f64 = 520.0;

/// The owner of each pixel of the frame: nothing, one line, or something that no text may cover.
#[derive(Debug, Clone)]
pub(super) struct OccupancyMap {
    frame: Rectangle,
    width: usize,
    height: usize,
    owners: Vec<u32>,
}

const FREE: u32 = 0;
/// A text, which no other text may cover.
const TAKEN: u32 = u32::MAX;
/// Strokes other than a single isoline.
const CROSSED: u32 = u32::MAX - 1;

/// What a label may cover.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Cover {
    /// Its own line only.
    OwnLine,
    /// Any stroke, but no text.
    Strokes,
    /// The same next to the line, for a line along the edge of the frame.
    Beside,
}

impl OccupancyMap {
    pub(super) fn new(frame: Rectangle) -> Self {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a frame has 60 to some thousand pixels"
        )]
        let side = |length: f64| length.clamp(1.0, 2e4).ceil() as usize;
        let (width, height) = (side(frame.width()), side(frame.height()));
        Self { frame, width, height, owners: vec![FREE; width * height] }
    }

    fn index(&self, PlotPoint { x, y }: PlotPoint) -> Option<usize> {
        let (x, y) = (x - self.frame.left, y - self.frame.top);
        if !(x >= 0.0 && y >= 0.0) {
            return None;
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "not negative; the cast saturates"
        )]
        let (column, row) = (x as usize, y as usize);
        (column < self.width && row < self.height).then_some(row * self.width + column)
    }

    fn mark(&mut self, point: PlotPoint, owner: u32) {
        if let Some(index) = self.index(point) {
            let before = self.owners[index];
            self.owners[index] = match before {
                FREE => owner,
                _ if before == owner => owner,
                TAKEN => TAKEN,
                _ if owner == TAKEN => TAKEN,
                _ => CROSSED,
            };
        }
    }

    /// Marks a stroke that no label should cover.
    pub(super) fn stroke(&mut self, points: &[PlotPoint]) {
        self.stroke_of(points, CROSSED);
    }

    fn stroke_of(&mut self, points: &[PlotPoint], owner: u32) {
        for pair in points.windows(2) {
            let (dx, dy) = (pair[1].x - pair[0].x, pair[1].y - pair[0].y);
            // Strokes far outside the frame may be very long but mark nothing.
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "pixels are clamped to 1e5"
            )]
            let steps = (libm::hypot(dx, dy) / 0.7).ceil().min(1e5) as usize;
            for step in 0..=steps {
                let share = step as f64 / steps.max(1) as f64;
                self.mark(PlotPoint::new(pair[0].x + share * dx, pair[0].y + share * dy), owner);
            }
        }
    }

    /// Marks a rectangle.
    pub(super) fn area(&mut self, area: Rectangle) {
        let mut y = area.top.max(self.frame.top);
        while y < area.bottom.min(self.frame.bottom) {
            let mut x = area.left.max(self.frame.left);
            while x < area.right.min(self.frame.right) {
                self.mark(PlotPoint::new(x, y), TAKEN);
                x += 1.0;
            }
            y += 1.0;
        }
    }

    /// Whether a rotated rectangle lies in the frame and covers nothing that the label may not cover.
    fn is_free(&self, candidate: &Candidate, half: FrameSize, owner: u32, cover: Cover) -> bool {
        let allowed = |found: u32| match cover {
            Cover::OwnLine => found == FREE || found == owner,
            Cover::Strokes | Cover::Beside => found != TAKEN,
        };
        let mut free = true;
        candidate.each_pixel(half, |point| {
            free &= self.index(point).is_some_and(|index| allowed(self.owners[index]));
        });
        free
    }

    fn take(&mut self, candidate: &Candidate, half: FrameSize) {
        candidate.each_pixel(half, |point| self.mark(point, TAKEN));
    }
}

/// A candidate position of a label: its centre and the direction of its baseline.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    centre: PlotPoint,
    direction: PlotPoint,
    at: f64,
    cost: f64,
}

impl Candidate {
    /// The candidates next to the line on both of its sides, for a text of this half height.
    fn beside(self, half: f64) -> [Self; 2] {
        let PlotPoint { x: dx, y: dy } = self.direction;
        [1.0, -1.0].map(|side| {
            let off = side * (half + BESIDE);
            let centre = PlotPoint::new(self.centre.x + off * dy, self.centre.y - off * dx);
            Self { centre, ..self }
        })
    }

    fn each_pixel(&self, half: FrameSize, mut visit: impl FnMut(PlotPoint)) {
        #[expect(clippy::cast_possible_truncation, reason = "half the size of a text")]
        let (across, up) = (half.width.ceil() as i32, half.height.ceil() as i32);
        let PlotPoint { x: dx, y: dy } = self.direction;
        for v in -up..=up {
            for u in -across..=across {
                let (u, v) = (f64::from(u), f64::from(v));
                visit(PlotPoint::new(
                    self.centre.x + u * dx - v * dy,
                    self.centre.y + u * dy + v * dx,
                ));
            }
        }
    }
}

/// A line with its arc length at every point.
struct MeasuredPath<'a> {
    points: &'a [PlotPoint],
    arc_length: Vec<f64>,
}

impl<'a> MeasuredPath<'a> {
    fn new(points: &'a [PlotPoint]) -> Self {
        let mut arc_length = vec![0.0];
        for pair in points.windows(2) {
            let leg = pair[0].distance(pair[1]);
            arc_length.push(arc_length[arc_length.len() - 1] + leg);
        }
        Self { points, arc_length }
    }

    fn length(&self) -> f64 {
        self.arc_length.last().copied().unwrap_or(0.0)
    }

    fn at(&self, path: f64) -> PlotPoint {
        let last = self.points.len() - 1;
        let leg =
            self.arc_length.partition_point(|arc_length| *arc_length <= path).clamp(1, last.max(1));
        let (Some(from), Some(to)) = (self.points.get(leg - 1), self.points.get(leg)) else {
            return self.points[last];
        };
        let chord = self.arc_length[leg] - self.arc_length[leg - 1];
        let share = if chord > 0.0 { (path - self.arc_length[leg - 1]) / chord } else { 0.0 };
        PlotPoint::new(from.x + share * (to.x - from.x), from.y + share * (to.y - from.y))
    }

    /// The candidate for a text of this half width, centred at a position on the line; `None` where the line
    /// bends too much.
    fn candidate(&self, at: f64, half: f64, most_bend: f64) -> Option<Candidate> {
        const SAMPLES: i32 = 8;
        let (from, to) = (self.at(at - half), self.at(at + half));
        let (dx, dy) = (to.x - from.x, to.y - from.y);
        let chord = libm::hypot(dx, dy);
        if chord < 1.8 * half {
            return None;
        }
        let mut direction = PlotPoint::new(dx / chord, dy / chord);
        let (mut bend, mut shift) = (0.0_f64, 0.0);
        for sample in 1..SAMPLES {
            let point = self.at(at - half + 2.0 * half * f64::from(sample) / f64::from(SAMPLES));
            let off = (point.y - from.y) * direction.x - (point.x - from.x) * direction.y;
            bend = bend.max(off.abs());
            shift += off / f64::from(SAMPLES);
        }
        if bend > most_bend {
            return None;
        }
        let middle = (0.5 * (from.x + to.x), 0.5 * (from.y + to.y));
        let centre = PlotPoint::new(middle.0 - shift * direction.y, middle.1 + shift * direction.x);
        // Keeps the text upright: from left to right, and upwards rather than downwards if vertical.
        if direction.x < -1e-9 || (direction.x.abs() <= 1e-9 && direction.y > 0.0) {
            direction = PlotPoint::new(-direction.x, -direction.y);
        }
        let off_middle = (at / self.length() - 0.5).abs();
        let cost = bend / most_bend + 0.6 * direction.y.abs() + 0.8 * off_middle;
        Some(Candidate { centre, direction, at, cost })
    }
}

/// Places labels on these lines.
pub(super) fn place(
    levels: &[LevelLines],
    occupied: &mut OccupancyMap,
    size: f64,
) -> Vec<PlacedLabel> {
    let mut owner = FREE;
    let mut owners: Vec<Vec<u32>> = Vec::new();
    for level in levels {
        let mut mine = Vec::new();
        for piece in &level.pieces {
            owner = owner.saturating_add(1).min(TAKEN - 1);
            occupied.stroke_of(piece, owner);
            mine.push(owner);
        }
        owners.push(mine);
    }
    let mut placed: Vec<PlacedLabel> = Vec::new();
    for cover in [Cover::OwnLine, Cover::Strokes, Cover::Beside] {
        for (number, level) in levels.iter().enumerate() {
            let unlabelled = placed.iter().all(|label| label.level != number);
            if !level.text.is_empty() && unlabelled {
                placed.extend(label((number, level), &owners[number], occupied, size, cover));
            }
        }
    }
    placed
}

/// Places the labels of one level: up to [`MOST`] that cover nothing else, or a single one over other strokes.
fn label(
    (number, level): (usize, &LevelLines),
    owners: &[u32],
    occupied: &mut OccupancyMap,
    size: f64,
    cover: Cover,
) -> Vec<PlacedLabel> {
    let half = FrameSize::new(0.5 * level.text.width(size, false) + MARGIN, 0.58 * size);
    let (most, least_length) = match cover {
        Cover::OwnLine => (MOST, 4.0 * half.width + 8.0),
        Cover::Strokes | Cover::Beside => (1, 2.0 * half.width + 6.0),
    };
    let mut paths: Vec<(usize, MeasuredPath<'_>)> = level
        .pieces
        .iter()
        .enumerate()
        .filter(|(_, piece)| piece.len() > 1)
        .map(|(piece, points)| (piece, MeasuredPath::new(points)))
        .filter(|(_, path)| path.length() > least_length)
        .collect();
    paths.sort_by(|one, other| other.1.length().total_cmp(&one.1.length()));
    let mut placed = Vec::new();
    for (piece, path) in &paths {
        for (from, to) in parts(path.length()) {
            if placed.len() == most {
                return placed;
            }
            let search = LabelSearch { half, owner: owners[*piece], size, cover };
            if let Some(candidate) = search.best(path, (from, to), occupied) {
                occupied.take(&candidate, FrameSize::new(half.width + 2.0, half.height + 1.0));
                // A line is interrupted under its label alone.
                let opened = if cover == Cover::Beside { 0.0 } else { half.width };
                placed.push(PlacedLabel {
                    level: number,
                    centre: candidate.centre,
                    rotation: libm::atan2(candidate.direction.y, candidate.direction.x)
                        .to_degrees(),
                    piece: *piece,
                    from: candidate.at - opened,
                    to: candidate.at + opened,
                });
            }
        }
    }
    placed
}

/// Equal parts of a long line, one per label.
fn parts(length: f64) -> Vec<(f64, f64)> {
    let count = (length / ONE_EACH).round().clamp(1.0, MOST as f64);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to a few")]
    let parts = (0..count as usize)
        .map(|part| (length * part as f64 / count, length * (part as f64 + 1.0) / count))
        .collect();
    parts
}

/// The search for a position of a label on its line.
struct LabelSearch {
    /// Half the width and height of the text (pixels).
    half: FrameSize,
    /// The line of the label in the occupancy map.
    owner: u32,
    /// Size of the text (pixels).
    size: f64,
    cover: Cover,
}

impl LabelSearch {
    /// The free candidate of least cost on a part of a line; straight sections are tried before bent ones.
    fn best(
        &self,
        path: &MeasuredPath<'_>,
        (from, to): (f64, f64),
        occupied: &OccupancyMap,
    ) -> Option<Candidate> {
        let half = self.half;
        let (first, last) = (from.max(half.width + 2.0), to.min(path.length() - half.width - 2.0));
        for most_bend in [0.12 * self.size, 0.3 * self.size] {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "lines in a frame are some thousand pixels chord"
            )]
            let count = ((last - first) / STEP).clamp(0.0, 1e4) as usize;
            let on_line = (0..=count).filter_map(|step| {
                path.candidate(first + STEP * step as f64, half.width, most_bend)
            });
            let mut candidates: Vec<Candidate> = match self.cover {
                Cover::OwnLine | Cover::Strokes => on_line.collect(),
                Cover::Beside => {
                    on_line.flat_map(|candidate| candidate.beside(half.height)).collect()
                }
            };
            candidates.sort_by(|one, other| one.cost.total_cmp(&other.cost));
            let free =
                |candidate: &&Candidate| occupied.is_free(candidate, half, self.owner, self.cover);
            if let Some(candidate) = candidates.iter().find(free) {
                return Some(*candidate);
            }
        }
        None
    }
}

/// The lines of a level, interrupted at its labels.
pub(super) fn opened(
    level: usize,
    pieces: &[Vec<PlotPoint>],
    placed: &[PlacedLabel],
) -> Vec<Vec<PlotPoint>> {
    let mut drawn = Vec::new();
    for (number, piece) in pieces.iter().enumerate() {
        let mut openings: Vec<(f64, f64)> = placed
            .iter()
            .filter(|text| text.level == level && text.piece == number)
            .map(|text| (text.from, text.to))
            .collect();
        if openings.is_empty() {
            drawn.push(piece.clone());
            continue;
        }
        openings.sort_by(|one, other| one.0.total_cmp(&other.0));
        let path = MeasuredPath::new(piece);
        let mut from = 0.0;
        for (start, end) in openings.into_iter().chain([(path.length(), 0.0)]) {
            let within = path.arc_length.iter().zip(piece);
            let inner =
                within.filter(|(at, _)| **at > from && **at < start).map(|(_, point)| *point);
            let mut part = vec![path.at(from)];
            part.extend(inner);
            part.push(path.at(start));
            drawn.push(part);
            from = end;
        }
    }
    drawn
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Rectangle = Rectangle { left: 0.0, top: 0.0, right: 400.0, bottom: 300.0 };

    fn level(text: &str, pieces: Vec<Vec<PlotPoint>>) -> LevelLines {
        LevelLines { text: RichText::parse(text), pieces }
    }

    /// A line along the edge of the frame has no room for its label: it is next to the line.
    #[test]
    fn a_line_along_the_frame_is_labelled_beside_itself() {
        let line: Vec<PlotPoint> =
            (0..=40).map(|k| PlotPoint::new(10.0 * f64::from(k), 298.0)).collect();
        let levels = [level("95 %", vec![line.clone()])];
        let placed = place(&levels, &mut OccupancyMap::new(FRAME), 11.0);
        assert_eq!(placed.len(), 1);
        assert!(placed[0].centre.y < 298.0 - 6.0, "{placed:?}");
        let drawn: f64 = opened(0, &[line], &placed)
            .iter()
            .flat_map(|part| part.windows(2))
            .map(|pair| (pair[1].x - pair[0].x).hypot(pair[1].y - pair[0].y))
            .sum();
        assert!((drawn - 400.0).abs() < 1e-9, "the line is whole: {drawn}");
    }

    fn circle(radius: f64) -> Vec<PlotPoint> {
        (0..=360)
            .map(|degree| {
                let angle = f64::from(degree).to_radians();
                PlotPoint::new(200.0 + radius * angle.cos(), 150.0 + radius * angle.sin())
            })
            .collect()
    }

    #[test]
    fn every_level_with_room_is_labelled_without_collisions() {
        let levels: Vec<LevelLines> =
            (1..=6).map(|n| level("20", vec![circle(22.0 * f64::from(n))])).collect();
        let placed = place(&levels, &mut OccupancyMap::new(FRAME), 10.0);
        for number in 1..levels.len() {
            assert!(placed.iter().any(|text| text.level == number), "level {number}");
        }
        for text in &placed {
            assert!(text.rotation.abs() <= 90.0);
        }
        for (at, one) in placed.iter().enumerate() {
            for other in &placed[at + 1..] {
                let apart = (one.centre.x - other.centre.x).hypot(one.centre.y - other.centre.y);
                assert!(apart > 12.0, "{one:?} {other:?}");
            }
        }
    }

    #[test]
    fn labels_prefer_straight_sections() {
        // A zigzag, then a straight section.
        let mut line: Vec<PlotPoint> = (0..40)
            .map(|k| PlotPoint::new(5.0 * f64::from(k), 100.0 + 15.0 * f64::from(k % 2)))
            .collect();
        line.push(PlotPoint::new(390.0, 100.0));
        let placed = place(&[level("40", vec![line])], &mut OccupancyMap::new(FRAME), 10.0);
        assert!(
            !placed.is_empty() && placed.iter().all(|text| text.centre.x > 200.0),
            "{placed:?}"
        );
    }

    #[test]
    fn labels_avoid_occupied_areas() {
        let line = vec![PlotPoint::new(10.0, 150.0), PlotPoint::new(390.0, 150.0)];
        let mut occupied = OccupancyMap::new(FRAME);
        occupied.area(Rectangle { left: 0.0, top: 100.0, right: 300.0, bottom: 200.0 });
        let placed = place(&[level("40", vec![line.clone()])], &mut occupied, 10.0);
        assert!(placed.len() == 1 && placed[0].centre.x > 305.0, "{placed:?}");
        occupied.area(FRAME);
        assert!(place(&[level("40", vec![line])], &mut occupied, 10.0).is_empty());
    }

    #[test]
    fn a_line_is_interrupted_only_at_its_labels() {
        let line = vec![PlotPoint::new(10.0, 150.0), PlotPoint::new(390.0, 150.0)];
        let levels = [level("40", vec![line.clone()])];
        let placed = place(&levels, &mut OccupancyMap::new(FRAME), 10.0);
        let drawn = opened(0, &levels[0].pieces, &placed);
        let length: f64 =
            drawn.iter().flat_map(|part| part.windows(2)).map(|pair| pair[1].x - pair[0].x).sum();
        assert_eq!(drawn.len(), placed.len() + 1);
        let opening: f64 = placed.iter().map(|text| text.to - text.from).sum();
        assert!((length + opening - 380.0).abs() < 1e-9);
    }
}
