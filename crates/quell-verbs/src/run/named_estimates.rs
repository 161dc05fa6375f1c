//! Estimates of a fit under the names and in the units in which they are reported.

use quell_design::NoStandardError;
use quell_design::estimates::Estimates;

/// Correlation of two estimates above which the data determine only a combination of them.
const CORRELATED: f64 = 0.99;

/// A parameter of a fit.
#[derive(Clone, Debug, PartialEq)]
pub struct ReportedParameter {
    /// Name in options and JSON, or path in a study.
    pub name: String,
    /// Unit; "1" without one.
    pub unit: String,
    /// Reported value over the value in the equations.
    pub factor: f64,
}

/// Estimates with their names.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedEstimates {
    /// The parameters, in the order of the estimates.
    pub parameters: Vec<ReportedParameter>,
    /// The estimates in the equations.
    pub estimates: Estimates,
}

impl NamedEstimates {
    /// The reported value of a parameter.
    pub fn value(&self, place: usize) -> f64 {
        self.parameters[place].factor * self.estimates.values[place]
    }

    /// Its standard error.
    ///
    /// # Errors
    /// Why it has none.
    pub fn error(&self, place: usize) -> Result<f64, NoStandardError> {
        let error = self.estimates.errors[place]?;
        Ok(self.parameters[place].factor.abs() * error)
    }

    /// The covariance in reported units, and the places of its rows.
    pub fn covariance(&self) -> (&[usize], Vec<Vec<f64>>) {
        let order = &self.estimates.order;
        let factor = |place: &usize| self.parameters[*place].factor;
        let rows = self.estimates.covariance.iter().zip(order);
        let scaled = rows.map(|(row, i)| {
            row.iter().zip(order).map(|(entry, j)| entry * factor(i) * factor(j)).collect()
        });
        (order, scaled.collect())
    }

    /// Table `[uncertainty]` for a study, of the parameters for which `path` gives one; empty without any.
    pub fn uncertainty(&self, path: impl Fn(&str) -> Option<String>) -> String {
        let (order, matrix) = self.covariance();
        let kept: Vec<(usize, usize, String)> = order
            .iter()
            .enumerate()
            .filter_map(|(row, place)| Some((row, *place, path(&self.parameters[*place].name)?)))
            .collect();
        match &kept[..] {
            [] => String::new(),
            [(row, place, path)] => format!(
                "[uncertainty]\n\"{path}\" = {{ normal = [{:?}, {:?}] }}\n",
                self.value(*place),
                matrix[*row][*row].sqrt()
            ),
            several => {
                let paths: Vec<&str> = several.iter().map(|(_, _, path)| path.as_str()).collect();
                let means: Vec<f64> =
                    several.iter().map(|(_, place, _)| self.value(*place)).collect();
                let rows = several.iter().map(|(i, ..)| {
                    let row: Vec<f64> = several.iter().map(|(j, ..)| matrix[*i][*j]).collect();
                    format!("    {row:?},\n")
                });
                format!(
                    "[uncertainty.covariance]\nof = {paths:?}\nmean = {means:?}\nmatrix = [\n{}]\n",
                    rows.collect::<String>()
                )
            }
        }
    }

    /// What the record does not determine, one sentence each.
    pub fn warnings(&self) -> Vec<String> {
        let estimates = &self.estimates;
        let name = |place: usize| self.parameters[place].name.as_str();
        let mut found = Vec::new();
        for place in 0..self.parameters.len() {
            match self.error(place) {
                Ok(error) if error > self.value(place).abs() => found.push(format!(
                    "{} = {} is not determined: its standard error {} exceeds it",
                    name(place),
                    crate::words::more_digits(self.value(place)),
                    quell_model::digits::digits(error, 2)
                )),
                // What the model does not explain is said about the whole fit.
                Err(why) if why.is_of_parameter() => {
                    found.push(format!("{} has no standard error: {why}", name(place)));
                }
                _ => {}
            }
        }
        for weak in &estimates.weak {
            let shares = weak.shares.iter().map(|(place, share)| {
                format!("{share:+.2} {}", name(*place)).replacen('-', "−", 1)
            });
            found.push(format!(
                "the record hardly determines the combination {} (each over its own sensitivity): fix one of them with --fix, or \
                 measure under other conditions",
                shares.collect::<Vec<_>>().join(" ")
            ));
        }
        for i in 0..estimates.order.len() {
            for j in 0..i {
                let correlation = estimates.correlation(i, j);
                if correlation.abs() > CORRELATED {
                    let names = [estimates.order[j], estimates.order[i]].map(name);
                    found.push(format!(
                        "{} and {} are determined only in combination (correlation {correlation:.4})",
                        names[0], names[1]
                    ));
                }
            }
        }
        found
    }
}
