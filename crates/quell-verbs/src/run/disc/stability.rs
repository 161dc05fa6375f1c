//! `stability` of a disc: the largest growth rate with its error, the verdict, and the frictions at which it changes.

use quell_disc::boundaries::{Marginal, NoBoundary, boundaries};
use quell_disc::dithered;
use quell_disc::instability::{GrowthShares, InstabilityKind, origins};
use quell_disc::marginal::marginal_frictions;
use quell_disc::partition::{FrictionCrossing, NoPartition, crossings};
use quell_disc::undithered;
use quell_linear::floquet::NotFollowerDither;
use quell_linear::growth::{Growth, Verdict};
use quell_model::disc::Contributions;
use quell_model::disc::DiscDither;
use quell_numerics::floquet::Effort;
use quell_numerics::order::ascending_by;
use serde_json::{Map, Value as Json, json};

use super::critical::{self, Critical};
use super::{overflowed, tangential};
use crate::complaint::Failure;
use crate::disc_units::{DiscUnits, FRICTION, from_reference};
use crate::reasons::reasons;
use crate::run::stability::DECIBELS;
use crate::study::DiscStudy;
use crate::words::digits;

/// A friction at which some motion is marginal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MarginalFriction {
    /// Friction f* of the load.
    pub friction: f64,
    /// Frequency of the marginal motion in ω_ref.
    pub frequency: f64,
}

/// Stability of a disc.
#[derive(Clone, Debug, PartialEq)]
pub struct DiscStability {
    /// Growth of the disc as given.
    pub growth: Growth,
    /// Growth of the disc without dither.
    pub undithered: Growth,
    /// Every motion that grows by more than its error, the fastest first.
    pub unstable: Vec<Growth>,
    /// Which part of the loads causes each of them, without dither; or why that is unknown.
    pub origins: Result<Vec<GrowthShares>, NoOrigins>,
    /// Critical speeds, and deflections under static loads.
    pub critical: Critical,
    /// Frictions at which a motion is marginal, with everything else as given, ascending; or why they are unknown. They have the
    /// sign of the load's own friction, and are ≥ 0 if that is zero.
    pub changes: Result<Vec<MarginalFriction>, NoMarginalFriction>,
    /// The largest friction, of either sign, up to which they are known; `None` where every one is.
    pub changes_up_to: Option<f64>,
    /// Whether the load cannot reach some motion, which is then marginal at any friction.
    pub out_of_reach: bool,
}

reasons! {
    /// Why the kinds of instability are unknown.
    pub enum NoOrigins {
        ;
        /// The disc is dithered.
        UnderDither => "the kinds of instability are those of a disc without dither",
    }
}

reasons! {
    /// Why the frictions at which a motion is marginal are unknown.
    pub enum NoMarginalFriction {
        /// There are no exact boundaries.
        NoBoundary(NoBoundary),
        /// There is no partition.
        NoPartition(NoPartition),
        /// The exponents could not be followed.
        NotFollowed(NotFollowerDither),
        ;
        /// The modes are damped.
        DampedModes => &format!(
            "{}; `quell map` over disc.load.friction shows the boundaries in every case",
            NoBoundary::DampedModes
        ),
        /// The study leaves parts of the disc out.
        PartsLeftOut =>
            "marginal frictions are computed for the whole disc only, and this study leaves parts out",
        /// The disc has no load.
        NoLoad => "the disc has no load",
    }
}

/// Stability of a study's disc.
///
/// # Errors
/// [`Failure::Failed`] if a matrix overflows.
pub fn run(study: &DiscStudy) -> Result<DiscStability, Failure> {
    let (disc, parts) = (study.disc(), study.parts());
    let failed = |why| overflowed("stability", why);
    let undithered = undithered::growth_with(disc, parts).map_err(failed)?;
    let dithered =
        dithered::prepared_with(disc, parts).map_err(|why| overflowed("stability", why))?;
    let (growth, unstable) = match dithered {
        Some(dithered) => {
            let growth = dithered.growth(1.0, Effort::default()).map_err(failed)?;
            (growth, dithered.growing(Effort::default()).map_err(failed)?)
        }
        None => (undithered, undithered::growing_with(disc, parts).map_err(failed)?),
    };
    let origins = match disc.dither() {
        DiscDither::None => Ok(origins(disc, parts, &unstable).map_err(failed)?),
        _ => Err(NoOrigins::UnderDither),
    };
    let critical = critical::run(study).map_err(failed)?;
    let mut changes_up_to = None;
    let (changes, out_of_reach) = match disc.dither() {
        _ if parts != Contributions::ALL => (Err(NoMarginalFriction::PartsLeftOut), false),
        DiscDither::None => still(study),
        DiscDither::Normal { .. } | DiscDither::Tangential { .. } => {
            let found = shaken(study);
            changes_up_to = found.as_ref().ok().and_then(|(_, up_to)| *up_to);
            (found.map(|(changes, _)| changes), false)
        }
    };
    Ok(DiscStability {
        growth,
        undithered,
        unstable,
        origins,
        critical,
        changes,
        changes_up_to,
        out_of_reach,
    })
}

