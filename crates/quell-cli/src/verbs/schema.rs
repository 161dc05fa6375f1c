//! `quell schema`: the keys of a study file.

use clap::Args;
use quell::Failure;
use quell::complaint::Complaint;
use quell::keys::listing;
use quell::schema::schema;

use crate::answer::Answer;

/// Lists the keys of a study file, table by table
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// A table and those inside it, such as contact or belt.initial [default: all]
    #[arg(value_name = "TABLE")]
    table: Option<String>,
    /// Prints the JSON Schema of a study file on standard output and nothing else
    #[arg(long, conflicts_with = "table")]
    json: bool,
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let table = arguments.table.as_deref();
    let text = listing(table).map_err(|nearest| {
        let allowed = "a table of a study, such as belt or contact.friction";
        let complaint = Complaint::option("TABLE", table.unwrap_or_default(), allowed);
        Failure::from(complaint.suggesting(nearest))
    })?;
    Ok(Answer::new(arguments.json, &schema(), || text))
}
