//! What `stability` knows of one mass alone: the criterion of the dissertation, the surface velocities at which sliding is unstable, and the
//! limit of high dither frequency.

use std::fmt;

use quell_linear::averaging::{
    AveragedVerdict, Averaging, AveragingError, Criterion, CriticalAmplitude, EverywhereStable,
    FastMotion, FastWave, NeverStable, UnstableBand, criterion, critical_amplitudes,
    everywhere_stable_amplitude, everywhere_stable_under_noise, unstable_bands,
};
use quell_linear::growth::of_criterion;
use quell_model::units::Quantity;
use quell_model::{Belt, Contact, Direction, OneMass, System};

use super::{becomes, kind};
use crate::fields::Fields;
use crate::range;
use crate::run::system::velocity_in_words;
use crate::study::SystemStudy;

/// Why no amplitude is known from which every surface velocity is stable.
#[derive(Clone, Debug, PartialEq)]
pub enum NoStableAmplitude {
    /// The average has no value.
    NoAverage(AveragingError),
    /// Some surface velocity is unstable at every amplitude.
    Never(NeverStable),
    /// The study has no dither.
    NoDither,
    /// It has several.
    SeveralDithers,
    /// The dither is normal.
    OfNormal,
    /// The waveform with this name has corners at every maximum of its fast velocity.
    Cornered(&'static str),
    /// Nothing grows or decays.
    Neutral,
}

impl From<AveragingError> for NoStableAmplitude {
    fn from(why: AveragingError) -> Self {
        Self::NoAverage(why)
    }
}

impl fmt::Display for NoStableAmplitude {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NoAverage(why) => return why.fmt(f),
            Self::Cornered(name) => {
                return write!(
                    f,
                    "it is known for sine, triangle, square and noise; \"{name}\" has corners at every maximum of its fast velocity"
                );
            }
            Self::Never(NeverStable::NoDamping) => {
                "without damping, a friction law that keeps falling leaves fast surfaces unstable at any amplitude"
            }
            Self::Never(NeverStable::InnerRegion) => {
                "slow surfaces stay unstable at any amplitude: the friction law falls too steeply"
            }
            Self::Never(NeverStable::OffScale) => "no such amplitude ratio exists up to 10⁶ v_m",
            Self::Never(NeverStable::NoEdge) => {
                "without dither, sliding is unstable at every velocity examined (up to 365 v_m), so no amplitude was tried"
            }
            Self::NoDither => "the study has no dither",
            Self::SeveralDithers => {
                "it is defined for a single dither, and this study has several"
            }
            Self::OfNormal => "of normal dither it is known to first order alone, in the limit",
            Self::Neutral => "without damping and with a flat friction law nothing grows or decays",
        })
    }
}

impl std::error::Error for NoStableAmplitude {}

/// What is known of one mass alone.
#[derive(Clone, Debug, PartialEq)]
pub struct OneMassStability {
    /// 2ζ + Fμ̄′(v₀) (2.26), twice the effective damping ratio.
    pub criterion: f64,
    /// Amplitude ratio from which every surface velocity is stable, or why none exists.
    pub everywhere_stable: Result<f64, NoStableAmplitude>,
    /// Surface velocities at which the study's own dither leaves steady sliding unstable.
    pub unstable_bands: Result<Vec<UnstableBand>, AveragingError>,
    /// The limit of high frequency, R → ∞: the dissertation's averaging. `None` without dither, which has no such limit.
    pub limit: Option<LimitStability>,
    mass: OneMass,
    /// An amplitude of the first dither over that of the belt.
    amplitude: f64,
}

/// Averaged stability in the limit of high dither frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitStability {
    /// Criterion and verdict at the study's own amplitude.
    pub criterion: Result<Criterion, AveragingError>,
    /// Amplitudes of the first dither at which stability changes.
    pub critical_amplitudes: Result<Vec<CriticalAmplitude>, AveragingError>,
    /// Amplitude ratio from which every surface velocity is stable, or why none exists.
    pub everywhere_stable: Result<f64, NoStableAmplitude>,
    /// Surface velocities at which the study's own dither leaves steady sliding unstable.
    pub unstable_bands: Result<Vec<UnstableBand>, AveragingError>,
}