/// Boundaries without dither.
fn still(study: &DiscStudy) -> (Result<Vec<MarginalFriction>, NoMarginalFriction>, bool) {
    match boundaries(study.disc()) {
        Ok(found) => {
            let out_of_reach = found.iter().any(|boundary| boundary.friction == Marginal::Always);
            let sign = sign_of_friction(study);
            let changes: Vec<MarginalFriction> = found
                .iter()
                .filter_map(|boundary| match boundary.friction {
                    Marginal::At(friction) if sign * friction >= 0.0 => {
                        Some(MarginalFriction { friction, frequency: boundary.frequency })
                    }
                    _ => None,
                })
                .collect();
            (Ok(ascending(changes)), out_of_reach)
        }
        Err(NoBoundary::DampedModes) => (Err(NoMarginalFriction::DampedModes), false),
        Err(why) => (Err(why.into()), false),
    }
}

/// Two methods find the same friction within this share of it.
const SAME: f64 = 1e-6;

/// Boundaries under dither: of a sine by D-partition, which finds those of every size except two that are very close in
/// frequency, which following the exponents finds; of any other waveform, of a slow sine and of a distributed load by
/// following the exponents alone, up to the friction that is returned with them.
fn shaken(study: &DiscStudy) -> Result<(Vec<MarginalFriction>, Option<f64>), NoMarginalFriction> {
    let disc = study.disc();
    // The partition gives factors of the friction, so start from 1, not from 0.
    let unit = disc.with_friction_of(0, 1.0).map_err(|_| NoMarginalFriction::NoLoad)?;
    let sign = sign_of_friction(study);
    let unit = if sign < 0.0 { unit.with_friction_times(-1.0).unwrap_or(unit) } else { unit };
    let change =
        |factor: f64, frequency: f64| MarginalFriction { friction: sign * factor, frequency };
    match crossings(&unit) {
        Ok(found) => {
            let mut changes: Vec<MarginalFriction> =
                found.iter().map(|found| change(found.factor, found.frequency)).collect();
            let followed = marginal_frictions(&unit).ok().flatten();
            for missed in followed.into_iter().flat_map(|followed| followed.factors) {
                let is_same = |known: &FrictionCrossing| {
                    (known.factor - missed.value).abs() <= SAME * missed.value
                };
                if !found.iter().any(is_same) {
                    changes.push(change(missed.value, missed.frequency));
                }
            }
            Ok((ascending(changes), None))
        }
        Err(why @ (NoPartition::Loads(_) | NoPartition::Undithered | NoPartition::Eigenvalues)) => {
            Err(why.into())
        }
        Err(why) if disc.law().is_some() => Err(why.into()),
        Err(_) => {
            let found = marginal_frictions(&unit)?.ok_or(NoPartition::Undithered)?;
            let changes = found.factors.iter().map(|found| change(found.value, found.frequency));
            Ok((ascending(changes.collect()), Some(found.up_to)))
        }
    }
}

/// −1 if the first load's friction is negative, else 1.
fn sign_of_friction(study: &DiscStudy) -> f64 {
    let friction = study.disc().loads().first().map_or(0.0, |load| load.friction);
    if friction < 0.0 { -1.0 } else { 1.0 }
}

fn ascending(mut changes: Vec<MarginalFriction>) -> Vec<MarginalFriction> {
    ascending_by(&mut changes, |a| a.friction);
    changes
}

/// Adds the kind of an unstable motion and the share of each part of the loads in its growth.
fn put_origin(object: &mut Json, origin: Option<&GrowthShares>) {
    object["kind"] = origin.and_then(GrowthShares::kind).map(InstabilityKind::name).into();
    object["shares"] = origin.map_or(Json::Null, |origin| {
        let parts = InstabilityKind::ALL.into_iter().zip(origin.shares);
        parts.map(|(kind, share)| (kind.part().to_owned(), Json::from(share))).collect()
    });
}

