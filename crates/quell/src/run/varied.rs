//! One number of a study varied over a range: `--parameter PATH --from A --to B --points N`.

use quell_model::Belt;
use quell_model::parameter::{BELT_VELOCITY, DITHER_AMPLITUDE, Parameter, SCALES};
use quell_model::units::Quantity;

use crate::complaint::{Complaint, Fault};
use crate::study::vocabulary::size::SignalMeasure;
use crate::study::vocabulary::{DocumentKind, Role, join};
use crate::study::{BeltStudy, Kind, ParameterId, SystemStudy, key_at, with_unit};

/// What a varied number must be.
pub(super) const OF_THE_EQUATIONS: &str = "a number of the equations, such as one of a contact, a friction law or a dither; this one changes none of them";

/// Most values of a range.
pub const MOST_VALUES: usize = 100_000;

/// A requested number of a study and the range of its values.
#[derive(Clone, Debug, PartialEq)]
pub struct Range {
    /// Path of the number.
    pub parameter: String,
    /// First value, in the unit of the key.
    pub from: f64,
    /// Last value, above the first.
    pub to: f64,
    /// Number of values, both ends included.
    pub points: usize,
}

/// A number of the equations of a study, named by one of its keys.
#[derive(Clone, Debug, PartialEq)]
pub struct Named {
    /// Path of the number of the equations, such as `dither.amplitude`.
    pub(super) path: String,
    /// The number of the study that the key names.
    parameter: ParameterId,
    /// The key that names it.
    key: String,
    /// What that key gives for one number of the equations.
    per_unit: f64,
}

impl Named {
    /// The number that `path` names; `option` is the option that gave it.
    ///
    /// # Errors
    /// A complaint with the nearest key that names a number of this study.
    pub(super) fn new(
        study: &BeltStudy,
        option: &'static str,
        path: &str,
    ) -> Result<Self, Box<Complaint>> {
        // What else is known of a wrong path, such as which of several dithers it may mean.
        if let Err(lost) = study.model().parameter(path)
            && lost.fault == Fault::Conflict
        {
            let allowed = format!("a number of this study; {}", lost.allowed);
            return Err(Box::new(Complaint::option(option, path, allowed)));
        }
        let table = path.trim().rsplit_once('.').map_or("", |(table, _)| table);
        let found = key_at(path, DocumentKind::Belt);
        // The intended number of the equations, whether or not this study uses its key.
        let meant = match &found {
            Ok(address) => address.key.parameter().map(|parameter| join(table, parameter.key())),
            Err(nearest) => nearest.clone(),
        };
        let meant =
            meant.or_else(|| Some(path.to_owned())).filter(|path| study.number(path).is_some());
        // A root mean square depends on the waveform, and the result is a peak value.
        let per_unit =
            study.per_one(path).filter(|_| not_a_peak(path, DocumentKind::Belt).is_none());
        let per_unit = per_unit.map(|(_, per_unit)| per_unit);
        match (meant, per_unit) {
            (Some(number), Some(per_unit)) => {
                let parameter = study.model().parameter(path)?;
                Ok(Self { path: number, parameter, key: path.to_owned(), per_unit })
            }
            (_, _) if is_of_several(path) => {
                let allowed = format!(
                    "a single number of the equations; {path} changes several, which `bifurcation` and `map` can vary"
                );
                Err(Box::new(Complaint::option(option, path, allowed)))
            }
            (Some(number), _) if not_a_peak(path, DocumentKind::Belt).is_some() => {
                let why = not_a_peak(path, DocumentKind::Belt).unwrap_or_default();
                let peak = key_of(study, &number);
                let allowed = format!("{peak}, a peak value: {why}");
                Err(Box::new(Complaint::option(option, path, allowed).suggesting(Some(peak))))
            }
            (meant, _) => {
                let [amplitude, velocity] = [DITHER_AMPLITUDE, BELT_VELOCITY]
                    .map(|parameter| key_of(study, parameter.path));
                let allowed = format!("a number of this study, such as {amplitude} or {velocity}");
                let near = meant.map(|path| key_of(study, &path));
                Err(Box::new(Complaint::option(option, path, allowed).suggesting(near)))
            }
        }
    }

