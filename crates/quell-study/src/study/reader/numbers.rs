//! Numbers: bounds, SI twins, and keys of the wrong system.

use quell_model::Waveform;
use quell_model::parameter::{
    Bounds, MASS, NATURAL_FREQUENCY, Parameter, STIFFNESS, ScaleKey, SiTwin,
};
use quell_model::units::measure::{self, Unread};
use quell_model::units::{Quantity, Scales};
use serde_json::Value as Json;

use super::{Reader, Units};
use crate::complaint::{Complaint, Fault, Origin};
use crate::study::document::{Node, Table, Value};
use crate::study::vocabulary::{self, join};

/// The result of reading the keys of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::study) enum Found {
    /// A valid value, dimensionless.
    Value(f64),
    /// An invalid value, already reported.
    Wrong,
    /// No value.
    Absent,
}

impl Found {
    /// The value, or the default if absent.
    pub(in crate::study) fn or(self, default: f64) -> Option<f64> {
        match self {
            Self::Value(value) => Some(value),
            Self::Absent => Some(default),
            Self::Wrong => None,
        }
    }
}

impl Reader {
    pub(super) fn scales(&mut self, belt: &Node) -> Option<Scales> {
        let table = belt.table()?;
        let mass = self.scale(table, MASS, belt.origin);
        let Some(node) = table.get(NATURAL_FREQUENCY.key()) else {
            let stiffness = self.scale(table, STIFFNESS, belt.origin);
            return Scales::new(mass?, stiffness?).ok();
        };
        let hertz = self.scale(table, NATURAL_FREQUENCY, belt.origin);
        if table.has(STIFFNESS.key()) {
            self.not_both(STIFFNESS.path, NATURAL_FREQUENCY.path, node);
            return None;
        }
        Scales::of_natural_frequency(mass?, hertz?).ok()
    }

    /// Reports the second of two keys for the same number.
    fn not_both(&mut self, first: &str, second: &str, node: &Node) {
        let allowed = format!("give either {first} or {second}, not both");
        let given = node.given();
        self.complain(Complaint::new(Fault::Conflict, second, node.origin, given, allowed));
    }

    fn scale(&mut self, table: &Table, scale: ScaleKey, header: Origin) -> Option<f64> {
        let Some(node) = table.get(scale.key()) else {
            let or = if scale == STIFFNESS {
                format!("; or {}", NATURAL_FREQUENCY.path)
            } else {
                String::new()
            };
            let allowed = format!(
                "{} in {} ({}, {}){or}; a study in SI requires mass and stiffness",
                scale.bounds, scale.unit, scale.symbol, scale.about
            );
            self.complain(Complaint::new(Fault::Missing, scale.path, header, Json::Null, allowed));
            return None;
        };
        self.within(scale.path, node, scale.bounds, scale.unit, false)
    }

    /// A required parameter.
    pub(in crate::study) fn number(
        &mut self,
        table: &Table,
        prefix: &str,
        header: Origin,
        parameter: Parameter,
    ) -> Option<f64> {
        match self.optional(table, prefix, parameter, None) {
            Found::Value(value) => Some(value),
            Found::Wrong => None,
            Found::Absent => {
                let keys = self.right_keys(parameter);
                let Parameter { bounds, symbol, about, .. } = parameter;
                let or = keys.get(1).map(|key| format!("; or {}", join(prefix, key)));
                let unit = match (self.units, parameter.si.first()) {
                    (Units::Si(_), Some(twin)) => format!(", in {}", twin.unit),
                    _ => String::new(),
                };
                let or = or.unwrap_or_default();
                let allowed = format!("{bounds}{unit} ({symbol}, {about}){or}");
                let key = join(prefix, &keys[0]);
                self.complain(Complaint::new(Fault::Missing, key, header, Json::Null, allowed));
                None
            }
        }
    }

