//! A CSV file of a measured frequency response.
//!
//! Columns `frequency` (angular) or `frequency_hz`, `output`, `input`, `re`, `im`: the receptance, displacement at `output`
//! over force at `input`. A static value (frequency 0) is needed for every pair.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fmt;

use quell_model::parameter::Bounds;
use quell_numerics::order::ascending_by;

use crate::data_file::{DataFile, Row};
use crate::files::WantedFile;
use crate::wrong_file::WrongFile;

/// What the file must be.
const WHAT: &str = "a CSV file of a frequency response";

/// The file.
pub const WANTED: WantedFile = WantedFile::of(WHAT);

/// The largest number of names.
const MOST_NAMES: usize = 200;

/// What is wrong with a measured frequency response.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WrongResponse {
    /// The name of an output or input is missing.
    NoName {
        /// The line, from 1.
        line: usize,
        /// The column.
        column: &'static str,
    },
    /// There are too many different names.
    TooManyNames,
    /// A pair has two lines at one frequency.
    RepeatedFrequency {
        /// Output and input.
        of: [String; 2],
    },
    /// A pair has no static value.
    NoStaticValue {
        /// Output and input.
        of: [String; 2],
    },
    /// A pair has other frequencies than the first one.
    OtherFrequencies {
        /// Output and input.
        of: [String; 2],
    },
    /// No frequency is above 0.
    OnlyStatic,
}

impl fmt::Display for WrongResponse {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoName { line, column } => {
                write!(f, "line {line}, {column}: a name is missing")
            }
            Self::TooManyNames => {
                write!(f, "a CSV file of at most {MOST_NAMES} different names")
            }
            Self::RepeatedFrequency { of: [output, input] } => write!(
                f,
                "a CSV file with one line for each frequency; {output} over {input} has two at one"
            ),
            Self::NoStaticValue { of: [output, input] } => write!(
                f,
                "a CSV file with a static value, a line with frequency 0, for every pair; {output} over {input} has none"
            ),
            Self::OtherFrequencies { of: [output, input] } => write!(
                f,
                "a CSV file with the same frequencies for every pair; {output} over {input} has others"
            ),
            Self::OnlyStatic => {
                f.write_str("a CSV file with a static value and at least one frequency above 0")
            }
        }
    }
}

impl std::error::Error for WrongResponse {}

impl From<WrongResponse> for WrongFile<WrongResponse> {
    fn from(why: WrongResponse) -> Self {
        Self::Contents(why)
    }
}

/// A measured receptance.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrequencyResponse {
    /// Angular frequencies, ascending, the first 0.
    pub frequencies: Vec<f64>,
    /// Names of outputs and inputs.
    pub names: Vec<String>,
    /// Output and input of each series, as places among the names.
    pub pairs: Vec<(usize, usize)>,
    /// Real and imaginary part at each frequency, one series for each pair: displacement over force in the units of the
    /// file.
    pub data: Vec<Vec<[f64; 2]>>,
    /// Whether the file gives frequencies in hertz.
    pub in_hertz: bool,
}

impl FrequencyResponse {
    /// The series of displacement at `output` over force at `input`, places among the names.
    pub fn receptance(&self, output: usize, input: usize) -> Option<&[[f64; 2]]> {
        let pair = self.pairs.iter().position(|pair| *pair == (output, input))?;
        self.data.get(pair).map(Vec::as_slice)
    }
}

/// Frequencies and values of each output and input.
type ResponseSeries = BTreeMap<(usize, usize), Vec<(f64, [f64; 2])>>;

