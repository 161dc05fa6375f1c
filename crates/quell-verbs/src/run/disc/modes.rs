//! `modes`: natural frequencies and shapes of the disc, and the critical speeds.

use std::f64::consts::TAU;

use quell_model::units::Quantity;
use serde_json::{Map, Value as Json, json};

use crate::dataset::{Array, Dataset};
use crate::disc_units::from_reference;
use crate::study::DiscStudy;
use crate::study::disc::ModeSource;
use crate::words::digits;

/// One mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModeRow {
    /// Radial number, from 1.
    pub radial: usize,
    /// Nodal diameters q.
    pub diameters: usize,
    /// k², if computed.
    pub frequency_parameter: Option<f64>,
    /// β = ω/ω_ref.
    pub ratio: f64,
    /// φ at the first load; without a load, at the outer edge.
    pub shape_at_load: f64,
    /// ξ.
    pub damping: f64,
    /// Frequency in hertz, if the study defines ω_ref.
    pub frequency_hz: Option<f64>,
    /// Critical speed in ω_ref: β/q, or β/√(q² − κ) of a disc that rotates; `None` without nodal diameters, and where centrifugal
    /// stress lets the wave run ahead of the loads at any speed.
    pub critical_speed: Option<f64>,
}

impl ModeRow {
    /// Critical speed in ω_ref.
    pub fn critical_speed(&self) -> Option<f64> {
        self.critical_speed
    }

    /// Critical speed in revolutions per minute.
    pub fn critical_speed_rpm(&self) -> Option<f64> {
        let hertz = self.frequency_hz?;
        let speed = self.critical_speed?;
        let still = self.ratio / self.diameters as f64;
        let at_rest = 60.0 * hertz / self.diameters as f64;
        Some(if speed == still { at_rest } else { at_rest * (speed / still) })
    }
}

/// The modes of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Modes {
    /// In the order of the study; computed ones by diameters, then radial number.
    pub rows: Vec<ModeRow>,
    /// The mode with the lowest critical speed β/q.
    pub critical: Option<usize>,
    /// k² of ω_ref, if modes are computed.
    pub reference: Option<f64>,
    /// ω_ref in hertz, if the study defines it.
    pub reference_hz: Option<f64>,
    /// M_p in kg, if the study gives material and size.
    pub plate_mass: Option<f64>,
}

/// The modes of a study.
pub fn run(study: &DiscStudy) -> Modes {
    let reference_hz = study.reference_hz();
    let modes = study.disc().modes();
    let plate = match study.source() {
        ModeSource::Plate(plate) => Some(plate),
        _ => None,
    };
    let rows: Vec<ModeRow> = modes
        .iter()
        .enumerate()
        .map(|(index, mode)| {
            let computed = plate.and_then(|plate| plate.set.modes().get(index));
            let lower = |other: &(usize, &quell_model::disc::Mode)| {
                other.1.diameters == mode.diameters
                    && (other.1.ratio, other.0) < (mode.ratio, index)
            };
            ModeRow {
                radial: computed.map_or_else(
                    || 1 + modes.iter().enumerate().filter(lower).count(),
                    |computed| computed.radial,
                ),
                diameters: mode.diameters,
                frequency_parameter: computed.map(|computed| computed.frequency_parameter),
                ratio: mode.ratio,
                shape_at_load: mode.shape_at_load,
                damping: mode.damping,
                frequency_hz: reference_hz.map(|hertz| mode.ratio * hertz),
                critical_speed: study.disc().critical_speed(index),
            }
        })
        .collect();
    let speeds =
        rows.iter().enumerate().filter_map(|(index, row)| Some((index, row.critical_speed()?)));
    let critical = speeds.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(index, _)| index);
    Modes {
        critical,
        reference: plate.map(|plate| plate.set.reference()),
        reference_hz,
        plate_mass: study.disc().plate_mass_kg(),
        rows,
    }
}

impl Modes {
    /// The lowest natural frequency and the lowest critical speed, each with its mode.
    pub fn sentence(&self, study: &DiscStudy) -> String {
        let of = |row: &ModeRow| format!("of mode ({}, {})", row.radial, row.diameters);
        let words = |name: &str, value: f64, usual: Option<(f64, &'static str)>| {
            let (value, unit) = usual.unwrap_or_else(|| from_reference(study, name, value));
            format!("{} {unit}", digits(value))
        };
        let Some(lowest) = self.rows.iter().min_by(|a, b| a.ratio.total_cmp(&b.ratio)) else {
            return "The disc has no modes.".to_owned();
        };
        let hertz = lowest.frequency_hz.map(|hertz| (hertz, "Hz"));
        let frequency = words("frequency", lowest.ratio, hertz);
        let frequency = format!("The lowest natural frequency is {frequency}, {}.", of(lowest));
        let critical = self.critical.map(|index| &self.rows[index]);
        let speed = critical.and_then(|row| Some((row, row.critical_speed()?)));
        match speed {
            None => format!("{frequency} No mode has a critical speed."),
            Some((row, speed)) => {
                let rpm = row.critical_speed_rpm().map(|rpm| (rpm, "rpm"));
                let speed = words("critical_speed", speed, rpm);
                format!("{frequency} The lowest critical speed is {speed}, {}.", of(row))
            }
        }
    }

