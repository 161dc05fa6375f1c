//! A belt as the origin of a system: its numbers keep their keys.

use quell_model::System;

use super::BeltStudy;
use crate::complaint::Complaints;
use crate::study::path::with_unit;
use crate::study::system::NumberedStudy;

impl NumberedStudy for BeltStudy {
    fn number(&self, path: &str) -> Option<f64> {
        Self::number(self, path)
    }

    fn unit_of(&self, path: &str) -> &'static str {
        self.address(path).ok().and_then(|address| address.measured_in).unwrap_or("1")
    }

    fn key_of(&self, path: &str) -> String {
        if self.scales().is_some() { with_unit(path) } else { path.to_owned() }
    }

    fn system_with(&self, numbers: &[(&str, f64)]) -> Result<System, Complaints> {
        let set = |study: Self, (path, value): &(&str, f64)| study.with(path, *value);
        numbers.iter().try_fold(self.clone(), set)?.system()
    }
}