    /// The study with another number of the equations, which the key gives.
    pub(super) fn set(&self, number: f64) -> (ParameterId, f64) {
        (self.parameter.clone(), number * self.per_unit)
    }

    /// The belt of another number of the equations; `None` where it is none.
    pub(super) fn belt_at(&self, study: &BeltStudy, number: f64) -> Option<Belt> {
        Some(study.setup_at(&[self.set(number)]).ok()?.belt().clone())
    }

    /// The complaint about a number that is given by `option` and changes nothing between two values of its key.
    pub(super) fn without_effect(
        &self,
        study: &BeltStudy,
        option: &'static str,
        ends: (f64, f64),
    ) -> Option<Complaint> {
        let [first, last] = [ends.0, ends.1].map(|end| self.belt_at(study, self.of(end)));
        let same = first.is_some() && first == last;
        same.then(|| Complaint::option(option, self.key.as_str(), OF_THE_EQUATIONS))
    }

    /// A value of the named key as a number of the equations.
    pub(super) fn of(&self, given: f64) -> f64 {
        given / self.per_unit
    }
}

/// The kind of the document in which the numbers of a system are declared.
pub(super) fn kind_of_document(study: &SystemStudy) -> DocumentKind {
    match study.declared().kind() {
        Kind::Belt(_) => DocumentKind::Belt,
        Kind::Disc(_) => DocumentKind::Disc,
        Kind::System(_) => DocumentKind::System,
    }
}

/// The number of the equations that a path means which names none itself, such as the peak amplitude for a root mean square.
pub(super) fn number_meant(study: &SystemStudy, path: &str) -> Option<String> {
    let table = path.trim().rsplit_once('.').map_or("", |(table, _)| table);
    let meant = match key_at(path, kind_of_document(study)) {
        Ok(address) => address.key.parameter().map(|parameter| join(table, parameter.key())),
        Err(nearest) => nearest,
    };
    meant.filter(|path| study.number(path).is_some())
}

/// Why a key that gives an amplitude by another size than its peak cannot be varied here.
pub(super) fn not_a_peak(path: &str, kind: DocumentKind) -> Option<&'static str> {
    let role = key_at(path, kind).ok()?.key.role;
    let measure = match role {
        Role::Size(_, size) if size.needs_actuator() => {
            return Some(
                "the force of a voltage or current depends on the frequency and the waveform",
            );
        }
        Role::Size(_, size) => size.measure,
        _ => return None,
    };
    match measure {
        SignalMeasure::Peak => None,
        SignalMeasure::RootMeanSquare => Some("a root mean square depends on the waveform"),
        SignalMeasure::PeakToPeak => Some("a peak-to-peak value depends on the waveform"),
    }
}

/// Whether a key changes several numbers of the equations at once: mass, stiffness, friction in newtons.
fn is_of_several(path: &str) -> bool {
    let role = key_at(path, DocumentKind::Belt).map(|address| address.key.role);
    let scale = |parameter: Parameter| SCALES.iter().any(|known| known.path == parameter.path);
    match role {
        Ok(Role::Number(parameter) | Role::Twin(parameter, _)) => scale(parameter),
        role => matches!(role, Ok(Role::FrictionForce(..))),
    }
}

/// The key by which a study gives a number of the equations: a frequency in hertz in a study with units.
pub fn key_of(study: &BeltStudy, path: &str) -> String {
    if study.scales().is_some() { with_unit(path) } else { path.to_owned() }
}

/// The quantity of a number of the equations.
pub(crate) fn quantity_of(study: &BeltStudy, path: &str) -> Quantity {
    study.address(path).ok().and_then(|address| address.quantity).unwrap_or(Quantity::Ratio)
}

/// Description and symbol of a number of the equations as the study gives it: those of the number with a unit in a study with units.
pub(crate) fn name_of(study: &BeltStudy, path: &str) -> Option<(&'static str, &'static str)> {
    let key = key_at(&key_of(study, path), DocumentKind::Belt).ok()?.key;
    let named = key
        .parameter()
        .and_then(|parameter| parameter.si.iter().find(|other| !other.unit.is_empty())?.own);
    let with_unit = named.filter(|_| study.scales().is_some());
    let (symbol, about) = with_unit.unwrap_or((key.symbol().unwrap_or_default(), key.about));
    Some((about, symbol))
}
