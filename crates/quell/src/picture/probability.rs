//! The distribution of the growth rate over the samples.

use super::caption::caption_of;
use crate::outcome::DISTRIBUTION_POINTS;
use crate::plot::{
    Figure, LineStyle, Panel, PlotAxis, PlotRole, Polyline, ReferenceLine, SharedLegend,
};
use crate::run::probability::{SampledGrowth, VibrationProbability};
use crate::study::{Kind, Study, SystemUnits};

/// Share of the samples whose growth rate is below each value.
pub fn probability(study: &Study, done: &VibrationProbability) -> Figure {
    let axis = PlotAxis::new("growth rate").symbol("Re λ");
    let axis = match unit(study) {
        Some(unit) => axis.unit(unit),
        None => axis,
    };
    let curve = |growth: &SampledGrowth| growth.distribution(DISTRIBUTION_POINTS);
    let mut panel = Panel::new(axis, PlotAxis::new("share of the samples below").between(0.0, 1.0))
        .with(ReferenceLine::vertical(0.0).label("grows beyond"));
    let sharper = done.growth_sharper.as_ref();
    let line = Polyline::new(PlotRole::Series(0), curve(&done.growth));
    panel = panel.with(match sharper {
        Some(_) => line.label("averaging"),
        None => line,
    });
    if let Some(growth) = sharper {
        panel = panel.with(
            Polyline::new(PlotRole::Series(1), curve(growth))
                .style(LineStyle::Dashed)
                .label("finite-R averaging"),
        );
    }
    Figure::single(panel)
        .legend(SharedLegend::Below)
        .title(study.title().unwrap_or_default())
        .caption(format!("{} {}", caption_of(study), done.sentence()))
}

/// The unit of growth rates.
fn unit(study: &Study) -> Option<&'static str> {
    match study.kind() {
        Kind::Belt(_) | Kind::Disc(_) => Some("ω₀"),
        Kind::System(_) => {
            let system = study.system().ok()?;
            (system.units() != SystemUnits::None).then_some("1/s")
        }
    }
}
