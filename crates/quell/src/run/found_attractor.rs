//! `attractor` of a belt: the motion on which a run ends, and its Lyapunov exponents. They are those of the belt as a system.

use std::f64::consts::TAU;

use quell_dynamics::attractor::{Attractor, AttractorKind, Patience, Unsettled, measure, settle};
use quell_dynamics::simulation::{Start, within};
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::attractor::{put, put_section, settings, words};
use super::exponents::{ExponentTimes, JudgedMotion, MeasuredExponents, MeasuredMotion};
use super::{failed, start};
use crate::complaint::Failure;
use crate::contact_state::refused_of_belt;
use crate::dataset::Dataset;
use crate::effort::STEPS_OF_A_SEARCH;
use crate::fields::Fields;
use crate::study::BeltStudy;
use crate::words::{digits, in_words, start_in_words};

/// What to find.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AttractorRequest {
    /// Displacement and velocity at τ = 0 instead of the study's start.
    pub start: Option<(f64, f64)>,
    /// Whether the Lyapunov exponents are measured, and over which times.
    pub lyapunov: Option<ExponentTimes>,
}

/// The motion on which a run of a belt ends.
#[derive(Clone, Debug)]
pub struct AttractorOfBelt {
    /// The start in words.
    pub start: String,
    /// The motion, or why it is not known.
    pub end: Result<Attractor, Unsettled>,
    /// Period of the section.
    pub period: f64,
    /// Periods of the section until the run had settled.
    pub periods: u64,
    /// Its exponents, if they were requested, or why they are not known.
    pub exponents: Option<Result<MeasuredExponents, String>>,
}

/// The motion on which the run of a study ends.
///
/// # Errors
/// A complaint about the start; [`Failure::Failed`] if the run stops.
pub fn run(study: &BeltStudy, request: &AttractorRequest) -> Result<AttractorOfBelt, Failure> {
    refused_of_belt(study, "attractor")?;
    within(STEPS_OF_A_SEARCH, || found(study, request))
}

fn found(study: &BeltStudy, request: &AttractorRequest) -> Result<AttractorOfBelt, Failure> {
    let belt = study.belt();
    let begun = match request.start {
        Some((displacement, velocity)) => Start { time: 0.0, displacement, velocity },
        None => start(study)?,
    };
    let settings = settings(belt)?;
    let patience = Patience { tolerance: study.solver().tolerance, ..Patience::SWEEP };
    let settled = settle(&settings, begun, patience).map_err(failed)?;
    let attractor = measure(&settings, &settled).map_err(failed)?;
    let (period, periods) = (settings.section.period, settled.periods);
    let at = attractor.as_ref().map_or(settled.state, |attractor| attractor.state);
    let kind = attractor.as_ref().map(|attractor| attractor.kind);
    let exponents = request.lyapunov.map(|times| {
        // One mass on its spring: the slowest oscillation has about the period 2π.
        let times = times.over(|| Ok(TAU.max(period)))?;
        let still = attractor.as_ref().is_some_and(|attractor| attractor.size() == 0.0);
        let judged = match kind {
            Some(AttractorKind::Periodic { .. }) if settings.is_autonomous() && still => {
                JudgedMotion::SteadySliding
            }
            Some(AttractorKind::Periodic { periods, radius }) if !settings.is_autonomous() => {
                JudgedMotion::Periodic { radius, period: f64::from(periods) * period }
            }
            Some(AttractorKind::QuasiPeriodic) => JudgedMotion::QuasiPeriodic,
            Some(AttractorKind::Unclassified) => JudgedMotion::NotPeriodic,
            _ => JudgedMotion::Other,
        };
        let motion = MeasuredMotion {
            system: &belt.system(),
            state: &[at.displacement, at.velocity],
            moves_freely: settings.is_autonomous() && !still && kind != Some(AttractorKind::Rest),
            judged,
        };
        Ok::<_, Failure>(MeasuredExponents::of(&motion, times))
    });
    let start = match request.start {
        None => start_in_words(study),
        Some((x, v)) => format!(
            "from x = {}, x′ = {}",
            in_words(study, Quantity::Displacement, x),
            in_words(study, Quantity::Velocity, v)
        ),
    };
    let end = attractor.ok_or_else(|| settled.why().unwrap_or(Unsettled::Moving));
    Ok(AttractorOfBelt { start, end, period, periods, exponents: exponents.transpose()? })
}

impl AttractorOfBelt {
    /// The exponents, if they are known.
    pub fn measured(&self) -> Option<&MeasuredExponents> {
        self.exponents.as_ref()?.as_ref().ok()
    }

    /// Units of time and of rates, each with its value in a unit of the equations.
    pub fn units(study: &BeltStudy) -> [(&'static str, f64); 2] {
        match study.scales() {
            Some(scales) => {
                let omega = scales.angular_frequency();
                [("s", 1.0 / omega), ("1/s", omega)]
            }
            None => [("1/ω₀", 1.0), ("ω₀", 1.0)],
        }
    }

    /// A rate with its unit.
    pub fn rate(study: &BeltStudy, rate: f64) -> String {
        let [_, (unit, factor)] = Self::units(study);
        format!("{} {unit}", digits(factor * rate))
    }

    /// The answer in one or two sentences.
    pub fn sentence(&self, study: &BeltStudy) -> String {
        let start = &self.start;
        let end = match &self.end {
            Ok(attractor) => {
                let words = words(study.scales(), attractor, self.period);
                format!("The run {start} ends on this motion: {words}.")
            }
            Err(why) => format!("Where the run {start} ends is unknown: {}.", why.about()),
        };
        let exponents = match &self.exponents {
            None => return end,
            Some(Ok(measured)) => measured.sentence(|rate| Self::rate(study, rate)),
            Some(Err(why)) => format!("Its Lyapunov exponents are unknown: {why}."),
        };
        format!("{end} {exponents}")
    }

    /// As JSON.
    pub fn json(&self, study: &BeltStudy) -> Json {
        let mut fields = Fields::new(study.scales());
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("start", self.start.clone())
            .plain("periods_until_settled", self.periods);
        match &self.end {
            Ok(attractor) => {
                let mut inner = Fields::new(study.scales());
                put(&mut inner, attractor, self.period);
                put_section(&mut inner, attractor);
                fields.nested("attractor", inner);
            }
            Err(why) => {
                fields.unknown("attractor", why.about());
            }
        }
        match &self.exponents {
            Some(Ok(measured)) => {
                let mut inner = Fields::new(study.scales());
                measured.put(&mut inner);
                fields.nested("lyapunov", inner);
            }
            Some(Err(why)) => {
                fields.unknown("lyapunov", why.clone());
            }
            None => {}
        }
        let warnings = self.measured().map(MeasuredExponents::warnings).unwrap_or_default();
        fields.plain("warnings", warnings);
        fields.finish()
    }

    /// The exponents over the time up to which they are averaged.
    pub fn dataset(&self, study: &BeltStudy) -> Option<Dataset> {
        let dataset = Dataset::new(study, "attractor").fact(self.sentence(study));
        let [time, rate] = Self::units(study);
        Some(self.measured()?.dataset(dataset, time, rate))
    }
}
