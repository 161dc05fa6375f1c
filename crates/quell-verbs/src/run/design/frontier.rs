//! The frontier of a design: the least objective against each limit, from the choices that were tried by averaging.

use quell_design::actuator::Actuator;
use quell_design::least_dither::{DesignObjective, DesignPoint, LimitedQuantity};

use super::answer::{quantity_of, quantity_of_limit};
use super::found::LeastDitherFound;
use super::study_with_design::StudyWithDesign;
use crate::fields::Fields;

/// Shares of a limit at which the frontier is evaluated.
const SHARES: [f64; 9] = [0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.2, 1.5, 2.0];

/// The least objective under one limit, the others as they are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrontierPoint {
    /// What is limited.
    pub quantity: LimitedQuantity,
    /// The value of the limit.
    pub value: f64,
    /// Its ratio to that of the study, or the inverse for a least load.
    pub share: f64,
    /// The least objective; `None` where no choice keeps this limit.
    pub objective: Option<f64>,
}

impl LeastDitherFound {
    /// The least objective against each limit.
    pub fn frontier(&self, study: &dyn StudyWithDesign) -> Vec<FrontierPoint> {
        let asked = study.asked().map(|asked| asked.limits.as_slice()).unwrap_or_default();
        let of_actuator = study.actuator().map(Actuator::limits).into_iter().flatten();
        let of_actuator = of_actuator.map(|limit| (LimitedQuantity::Actuator(limit), 1.0));
        let limits: Vec<_> = asked.iter().copied().chain(of_actuator).collect();
        let at = |place: usize, share: f64| {
            let keeps = |point: &&DesignPoint| {
                point.used.iter().enumerate().all(|(number, (_, used))| {
                    let most = if number == place { share } else { 1.0 };
                    used.as_ref().is_ok_and(|used| *used <= most)
                })
            };
            let tried = self.answer().tried.iter().filter(keeps);
            let objectives = tried.filter_map(|point| point.objective.clone().ok());
            let objective = objectives.min_by(f64::total_cmp);
            let (quantity, limit) = limits[place];
            let is_least = quantity == LimitedQuantity::MinimumNormalLoad;
            let value = if is_least { limit / share } else { limit * share };
            FrontierPoint { quantity, value, share, objective }
        };
        (0..limits.len()).flat_map(|place| SHARES.map(|share| at(place, share))).collect()
    }

    /// Adds `frontier`.
    pub(super) fn put_frontier(
        &self,
        fields: &mut Fields,
        study: &dyn StudyWithDesign,
        minimise: DesignObjective,
    ) {
        let rows = self.frontier(study).into_iter().map(|point| {
            let mut inner = study.fields();
            let objective = point.objective.ok_or_else(|| "no choice keeps this limit".to_owned());
            inner
                .plain("limit", point.quantity.name())
                .number("value", quantity_of_limit(study, point.quantity), point.value)
                .known("objective", quantity_of(study, minimise), objective);
            inner
        });
        fields.list("frontier", rows.collect::<Vec<_>>());
    }
}