    /// As JSON.
    pub fn json(&self, study: &DiscStudy) -> Json {
        let modes: Vec<Json> = self
            .rows
            .iter()
            .map(|row| {
                json!({
                    "radial": row.radial,
                    "diameters": row.diameters,
                    "frequency_parameter": row.frequency_parameter,
                    "ratio": row.ratio,
                    "shape_at_load": row.shape_at_load,
                    "damping": row.damping,
                    "critical_speed": row.critical_speed(),
                    "frequency": row.ratio,
                })
            })
            .collect();
        let critical = self.critical.map(|index| {
            let row = &self.rows[index];
            json!({ "radial": row.radial, "diameters": row.diameters })
        });
        let mut why = Map::new();
        let mut explain = |null: bool, key: &str, reason: &str| {
            if null {
                why.insert(key.to_owned(), reason.into());
            }
        };
        let unlisted = "the modes are given, not computed from a plate";
        let listed = self.reference.is_none();
        explain(listed, "modes[].frequency_parameter", unlisted);
        explain(listed, "reference_frequency", unlisted);
        let metal = "the study does not give youngs_modulus_pa, density_kg_per_m3, thickness_m and outer_radius_m";
        let mass =
            if listed { "the study does not give plate_mass_kg and modes in hertz" } else { metal };
        let metal = if listed { "the listed modes are not in hertz" } else { metal };
        explain(self.reference_hz.is_none(), "reference", metal);
        explain(self.plate_mass.is_none(), "plate_mass", mass);
        explain(
            self.rows.iter().any(|row| row.critical_speed.is_none()),
            "modes[].critical_speed",
            if study.disc().is_stiffened() {
                "a mode without nodal diameters has no critical speed, nor has one that centrifugal stress keeps ahead of the loads"
            } else {
                "a mode without nodal diameters has no critical speed"
            },
        );
        explain(critical.is_none(), "critical_mode", "no mode has a nodal diameter");
        let mut object = json!({
            "ok": true,
            "sentence": self.sentence(study),
            "modes": modes,
            "critical_mode": critical,
            "reference_frequency": self.reference,
            "reference": self.reference_hz.map(|hertz| TAU * hertz),
            "plate_mass": self.plate_mass,
            "units": {
                "frequency_parameter": "1 (k² = ω a² √(ρh/D))",
                "ratio": "1 (ω/ω_ref)",
                "shape_at_load": "1 (unit mean square of φ cos qθ over the plate)",
                "critical_speed": "ω_ref",
                "frequency": "ω_ref",
                "reference": "rad/s",
                "plate_mass": "kg",
            },
            "why": why,
            "warnings": study.warnings(),
        });
        if study.disc().loads().is_empty() {
            object["why"]["modes[].shape_at_load"] =
                "the disc has no load, so the shape is given at the outer edge".into();
        }
        object
    }

    /// As a dataset, one row per mode; the CSV can be read back as `modes_file` of a study.
    pub fn dataset(&self, study: &DiscStudy) -> Dataset {
        let column = |of: &dyn Fn(&ModeRow) -> f64| self.rows.iter().map(of).collect::<Vec<f64>>();
        let number = (1..=self.rows.len()).map(|index| index as f64).collect();
        let mut dataset = Dataset::of(&study.into(), "modes")
            .axis("mode", Quantity::Count, number)
            .with(Array::new("radial", "1", column(&|row| row.radial as f64)))
            .with(Array::new("diameters", "1", column(&|row| row.diameters as f64)));
        if self.reference.is_some() {
            let values = column(&|row| row.frequency_parameter.unwrap_or(f64::NAN));
            dataset = dataset.with(Array::new("frequency_parameter", "1", values));
        }
        dataset = dataset
            .with(Array::new("ratio", "1", column(&|row| row.ratio)))
            .with(Array::new("shape_at_load", "1", column(&|row| row.shape_at_load)))
            .with(Array::new("damping", "1", column(&|row| row.damping)));
        if self.reference_hz.is_some() {
            let values = column(&|row| row.frequency_hz.unwrap_or(f64::NAN));
            dataset = dataset.with(Array::new("frequency_hz", "Hz", values));
        }
        dataset
    }
}
