//! Pictures of outcomes: one file per verb, the undithered case dashed beside the dithered one.
//!
//! A study in SI is drawn in SI, with the metric prefix that suits the values; any other in the
//! numbers of the equations. The caption says what the picture cannot.

mod basins;
mod bifurcation;
mod caption;
pub mod disc;
mod friction;
mod map;
mod orbit;
mod response;
mod ruler;
mod simulate;
mod stability;
mod sweep;
mod thresholds;

pub use basins::basins;
pub use bifurcation::bifurcation;
pub use friction::friction;
pub use map::{MOST_PANELS, Map, MapAxis, MapKind, map, map_panel};
pub use orbit::{orbit, response as periodic_response};
pub use response::response;
pub use simulate::simulate;
pub use stability::stability;
pub use sweep::sweep;
pub use thresholds::{curves, thresholds};

use crate::complaint::Failure;
use crate::output::Output;
use crate::plot::{Figure, Panel, PlotError, PlotRole, Polyline, Region};
use crate::study::BeltStudy;

/// Kinds of pictures that can be written.
pub const EXTENSIONS: &[&str] = &["svg", "png"];

/// Writes a figure as the output's extension says.
///
/// # Errors
/// [`Failure::Failed`] where it cannot be drawn or written.
pub fn write(figure: &Figure, output: Output) -> Result<String, Failure> {
    let bytes = if output.extension() == "png" {
        figure.to_png().map_err(undrawable)?
    } else {
        figure.to_svg().into_bytes()
    };
    output.write(&bytes).map(|path| path.display().to_string())
}

/// Why there is no picture.
#[expect(clippy::needless_pass_by_value, reason = "the last word on an error, for `map_err`")]
fn undrawable(why: PlotError) -> Failure {
    Failure::Failed { key: "--plot".to_owned(), why: why.to_string() }
}

/// A panel with the stretches of a parameter in which the quiet response is unstable.
fn with_unstable(panel: Panel, stretches: Vec<(f64, f64)>) -> Panel {
    stretches.into_iter().enumerate().fold(panel, |panel, (number, (from, to))| {
        let label = if number == 0 { "base response unstable" } else { "" };
        panel.with(Region::across_x(PlotRole::Undecided, from, to).label(label))
    })
}

/// A panel with a curve without dither beside one with it, or of a study without dither its one curve.
fn both(panel: Panel, study: &BeltStudy, curve: impl Fn(PlotRole, bool) -> Polyline) -> Panel {
    if study.belt().dithers().is_empty() {
        return panel.with(curve(PlotRole::Exact, true));
    }
    panel
        .with(curve(PlotRole::Undithered, false).label("without dither"))
        .with(curve(PlotRole::Dithered, true).label("with dither"))
}
