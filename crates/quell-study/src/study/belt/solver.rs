//! `[solver]`: optional, with the defaults of the design.

use quell_input::document::Table;
use quell_model::parameter::{RECORD_PERIODS, SETTLE, TOLERANCE};

use crate::study::Solver;
use crate::study::reader::Reader;
use crate::study::vocabulary::Section;

/// Reads `[solver]`.
pub(super) fn read(reader: &mut Reader, root: &Table) -> Option<Solver> {
    let default = Solver::default();
    let Some(node) = root.get("solver") else {
        return Some(default);
    };
    let table = reader.table("solver", node)?;
    reader.unknown_keys(table, Section::Solver, "solver");
    let tolerance = reader.optional(table, "solver", TOLERANCE);
    let settle = reader.optional(table, "solver", SETTLE);
    let periods = reader.optional(table, "solver", RECORD_PERIODS);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a whole number within the bounds of the registry"
    )]
    let record_periods = periods.or(f64::from(default.record_periods))? as _;
    Some(Solver {
        tolerance: tolerance.or(default.tolerance)?,
        settle: settle.or(default.settle)?,
        record_periods,
    })
}