/// The response of a text.
///
/// # Errors
/// What is wrong, with its line.
pub fn parse(text: &str) -> Result<FrequencyResponse, WrongFile<WrongResponse>> {
    let file = DataFile::new(text, WHAT)?;
    let (frequency, in_hertz) = file.frequency()?;
    let [output, input, re, im] = ["output", "input", "re", "im"].map(|name| file.needed(name));
    let (output, input, re, im) = (output?, input?, re?, im?);
    let mut names: Vec<String> = Vec::new();
    let mut series = ResponseSeries::new();
    for row in file.rows() {
        let number = |at, name, bounds: Bounds| {
            row.number(at, name, &bounds.to_string(), |value| bounds.contains(value))
        };
        let written = number(frequency, "frequency", Bounds::NOT_NEGATIVE)?;
        let frequency = if in_hertz { TAU * written } else { written };
        let output = place(&mut names, row, output, "output")?;
        let input = place(&mut names, row, input, "input")?;
        let value = [number(re, "re", Bounds::FINITE)?, number(im, "im", Bounds::FINITE)?];
        series.entry((output, input)).or_default().push((frequency, value));
    }
    Ok(ordered(names, series, in_hertz)?)
}

/// The place of a name among the names.
fn place(
    names: &mut Vec<String>,
    row: &Row<'_>,
    at: usize,
    column: &'static str,
) -> Result<usize, WrongResponse> {
    let name = row.text(at);
    if name.is_empty() {
        return Err(WrongResponse::NoName { line: row.line(), column });
    }
    if let Some(found) = names.iter().position(|known| known == name) {
        return Ok(found);
    }
    if names.len() == MOST_NAMES {
        return Err(WrongResponse::TooManyNames);
    }
    names.push(name.to_owned());
    Ok(names.len() - 1)
}

/// The series in the order of frequency, each at the same frequencies.
fn ordered(
    names: Vec<String>,
    series: ResponseSeries,
    in_hertz: bool,
) -> Result<FrequencyResponse, WrongResponse> {
    let mut found = FrequencyResponse { names, in_hertz, ..FrequencyResponse::default() };
    for (pair, mut values) in series {
        ascending_by(&mut values, |a| a.0);
        let of = [pair.0, pair.1].map(|place| found.names[place].clone());
        let (frequencies, values): (Vec<f64>, Vec<[f64; 2]>) = values.into_iter().unzip();
        if frequencies.windows(2).any(|two| two[0] == two[1]) {
            return Err(WrongResponse::RepeatedFrequency { of });
        }
        if frequencies.first() != Some(&0.0) {
            return Err(WrongResponse::NoStaticValue { of });
        }
        if found.frequencies.is_empty() {
            found.frequencies = frequencies;
        } else if found.frequencies != frequencies {
            return Err(WrongResponse::OtherFrequencies { of });
        }
        found.pairs.push(pair);
        found.data.push(values);
    }
    if found.frequencies.len() < 2 {
        return Err(WrongResponse::OnlyStatic);
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_are_ordered_and_complete() {
        let head = "frequency_hz,output,input,re,im\n";
        let right = format!("{head}2,a,a,0.5,-0.1\n0,a,a,1,0\n0,b,a,2,0\n2,b,a,3,1\n");
        let found = parse(&right).expect("a response");
        assert_eq!(found.frequencies, [0.0, 2.0 * TAU]);
        assert_eq!(found.names, ["a", "b"]);
        assert_eq!(found.receptance(1, 0), Some(&[[2.0, 0.0], [3.0, 1.0]][..]));
        assert_eq!(found.receptance(0, 1), None);
        for (rows, part) in [
            ("1,a,a,1,0\n2,a,a,1,0\n", "static value"),
            ("0,a,a,1,0\n", "at least one frequency"),
            ("0,a,a,1,0\n1,a,a,1,0\n1,a,a,2,0\n", "two at one"),
            ("0,a,a,1,0\n1,a,a,1,0\n0,b,a,2,0\n", "others"),
            ("0,a,a,nan,0\n", "line 2, re"),
            ("0,,a,1,0\n", "line 2, output"),
        ] {
            let wrong = parse(&format!("{head}{rows}")).expect_err(rows).to_string();
            assert!(wrong.contains(part), "{rows}: {wrong}");
        }
        let both = "frequency,frequency_hz,output,input,re,im\n";
        assert!(parse(both).expect_err("two units").to_string().contains("both"));
    }
}