impl OneMassStability {
    /// That of a system in which friction has this slope ∂T̄/∂γ; `None` where it is not one mass, and of small motions of a contact
    /// with a state, which no slope describes.
    pub(super) fn of(system: &System, slope: f64) -> Option<Self> {
        if !system.is_dithered() && system.contacts.iter().any(Contact::has_state) {
            return None;
        }
        let mass = system.one_averaged_mass()?;
        let belt = mass.belt();
        Some(Self {
            criterion: belt.damping_rate(slope / mass.force(), 1.0),
            everywhere_stable: everywhere_stable(belt, Averaging::FiniteR),
            unstable_bands: unstable_bands(belt, Averaging::FiniteR),
            limit: system.is_dithered().then(|| LimitStability::of(belt)),
            amplitude: system.inputs.first().map_or(1.0, |input| mass.amplitude(&input.target)),
            mass,
        })
    }

    /// The belt that the system is, with a rigid contact.
    pub fn belt(&self) -> &Belt {
        self.mass.belt()
    }

    /// An amplitude of the first dither over that of the belt.
    pub fn amplitude(&self) -> f64 {
        self.amplitude
    }

    /// Warnings about velocities and amplitudes outside the range of the friction law.
    pub(super) fn warnings(&self, study: &SystemStudy) -> Vec<String> {
        let belt = self.belt();
        let Some(contact) = study.system().contacts.first() else { return Vec::new() };
        let mut warnings = Vec::new();
        let mut warn = |what: &str, slip: f64| {
            let words = |speed| velocity_in_words(study, speed);
            warnings.extend(
                range::at_contact(contact, slip, words).map(|why| format!("{what}, {why}")),
            );
        };
        let limit = self.limit.iter();
        let ratios = [&self.everywhere_stable]
            .into_iter()
            .chain(limit.clone().map(|limit| &limit.everywhere_stable));
        let ratio = ratios.flatten().fold(0.0_f64, |most, ratio| most.max(*ratio));
        let bands = [&self.unstable_bands]
            .into_iter()
            .chain(limit.clone().map(|limit| &limit.unstable_bands));
        let ends = bands.flatten().flatten().map(|band| band.upper.unwrap_or(band.lower));
        let furthest = ends.fold(0.0, f64::max);
        let fast = FastMotion::of(belt, furthest, Averaging::Limit);
        let fast = fast.and_then(|motion| motion.largest_slip()).unwrap_or_default();
        warn("at the largest unstable surface velocity", furthest + fast);
        if let Some(dither) = belt.dithers().first() {
            let changed =
                quell_model::Dither { amplitude: ratio * dither.frequency_ratio, ..dither.clone() };
            let slip = belt.belt_velocity() + belt.fast_velocity_of(&changed);
            warn("at the amplitude from which every surface velocity is stable", slip);
        }
        warnings
    }

    /// One amplitude ratio α of the first dither as its amplitude.
    pub fn amplitude_of_ratio(&self) -> f64 {
        let first = self.belt().dithers().first();
        self.amplitude * first.map_or(0.0, |dither| dither.frequency_ratio)
    }

    fn put_everywhere_stable(&self, ratio: &Result<f64, NoStableAmplitude>, fields: &mut Fields) {
        let force = ratio.clone().map(|ratio| self.amplitude_of_ratio() * ratio);
        fields.known("everywhere_stable_amplitude", Quantity::Force, force).known(
            "everywhere_stable_amplitude_ratio",
            Quantity::Velocity,
            ratio.clone(),
        );
    }

    /// Adds the fields of one mass.
    pub(super) fn put(&self, study: &SystemStudy, fields: &mut Fields) {
        fields.number("criterion", Quantity::Ratio, self.criterion);
        self.put_everywhere_stable(&self.everywhere_stable, fields);
        put_bands(&self.unstable_bands, study, fields);
        match &self.limit {
            None => {
                fields.unknown("limit", "the study has no dither");
            }
            Some(limit) => {
                fields.nested("limit", limit.fields(study, self));
            }
        }
    }
}

impl LimitStability {
    fn of(belt: &Belt) -> Self {
        Self {
            criterion: criterion(belt, Averaging::Limit),
            critical_amplitudes: critical_amplitudes(belt, Averaging::Limit),
            everywhere_stable: everywhere_stable(belt, Averaging::Limit),
            unstable_bands: unstable_bands(belt, Averaging::Limit),
        }
    }

