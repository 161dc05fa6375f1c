//! Pictures of outcomes: one file per verb, with the undithered case dashed for comparison.
//!
//! A study in SI is drawn in SI with a suitable metric prefix; any other study is drawn in the dimensionless numbers of the
//! equations. The caption states the law, the belt, the dither and the start.

mod actuator;
mod basins;
pub mod bifurcation;
mod caption;
mod compare;
pub(crate) mod describing;
mod design;
pub mod disc;
pub mod exponents;
mod fit;
mod fitted_record;
mod frame;
pub(crate) mod friction;
mod manoeuvre;
mod map;
pub(crate) mod noise_response;
pub mod orbit;
mod page;
mod probability;
pub(crate) mod ramp;
pub(crate) mod receptance;
mod response;
mod ruler;
mod simulate;
pub mod sketch;
mod stability;
mod sweep;
pub mod system;
pub mod system_modes;
mod thresholds;
mod waveforms;
mod window;

pub use actuator::actuator;
pub use basins::basins;
pub use compare::compare;
pub use design::{design, disc_design};
pub use fit::fit;
pub use fitted_record::{decay, record_fit};
pub use map::{MOST_PANELS, MapAxis, MapKind, MappedQuantity, map, map_panel};
pub use page::{PicturePage, PictureWidth};
pub use probability::probability;
pub use response::response;
pub use simulate::simulate;
pub use stability::stability;
pub use sweep::sweep;
pub use thresholds::{curves, thresholds};
pub use waveforms::waveforms;
pub(crate) use window::window;

use crate::complaint::Failure;
use crate::output::Output;
use crate::plot::{Figure, Fill, Panel, PlotError, PlotRole, Region};
use quell_numerics::interval::RealInterval;

/// File name extensions of the supported picture formats.
pub const EXTENSIONS: &[&str] = &["svg", "pdf", "png"];

/// Writes a figure in the format of the output's extension.
///
/// # Errors
/// [`Failure::Failed`] if the figure cannot be drawn or written.
pub fn write(figure: &Figure, output: Output) -> Result<String, Failure> {
    let bytes = match output.extension().as_str() {
        "png" => figure.to_png().map_err(undrawable)?,
        "pdf" => figure.to_pdf().map_err(undrawable)?,
        _ => figure.to_svg().into_bytes(),
    };
    output.write(&bytes).map(|path| path.display().to_string())
}

/// The failure for a figure that cannot be drawn.
#[expect(clippy::needless_pass_by_value, reason = "consumes the error, for `map_err`")]
fn undrawable(why: PlotError) -> Failure {
    Failure::Failed { key: "--plot".to_owned(), why: why.to_string().into() }
}

/// Adds the intervals of a parameter in which the base response is unstable to a panel.
fn with_unstable(panel: Panel, intervals: Vec<RealInterval>) -> Panel {
    intervals.into_iter().enumerate().fold(
        panel,
        |panel, (number, RealInterval { lower: from, upper: to })| {
            let label = if number == 0 { "base response unstable" } else { "" };
            let region = Region::across_x(PlotRole::Undecided, from, to).fill(Fill::Hatched);
            panel.with(region.label(label))
        },
    )
}
