//! `stability`: averaged stability of steady sliding, and the amplitudes at which it changes.
//!
//! Protocol "averaged": the slow motion about steady sliding under fast dither by finite-R averaging, which uses the oscillator's own
//! response to the dither and one more term of the fast motion under normal dither. `limit` is the dissertation's averaging, in the
//! limit of high frequency R → ∞ (2.26).

pub use quell_linear::averaging::SlopeSide;
use quell_linear::averaging::{
    AveragedVerdict, AveragingError, AveragingOptions, Becomes, Criterion, CriticalAmplitude,
    CrossingKind, EverywhereStable, NeverStable, UndecidedBecause, UnstableBand, criterion,
    critical_amplitudes, everywhere_stable_amplitude, everywhere_stable_under_noise, fast_wave,
    unstable_bands,
};
use quell_linear::growth::{Growth, of_criterion};
use quell_linear::linearised::Linearised;
use quell_linear::spectrum;
use quell_model::units::Quantity;
use quell_model::{Belt, Dither};
use serde_json::Value as Json;

use crate::contact_state;
use crate::fields::Fields;
use crate::noise::{few_lines, normal_noise};
use crate::range;
use crate::study::BeltStudy;
use crate::words::{digits, in_words};

/// Below this frequency ratio a dither is hardly fast.
pub(crate) const FAST: f64 = 5.0;

/// Averaged stability under one model of the fast motion.
#[derive(Clone, Debug)]
pub struct AveragedStability {
    /// Model of the fast motion.
    pub options: AveragingOptions,
    /// Criterion and verdict at the study's own amplitude.
    pub criterion: Result<Criterion, AveragingError>,
    /// Amplitudes of the first dither at which stability changes.
    pub critical_amplitudes: Result<Vec<CriticalAmplitude>, AveragingError>,
    /// Amplitude ratio from which every belt velocity is stable, or why none exists.
    pub everywhere_stable: Result<f64, String>,
    /// Belt velocities at which the study's own dither leaves steady sliding unstable.
    pub unstable_bands: Result<Vec<UnstableBand>, AveragingError>,
}

/// Averaged stability of a study.
#[derive(Clone, Debug)]
pub struct BeltStability {
    /// By finite-R averaging, with the oscillator's own response; without dither by the slope of the friction law.
    pub averaged: AveragedStability,
    /// In the limit of high frequency, R → ∞: the dissertation's averaging. `None` without dither, which has no such limit.
    pub limit: Option<AveragedStability>,
    /// The exact small motion about steady sliding without dither that grows fastest, with the state of bristles; `None` of a law
    /// without bristles, whose criterion is exact there.
    pub bristles: Option<Result<Growth, String>>,
}

/// Averaged stability of a study.
pub fn run(study: &BeltStudy) -> BeltStability {
    let belt = study.belt();
    BeltStability {
        averaged: averaged(belt, AveragingOptions::FINITE_R),
        limit: (!belt.dithers().is_empty()).then(|| averaged(belt, AveragingOptions::LIMIT)),
        bristles: belt.friction().bristles().map(|_| small_motions_of_bristles(belt)),
    }
}

/// The small motion about steady sliding without dither that grows fastest, with the state of the bristles.
fn small_motions_of_bristles(belt: &Belt) -> Result<Growth, String> {
    let system = belt.undithered().system();
    let linear = Linearised::new(&system).map_err(|why| why.to_string())?;
    spectrum::growth(&linear, &linear.friction()).map_err(|why| why.to_string())
}

fn averaged(belt: &Belt, options: AveragingOptions) -> AveragedStability {
    AveragedStability {
        options,
        criterion: criterion(belt, options),
        critical_amplitudes: critical_amplitudes(belt, options),
        everywhere_stable: everywhere_stable(belt, options),
        unstable_bands: unstable_bands(belt, options),
    }
}

/// Whether damping and the slope of the law cancel at the belt velocity.
fn is_neutral(belt: &Belt) -> bool {
    let slope = belt.friction().slope(belt.belt_velocity());
    belt.damping_rate(slope, belt.normal_load()) == 0.0
}

