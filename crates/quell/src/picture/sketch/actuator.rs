//! The actuator of a sketch: a stack of discs, a coil in its magnet, a motor, or a box with a measured curve; and its row of the key.

use std::f64::consts::TAU;

use quell_design::actuator::Actuator;
use quell_model::units::Quantity;

use crate::plot::{FrameSize, LineStyle, PlotPoint, SketchInk, SketchKey, SketchPart, SketchShape};
use crate::words::{capital, digits};

/// Width of the drawing.
pub(super) const WIDTH: f64 = 30.0;
/// Half of its height.
const HALF: f64 = 7.0;
/// Corners of the circle of a motor.
const CORNERS: u32 = 24;

fn line(points: Vec<PlotPoint>) -> SketchShape {
    SketchShape::Line { points, style: LineStyle::Solid }
}

/// The actuator between the driven point on the left, at `from`, and the ground on the right.
pub(super) fn drawn(PlotPoint { x: left, y: level }: PlotPoint, actuator: &Actuator) -> SketchPart {
    let end = left + WIDTH;
    let body = match actuator {
        Actuator::Piezo(_) => stack(left, level),
        Actuator::VoiceCoil(_) => coil(left, level),
        Actuator::Motor(_) => motor(left, level),
        Actuator::Measured(_) => measured(left, level),
    };
    let ground = SketchShape::Ground {
        from: PlotPoint::new(end, level - HALF - 4.0),
        to: PlotPoint::new(end, level + HALF + 4.0),
    };
    let part =
        SketchPart::new("actuator", actuator.kind().in_words(), ground).ink(SketchInk::Input);
    body.into_iter().fold(part, SketchPart::and)
}

/// Discs on each other.
fn stack(left: f64, level: f64) -> Vec<SketchShape> {
    let at = PlotPoint::new;
    let block = SketchShape::Block {
        corner: at(left, level - HALF),
        size: FrameSize::new(WIDTH, 2.0 * HALF),
    };
    let discs = (1..6).map(|k| {
        let x = left + WIDTH * f64::from(k) / 6.0;
        line(vec![at(x, level - HALF), at(x, level + HALF)])
    });
    [block].into_iter().chain(discs).collect()
}

/// A magnet that is open on the left, with windings inside.
fn coil(left: f64, level: f64) -> Vec<SketchShape> {
    let at = PlotPoint::new;
    let (inner, end) = (left + 8.0, left + WIDTH);
    let magnet = line(vec![
        at(inner, level - HALF),
        at(end, level - HALF),
        at(end, level + HALF),
        at(inner, level + HALF),
    ]);
    let turns = (0..4).map(|k| {
        let x = inner + 1.0 + 4.0 * f64::from(k);
        line(vec![at(x, level + 4.0), at(x + 3.0, level - 4.0)])
    });
    let rod = line(vec![at(left, level), at(inner + 1.0, level)]);
    [magnet, rod].into_iter().chain(turns).collect()
}

/// A circle on a shaft.
fn motor(left: f64, level: f64) -> Vec<SketchShape> {
    let at = PlotPoint::new;
    let radius = HALF + 2.0;
    let centre = left + WIDTH - radius - 4.0;
    let corner = |k: u32| {
        let (sin, cos) = libm::sincos(TAU * f64::from(k) / f64::from(CORNERS));
        at(centre + radius * cos, level + radius * sin)
    };
    let shaft = line(vec![at(left, level), at(centre - radius, level)]);
    let foot = line(vec![at(centre + radius, level), at(left + WIDTH, level)]);
    let turn = SketchShape::Turn { centre: at(centre, level), radius: 4.5, angles: (300.0, 30.0) };
    vec![line((0..=CORNERS).map(corner).collect()), shaft, foot, turn]
}

/// A box with a resonance.
fn measured(left: f64, level: f64) -> Vec<SketchShape> {
    let block = SketchShape::Block {
        corner: PlotPoint::new(left, level - HALF),
        size: FrameSize::new(WIDTH, 2.0 * HALF),
    };
    let heights = [3.0, 2.5, 1.0, -5.0, 1.0, 4.0];
    let curve = heights
        .iter()
        .zip(0..)
        .map(|(height, k)| PlotPoint::new(left + 3.0 + 4.8 * f64::from(k), level + height));
    vec![block, line(curve.collect())]
}

/// The row of the key: the numbers of the data sheet, each mechanical one in words.
pub(super) fn key(actuator: &Actuator, words: &dyn Fn(Quantity, f64) -> String) -> SketchKey {
    let force =
        |symbol: &str, value: f64| format!("${symbol}$ = {}", words(Quantity::Force, value));
    let plain = |symbol: &str, value: Option<f64>, unit: &str| {
        value.map(|value| format!("${symbol}$ ≤ {} {unit}", digits(value)))
    };
    let items = match actuator {
        Actuator::Piezo(stack) => vec![
            Some(force("F_b", stack.blocked_force)),
            plain("U", stack.maximum_voltage, "V"),
            plain("I", stack.maximum_current, "A"),
        ],
        Actuator::VoiceCoil(coil) | Actuator::Motor(coil) => vec![
            Some(format!("$K_f$ = {}", words(Quantity::ForcePerCurrent, coil.force_per_ampere))),
            plain("I_{rms}", coil.rms_current, "A"),
            plain("I", coil.maximum_current, "A"),
            plain("U", coil.maximum_voltage, "V"),
        ],
        Actuator::Measured(measured) => vec![
            plain("U", measured.maximum_voltage, "V"),
            plain("I", measured.maximum_current, "A"),
            plain("I_{rms}", measured.rms_current, "A"),
        ],
    };
    SketchKey::new(capital(actuator.kind().in_words()), items.into_iter().flatten())
}