    /// An optional parameter. The waveform converts a root mean square to a peak.
    pub(in crate::study) fn optional(
        &mut self,
        table: &Table,
        prefix: &str,
        parameter: Parameter,
        waveform: Option<&Waveform>,
    ) -> Found {
        let twins: Vec<SiTwin> =
            parameter.si.iter().copied().filter(|twin| table.has(twin.key)).collect();
        let plain = table.get(parameter.key());
        let (si, disc) = (self.is_si(), self.is_of_a_disc());
        match (plain, twins.as_slice()) {
            (None, []) => Found::Absent,
            (Some(node), []) if !si || parameter.si.is_empty() || parameter.is_pure() => {
                self.plain(node, &join(prefix, parameter.key()), parameter)
            }
            (None, [twin]) if si || disc => self.twin(table, prefix, parameter, *twin, waveform),
            (None, [first, .., last]) if si || disc => {
                if let Some(node) = table.get(last.key) {
                    self.not_both(&join(prefix, first.key), &join(prefix, last.key), node);
                }
                Found::Wrong
            }
            (Some(node), [twin, ..]) if disc || (si && parameter.is_pure()) => {
                self.not_both(&join(prefix, twin.key), &join(prefix, parameter.key()), node);
                Found::Wrong
            }
            (plain, twins) => {
                self.mixed(table, prefix, parameter, plain, twins);
                Found::Wrong
            }
        }
    }

    /// Complains about keys of the wrong system.
    fn mixed(
        &mut self,
        table: &Table,
        prefix: &str,
        parameter: Parameter,
        plain: Option<&Node>,
        twins: &[SiTwin],
    ) {
        let plain_key = join(prefix, parameter.key());
        let twin_key = join(prefix, twins.first().unwrap_or(&parameter.si[0]).key);
        if matches!(self.units, Units::Si(_)) {
            let Some(node) = plain else { return };
            // An option is set by the other key; a key in the file next to its twin is removed.
            let is_set = matches!(node.origin, Origin::Argument(_));
            let instead = if twins.is_empty() || is_set { "use" } else { "remove it and keep" };
            let allowed = format!(
                "the study is in SI, but {plain_key} is dimensionless: {instead} {twin_key} ({})",
                parameter.si[0].unit
            );
            let complaint =
                Complaint::new(Fault::Mixed, plain_key, node.origin, node.given(), allowed);
            self.complain(complaint.suggesting(Some(twin_key)));
            return;
        }
        for twin in twins {
            let Some(node) = table.get(twin.key) else {
                continue;
            };
            let key = join(prefix, twin.key);
            let allowed = format!(
                "the study is dimensionless, but {key} is in SI: use {plain_key}, or convert the whole study to SI with \
                 belt.mass_kg and belt.stiffness_n_per_m"
            );
            let complaint = Complaint::new(Fault::Mixed, key, node.origin, node.given(), allowed);
            self.complain(complaint.suggesting(Some(plain_key.clone())));
        }
    }

    fn plain(&mut self, node: &Node, key: &str, parameter: Parameter) -> Found {
        let count = parameter.quantity == Quantity::Count;
        let value = self.within(key, node, parameter.bounds, "", count);
        self.remember(key, key, node.origin, 1.0);
        value.map_or(Found::Wrong, Found::Value)
    }

    fn twin(
        &mut self,
        table: &Table,
        prefix: &str,
        parameter: Parameter,
        twin: SiTwin,
        waveform: Option<&Waveform>,
    ) -> Found {
        let Some(node) = table.get(twin.key) else {
            return Found::Absent;
        };
        let key = join(prefix, twin.key);
        let rms = match (twin.rms, waveform) {
            (true, Some(waveform)) => Some(waveform.root_mean_square()),
            (true, None) => None,
            (false, _) => Some(1.0),
        };
        // A key in rpm is not in the SI unit of its quantity.
        let unit = twin.unit.trim_end_matches(" (rms)");
        let (si_unit, _) = parameter.quantity.si_unit().unwrap_or((unit, ""));
        let size = measure::convert(1.0, unit, si_unit).unwrap_or(1.0);
        let per_unit = self.si_per_unit(parameter.quantity);
        let factor = per_unit.zip(rms).map(|(per_unit, rms)| per_unit * rms / size);
        // Without scales the sign can still be checked.
        let scale = factor.unwrap_or(1.0);
        let judged = factor.is_some()
            || (parameter.bounds.lower == 0.0 && parameter.bounds.upper.is_infinite());
        let bounds = if judged {
            Bounds {
                lower: parameter.bounds.lower * scale,
                upper: parameter.bounds.upper * scale,
                ..parameter.bounds
            }
        } else {
            Bounds::FINITE
        };
        let Some(given) = self.within(&key, node, bounds, twin.unit, false) else {
            return Found::Wrong;
        };
        let Some((per_unit, rms)) = per_unit.zip(rms) else {
            self.without_scale(parameter, &key, node);
            return Found::Wrong;
        };
        self.remember(&join(prefix, parameter.key()), &key, node.origin, scale);
        Found::Value(given * size / rms / per_unit)
    }