fn everywhere_stable(belt: &Belt, options: AveragingOptions) -> Result<f64, String> {
    let [dither] = belt.dithers() else {
        return Err(match belt.dithers() {
            [] => "the study has no dither".to_owned(),
            _ => "it is defined for a single dither, and this study has several".to_owned(),
        });
    };
    let is_noise = !dither.waveform.is_periodic();
    if !is_noise && !dither.waveform.is_symmetric() {
        let name = dither.waveform.name();
        return Err(format!(
            "it is known for sine, triangle, square and noise; \"{name}\" has corners at every maximum of its fast velocity"
        ));
    }
    let found = if is_noise {
        everywhere_stable_under_noise(belt, dither, options)
    } else {
        fast_wave(dither, options.response).and_then(|wave| {
            let (damping, load) = (belt.damping_ratio(), belt.normal_load());
            everywhere_stable_amplitude(belt.friction(), damping, load, wave, dither.direction)
        })
    };
    match found.map_err(|why| why.to_string())? {
        EverywhereStable::Always if is_neutral(belt) => {
            Err("without damping and with a flat friction law nothing grows or decays".to_owned())
        }
        EverywhereStable::Always => Ok(0.0),
        EverywhereStable::From { amplitude_ratio, .. } => Ok(amplitude_ratio),
        EverywhereStable::Never { why } => Err(match why {
            NeverStable::NoDamping => {
                "without damping, a friction law that keeps falling leaves fast belts unstable at any amplitude"
            }
            NeverStable::InnerRegion => {
                "slow belts stay unstable at any amplitude: the friction law falls too steeply"
            }
            NeverStable::OffScale => "no such amplitude ratio exists up to 10⁶ v_m",
            NeverStable::NoEdge => {
                "without dither, sliding is unstable at every belt velocity examined (up to 365 v_m), so no amplitude was tried"
            }
        }
        .to_owned()),
    }
}

/// The word of a verdict.
fn word(criterion: &Result<Criterion, AveragingError>) -> &'static str {
    match criterion.as_ref().map(|criterion| criterion.verdict) {
        Ok(AveragedVerdict::Stable) => "stable",
        Ok(AveragedVerdict::Unstable) => "unstable",
        Ok(AveragedVerdict::Undecided { .. }) | Err(_) => "undecided",
    }
}

/// Growth by a factor of e in decibels: 20 log₁₀ e.
pub const DECIBELS: f64 = 20.0 * std::f64::consts::LOG10_E;

impl AveragedStability {
    /// "stable", "unstable" or "undecided".
    pub fn verdict(&self) -> &'static str {
        word(&self.criterion)
    }

    fn put(&self, study: &BeltStudy, fields: &mut Fields) {
        let words = |why: &AveragingError| why.to_string();
        let value =
            |field: fn(&Criterion) -> f64| self.criterion.as_ref().map(field).map_err(words);
        let rate = value(|criterion| of_criterion(criterion.value));
        if let Some(scales) = fields.scales() {
            let decibels = rate.clone().map(|rate| DECIBELS * rate * scales.angular_frequency());
            fields.decibels("growth_rate_db_per_s", decibels);
        }
        fields
            .plain("verdict", self.verdict())
            .known("criterion", Quantity::Ratio, value(|criterion| criterion.value))
            .known("error", Quantity::Ratio, value(|criterion| criterion.error))
            .rate("growth_rate", rate)
            .known(
                "effective_coefficient",
                Quantity::Ratio,
                value(|criterion| criterion.effective.coefficient),
            );
        let one_sided =
            self.criterion.as_ref().is_ok_and(|found| found.effective.side == SlopeSide::Outer);
        fields.plain("one_sided", one_sided);
        self.put_critical(fields);
        let frequency_ratio =
            study.belt().dithers().first().map_or(0.0, |dither| dither.frequency_ratio);
        let ratio = &self.everywhere_stable;
        fields.known("everywhere_stable_amplitude_ratio", Quantity::Velocity, ratio.clone()).known(
            "everywhere_stable_amplitude",
            Quantity::Force,
            ratio.clone().map(|ratio| ratio * frequency_ratio),
        );
        self.put_bands(fields);
    }

    /// The amplitudes at which the verdict changes.
    fn put_critical(&self, fields: &mut Fields) {
        let name = "critical_amplitudes";
        let found = match &self.critical_amplitudes {
            Ok(found) => found,
            Err(why) => {
                fields.unknown(name, why.to_string());
                return;
            }
        };
        let scales = fields.scales();
        let items = found.iter().map(|critical| {
            let mut inner = Fields::new(scales);
            inner
                .number("amplitude_ratio", Quantity::Velocity, critical.amplitude_ratio)
                .number("amplitude", Quantity::Force, critical.amplitude)
                .plain("kind", kind(critical.crossing))
                .plain("becomes", becomes(critical.becomes))
                .number("amplitude_ratio_error", Quantity::Velocity, critical.error)
                .plain("contact_stays_closed", critical.contact_stays_closed);
            inner
        });
        fields.list(name, items);
    }

    /// The unstable belt velocities.
    fn put_bands(&self, fields: &mut Fields) {
        let name = "unstable_belt_velocities";
        let bands = match &self.unstable_bands {
            Ok(bands) => bands,
            Err(why) => {
                fields.unknown(name, why.to_string());
                return;
            }
        };
        let scales = fields.scales();
        let items = bands.iter().map(|band| {
            let mut inner = Fields::new(scales);
            let no_end = || format!("no upper end was found {LOOKED_AT}");
            inner.number("lower", Quantity::Velocity, band.lower).known(
                "upper",
                Quantity::Velocity,
                band.upper.ok_or_else(no_end),
            );
            match band.lower_crossing {
                Some(crossing) => inner.plain("lower_kind", kind(crossing)),
                None => inner.plain("lower_kind", "rest"),
            };
            inner
        });
        fields.list(name, items);
    }
}

