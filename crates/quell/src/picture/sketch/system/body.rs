//! The bodies of a system: what they stand for, and the text in their boxes.

use quell_model::system::{Mechanical, StateSpace, Structure};

use super::widths;
use crate::picture::sketch::symbols::{indexed, number, terms};
use crate::run::design::StudyWithDesign;
use crate::study::SystemStudy;
use crate::words::counted;

/// The most coordinates or states that are drawn one by one.
const MOST_BODIES: usize = 12;
/// Width of the name that fits into a narrow box, in letters.
const SHORT_NAME: usize = 8;
/// Width of a letter of average size (pixels), rounded up.
const LETTER: f64 = 6.3;

/// What a body is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BodyKind {
    /// One coordinate with its mass.
    Mass,
    /// One state with its equation.
    State,
    /// The modes of a component.
    Modes,
    /// Many coordinates or states, or the points of a measured structure.
    Group,
}

/// A body.
#[derive(Clone, Debug)]
pub(super) struct SketchBody {
    pub(super) kind: BodyKind,
    /// Its name.
    pub(super) name: String,
    /// Lines of text in its box.
    pub(super) lines: Vec<String>,
    /// The coordinates or states that it stands for.
    pub(super) indices: Vec<usize>,
}

/// The bodies of a study.
pub(super) fn of(study: &SystemStudy, room: f64) -> Vec<SketchBody> {
    let system = study.system();
    let names = system.structure.names();
    if study.frequency_response().is_some() {
        let lines = vec!["measured structure".to_owned(), counted(names.len(), "point")];
        return vec![group("measured structure", lines, (0..names.len()).collect())];
    }
    match &system.structure {
        Structure::Mechanical(mechanical) => match components(mechanical) {
            Some(components) => components
                .into_iter()
                .map(|(name, indices)| modes(study, mechanical, name, indices))
                .collect(),
            None if names.len() > MOST_BODIES => vec![many(names, "coordinate")],
            None => (0..names.len()).map(|place| mass(names, place)).collect(),
        },
        Structure::StateSpace(_) if names.len() > MOST_BODIES => vec![many(names, "state")],
        Structure::StateSpace(states) => {
            (0..names.len()).map(|place| state(study, states, place, room)).collect()
        }
    }
}

fn mass(names: &[String], place: usize) -> SketchBody {
    let name = &names[place];
    let place_name = (place + 1).to_string();
    let shown =
        if name.chars().count() <= SHORT_NAME { name.clone() } else { indexed("q", &place_name) };
    let lines = vec![shown, indexed("m", &place_name)];
    SketchBody { kind: BodyKind::Mass, name: name.clone(), lines, indices: vec![place] }
}

/// Modes by component, where every coordinate is a mode: modal coordinates are `mode.1`, `mode.2`, … or `component.1`, …, and no
/// other coordinate has a point in its name.
fn components(mechanical: &Mechanical) -> Option<Vec<(String, Vec<usize>)>> {
    let mut components: Vec<(String, Vec<usize>)> = Vec::new();
    for (place, name) in mechanical.coordinates().iter().enumerate() {
        let (component, _) = name.rsplit_once('.')?;
        match components.iter_mut().find(|(known, _)| known == component) {
            Some((_, indices)) => indices.push(place),
            None => components.push((component.to_owned(), vec![place])),
        }
    }
    Some(components)
}

fn modes(
    study: &SystemStudy,
    mechanical: &Mechanical,
    name: String,
    indices: Vec<usize>,
) -> SketchBody {
    let frequencies = indices.iter().map(|&place| mechanical.stiffness()[(place, place)].sqrt());
    let (least, most) = frequencies
        .fold((f64::INFINITY, 0.0_f64), |(least, most), next| (least.min(next), most.max(next)));
    let range = |factor: f64, unit: &str| {
        let (least, most) = (number(least * factor), number(most * factor));
        if indices.len() == 1 {
            format!("{least}{unit}")
        } else {
            format!("{least} to {most}{unit}")
        }
    };
    let scale = study.frequency_scale();
    let frequency = range(scale.factor, scale.unit);
    let count = counted(indices.len(), "mode");
    let lines =
        if name == "mode" { vec![count, frequency] } else { vec![name.clone(), count, frequency] };
    let name = if name == "mode" { "modes".to_owned() } else { name };
    SketchBody { kind: BodyKind::Modes, name, lines, indices }
}

fn many(names: &[String], noun: &str) -> SketchBody {
    let (first, last) = (&names[0], &names[names.len() - 1]);
    let between = format!("{first} to {last}");
    let mut lines = vec![counted(names.len(), noun)];
    if between.chars().count() <= 18 {
        lines.push(between);
    }
    group(&lines[0].clone(), lines, (0..names.len()).collect())
}

fn group(name: &str, lines: Vec<String>, indices: Vec<usize>) -> SketchBody {
    SketchBody { kind: BodyKind::Group, name: name.to_owned(), lines, indices }
}

/// A state with its equation over several lines; friction and inputs are drawn as arrows.
fn state(study: &SystemStudy, states: &StateSpace, place: usize, room: f64) -> SketchBody {
    const MOST_TERMS: usize = 12;
    let name = states.names()[place].clone();
    let mut terms = terms(states.matrix().row(place), states.names(), MOST_TERMS);
    let force = study.system().structure.force()[place];
    if force != 0.0 || terms.is_empty() {
        let sign = match (force < 0.0, terms.is_empty()) {
            (true, true) => "−",
            (true, false) => "− ",
            (false, true) => "",
            (false, false) => "+ ",
        };
        terms.push(format!("{sign}{}", number(force.abs())));
    }
    // Letters that fit into a line of the box.
    let fit = ((widths::state_width(room) - 12.0) / LETTER).floor();
    let mut lines = vec![format!("{name}′ =")];
    for term in terms {
        let longer = lines.last().map_or(0, |line| line.chars().count()) + 1 + term.chars().count();
        match lines.last_mut() {
            Some(line) if longer as f64 <= fit => *line = format!("{line} {term}"),
            _ => lines.push(term),
        }
    }
    SketchBody { kind: BodyKind::State, name, lines, indices: vec![place] }
}
