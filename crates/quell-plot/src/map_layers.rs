//! Layers of maps: a field shown as colours, and its isolines.

use super::axis::{PlotAxis, Scale};
use super::colouring::{ColourMap, Colouring};
use super::field::Field;
use super::geometry::{PlotPoint, PlotRange};
use super::isoline::isolines;
use super::palette::PlotRole;

/// A field shown as colours, with one cell per grid point.
#[derive(Debug, Clone, PartialEq)]
pub struct Heatmap {
    /// The values.
    pub field: Field,
    /// Their colours.
    pub colouring: Colouring,
    /// Quantity shown: label and ticks of the colour bar; `None` for no bar.
    pub bar: Option<PlotAxis>,
    /// Reasons why points have no value, each with its own hatch.
    pub gaps: Vec<Gap>,
}

/// Points without a value, for one reason.
#[derive(Debug, Clone, PartialEq)]
pub struct Gap {
    /// The reason, shown in the legend.
    pub label: String,
    /// Whether the reason applies to each value of the field, in the order of the values.
    pub cells: Vec<bool>,
}

impl Heatmap {
    /// A field with this colouring. Points without a value are hatched.
    #[must_use]
    pub fn new(field: Field, colouring: Colouring) -> Self {
        Self { field, colouring, bar: None, gaps: Vec::new() }
    }

    /// Adds a colour bar next to the frame, for the quantity of this axis.
    #[must_use]
    pub fn bar(mut self, quantity: PlotAxis) -> Self {
        self.bar = Some(quantity);
        self
    }

    /// Gives the reason why points have no value: those without a value where `holds(column, row)` is true and
    /// no earlier reason applies.
    #[must_use]
    pub fn gap(mut self, label: impl Into<String>, holds: impl Fn(usize, usize) -> bool) -> Self {
        let across = self.field.x().len();
        let known: Vec<bool> = (0..self.field.values().len())
            .map(|at| self.gaps.iter().any(|gap| gap.cells.get(at) == Some(&true)))
            .collect();
        let values = self.field.values().iter().zip(known).enumerate();
        let cells = values
            .map(|(at, (value, known))| {
                value.is_none() && !known && holds(at % across, at / across)
            })
            .collect();
        self.gaps.push(Gap { label: label.into(), cells });
        self
    }

    /// All points without a value, grouped by reason, those without a reason last; reasons that apply nowhere
    /// are omitted.
    pub(super) fn all_gaps(&self) -> Vec<(usize, &str, Vec<bool>)> {
        let holds = |cells: &[bool]| cells.iter().any(|cell| *cell);
        let mut gaps: Vec<(usize, &str, Vec<bool>)> = Vec::new();
        let mut rest: Vec<bool> = self.field.values().iter().map(Option::is_none).collect();
        for (number, gap) in self.gaps.iter().enumerate() {
            let mut cells = vec![false; rest.len()];
            for ((cell, rest), holds) in cells.iter_mut().zip(&mut rest).zip(&gap.cells) {
                *cell = *rest && *holds;
                *rest &= !*holds;
            }
            gaps.push((number, &gap.label, cells));
        }
        gaps.push((self.gaps.len(), "no value", rest));
        gaps.retain(|(_, _, cells)| holds(cells));
        gaps
    }

    pub(super) fn colour_map(&self) -> ColourMap {
        ColourMap::new(&self.colouring, self.field.extremes())
    }
}

/// Isolines of a field at given levels.
#[derive(Debug, Clone, PartialEq)]
pub struct Contours {
    /// The values.
    pub field: Field,
    /// The levels, each with the label on its lines; empty for no label.
    pub levels: Vec<(f64, String)>,
    /// What the lines represent; they are thinner than a curve of this role.
    pub role: PlotRole,
    /// Width of the lines (pixels).
    pub width: f64,
    /// Text in the legend; empty for no entry.
    pub label: String,
}

/// Width of isolines (pixels).
const WIDTH: f64 = 0.9;

impl Contours {
    /// Isolines at these levels, labelled with their values.
    #[must_use]
    pub fn new(field: Field, levels: impl IntoIterator<Item = f64>) -> Self {
        let levels = levels
            .into_iter()
            .filter(|level| level.is_finite())
            .map(|level| (level, printed(level)))
            .collect();
        Self { field, levels, role: PlotRole::Boundary, width: WIDTH, label: String::new() }
    }

    /// Isolines at about `count` round levels within the range of the field.
    #[must_use]
    pub fn about(field: Field, count: usize) -> Self {
        let levels = field.extremes().map_or_else(Vec::new, |range| round_levels(range, count));
        Self::new(field, levels)
    }

    /// Appends a unit to the labels on the lines.
    #[must_use]
    pub fn unit(mut self, unit: &str) -> Self {
        // A narrow no-break space.
        self.levels.iter_mut().for_each(|(_, text)| *text = format!("{text}\u{202f}{unit}"));
        self
    }

    /// Removes the labels from the lines.
    #[must_use]
    pub fn plain(mut self) -> Self {
        self.levels.iter_mut().for_each(|(_, text)| text.clear());
        self
    }

