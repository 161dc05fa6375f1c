//! Frames: the box around a panel with its ticks, numbers, axis labels and title.

use kuva::render::render::TextAnchor;

use super::arrange::{LABEL_GAP, LegendPlan, NUMBER_GAP, PanelPlan};
use super::axis::Mapping;
use super::canvas::{Canvas, Setting, Stroke, path};
use super::draw::Sizes;
use super::legend;
use super::palette::FRAME;
use super::typeset::Label;

const FRAME_WIDTH: f64 = 0.8;
const MAJOR_TICK: f64 = 4.5;
const MINOR_TICK: f64 = 2.5;

/// Draws the frame of a panel with everything that stands around it.
pub(super) fn draw_frame(
    canvas: &mut Canvas,
    plan: &PanelPlan,
    sizes: Sizes,
    x: &Mapping,
    y: &Mapping,
) {
    let frame = plan.frame;
    let mut marks = Vec::new();
    let mut minor_marks = Vec::new();
    let upright = |at: f64, length: f64| {
        [
            vec![(at, frame.bottom), (at, frame.bottom - length)],
            vec![(at, frame.top), (at, frame.top + length)],
        ]
    };
    let level = |at: f64, length: f64| {
        [
            vec![(frame.left, at), (frame.left + length, at)],
            vec![(frame.right, at), (frame.right - length, at)],
        ]
    };
    for (value, _) in &plan.x_ticks.major {
        marks.extend(
            x.pixel(*value)
                .map(|at| upright(at, MAJOR_TICK))
                .into_iter()
                .flatten(),
        );
    }
    for (value, _) in &plan.y_ticks.major {
        marks.extend(
            y.pixel(*value)
                .map(|at| level(at, MAJOR_TICK))
                .into_iter()
                .flatten(),
        );
    }
    for value in &plan.x_ticks.minor {
        minor_marks.extend(
            x.pixel(*value)
                .map(|at| upright(at, MINOR_TICK))
                .into_iter()
                .flatten(),
        );
    }
    for value in &plan.y_ticks.minor {
        minor_marks.extend(
            y.pixel(*value)
                .map(|at| level(at, MINOR_TICK))
                .into_iter()
                .flatten(),
        );
    }
    canvas.stroke(path(&minor_marks, false), &Stroke::solid(FRAME, 0.6));
    canvas.stroke(path(&marks, false), &Stroke::solid(FRAME, FRAME_WIDTH));
    canvas.rectangle(frame, None, Some((FRAME, FRAME_WIDTH)));
    draw_numbers(canvas, plan, sizes, x, y);
    draw_labels(canvas, plan, sizes);
}

fn draw_numbers(canvas: &mut Canvas, plan: &PanelPlan, sizes: Sizes, x: &Mapping, y: &Mapping) {
    let frame = plan.frame;
    let size = f64::from(sizes.number);
    if plan.x_numbers {
        for (value, label) in &plan.x_ticks.major {
            let Some(at) = x.pixel(*value) else { continue };
            let baseline = frame.bottom + NUMBER_GAP + 0.76 * size;
            canvas.text(
                label,
                (at, baseline),
                Setting::new(sizes.number, TextAnchor::Middle),
            );
        }
        if plan.x_ticks.exponent != 0 {
            let below = frame.bottom + NUMBER_GAP + size + LABEL_GAP + 0.8 * f64::from(sizes.label);
            let label = Label::parse(&format!("$×10^{{{}}}$", plan.x_ticks.exponent));
            canvas.text(
                &label,
                (frame.right, below),
                Setting::new(sizes.number, TextAnchor::End),
            );
        }
    }
    if plan.y_numbers {
        for (value, label) in &plan.y_ticks.major {
            let Some(at) = y.pixel(*value) else { continue };
            let place = (frame.left - NUMBER_GAP, at + 0.36 * size);
            canvas.text(label, place, Setting::new(sizes.number, TextAnchor::End));
        }
        if plan.y_ticks.exponent != 0 {
            let label = Label::parse(&format!("$×10^{{{}}}$", plan.y_ticks.exponent));
            let place = (frame.left - 2.0, frame.top - 6.0);
            canvas.text(&label, place, Setting::new(sizes.number, TextAnchor::End));
        }
    }
}

fn draw_labels(canvas: &mut Canvas, plan: &PanelPlan, sizes: Sizes) {
    let frame = plan.frame;
    let middle = (
        0.5 * (frame.left + frame.right),
        0.5 * (frame.top + frame.bottom),
    );
    let size = f64::from(sizes.label);
    let setting = Setting::new(sizes.label, TextAnchor::Middle);
    let first = frame.bottom + NUMBER_GAP + f64::from(sizes.number) + LABEL_GAP + 0.8 * size;
    for (number, line) in plan.x_label.iter().enumerate() {
        canvas.text(
            line,
            (middle.0, first + 1.25 * size * number as f64),
            setting,
        );
    }
    let upwards = Setting {
        upwards: true,
        ..setting
    };
    for (number, line) in plan.y_label.iter().rev().enumerate() {
        let at = frame.left - plan.y_label_distance - 1.25 * size * number as f64;
        canvas.text(line, (at, middle.1), upwards);
    }
    let mut baseline = frame.top - 6.0;
    if plan.legend == LegendPlan::Above {
        baseline -= legend::lines_height(&plan.entries, frame.width(), sizes) + 2.0;
    }
    for line in plan.title.iter().rev() {
        canvas.text(
            line,
            (frame.left, baseline),
            Setting::new(sizes.title, TextAnchor::Start),
        );
        baseline -= 1.3 * f64::from(sizes.title);
    }
}
