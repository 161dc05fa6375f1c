//! Where the least dither leaves the range of a friction law.

use super::found::{DesignNumber, LeastDitherFound};
use super::study_with_design::StudyWithDesign;

impl LeastDitherFound {
    /// Warnings where the dither of the answer takes the slip out of the range of a law, at a corner of the box or the point that decides.
    pub(super) fn warnings_about_laws(&self, study: &dyn StudyWithDesign) -> Vec<String> {
        let Ok(found) = &self.answer().answer else { return Vec::new() };
        let mut points: Vec<Vec<f64>> = vec![Vec::new()];
        for number in &self.over {
            // The fastest first, as a rule.
            let ends = [number.range.1, number.range.0];
            let longer = |point: &Vec<f64>| ends.map(|end| [point.as_slice(), &[end]].concat());
            points = points.iter().flat_map(longer).collect();
        }
        points.extend(found.critical.worst.clone());
        let amplitude = [(&self.amplitude, found.verified_amplitude)];
        let others = self.others.iter().zip(found.critical.others.iter().copied());
        let warned = points.iter().map(|point| {
            let at = self.over.iter().zip(point.iter().copied());
            let numbers = others.clone().chain(at).chain(amplitude);
            let numbers: Vec<(&str, f64)> = numbers.map(in_units).collect();
            study.beyond_laws(self.waveform(), &numbers)
        });
        warned.into_iter().find(|warnings| !warnings.is_empty()).unwrap_or_default()
    }
}

/// A number of the equations with its path, in the unit of the path.
fn in_units((number, value): (&DesignNumber, f64)) -> (&str, f64) {
    (&number.path, value * number.per_unit)
}
