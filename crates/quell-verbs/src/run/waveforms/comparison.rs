//! Waveforms side by side: which is least in each quantity, and by what it is known.
//!
//! Exact amplitudes rank the waveforms, with the cost at these amplitudes. Averages rank them only where no waveform has an exact
//! amplitude, and then those that repeat fast enough.

use std::fmt::Write as _;

use quell_linear::driven_point::NoDrivenPoint;
use quell_linear::linear_cost::LinearCost;
use quell_model::Waveform;
use quell_model::units::Quantity;

use super::{NoLeastDither, label};
use crate::reasons::reasons;
use crate::run::system::in_units;
use crate::study::SystemStudy;

/// The least dither of one waveform that quenches.
#[derive(Clone, Debug, PartialEq)]
pub struct LeastDither {
    /// The amplitude.
    pub amplitude: f64,
    /// The larger amplitude from which sliding is unstable again, if any.
    pub until: Option<f64>,
}

/// One waveform of the comparison.
#[derive(Clone, Debug)]
pub struct ComparedWaveform {
    /// The waveform.
    pub waveform: Waveform,
    /// Share of the period in which it acts: 1 except for bursts.
    pub duty_cycle: f64,
    /// Whether it is that of the study.
    pub own: bool,
    /// Whether it repeats too slowly for averaging to rank it.
    pub slow: bool,
    /// The least dither by averaging, or why no amplitude quenches.
    pub averaged: Result<LeastDither, NoLeastDither>,
    /// The exact least dither at the study's frequency, or why it is unknown.
    pub exact: Result<LeastDither, NoLeastDither>,
    /// The cost of unit amplitude in the structure without friction, or why it has no value.
    pub unit: Result<LinearCost, NoDrivenPoint>,
    /// Why the average, which does not know the state of the contacts, differs from that with it at the least amplitude.
    pub without_state: Option<String>,
}

reasons! {
    /// Why a quantity of a waveform has no value.
    pub enum NoWaveformValue {
        /// No amplitude quenches.
        NoLeast(NoLeastDither),
        /// The cost has no value.
        NoCost(NoDrivenPoint),
        ;
    }
}

/// The waveforms of a study.
#[derive(Clone, Debug)]
pub struct WaveformComparison {
    /// Every waveform: sine, triangle, square, the study's own, bursts in ascending duty cycle.
    pub rows: Vec<ComparedWaveform>,
    /// Name of the carrier of the bursts.
    pub carrier: &'static str,
}

/// What the amplitudes are by which waveforms are ranked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RankedBy {
    /// Exact thresholds at the study's frequency.
    Exact,
    /// Averages.
    Averaging,
}

impl RankedBy {
    /// The word in outputs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Averaging => "averaging",
        }
    }
}

/// A quantity in which waveforms are compared.
pub struct CostColumn {
    /// Name in JSON.
    pub(crate) name: &'static str,
    /// Words for tables and sentences.
    pub words: &'static str,
    /// What it is.
    pub quantity: Quantity,
    /// The value at an amplitude.
    of: fn(f64, &ComparedWaveform) -> Result<f64, NoDrivenPoint>,
}

/// The compared quantities, the amplitude first.
pub const COLUMNS: [CostColumn; 5] = [
    CostColumn {
        name: "amplitude",
        words: "amplitude",
        quantity: Quantity::Force,
        of: |amplitude, _| Ok(amplitude),
    },
    CostColumn {
        name: "root_mean_square",
        words: "rms force",
        quantity: Quantity::Force,
        of: |amplitude, row| Ok(amplitude * row.waveform.root_mean_square()),
    },
    CostColumn {
        name: "power",
        words: "power",
        quantity: Quantity::Power,
        of: |amplitude, row| Ok(amplitude * amplitude * row.unit?.power),
    },
    CostColumn {
        name: "stroke",
        words: "stroke",
        quantity: Quantity::Displacement,
        of: |amplitude, row| Ok(amplitude * row.unit?.stroke),
    },
    CostColumn {
        name: "velocity",
        words: "velocity",
        quantity: Quantity::Velocity,
        of: |amplitude, row| Ok(amplitude * row.unit?.velocity),
    },
];

impl ComparedWaveform {
    /// A short label, such as "burst 3 : 5": periods of the carrier in the burst and in the pause.
    pub fn label(&self) -> String {
        label(&self.waveform)
    }

    /// A quantity at the least amplitude by averaging.
    ///
    /// # Errors
    /// Why it has no value.
    pub fn averaged_value(&self, column: &CostColumn) -> Result<f64, NoWaveformValue> {
        Ok((column.of)(self.averaged.as_ref().map_err(Clone::clone)?.amplitude, self)?)
    }