    /// "stable", "unstable" or "undecided".
    pub fn verdict(&self) -> &'static str {
        match self.criterion.as_ref().map(|criterion| criterion.verdict) {
            Ok(AveragedVerdict::Stable) => "stable",
            Ok(AveragedVerdict::Unstable) => "unstable",
            Ok(AveragedVerdict::Undecided { .. }) | Err(_) => "undecided",
        }
    }

    fn fields(&self, study: &SystemStudy, of: &OneMassStability) -> Fields {
        let mut fields = Fields::in_units(study.units());
        fields.plain("verdict", self.verdict());
        let value = |field: fn(&Criterion) -> f64| self.criterion.as_ref().map(field);
        fields.known("criterion", Quantity::Ratio, value(|criterion| criterion.value)).known(
            "criterion_error",
            Quantity::Ratio,
            value(|criterion| criterion.error),
        );
        let rate = self.criterion.as_ref();
        fields.known_rate(
            "growth_rate",
            rate.map(|found| of.mass.rate() * of_criterion(found.value)),
        );
        match &self.critical_amplitudes {
            Err(why) => {
                fields.unknown("critical_amplitudes", why);
            }
            Ok(critical) => {
                let items = critical.iter().map(|critical| {
                    let error = critical.error / critical.amplitude_ratio * critical.amplitude;
                    let mut inner = Fields::in_units(study.units());
                    inner
                        .number("amplitude", Quantity::Force, of.amplitude * critical.amplitude)
                        .number("amplitude_error", Quantity::Force, of.amplitude * error)
                        .number("amplitude_ratio", Quantity::Velocity, critical.amplitude_ratio)
                        .plain("kind", kind(critical.crossing))
                        .plain("becomes", becomes(critical.becomes))
                        .plain("contacts_stay_closed", critical.contact_stays_closed);
                    inner
                });
                fields.list("critical_amplitudes", items.collect::<Vec<_>>());
            }
        }
        of.put_everywhere_stable(&self.everywhere_stable, &mut fields);
        put_bands(&self.unstable_bands, study, &mut fields);
        fields
    }
}

/// The range of surface velocities that [`unstable_bands`] examines.
pub const LOOKED_AT: &str = "up to 200 v_m beyond the fast velocity";

/// The unstable surface velocities.
fn put_bands(
    bands: &Result<Vec<UnstableBand>, AveragingError>,
    study: &SystemStudy,
    fields: &mut Fields,
) {
    let name = "unstable_surface_velocities";
    let bands = match bands {
        Ok(bands) => bands,
        Err(why) => {
            fields.unknown(name, why);
            return;
        }
    };
    let items = bands.iter().map(|band| {
        let mut inner = Fields::in_units(study.units());
        let no_end = || format!("no upper end was found {LOOKED_AT}");
        inner.number("lower", Quantity::Velocity, band.lower).known(
            "upper",
            Quantity::Velocity,
            band.upper.ok_or_else(no_end),
        );
        inner.plain("lower_kind", band.lower_crossing.map_or("rest", kind));
        inner
    });
    fields.list(name, items.collect::<Vec<_>>());
}

/// Whether damping and the slope of the law cancel at the belt velocity.
fn is_neutral(belt: &Belt) -> bool {
    let slope = belt.friction().slope(belt.belt_velocity());
    belt.damping_rate(slope, belt.normal_load()) == 0.0
}

fn everywhere_stable(belt: &Belt, averaging: Averaging) -> Result<f64, NoStableAmplitude> {
    let [dither] = belt.dithers() else {
        return Err(match belt.dithers() {
            [] => NoStableAmplitude::NoDither,
            _ => NoStableAmplitude::SeveralDithers,
        });
    };
    if averaging == Averaging::FiniteR && dither.lowest_ratio() <= 1.0 {
        let frequency_ratio = dither.lowest_ratio();
        return Err(AveragingError::NotFast { frequency_ratio }.into());
    }
    if averaging == Averaging::FiniteR && dither.direction == Direction::Normal {
        return Err(NoStableAmplitude::OfNormal);
    }
    let is_noise = !dither.waveform.is_periodic();
    if !is_noise && !dither.waveform.is_symmetric() {
        return Err(NoStableAmplitude::Cornered(dither.waveform.name()));
    }
    let found = if is_noise {
        everywhere_stable_under_noise(belt, dither, averaging)
    } else {
        let (waveform, frequency_ratio) = (dither.waveform.clone(), dither.frequency_ratio);
        let wave = match averaging {
            Averaging::FiniteR => FastWave::Oscillator { waveform, frequency_ratio },
            Averaging::Limit | Averaging::LimitToSecondOrder => FastWave::Integral(waveform),
        };
        let (damping, load) = (belt.damping_ratio(), belt.normal_load());
        everywhere_stable_amplitude(belt.friction(), damping, load, wave, dither.direction)
    };
    match found? {
        EverywhereStable::Always if is_neutral(belt) => Err(NoStableAmplitude::Neutral),
        EverywhereStable::Always => Ok(0.0),
        EverywhereStable::From { amplitude_ratio, .. } => Ok(amplitude_ratio),
        EverywhereStable::Never { why } => Err(NoStableAmplitude::Never(why)),
    }
}
