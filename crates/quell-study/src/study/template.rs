//! What the equations of a study are made from.

use quell_input::complaint::Complaints;
use quell_input::document::Table;
use quell_model::parameter::Parameter;

use super::system::SystemSetup;

/// What a study of one kind declares: names, units and an assembly of the system that they describe. A kind implements it where its tables
/// are read; what is above does not know which kind it has.
pub(super) trait Template {
    /// Name of the kind.
    fn name(&self) -> &'static str;

    /// The system that the study of a document describes, with what its runs need.
    fn system(&self, document: &Table) -> SystemSetup;

    /// The number at a path of the document, in the unit of its key; `None` where the study has no such number.
    fn number(&self, document: &Table, path: &str) -> Option<f64>;

    /// The path of a number of a contact of the system.
    fn path_of(&self, contact: &str, parameter: Parameter) -> String;

    /// The table that makes the study vary in time.
    fn varies_by(&self) -> Option<&'static str>;

    /// The key of the first dither that has no period.
    fn noise(&self) -> Option<String>;

    /// Gives the document the velocities, loads and amplitudes of a time.
    ///
    /// # Errors
    /// What cannot be taken at one moment.
    fn freeze(&self, document: &mut Table, time: f64) -> Result<(), Complaints>;
}
