//! `stability`: every small motion about steady sliding, and under dither about averaged sliding, with what is known of one mass alone.
//!
//! Protocol "averaged": the slow motion about steady sliding under fast dither, with the response of the structure to the dither and,
//! under dither of a load, the second order of the motion that friction makes of it. Of one mass `limit` is the dissertation's
//! averaging, in the limit of high frequency R → ∞ (2.26).

mod answer;
mod one_mass;

pub(crate) use answer::{put_contact, put_critical};
pub use one_mass::{LOOKED_AT, LimitStability, NoStableAmplitude, OneMassStability};

use quell_dynamics::orbit::NoSlidingVerdict;
use quell_linear::averaging::{
    AveragedSliding, AveragingError, Becomes, CriticalInput, CrossingKind, DitheredContact,
    DitheredSystem,
};
use quell_linear::growth::{Growth, Verdict};
use quell_linear::linearised::{FrictionSlopes, Linearised};
use quell_linear::spectrum::{MotionSpectrum, SmallMotion, growth, spectrum};
use quell_model::System;
use quell_model::profile::Wave;
use quell_model::units::Quantity;

use crate::complaint::Failure;
use crate::contact_state;
use crate::noise::{few_lines, normal_noise};
use crate::range::outside_of_laws;
use crate::run::system::modes::natural;
use crate::run::system::validity::{condition, opened, opening};
use crate::run::system::{
    failed, force, has_equations, in_units, oscillating, rate_of, upper, velocity_in_words,
};
use crate::study::{SystemStudy, UnitSystem};
use crate::words::digits;

/// Below this ratio of the dither frequency to that of a motion the dither is hardly fast: a verdict by averaging is warned of.
pub(crate) const FAST: f64 = 5.0;

/// Below this ratio amplitudes by averaging are not compared.
pub(crate) const FAR: f64 = 3.0;

/// Growth by a factor of e in decibels: 20 log₁₀ e.
pub const DECIBELS: f64 = 20.0 * std::f64::consts::LOG10_E;

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

/// A contact in steady or averaged sliding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlidingContact {
    /// Friction force.
    pub friction: f64,
    /// Normal load.
    pub normal_load: f64,
    /// What dither does to it; `None` without.
    pub dithered: Option<DitheredContact>,
}

/// What holds under dither.
#[derive(Clone, Debug, PartialEq)]
pub struct UnderDither {
    /// Every small motion without it, or why none exists.
    pub undithered: Result<MotionSpectrum, NoSlidingVerdict>,
    /// Amplitudes of the first dither at which the verdict changes, or why they are unknown.
    pub critical: Result<Vec<CriticalInput>, AveragingError>,
}

/// Stability of steady sliding.
#[derive(Clone, Debug, PartialEq)]
pub struct SlidingStability {
    /// Every small motion.
    pub spectrum: MotionSpectrum,
    /// The contacts, in the order of the study.
    pub contacts: Vec<SlidingContact>,
    /// What holds under dither; `None` without.
    pub dither: Option<UnderDither>,
    /// What is known of one mass alone; `None` of another system.
    pub one_mass: Option<OneMassStability>,
    /// Warnings about the answer.
    pub warnings: Vec<String>,
}

/// Stability of a study's system.
///
/// # Errors
/// [`Failure::Failed`] without steady sliding, and where averaging has no answer.
pub fn run(study: &SystemStudy) -> Result<SlidingStability, Failure> {
    has_equations(study, "stability")?;
    let system = study.system();
    let mut warnings = study.warnings().to_vec();
    let undithered = undithered(system);
    if !system.is_dithered() {
        let (spectrum, contacts, slope) = undithered.map_err(|why| failed("stability", why))?;
        let one_mass = OneMassStability::of(system, slope);
        warnings.extend(of_sliding(study));
        warnings.extend(one_mass.iter().flat_map(|one| one.warnings(study)));
        return Ok(SlidingStability { spectrum, contacts, dither: None, one_mass, warnings });
    }
    let prepared = DitheredSystem::new(system).map_err(|why| failed("stability", why))?;
    let average = prepared.average().map_err(|why| failed("stability", why))?;
    let spectrum = average.spectrum().map_err(|why| failed("stability", why))?;
    let critical = prepared.critical_amplitudes(0);
    let contacts: Vec<SlidingContact> = average
        .contacts
        .iter()
        .map(|contact| SlidingContact {
            friction: contact.friction,
            normal_load: contact.normal_load,
            dithered: Some(*contact),
        })
        .collect();
    let slope = average.contacts.first().map_or(0.0, |contact| contact.slope_by_velocity);
    let one_mass = OneMassStability::of(system, slope);
    let undithered = undithered.map(|(spectrum, ..)| spectrum);
    let dither = Some(UnderDither { undithered, critical });
    let mut found = SlidingStability { spectrum, contacts, dither, one_mass, warnings };
    let added = found.warnings_under_dither(study, &average.contacts);
    found.warnings.extend(added);
    Ok(found)
}