/// The range of belt velocities that [`unstable_bands`] examines.
pub const LOOKED_AT: &str = "up to 200 v_m beyond the fast velocity";

/// Name of a crossing in output.
pub fn kind(crossing: CrossingKind) -> &'static str {
    match crossing {
        CrossingKind::Root => "root",
        CrossingKind::Jump => "jump",
    }
}

/// Name of a change in output.
pub fn becomes(becomes: Becomes) -> &'static str {
    match becomes {
        Becomes::Stable => "stable",
        Becomes::Unstable => "unstable",
    }
}

impl BeltStability {
    /// The name of the averaging that decides.
    pub fn method(&self) -> &'static str {
        if self.limit.is_some() { "finite-R averaging" } else { "the slope of the friction law" }
    }

    /// The verdict, and the next amplitude that changes it.
    pub fn sentence(&self, study: &BeltStudy) -> String {
        let v = in_words(study, Quantity::Velocity, study.belt().belt_velocity());
        let verdict = match &self.averaged.criterion {
            Err(why) => {
                format!("the stability of steady sliding at v₀ = {v} is unknown: {why}")
            }
            Ok(found) => match found.verdict {
                AveragedVerdict::Stable => {
                    format!("steady sliding at v₀ = {v} is stable for small slow motions")
                }
                AveragedVerdict::Unstable => {
                    format!("steady sliding at v₀ = {v} is unstable for small slow motions")
                }
                AveragedVerdict::Undecided { why: UndecidedBecause::WithinError } => format!(
                    "the stability of steady sliding at v₀ = {v} is undecided: the criterion is zero within its error"
                ),
                AveragedVerdict::Undecided { why: UndecidedBecause::AtCorner } => format!(
                    "the stability of steady sliding at v₀ = {v} is undecided: the belt is exactly as fast as the fast motion; \
                     slightly faster belts are unstable and slightly slower ones stable"
                ),
            },
        };
        format!("By {}, {verdict}.{}", self.method(), self.next(study))
    }

    /// The next amplitude at which the verdict changes.
    fn next(&self, study: &BeltStudy) -> String {
        let Some(dither) = study.belt().dithers().first() else {
            return " The study has no dither.".to_owned();
        };
        let averaged = &self.averaged;
        let (Ok(critical), Ok(_)) = (&averaged.critical_amplitudes, &averaged.criterion) else {
            return self.limit_in_words();
        };
        let now = dither.amplitude_ratio();
        let next = critical.iter().find(|critical| {
            critical.amplitude_ratio > now && becomes(critical.becomes) != averaged.verdict()
        });
        match next {
            Some(next) => format!(
                " More dither makes it {} from D = {} (α = {}) on{}.",
                becomes(next.becomes),
                in_words(study, Quantity::Force, next.amplitude),
                in_words(study, Quantity::Velocity, next.amplitude_ratio),
                if next.contact_stays_closed { "" } else { ", but would open the contact" }
            ),
            None if critical.is_empty() => " No amplitude of this dither changes that.".to_owned(),
            None => " A larger amplitude does not change that.".to_owned(),
        }
    }

    /// The verdict in the limit of high frequency, where finite-R averaging has none.
    fn limit_in_words(&self) -> String {
        let known = self.limit.as_ref().filter(|limit| limit.criterion.is_ok());
        known.map_or(String::new(), |limit| {
            format!(" In the limit of high dither frequency it is {}.", limit.verdict())
        })
    }

    /// Warnings about the result.
    pub fn warnings(&self, study: &BeltStudy) -> Vec<String> {
        let ratios = study.belt().dithers().iter().map(Dither::lowest_ratio);
        let hardly = ratios.filter(|ratio| *ratio < FAST).map(|ratio| {
            format!("averaging assumes fast dither, and R = {ratio} is hardly fast; check with `simulate`")
        });
        let apart = self.limit.as_ref().filter(|limit| {
            self.averaged.criterion.is_ok()
                && limit.criterion.is_ok()
                && limit.verdict() != self.averaged.verdict()
        });
        let apart = apart.map(|limit| {
            format!(
                "the limit of high dither frequency has another verdict: {} at the finite R of this study, {} in the limit; check \
                 with `simulate`",
                self.averaged.verdict(),
                limit.verdict()
            )
        });
        let range = range::averaged(study).into_iter().chain(self.beyond(study));
        let belt = study.belt();
        let rigid = contact_state::rigid_average(belt, belt.belt_velocity());
        let bristles = self.of_bristles(belt);
        let state = contact_state::passivity(study).into_iter().chain(rigid).chain(bristles);
        hardly
            .chain(apart)
            .chain(range)
            .chain(state)
            .chain(few_lines(belt))
            .chain(normal_noise(belt))
            .collect()
    }

    /// The warning about the state of bristles: without dither the exact verdict is known.
    fn of_bristles(&self, belt: &Belt) -> Option<String> {
        let acts = belt.dithers().iter().any(|dither| dither.amplitude > 0.0);
        match self.bristles.as_ref()? {
            Ok(growth) if !acts => Some(format!(
                "the criterion takes the bristles to follow the slip at once; with their own state steady sliding is {} \
                 (small_motions), and the growth rate per unit τ is {}",
                growth.verdict().name(),
                digits(growth.rate)
            )),
            _ => Some(contact_state::small_motions("")),
        }
    }

    /// The exact small motions with the state of bristles.
    fn put_bristles(&self, study: &BeltStudy, fields: &mut Fields) {
        let Some(found) = &self.bristles else { return };
        let mut inner = Fields::new(study.scales());
        inner.plain(
            "method",
            "eigenvalues of small motions about steady sliding without dither, with the state of the bristles",
        );
        match found {
            Ok(growth) => {
                inner
                    .plain("verdict", growth.verdict().name())
                    .rate("growth_rate", Ok(growth.rate))
                    .rate("growth_rate_error", Ok(growth.error))
                    .number("frequency", Quantity::FrequencyRatio, growth.frequency);
            }
            Err(why) => {
                inner.plain("verdict", "undecided").unknown("growth_rate", why.clone());
            }
        }
        fields.nested("small_motions", inner);
    }

    /// Warnings about critical amplitudes and bands outside the range of the friction law.
    fn beyond(&self, study: &BeltStudy) -> Vec<String> {
        let belt = study.belt();
        let Some(range) = belt.friction().range() else { return Vec::new() };
        let averaged: Vec<&AveragedStability> =
            [&self.averaged].into_iter().chain(&self.limit).collect();
        let mut warnings = Vec::new();
        let amplitudes =
            averaged.iter().filter_map(|averaged| averaged.critical_amplitudes.as_ref().ok());
        let slips = amplitudes.flatten().map(|critical| {
            let slip = range::at_amplitude(belt, critical.amplitude);
            (critical.amplitude, slip)
        });
        let outside = slips.filter(|(_, slip)| *slip > range.upper);
        if let Some((amplitude, slip)) = outside.min_by(|a, b| a.0.total_cmp(&b.0)) {
            let amplitude = in_words(study, Quantity::Force, amplitude);
            let what =
                format!("at the critical amplitude D = {amplitude}, slip including dither reaches");
            warnings.push(range::sentence(study, &range, &what, slip));
        }
        let everywhere =
            averaged.iter().filter_map(|averaged| averaged.everywhere_stable.as_ref().ok());
        let ratio = everywhere.fold(0.0_f64, |most, ratio| most.max(*ratio));
        let frequency = belt.dithers().first().map_or(0.0, |dither| dither.frequency_ratio);
        let slip = range::at_amplitude(belt, ratio * frequency);
        if slip > range.upper {
            let ratio = in_words(study, Quantity::Velocity, ratio);
            let what = format!(
                "at α = {ratio}, from which every belt velocity is stable, slip including dither reaches"
            );
            warnings.push(range::sentence(study, &range, &what, slip));
        }
        let bands = averaged.iter().filter_map(|averaged| averaged.unstable_bands.as_ref().ok());
        let ends = bands.flatten().map(|band| band.upper.unwrap_or(band.lower));
        let furthest = ends.fold(0.0, f64::max);
        let slip = range::with_dither(belt, furthest);
        if slip > range.upper {
            let furthest = in_words(study, Quantity::Velocity, furthest);
            let what = format!(
                "at the largest unstable belt velocity, {furthest}, slip including dither reaches"
            );
            warnings.push(range::sentence(study, &range, &what, slip));
        }
        warnings
    }

    /// As JSON.
    pub fn json(&self, study: &BeltStudy) -> Json {
        let mut fields = Fields::new(study.scales());
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("protocol", "averaged")
            .plain("method", self.method());
        self.averaged.put(study, &mut fields);
        match &self.limit {
            Some(limit) => {
                let mut inner = Fields::new(study.scales());
                inner.plain("method", "averaging in the limit of high dither frequency");
                limit.put(study, &mut inner);
                fields.nested("limit", inner);
            }
            None => {
                fields.unknown("limit", "the study has no dither");
            }
        }
        self.put_bristles(study, &mut fields);
        fields.plain("warnings", self.warnings(study));
        fields.finish()
    }
}
