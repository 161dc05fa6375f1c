//! The points of a map: the product of the axes of a study, the last axis fastest.

use quell_input::said::{Mention, Said};
use std::fmt::Write as _;

use serde_json::Value as Json;

use super::refine;
use crate::complaint::{Complaint, Complaints, Fault, Origin};
use crate::study::{Axis, ParameterId, Study, Sweep};

/// Largest number of points of a map: their values are kept in memory until the map is done.
pub const MOST_POINTS: usize = 100_000_000;

/// The message for a study without axes.
const EXAMPLE: &str = "at least one axis in the study, such as\n\
     \n\
     [[sweep]]\n\
     parameter = \"dither.amplitude\"\n\
     from = 0.05\n\
     to = 1.0\n\
     points = 20              # or values = [...]; spacing = \"log\"\n\
     \n\
     or ";

/// One axis of a map.
#[derive(Clone, Debug, PartialEq)]
pub struct GridAxis {
    /// Name in datasets: the path with its dots as underscores, such as `dither_amplitude`,
    /// and without a table name that the key repeats (`belt_velocity`).
    pub name: String,
    /// Path of the number that is varied, such as `dither.amplitude`.
    pub path: String,
    /// Description of the varied number in one line.
    pub about: &'static str,
    /// Symbol of the number in the equations, if any.
    pub symbol: Option<&'static str>,
    /// Unit of the values.
    pub unit: &'static str,
    /// The values in order.
    pub values: Vec<f64>,
    /// Whether they are spaced at equal ratios.
    pub logarithmic: bool,
}

/// The points of a map.
#[derive(Clone, Debug)]
pub struct Grid {
    study: Study,
    axes: Vec<GridAxis>,
    /// The number that each axis varies.
    parameters: Vec<ParameterId>,
}

impl Grid {
    /// The grid of a study.
    ///
    /// # Errors
    /// A complaint if the study has no axis, two axes that set the same number, or more
    /// than [`MOST_POINTS`] points.
    pub fn of(study: impl Into<Study>) -> Result<Self, Box<Complaint>> {
        let study = study.into();
        let disc = study.disc().ok();
        let values = |sweep: &Sweep| match &disc {
            Some(disc) => refine::values(disc, sweep),
            None => sweep.axis.values().collect(),
        };
        let sweeps = study.sweeps();
        if sweeps.is_empty() {
            let allowed = Said::from(EXAMPLE).mention(Mention::ValuesOfAmplitude);
            let complaint =
                Complaint::new(Fault::Missing, "[[sweep]]", Origin::Whole, Json::Null, allowed);
            return Err(Box::new(complaint));
        }
        for (index, sweep) in sweeps.iter().enumerate() {
            let earlier = &sweeps[..index];
            if let Some(other) = earlier.iter().find(|other| same(other, sweep)) {
                let key = format!("sweep[{index}].parameter");
                let allowed = format!("{} sets the same number as {}", sweep.path, other.path);
                let path = sweep.path.clone();
                let complaint = Complaint::new(Fault::Conflict, key, Origin::Whole, path, allowed);
                return Err(Box::new(complaint));
            }
        }
        let points = sweeps
            .iter()
            .try_fold(1_usize, |points, sweep| points.checked_mul(sweep.axis.len()))
            .filter(|points| *points <= MOST_POINTS);
        if points.is_none() {
            let allowed = format!("axes whose product is at most {MOST_POINTS} points");
            let lengths: Vec<String> =
                sweeps.iter().map(|sweep| sweep.axis.len().to_string()).collect();
            let lengths = lengths.join(" × ");
            let complaint =
                Complaint::new(Fault::Value, "[[sweep]]", Origin::Whole, lengths, allowed);
            return Err(Box::new(complaint));
        }
        let axes = sweeps.iter().map(|sweep| GridAxis {
            name: name_of(&sweep.path),
            path: sweep.path.clone(),
            about: sweep.target.about,
            symbol: sweep.target.symbol,
            unit: sweep.target.unit,
            values: values(sweep),
            logarithmic: matches!(sweep.axis, Axis::Logarithmic { .. }),
        });
        let axes: Vec<GridAxis> = axes.collect();
        let model = study.model();
        let parameters = axes.iter().map(|axis| model.parameter(&axis.path));
        let parameters = parameters.collect::<Result<_, _>>()?;
        Ok(Self { study, axes, parameters })
    }

    /// The study of the grid.
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// The number that each axis varies.
    pub fn parameters(&self) -> &[ParameterId] {
        &self.parameters
    }

    /// The axes in order.
    pub fn axes(&self) -> &[GridAxis] {
        &self.axes
    }

    /// Number of values of each axis.
    pub fn shape(&self) -> Vec<usize> {
        self.axes.iter().map(|axis| axis.values.len()).collect()
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.axes.iter().map(|axis| axis.values.len()).product()
    }

    /// Whether the number is zero; never true.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Values of the axes at point `index` in row-major order.
    pub fn values_at(&self, index: usize) -> Vec<f64> {
        let mut after = self.len();
        let values = self.axes.iter().map(|axis| {
            after /= axis.values.len();
            axis.values[index / after % axis.values.len()]
        });
        values.collect()
    }

    /// The study at point `index`.
    ///
    /// # Errors
    /// Every complaint, if these values together do not form a valid study.
    pub fn study_at(&self, index: usize) -> Result<Study, Complaints> {
        self.study_with(&self.values_at(index))
    }