/// Every small motion about steady sliding without dither, with the contacts there and the slope of friction at the first; or why no
/// steady sliding exists.
fn undithered(
    system: &System,
) -> Result<(MotionSpectrum, Vec<SlidingContact>, f64), NoSlidingVerdict> {
    let linear = Linearised::new(system).map_err(NoSlidingVerdict::NoSliding)?;
    let friction = linear.friction();
    let found = spectrum(&linear, &friction).map_err(NoSlidingVerdict::Eigenvalues)?;
    let contacts = linear.contacts().iter().zip(&friction).map(|(contact, friction)| {
        let normal_load = contact.steady.normal_load;
        SlidingContact { friction: friction.force, normal_load, dithered: None }
    });
    let slope = friction.first().map_or(0.0, |friction| friction.by_velocity);
    Ok((found, contacts.collect(), slope))
}

/// Warnings about sliding without dither.
fn of_sliding(study: &SystemStudy) -> Vec<String> {
    outside_of_laws(study.system(), |speed| velocity_in_words(study, speed), None)
}

/// Warnings about sliding that is averaged over a dither; `slow` has its small motions.
fn of_average(
    study: &SystemStudy,
    average: &[DitheredContact],
    slow: &MotionSpectrum,
) -> Vec<String> {
    let system = study.system();
    let words = |speed| velocity_in_words(study, speed);
    let mut warnings = outside_of_laws(system, words, Some(average));
    warnings.extend(opened(study.units(), system, average));
    warnings.extend(not_slow(study, slow));
    warnings.extend(few_lines(system));
    warnings.extend(normal_noise(system));
    warnings.extend(contact_state::averaged_without_states(system, average));
    warnings
}

/// The equations of small motions about sliding, averaged over a dither, with their verdict and its warnings: those of `stability`.
pub(in crate::run) struct SlidingEquations {
    pub(in crate::run) linear: Linearised,
    pub(in crate::run) friction: Vec<FrictionSlopes>,
    pub(in crate::run) verdict: Verdict,
    pub(in crate::run) warnings: Vec<String>,
}

impl SlidingEquations {
    /// Those of a study, for a verb.
    pub(in crate::run) fn new(study: &SystemStudy, verb: &str) -> Result<Self, Failure> {
        let system = study.system();
        if !system.is_dithered() {
            let linear = Linearised::new(system).map_err(|why| failed(verb, why))?;
            let friction = linear.friction();
            let growth = growth(&linear, &friction).map_err(|why| failed(verb, why))?;
            let (verdict, warnings) = (growth.verdict(), of_sliding(study));
            return Ok(Self { linear, friction, verdict, warnings });
        }
        let average = DitheredSystem::new(system).and_then(|prepared| prepared.average());
        let AveragedSliding { linear, friction, contacts } =
            average.map_err(|why| failed(verb, why))?;
        let slow = spectrum(&linear, &friction).map_err(|why| failed(verb, why))?;
        let without = undithered(system).map(|(without, ..)| without);
        let warnings = of_average(study, &contacts, without.as_ref().unwrap_or(&slow));
        let at_corner = contacts.iter().any(|contact| contact.one_sided);
        Ok(Self { linear, friction, verdict: averaged_verdict(slow.growth, at_corner), warnings })
    }
}

/// The warning about motions that are not much slower than the dither.
pub(in crate::run) fn not_slow(study: &SystemStudy, slow: &MotionSpectrum) -> Option<String> {
    let slowest = study.system().waves().map(Wave::lowest).fold(f64::INFINITY, f64::min);
    let near = upper(slow).filter(|motion| natural(motion) * FAST > slowest);
    let distance = |motion: &SmallMotion| (natural(motion) - slowest).abs();
    let nearest = near.min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    let own = natural(nearest);
    let because =
        "averaging assumes that the dither is much faster than every motion; check with `simulate`";
    if nearest.frequency() == 0.0 {
        let units = study.units();
        return Some(format!(
            "a motion without oscillation has the rate |λ| = {}, which is not far below the angular frequency of the dither, {}: \
             {because}",
            rate_of(units, own),
            rate_of(units, slowest)
        ));
    }
    let (factor, unit) = match study.units() {
        UnitSystem::None => (1.0, ""),
        _ => (1.0 / std::f64::consts::TAU, " Hz"),
    };
    Some(format!(
        "the eigenfrequency {}{unit} is not far below the dither frequency {}{unit}: {because}",
        digits(factor * own),
        digits(factor * slowest)
    ))
}

/// The verdict on a growth rate: undecided too where the fast slip of a contact just reaches the velocity of its surface, and slower
/// surfaces have another slope.
pub(crate) fn averaged_verdict(growth: Growth, at_corner: bool) -> Verdict {
    match growth.verdict() {
        Verdict::Unstable if at_corner => Verdict::Undecided,
        verdict => verdict,
    }
}

impl SlidingStability {
    /// The verdict: undecided too where the fast slip of a contact just reaches the velocity of its surface.
    pub fn verdict(&self) -> Verdict {
        averaged_verdict(self.spectrum.growth, self.at_corner())
    }

    /// Whether the fast slip of a contact just reaches the velocity of its surface.
    fn at_corner(&self) -> bool {
        let dithered = self.contacts.iter().filter_map(|contact| contact.dithered);
        dithered.into_iter().any(|contact| contact.one_sided)
    }

