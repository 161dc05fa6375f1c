//! `basins`: which starts end on which motion.

use std::sync::Arc;

use pyo3::prelude::*;
use quell::run::basins::{BasinsRequest, StartLayout, default_plane, read_plane};
use quell::run::varied::Range;
use quell::study::SystemStudy;
use quell::verbs::{system_of, verbs};
use quell::{Failure, RealInterval, Study, quantity};
use quell_model::units::Quantity;

use super::map::{Counter, Watched};
use crate::answer::NativeAnswer;
use crate::arguments::Pair;
use crate::call;

/// The plane of starts: two names with their windows, or the windows of the first displacement and its velocity.
pub(crate) type GivenPlane = (Option<String>, (Option<Pair>, Option<Pair>));

/// The window of a quantity.
fn window(
    system: &SystemStudy,
    pair: Option<&Pair>,
    quantity: Quantity,
    option: &'static str,
) -> Result<Option<RealInterval>, Failure> {
    let read = |text: &str| quantity::number(text, Some(quantity), system.units(), option);
    pair.map(|(from, to)| Ok(RealInterval::new(read(from)?, read(to)?))).transpose()
}

/// Runs the verb.
pub(crate) fn run(
    py: Python<'_>,
    study: Arc<Study>,
    (plane, (displacement, velocity)): GivenPlane,
    (layout, over): (Option<StartLayout>, Option<Range>),
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<NativeAnswer> {
    let counter = Arc::new(Counter::default());
    let watched = Watched::new(&counter, progress);
    let work = move || {
        let system = system_of(&study, "basins")?;
        let across =
            window(&system, displacement.as_ref(), Quantity::Displacement, "--displacement");
        let up = window(&system, velocity.as_ref(), Quantity::Velocity, "--velocity");
        let axes = match plane {
            Some(text) => read_plane(&system, &text)?,
            None => default_plane(&system, [across?, up?])?,
        };
        let request = BasinsRequest { axes: Some(axes), layout, over };
        Ok(NativeAnswer::new(verbs(&study).basins(&request, counter.running(threads))?))
    };
    call::watched(py, work, watched)
}
