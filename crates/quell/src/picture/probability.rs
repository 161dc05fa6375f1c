//! The distribution of the growth rate over the samples.

use super::caption::caption_of;
use crate::outcome::DISTRIBUTION_POINTS;
use crate::plot::{
    Figure, LineStyle, Panel, PlotAxis, PlotPoint, PlotRole, Polyline, ReferenceLine, SharedLegend,
};
use crate::run::probability::{SampledGrowth, VibrationProbability};
use crate::study::Study;

/// Share of the samples whose growth rate is below each value, in this unit with this many of them in one of the equations.
pub fn probability(
    study: &Study,
    done: &VibrationProbability,
    (unit, factor): (&'static str, f64),
    sentence: &str,
) -> Figure {
    let axis = PlotAxis::new("growth rate").symbol("Re λ");
    let axis = if unit == "1" { axis } else { axis.unit(unit) };
    let curve = |growth: &SampledGrowth| {
        let (rates, shares) = growth.distribution(DISTRIBUTION_POINTS, factor);
        PlotPoint::zip(rates, shares)
    };
    let mut panel = Panel::new(axis, PlotAxis::new("share of the samples below").between(0.0, 1.0))
        .with(ReferenceLine::vertical(0.0).label("grows beyond"));
    let limit = done.limit_growth.as_ref();
    let line = Polyline::new(PlotRole::Series(0), curve(&done.growth));
    panel = panel.with(match limit {
        Some(_) => line.label("finite-R averaging"),
        None => line,
    });
    if let Some(growth) = limit {
        panel = panel.with(
            Polyline::new(PlotRole::Series(1), curve(growth))
                .style(LineStyle::Dashed)
                .label("limit R → ∞"),
        );
    }
    Figure::single(panel)
        .legend(SharedLegend::Below)
        .title(study.title().unwrap_or_default())
        .caption(format!("{} {sentence}", caption_of(study)))
}