    /// A quantity at the exact least amplitude, or why it has no value.
    pub(crate) fn exact_value(&self, column: &CostColumn) -> Result<f64, NoWaveformValue> {
        Ok((column.of)(self.exact.clone()?.amplitude, self)?)
    }
}

impl WaveformComparison {
    /// By what the waveforms are ranked.
    pub fn ranked_by(&self) -> RankedBy {
        if self.rows.iter().any(|row| row.exact.is_ok()) {
            RankedBy::Exact
        } else {
            RankedBy::Averaging
        }
    }

    /// A quantity of a waveform at the amplitude by which it is ranked.
    pub fn ranked(&self, row: &ComparedWaveform, column: &CostColumn) -> Option<f64> {
        match self.ranked_by() {
            RankedBy::Exact => row.exact_value(column).ok(),
            RankedBy::Averaging if row.slow => None,
            RankedBy::Averaging => row.averaged_value(column).ok(),
        }
    }

    /// The waveform that is least in a column.
    pub fn best(&self, column: &CostColumn) -> Option<&ComparedWaveform> {
        let known = self.rows.iter().filter_map(|row| Some((row, self.ranked(row, column)?)));
        known.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(row, _)| row)
    }

    /// The carrier without pauses.
    fn carrier_row(&self) -> Option<&ComparedWaveform> {
        self.rows.iter().find(|row| row.waveform.name() == self.carrier)
    }

    /// The result in a few sentences.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let force = |value: f64| in_units(study.units(), Quantity::Force, value);
        let [amplitude, _, power, ..] = &COLUMNS;
        let Some(best) = self.best(amplitude) else { return self.without_best() };
        let value = self.ranked(best, amplitude).map(&force).unwrap_or_default();
        let count = self.rows.iter().filter(|row| self.ranked(row, amplitude).is_some()).count();
        let of = match count {
            1 => "The only waveform with".to_owned(),
            count if count == self.rows.len() => format!("Of {count} waveforms"),
            count => format!("Of the {count} waveforms (of {}) with", self.rows.len()),
        };
        let mut text = match (self.ranked_by(), count == self.rows.len(), count) {
            (RankedBy::Exact, true, _) => format!(
                "{of} {} stabilises steady sliding with the least amplitude, {value}, by exact thresholds at the study's frequency.",
                named(best)
            ),
            (RankedBy::Exact, false, 1) => format!(
                "{of} an exact amplitude that stabilises steady sliding is {}, with {value}.",
                named(best)
            ),
            (RankedBy::Exact, false, _) => format!(
                "{of} an exact amplitude that stabilises steady sliding, {} has the least, {value}.",
                named(best)
            ),
            // Why is said of every waveform in the table.
            (RankedBy::Averaging, ..) => format!(
                "By averaging alone {} has the least amplitude, {value}: no waveform has an exact one that stabilises steady sliding.",
                named(best)
            ),
        };
        text += &self.least_power(power);
        text
    }

    /// Why no waveform is best.
    fn without_best(&self) -> String {
        if self.rows.iter().any(|row| row.averaged.is_ok()) {
            return "No waveform has an exact amplitude that quenches, and every waveform that quenches by averaging repeats too slowly \
                    for averaging to rank it."
                .to_owned();
        }
        let why = self.rows.iter().find_map(|row| row.averaged.as_ref().err());
        format!(
            "No waveform quenches: {}.",
            why.map_or("none was tried".to_owned(), ToString::to_string)
        )
    }

    /// The waveform that takes least power, against the carrier without pauses.
    fn least_power(&self, power: &CostColumn) -> String {
        let carrier = self.carrier_row().and_then(|row| self.ranked(row, power));
        let (Some(cheapest), Some(whole)) =
            (self.best(power), carrier.filter(|whole| *whole > 0.0))
        else {
            return String::new();
        };
        let carrier = self.carrier;
        if cheapest.waveform.name() == carrier {
            return format!(" No waveform takes less power than the continuous {carrier}.");
        }
        let mut text = String::new();
        if let Some(least) = self.ranked(cheapest, power) {
            let share = quell_model::digits::digits(100.0 * least / whole, 3);
            let named = named(cheapest);
            let _ = write!(
                text,
                " The least power is that of {named}, {share} % of that of the continuous {carrier}."
            );
        }
        text
    }
}

/// "a sine", "a burst 3 : 5".
fn named(row: &ComparedWaveform) -> String {
    format!("a {}", row.label())
}
