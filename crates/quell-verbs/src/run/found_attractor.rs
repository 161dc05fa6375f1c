//! `attractor`: the motion on which a run ends, and its Lyapunov exponents.

use quell_dynamics::attractor::{EndOfRun, MotionKind, NoEnd, SystemAttractor, end_of_run};
use quell_dynamics::simulation::within;
use quell_linear::pure_slip::period;
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::exponents::{
    ExponentTimes, JudgedMotion, MeasuredExponents, MeasuredMotion, NoMeasuredExponents,
};
use super::system::attractor::{in_words, put_attractor};
use super::system::of_runs::beyond_laws;
use super::system::periods::slowest_period;
use super::system::start::{StateNumbers, start_in_words, start_with};
use super::system::{has_equations, rate_of};
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::effort::STEPS_OF_A_SEARCH;
use crate::fields::Fields;
use crate::study::{SystemStudy, UnitSystem};

/// What to find.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AttractorRequest {
    /// Numbers that replace those of the study's start.
    pub start: StateNumbers,
    /// Whether the Lyapunov exponents are measured, and over which times.
    pub lyapunov: Option<ExponentTimes>,
}

/// The motion on which a run of a system ends.
#[derive(Clone, Debug)]
pub struct FoundAttractor {
    /// The start in words.
    pub start: String,
    /// The motion, or why it is not known.
    pub end: Result<EndOfRun, NoEnd>,
    /// Its exponents, if they were requested, or why they are not known.
    pub exponents: Option<Result<MeasuredExponents, NoMeasuredExponents>>,
}

/// The motion on which the run of a study ends.
///
/// # Errors
/// Complaints about the start and the times.
pub fn run(study: &SystemStudy, request: &AttractorRequest) -> Result<FoundAttractor, Failure> {
    has_equations(study, "attractor")?;
    let system = study.system();
    let start = start_with(study, &request.start)?.state;
    let end = within(STEPS_OF_A_SEARCH, || end_of_run(system, &study.observe(), &start));
    let exponents = request.lyapunov.map(|times| {
        let times = times.over(|| slowest_period(study, "--record"))?;
        let attractor = end.as_ref().ok().map(|end| &end.attractor);
        let kind = attractor.map(|attractor| &attractor.kind);
        let judged = match kind {
            Some(MotionKind::Periodic { periods, radius }) => {
                period(system).map_or(JudgedMotion::Other, |period| JudgedMotion::Periodic {
                    radius: *radius,
                    period: f64::from(*periods) * period,
                })
            }
            Some(MotionKind::Cycle { period, radius }) => {
                JudgedMotion::Periodic { radius: *radius, period: *period }
            }
            Some(MotionKind::QuasiPeriodic { .. }) => JudgedMotion::QuasiPeriodic,
            Some(MotionKind::NotPeriodic { .. }) => JudgedMotion::NotPeriodic,
            Some(MotionKind::Rest) if attractor.is_some_and(SystemAttractor::slides) => {
                JudgedMotion::SteadySliding
            }
            Some(MotionKind::Rest) | None => JudgedMotion::Other,
        };
        let motion = MeasuredMotion {
            system,
            state: attractor.map_or(&start, |attractor| &attractor.state),
            moves_freely: !system.is_dithered() && kind != Some(&MotionKind::Rest),
            judged,
        };
        Ok::<_, Failure>(MeasuredExponents::of(&motion, times))
    });
    let start = start_in_words(study, &request.start);
    Ok(FoundAttractor { start, end, exponents: exponents.transpose()? })
}

impl FoundAttractor {
    /// The exponents, if they are known.
    pub fn measured(&self) -> Option<&MeasuredExponents> {
        self.exponents.as_ref()?.as_ref().ok()
    }

    /// The answer in one or two sentences.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let start = &self.start;
        let end = match &self.end {
            Ok(end) => {
                let words = in_words(&end.attractor, study.units());
                format!("The run {start} ends on this motion: {words}.")
            }
            Err(why) if self.exponents.is_none() => format!(
                "Where the run {start} ends is unknown: {why}. Its Lyapunov exponents (--lyapunov) distinguish an irregular motion from a \
                 regular one."
            ),
            Err(why) => format!("Where the run {start} ends is unknown: {why}."),
        };
        let exponents = match &self.exponents {
            None => return end,
            Some(Ok(measured)) => measured.sentence(|rate| rate_of(study.units(), rate)),
            Some(Err(why)) => format!("Its Lyapunov exponents are unknown: {why}."),
        };
        format!("{end} {exponents}")
    }

    /// As JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let mut fields = Fields::in_units(study.units());
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("start", self.start.clone());
        match &self.end {
            Ok(end) => {
                let mut inner = Fields::in_units(study.units());
                put_attractor(&mut inner, &end.attractor, study);
                fields.nested("attractor", inner);
                fields.plain("periods_until_settled", end.periods);
            }
            Err(why) => {
                fields.unknown("attractor", why);
                fields.unknown("periods_until_settled", why);
            }
        }
        match &self.exponents {
            Some(Ok(measured)) => {
                let mut inner = Fields::in_units(study.units());
                measured.put(&mut inner);
                fields.nested("lyapunov", inner);
            }
            Some(Err(why)) => {
                fields.unknown("lyapunov", why);
            }
            None => {}
        }
        fields.plain("warnings", self.warnings(study));
        fields.finish()
    }

    /// Warnings: those of the study, about slip beyond the ranges of the laws, and about the exponents.
    fn warnings(&self, study: &SystemStudy) -> Vec<String> {
        let attractor = self.end.as_ref().ok().map(|end| &end.attractor);
        let beyond = attractor.map_or_else(Vec::new, |attractor| {
            beyond_laws(study, |contact| attractor.largest_slip[contact])
        });
        let warnings = study.warnings().iter().cloned().chain(beyond);
        let found = self.measured().map(MeasuredExponents::warnings).unwrap_or_default();
        warnings.chain(found).collect()
    }

    /// The exponents over the time up to which they are averaged.
    pub fn dataset(&self, study: &SystemStudy) -> Option<Dataset> {
        let dataset = Dataset::of(&study.into(), "attractor").fact(self.sentence(study));
        let time = study.units().unit(Quantity::Time).unwrap_or("1");
        Some(self.measured()?.dataset(dataset, (time, 1.0), (unit_of_rates(study), 1.0)))
    }
}

/// The unit of rates in datasets.
pub fn unit_of_rates(study: &SystemStudy) -> &'static str {
    if study.units() == UnitSystem::None { "1" } else { "1/s" }
}