    /// The study at the corners of the grid.
    pub(super) fn corner_studies(&self) -> Vec<Study> {
        // More than six axes: use only the lowest and the highest corner.
        let all = 1_usize << self.axes.len().min(6);
        let corners = (0..all).map(|corner| {
            let values: Vec<f64> = self
                .axes
                .iter()
                .enumerate()
                .map(|(index, axis)| {
                    let bit = if self.axes.len() > 6 { 0 } else { index };
                    let last = axis.values.len() - 1;
                    axis.values[if corner >> bit & 1 == 1 { last } else { 0 }]
                })
                .collect();
            self.study_with(&values).ok()
        });
        corners.flatten().collect()
    }

    /// The numbers of point `index`.
    pub(super) fn numbers_at(&self, index: usize) -> Vec<(ParameterId, f64)> {
        self.parameters.iter().cloned().zip(self.values_at(index)).collect()
    }

    fn study_with(&self, values: &[f64]) -> Result<Study, Complaints> {
        self.study.at(self.axes.iter().map(|axis| axis.path.as_str()).zip(values.iter().copied()))
    }
}

/// Whether two axes set the same number, as a parameter and its key with a unit do.
fn same(first: &Sweep, second: &Sweep) -> bool {
    first.target.number == second.target.number
}

/// `dither[1].amplitude` → `dither_1_amplitude`; `belt.belt_velocity` → `belt_velocity`.
fn name_of(path: &str) -> String {
    let (table, key) = path.rsplit_once('.').unwrap_or(("", path));
    let mut name = String::new();
    if table.is_empty() || key.starts_with(&format!("{table}_")) {
        return key.to_owned();
    }
    for letter in table.chars() {
        match letter {
            '.' | '[' => name.push('_'),
            ']' => {}
            letter => name.push(letter),
        }
    }
    let _ = write!(name, "_{key}");
    name
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::{BeltStudy, Change};

    const TEXT: &str = "schema = 1\n[belt]\ndamping_ratio = 0.01\nnormal_load = 1\n\
        belt_velocity = 0.1\n[friction]\nlaw = \"stribeck\"\nstatic_coefficient = 0.4\n\
        minimum_coefficient = 0.2\nreference_velocity = 0.2\n[[dither]]\ndirection = \"normal\"\n\
        waveform = \"sine\"\namplitude = 0.1\nfrequency_ratio = 10\n[[dither]]\n\
        direction = \"tangential\"\nwaveform = \"square\"\namplitude = 0.1\nfrequency_ratio = 7\n";

    fn grid(axes: &str) -> Result<Grid, Box<Complaint>> {
        Grid::of(BeltStudy::parse(&format!("{TEXT}{axes}"), &[]).expect("valid"))
    }

    #[test]
    fn a_point_is_the_study_with_its_changes() {
        let grid = grid(
            "[[sweep]]\nparameter = \"dither[1].amplitude\"\nvalues = [0.1, 0.3, 0.7]\n\
             [[sweep]]\nparameter = \"belt.belt_velocity\"\nfrom = 0.01\nto = 1\npoints = 4\n\
             spacing = \"log\"\n[[sweep]]\nparameter = \"belt.initial.displacement\"\nvalues = [0, 1]",
        )
        .expect("three axes");
        assert_eq!((grid.shape(), grid.len()), (vec![3, 4, 2], 24));
        let names: Vec<&str> = grid.axes().iter().map(|axis| axis.name.as_str()).collect();
        assert_eq!(names, ["dither_1_amplitude", "belt_velocity", "belt_initial_displacement"]);
        for index in 0..grid.len() {
            let values = grid.values_at(index);
            let changes: Vec<Change> = grid
                .axes()
                .iter()
                .zip(&values)
                .map(|(axis, value)| Change::parse(&format!("{}={value:?}", axis.path), "--set"))
                .collect::<Result<_, _>>()
                .expect("changes");
            let alone = BeltStudy::parse(TEXT, &changes).expect("valid");
            let point = grid.study_at(index).expect("valid");
            let point = point.belt().expect("of a belt");
            assert_eq!((point.kind(), point.changes()), (alone.kind(), alone.changes()));
            assert!(point.sweeps().is_empty());
        }
        // Row-major: the last axis fastest.
        assert_eq!(grid.values_at(1)[2], 1.0);
        assert_eq!(grid.values_at(8)[0], 0.3);
    }

    #[test]
    fn invalid_grids_are_refused() {
        let refused = grid("").expect_err("no axis");
        assert!(refused.allowed.contains("[[sweep]]\nparameter = "), "{refused}");
        let valid = grid(
            "[[sweep]]\nparameter = \"dither[0].amplitude\"\nvalues = [0.1]\n\
             [[sweep]]\nparameter = \"dither[1].amplitude\"\nvalues = [0.1]\n",
        );
        assert!(valid.is_ok());
        let axis = |path| {
            format!("[[sweep]]\nparameter = \"{path}\"\nfrom = 0.1\nto = 0.2\npoints = 100000\n")
        };
        let refused = grid(&(axis("belt.damping_ratio") + &axis("belt.belt_velocity")));
        assert!(refused.expect_err("too many").allowed.contains("at most"));
    }
}
