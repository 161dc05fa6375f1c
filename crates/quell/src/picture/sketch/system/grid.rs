//! Positions of the bodies: rows of boxes, each row with room for supports and tracks above and contacts below.

use quell_model::system::InputTarget;

use super::body::{BodyKind, SketchBody};
use super::contact_place;
use super::link::SketchLink;
use super::widths::{GAP, state_width};
use crate::study::SystemStudy;

/// Height of a support above a box.
pub(super) const SUPPORT: f64 = 32.0;
/// Height of a box without forces: that of the springs between neighbours, below which forces act.
pub(super) const SPRINGS: f64 = 38.0;
/// Height of one force below the springs.
pub(super) const FORCE: f64 = 24.0;
/// Height of one track.
const TRACK: f64 = 26.0;
/// Vertical distance of two rows.
const BETWEEN: f64 = 12.0;
/// Height of the resonators on a group of modes.
const RESONATORS: f64 = 32.0;
/// The most tracks above a row.
const MOST_TRACKS: usize = 3;

/// The box of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BodySeat {
    pub(super) row: usize,
    pub(super) column: usize,
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl BodySeat {
    pub(super) fn right(&self) -> f64 {
        self.left + self.width
    }

    pub(super) fn bottom(&self) -> f64 {
        self.top + self.height
    }

    pub(super) fn middle(&self) -> f64 {
        self.left + 0.5 * self.width
    }
}

/// The boxes of all bodies and the tracks of links.
#[derive(Clone, Debug)]
pub(super) struct BodyGrid {
    seats: Vec<BodySeat>,
    /// Links with a track (from, to), and its height.
    tracks: Vec<((usize, usize), f64)>,
    bottom: f64,
}

impl BodyGrid {
    /// Places the bodies on a sheet with this room.
    pub(super) fn new(
        room: f64,
        study: &SystemStudy,
        bodies: &[SketchBody],
        links: &[SketchLink],
    ) -> Self {
        let (width, columns) = columns(room, bodies);
        let mut grid = Self { seats: Vec::new(), tracks: Vec::new(), bottom: 0.0 };
        let mut bottom = 0.0;
        let own_track = |link: &SketchLink, members: &std::ops::Range<usize>| {
            link.to.is_some_and(|to| {
                members.contains(&link.from) && members.contains(&to) && to > link.from + 1
            })
        };
        for row in 0..bodies.len().div_ceil(columns) {
            let members = row * columns..((row + 1) * columns).min(bodies.len());
            let own: Vec<&SketchLink> =
                links.iter().filter(|link| own_track(link, &members)).take(MOST_TRACKS).collect();
            let supported =
                links.iter().any(|link| link.to.is_none() && members.contains(&link.from));
            let modal = bodies[members.clone()].iter().any(|body| body.kind == BodyKind::Modes);
            let head = if supported {
                SUPPORT + 8.0
            } else if modal {
                RESONATORS
            } else {
                0.0
            };
            let top = bottom + head + TRACK * own.len() as f64;
            for (place, link) in own.iter().enumerate() {
                let level = top - head - TRACK * (place as f64 + 0.4);
                grid.tracks.push(((link.from, link.to.unwrap_or_default()), level));
            }
            let height = height(study, bodies, members.clone());
            for column in 0..members.len() {
                let left = (width + GAP) * column as f64;
                grid.seats.push(BodySeat { row, column, left, top, width, height });
            }
            let depth = contact_place::depth(study, bodies, members);
            bottom = top + height + depth + BETWEEN;
        }
        grid.bottom = bottom;
        grid
    }

    /// The box of a body.
    pub(super) fn seat(&self, body: usize) -> BodySeat {
        self.seats[body]
    }

    /// The track of a link within a row, if it has one: its number in the row and its height.
    pub(super) fn track(&self, link: &SketchLink) -> Option<(usize, f64)> {
        let ends = (link.from, link.to?);
        let (place, (_, level)) =
            self.tracks.iter().enumerate().find(|(_, (known, _))| *known == ends)?;
        let row = self.seat(link.from).row;
        let before =
            self.tracks[..place].iter().filter(|((from, _), _)| self.seat(*from).row == row);
        Some((before.count(), *level))
    }

    /// Lower edge of all rows.
    pub(super) fn bottom(&self) -> f64 {
        self.bottom
    }

    /// Middle of the widest row.
    pub(super) fn middle(&self) -> f64 {
        0.5 * self.seats.iter().map(BodySeat::right).fold(0.0, f64::max)
    }

    /// Whether one body ends a row and the other begins the next.
    pub(super) fn wraps(&self, from: usize, to: usize) -> bool {
        to == from + 1 && self.seat(from).row != self.seat(to).row
    }
}

/// Width of a box, and the number of boxes in a row.
fn columns(room: f64, bodies: &[SketchBody]) -> (f64, usize) {
    let single = bodies.iter().all(|body| body.kind == BodyKind::Mass);
    if bodies.iter().any(|body| body.kind == BodyKind::State) {
        return (state_width(room), 1);
    }
    let width = if single { 54.0 } else { 118.0 };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
    let fit = ((room - GAP) / (width + GAP)).floor() as usize;
    (width, fit.clamp(1, bodies.len().max(1)))
}

/// Height of the boxes of a row: springs at the top, below them the forces of the body that has most.
fn height(study: &SystemStudy, bodies: &[SketchBody], members: std::ops::Range<usize>) -> f64 {
    let forces = |body: &SketchBody| {
        let acts = |row: &[f64]| {
            body.indices.iter().any(|&place| row.get(place).is_some_and(|b| *b != 0.0))
        };
        let inputs = study.system().inputs.iter().filter(|input| match &input.target {
            InputTarget::Force(row) => acts(row),
            InputTarget::NormalLoad { .. } | InputTarget::Friction { .. } => false,
        });
        let constant = acts(study.system().structure.force()) && body.kind != BodyKind::State;
        inputs.count().max(usize::from(constant))
    };
    let most = bodies[members.clone()].iter().map(forces).max().unwrap_or(0);
    match &bodies[members.start] {
        // Forces on a state are next to its equation.
        SketchBody { kind: BodyKind::State, lines, .. } => {
            (10.0 + 12.5 * lines.len() as f64).max(FORCE * most as f64)
        }
        _ => SPRINGS + FORCE * most as f64,
    }
}