    /// Reports a number in SI of a disc whose scale is unknown; for a belt the missing mass or stiffness has already been
    /// reported.
    fn without_scale(&mut self, parameter: Parameter, key: &str, node: &Node) {
        if !self.is_of_a_disc() {
            return;
        }
        let needed = match parameter.quantity {
            Quantity::FrequencyRatio => {
                "values in hertz require disc.youngs_modulus_pa, density_kg_per_m3, thickness_m and outer_radius_m, or \
                 modes in hertz"
            }
            Quantity::LoadFriction => {
                "values in newtons require radius_ratio of the load and modes computed from a plate with \
                 disc.youngs_modulus_pa, density_kg_per_m3, thickness_m and outer_radius_m"
            }
            _ => {
                "SI values require the mass of the plate: modes computed with disc.youngs_modulus_pa, density_kg_per_m3, \
                 thickness_m and outer_radius_m"
            }
        };
        let allowed = format!("{needed}; or give {} instead", parameter.key());
        let complaint = Complaint::new(Fault::Conflict, key, node.origin, node.given(), allowed);
        self.complain(complaint);
    }

    /// A finite number within bounds.
    pub(in crate::study) fn within(
        &mut self,
        key: &str,
        node: &Node,
        bounds: Bounds,
        unit: &str,
        whole: bool,
    ) -> Option<f64> {
        let range = if whole {
            bounds.to_string().replacen("number", "whole number", 1)
        } else {
            bounds.to_string()
        };
        let range = if unit.is_empty() { range } else { format!("{range}, in {unit}") };
        let Value::Number(value) = node.value else {
            self.wrong(key, node, format!("{range}{}", self.no_number(key, node, unit)));
            return None;
        };
        if !bounds.contains(value) || (whole && value.fract() != 0.0) {
            self.wrong(key, node, range);
            return None;
        }
        Some(value)
    }

    /// Why a value is not a number for a key, in `unit` if given.
    fn no_number(&self, key: &str, node: &Node, unit: &str) -> String {
        let kind = node.kind();
        let Value::Text(text) = &node.value else { return format!("; got {kind}") };
        if text.trim().parse::<f64>().is_ok() {
            return format!(", without quotes; got {kind}");
        }
        if !measure::has_unit(text) {
            return format!("; got {kind}");
        }
        let of_key = || vocabulary::resolve(key).ok()?.key.measured_in();
        let given = Some(unit.trim_end_matches(" (rms)")).filter(|unit| !unit.is_empty());
        match measure::read(text, given.or_else(of_key)) {
            Err(why @ Unread::NoUnitHere(_)) if !self.is_si() => {
                let instead = if self.is_of_a_disc() {
                    "units require SI keys, such as disc.load.speed_rpm"
                } else {
                    "units require a study in SI, with belt.mass_kg"
                };
                format!("; {why}: {instead}")
            }
            Err(why) => format!("; {why}"),
            Ok(_) => format!("; got {kind}"),
        }
    }

    /// Keys that give a parameter in the system of this study.
    fn right_keys(&self, parameter: Parameter) -> Vec<String> {
        match self.units {
            Units::Si(_) if !parameter.si.is_empty() => {
                let twins = parameter.si.iter().map(|twin| twin.key.to_owned());
                let pure = parameter.is_pure().then(|| parameter.key().to_owned());
                twins.chain(pure).collect()
            }
            Units::Disc(_) => {
                let twins = parameter.si.iter().map(|twin| twin.key);
                [parameter.key()].into_iter().chain(twins).map(str::to_owned).collect()
            }
            _ => vec![parameter.key().to_owned()],
        }
    }
}