    /// Warnings about the average and about the critical amplitudes.
    fn warnings_under_dither(
        &self,
        study: &SystemStudy,
        average: &[DitheredContact],
    ) -> Vec<String> {
        let without = self.dither.as_ref().and_then(|dither| dither.undithered.as_ref().ok());
        let mut warnings = of_average(study, average, without.unwrap_or(&self.spectrum));
        warnings.extend(self.critical_beyond(study));
        warnings.extend(self.one_mass.iter().flat_map(|one| one.warnings(study)));
        warnings.extend(self.limit_apart());
        warnings
    }

    /// The warning about the first critical amplitude at which slip is outside the range of a law.
    fn critical_beyond(&self, study: &SystemStudy) -> Option<String> {
        let critical = self.dither.as_ref()?.critical.as_ref().ok()?;
        let first = critical.iter().find(|found| !found.within_laws)?;
        let amplitude = in_units(study.units(), Quantity::Force, first.amplitude);
        Some(format!(
            "at the critical amplitude {amplitude} the slip velocity is outside the range of a friction law: numbers from there are \
             extrapolated"
        ))
    }

    /// The warning about another verdict in the limit of high frequency.
    fn limit_apart(&self) -> Option<String> {
        let limit = self.one_mass.as_ref()?.limit.as_ref()?;
        let (here, there) = (self.verdict().name(), limit.verdict());
        (limit.criterion.is_ok() && here != there).then(|| {
            format!(
                "the limit of high dither frequency has another verdict: {here} at the frequency of this study, {there} in the limit; \
                 check with `simulate`"
            )
        })
    }

    /// The protocol of the verdict.
    pub fn protocol(&self) -> &'static str {
        if self.dither.is_some() { "averaged" } else { "linearised" }
    }

    /// The answer in one or two sentences.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let Growth { rate, error, frequency } = self.spectrum.growth;
        let by = match self.dither {
            Some(_) => "By averaging over the dither",
            None => "By linearisation",
        };
        let units = study.units();
        let (is, condition) = self.condition(study.system());
        let verdict = match self.verdict() {
            Verdict::Stable => format!(
                "steady sliding {is} stable{condition}: every motion decays, the slowest at the rate {}",
                rate_of(units, -rate)
            ),
            Verdict::Unstable => format!(
                "steady sliding {is} unstable{condition}: a motion {} grows at the rate {}",
                oscillating(units, frequency),
                rate_of(units, rate)
            ),
            Verdict::Undecided if self.at_corner() => {
                "the stability of steady sliding is undecided: a surface is exactly as fast as the fast motion, where mean friction has \
                 two slopes; with that of slightly faster surfaces it is unstable"
                    .to_owned()
            }
            Verdict::Undecided if !error.is_finite() => {
                "the stability of steady sliding is undecided: the numbers are too large or too small to bound the error of the \
                 growth rate"
                    .to_owned()
            }
            Verdict::Undecided => format!(
                "the stability of steady sliding is undecided: the largest growth rate is zero within its error, {error:.1e}"
            ),
        };
        format!("{by}, {verdict}.{}", self.next(study))
    }

    /// The verb of the verdict, and the condition under which it would hold: "is" alone where every contact stays closed.
    fn condition(&self, system: &System) -> (&'static str, String) {
        let dithered: Option<Vec<DitheredContact>> =
            self.contacts.iter().map(|contact| contact.dithered).collect();
        let dithered = dithered.unwrap_or_default();
        match condition(&opening(system, &dithered)) {
            Some(condition) => ("would be", format!(" {condition}")),
            None => ("is", String::new()),
        }
    }

    /// The next amplitude at which the verdict changes.
    fn next(&self, study: &SystemStudy) -> String {
        let Some(UnderDither { critical: Ok(critical), undithered }) = &self.dither else {
            return String::new();
        };
        let without = undithered.as_ref().map_or(String::new(), |found| {
            format!(" Without dither it is {}", found.growth.verdict().name())
        });
        let waves = study.system().inputs.first().map(|input| input.profile.waves());
        let now = waves.and_then(|waves| waves.first()).map_or(0.0, |wave| wave.amplitude);
        let wanted = match self.verdict() {
            Verdict::Stable => Becomes::Unstable,
            _ => Becomes::Stable,
        };
        let next = critical.iter().find(|found| found.amplitude > now && found.becomes == wanted);
        let more = next.map_or(String::new(), |found| {
            let is_first = study.system().inputs.len() > 1;
            let (separator, more) = match (without.is_empty(), is_first) {
                (true, true) => (" ", "A larger first dither"),
                (true, false) => (" ", "More dither"),
                (false, true) => ("; ", "a larger first dither"),
                (false, false) => ("; ", "more dither"),
            };
            format!(
                "{separator}{more} makes it {} from the amplitude {} on{}",
                becomes(found.becomes),
                force(study.units(), found.amplitude),
                if found.contacts_stay_closed { "" } else { ", if contacts stayed closed" }
            )
        });
        let said = without + &more;
        if said.is_empty() { said } else { said + "." }
    }
}