    /// Sets what the lines represent.
    #[must_use]
    pub fn role(mut self, role: PlotRole) -> Self {
        self.role = role;
        self
    }

    /// Sets the width of the lines (pixels).
    #[must_use]
    pub fn width(mut self, width: f64) -> Self {
        self.width = width;
        self
    }

    /// Text in the legend.
    #[must_use]
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// The lines of each level in values of x and y; the interpolation is linear along the axes as drawn.
    pub(super) fn lines(&self, x: &PlotAxis, y: &PlotAxis) -> Vec<Vec<Vec<PlotPoint>>> {
        let positions = |axis: &PlotAxis, values: &[f64]| -> Vec<f64> {
            values.iter().map(|value| axis.along(*value)).collect()
        };
        let (at_x, at_y) = (positions(x, self.field.x()), positions(y, self.field.y()));
        // A point that a logarithmic axis cannot represent is treated as missing.
        let across = at_x.len();
        let placed = |at: usize| at_x[at % across].is_finite() && at_y[at / across].is_finite();
        let values: Vec<Option<f64>> = self
            .field
            .values()
            .iter()
            .enumerate()
            .map(|(at, value)| value.filter(|_| placed(at)))
            .collect();
        let back = |axis: &PlotAxis, position: f64| match axis.scale {
            Scale::Linear => position,
            Scale::Log => libm::pow(10.0, position),
        };
        self.levels
            .iter()
            .map(|(level, _)| {
                isolines(&at_x, &at_y, &values, *level)
                    .into_iter()
                    .map(|line| {
                        line.points
                            .iter()
                            .map(|point| PlotPoint::new(back(x, point.x), back(y, point.y)))
                            .collect()
                    })
                    .collect()
            })
            .collect()
    }
}

/// Formats a level for its label.
fn printed(level: f64) -> String {
    let text = format!("{level:.3e}");
    let short = text.parse::<f64>().unwrap_or(level);
    let short = if short == 0.0 { 0.0 } else { short };
    let text = if short != 0.0 && (short.abs() < 1e-3 || short.abs() >= 1e5) {
        let text = format!("{short:e}");
        match text.split_once('e') {
            Some((mantissa, exponent)) => format!("{mantissa}·$10^{{{exponent}}}$"),
            None => text,
        }
    } else {
        short.to_string()
    };
    text.strip_prefix('-').map_or(text.clone(), |digits| format!("\u{2212}{digits}"))
}

/// Round levels strictly within a range: multiples of 1, 2 or 5 times a power of ten.
fn round_levels(PlotRange { lower: least, upper: most }: PlotRange, count: usize) -> Vec<f64> {
    let width = 0.5 * most - 0.5 * least;
    if width <= 0.0 || count == 0 {
        return Vec::new();
    }
    let wanted = 2.0 * (width / count as f64);
    let decade = libm::pow(10.0, libm::log10(wanted).floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|leading| leading * decade)
        .find(|step| *step >= wanted * 0.75)
        .unwrap_or(wanted);
    let first = (least / step).floor();
    (1..=4 * count + 4)
        .map(|number| (first + number as f64) * step)
        .take_while(|level| *level < most)
        .filter(|level| *level > least)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_round_and_within_the_range() {
        assert_eq!(
            round_levels(PlotRange::new(0.0, 1.0), 5),
            vec![0.2, 0.4, 0.6000000000000001, 0.8]
        );
        assert_eq!(round_levels(PlotRange::new(-3.0, 4.0), 3), vec![-2.0, 0.0, 2.0]);
        assert!(round_levels(PlotRange::new(2.0, 2.0), 5).is_empty());
        assert!(round_levels(PlotRange::new(-1e308, 1e308), 5).len() > 2);
    }

    #[test]
    fn labels_of_isolines_are_short() {
        for (level, text) in [
            (0.6000000000000001, "0.6"),
            (-20.0, "−20"),
            (0.0, "0"),
            (-0.0, "0"),
            (2e-5, "2·$10^{-5}$"),
            (-1e6, "−1·$10^{6}$"),
        ] {
            assert_eq!(printed(level), text);
        }
    }

    #[test]
    fn every_missing_point_has_exactly_one_reason() {
        let values = vec![None, Some(1.0), None, None];
        let field = Field::new(vec![0.0, 1.0], vec![0.0, 1.0], values).expect("a field");
        let grid = Heatmap::new(field, Colouring::Outcomes(Vec::new()))
            .gap("first", |column, row| (column, row) == (0, 0))
            .gap("all below", |_, row| row == 0)
            .gap("lower left again", |column, _| column == 0);
        let gaps = grid.all_gaps();
        let found: Vec<(&str, Vec<bool>)> =
            gaps.into_iter().map(|(_, label, cells)| (label, cells)).collect();
        assert_eq!(
            found,
            vec![
                ("first", vec![true, false, false, false]),
                ("lower left again", vec![false, false, true, false]),
                ("no value", vec![false, false, false, true]),
            ]
        );
    }
}