impl DiscStability {
    /// The result in one or two sentences.
    pub fn sentence(&self, study: &DiscStudy) -> String {
        let words = |name: &str, value: f64| from_reference(study, name, value);
        let (speed, unit) = words("speed", study.disc().speed());
        let speed = format!("{} {unit}", digits(speed));
        let under = match study.disc().dither() {
            DiscDither::None => "without dither",
            DiscDither::Normal { .. } => "under this normal dither",
            DiscDither::Tangential { .. } => "under this tangential dither",
        };
        let (rate, unit) = words("growth", self.growth.rate);
        let (error, _) = words("growth", self.growth.error);
        match self.growth.verdict() {
            Verdict::Stable => {
                format!("At Ω = {speed} the disc is stable {under}: every motion decays.")
            }
            Verdict::Unstable => {
                format!("At Ω = {speed} the disc is unstable {under}: at least one motion grows.")
            }
            Verdict::Undecided => format!(
                "At Ω = {speed} the stability of the disc {under} is undecided: the growth rate {rate:.1e} {unit} is zero \
                 within its error {error:.1e} {unit}. Discs without damping are undecided along whole lines of a map."
            ),
        }
    }

    /// As JSON.
    pub fn json(&self, study: &DiscStudy) -> Json {
        let growth = |growth: &Growth| {
            json!({
                "verdict": growth.verdict().name(),
                "growth_rate": growth.rate,
                "growth_rate_error": growth.error,
                "frequency": growth.frequency,
            })
        };
        let mut object = growth(&self.growth);
        let mut why = Map::new();
        object["unstable_modes"] = self
            .unstable
            .iter()
            .enumerate()
            .map(|(index, mode)| {
                let mut object = growth(mode);
                let origin = self.origins.as_ref().ok().and_then(|origins| origins.get(index));
                put_origin(&mut object, origin);
                object
            })
            .collect();
        if let Err(reason) = &self.origins {
            for key in ["unstable_modes[].kind", "unstable_modes[].shares"] {
                why.insert(key.to_owned(), reason.to_string().into());
            }
        }
        object["ok"] = true.into();
        object["sentence"] = self.sentence(study).into();
        object["protocol"] = match study.disc().dither() {
            DiscDither::None => "eigenvalues".into(),
            _ => "floquet".into(),
        };
        object["speed"] = study.disc().speed().into();
        object["undithered"] = growth(&self.undithered);
        object["without"] = study.without().into();
        object["changes"] = match &self.changes {
            Ok(changes) => changes
                .iter()
                .map(|change| json!({ "friction": change.friction, "frequency": change.frequency }))
                .collect(),
            Err(reason) => {
                why.insert("changes".to_owned(), reason.to_string().into());
                Json::Null
            }
        };
        object["changes_up_to"] = self.changes_up_to.into();
        if self.changes_up_to.is_none() {
            let reason = match &self.changes {
                Ok(_) => "the marginal frictions of every size are known".to_owned(),
                Err(reason) => reason.to_string(),
            };
            why.insert("changes_up_to".to_owned(), reason.into());
        }
        if let Some(shaken) = tangential::json(study) {
            object["tangential_dither"] = shaken;
            if object["tangential_dither"].is_null() {
                let reason = "no load has a slip_ratio and a speed";
                why.insert("tangential_dither".to_owned(), reason.into());
            }
        }
        object["out_of_reach"] = self.out_of_reach.into();
        let mut warnings = study.warnings().to_vec();
        warnings.extend(self.critical.warnings(study));
        object["warnings"] = warnings.into();
        object["units"] = json!({
            "growth_rate": "ω_ref", "growth_rate_error": "ω_ref", "frequency": "ω_ref", "speed": "ω_ref", "friction": FRICTION,
        });
        self.critical.put(study, &mut object, &mut why);
        let units = DiscUnits::of(study);
        if let Some((omega, _)) = units.and_then(|units| units.one("growth_rate", "ω_ref")) {
            object["growth_rate_db_per_s"] = (DECIBELS * omega * self.growth.rate).into();
            if study.scales(0).is_some_and(|scales| scales.load_radius_m.is_some()) {
                object["speed_at_load"] = study.disc().speed().into();
                object["units"]["speed_at_load"] = "r₀ω_ref".into();
            }
        }
        if !why.is_empty() {
            object["why"] = Json::Object(why);
        }
        object
    }
}
