//! `probability`: how probable it is that a study with uncertain numbers vibrates.

use std::fmt::Write as _;

use serde_json::Value as Json;

use super::Presented;
use crate::complaint::Failure;
use crate::dataset::{Array, Dataset};
use crate::picture;
use crate::plot::Figure;
use crate::run::probability::{SampledKind, VibrationProbability};
use crate::study::{Study, StudyKind, StudyOf};
use crate::words::quantity_at;

/// Points of the distribution of the growth rate in datasets and pictures.
pub(crate) const POINTS: usize = 401;

impl<K> Presented<K> for VibrationProbability
where
    K: StudyKind + Send + Sync,
    StudyOf<K>: SampledKind,
    for<'a> Study: From<&'a StudyOf<K>>,
{
    const NAME: &'static str = "probability";
    const TITLED: bool = true;

    fn json(&self, study: &StudyOf<K>) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &StudyOf<K>) -> Option<String> {
        Some(self.sentence(study))
    }

    fn notes(&self, study: &StudyOf<K>) -> Vec<String> {
        self.notes(study)
    }

    fn table(&self, _: &StudyOf<K>) -> String {
        table(self)
    }

    fn datasets(&self, study: &StudyOf<K>) -> Vec<(&'static str, Dataset)> {
        let (unit, factor) = study.unit_of_rates();
        let (rates, shares) = self.growth.distribution(POINTS, factor);
        let dataset = Dataset::of(&study.into(), "probability")
            .fact(self.sentence(study))
            .with_axis(Array::new("share", "1", shares))
            .with(Array::new("growth", unit, rates));
        vec![("probability", dataset)]
    }

    fn figure(&self, study: &StudyOf<K>) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::probability(
            &study.into(),
            self,
            study.unit_of_rates(),
            &self.sentence(study),
        )))
    }
}

/// Indices of every number or group of correlated numbers.
fn table(found: &VibrationProbability) -> String {
    let words = |group: &Vec<usize>| {
        let names: Vec<String> = found.names(group).into_iter().map(quantity_at).collect();
        names.join(" with ")
    };
    let names: Vec<String> = found.groups.iter().map(words).collect();
    let width = names.iter().map(|name| name.chars().count()).max().unwrap_or(0).max(6);
    let mut text =
        format!("  {:<width$}  {:>18}  {:>18}\n", "number", "first-order index", "total index");
    for (name, indices) in names.iter().zip(&found.growth.indices) {
        match indices {
            Ok(indices) => {
                let shown = |index: quell_design::probability::SobolEstimate| {
                    format!("{:.4} ± {:.4}", index.value, index.error)
                };
                let (first, total) = (shown(indices.first), shown(indices.total));
                let _ = writeln!(text, "  {name:<width$}  {first:>18}  {total:>18}");
            }
            Err(why) => {
                let _ = writeln!(text, "  {name:<width$}  unknown: {why}");
            }
        }
    }
    text
}
