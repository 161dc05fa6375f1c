//! `stability` of a measured structure.

use serde_json::Value as Json;

use crate::outcome::Presented;
use crate::outcome::table::figure;
use crate::run::system::measured::MeasuredStability;
use crate::study::{SystemSetup, SystemStudy};

impl Presented<SystemSetup> for MeasuredStability {
    const NAME: &'static str = "stability-of-measured-response";
    const TITLED: bool = true;

    fn json(&self, study: &SystemStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, _: &SystemStudy) -> String {
        let turns = self.sliding.turns;
        format!(
            "  unstable roots {}, half turns of the determinant {}, least distance from 0 {}\n",
            turns.unstable,
            figure(turns.half_turns),
            figure(turns.distance)
        )
    }
}
