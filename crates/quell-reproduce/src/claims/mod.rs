//! The table of claims: the statements of the dissertation, independent numerical measurements, and the verdicts.
//!
//! The functions of the modules listed in `SECTIONS` measure the claims. The verdict follows only from printed and measured values
//! by the rules of [`ClaimVerdict`]. The verdicts on record are in [`LEDGER`]; a test compares every claim with it, so that no
//! verdict changes unnoticed. `statements` groups the claims by the statements that they measure.

use quell::parallel::Parallel;
use serde_json::{Value as Json, json};

use super::product::{Cell, DataTable, Product};
use super::shared::SharedMeasurements;
use super::source::EntrySource;
use quell::complaint::Failure;

mod attractors;
mod bands;
mod chapter2;
mod chapter3;
mod chapter3_formulas;
mod chapter4;
mod chapter5;
mod isocline;
mod ledger;
mod qualitative;
mod record;
mod revived;
mod sheet;
mod statements;
mod thresholds;

pub use super::claim::{Claim, ClaimVerdict, Expected};
pub use ledger::LEDGER;
pub use statements::{SEVERAL, StatementVerdict, count, slips, statement_of, statements, summary};

use sheet::ClaimSheet;

/// Measures a few claims and records them.
type ClaimMeasurement = fn(&mut ClaimSheet) -> Result<(), Failure>;

/// All measurements, in the order of the dissertation.
const SECTIONS: &[ClaimMeasurement] = &[
    chapter2::friction_laws,
    chapter2::responses,
    chapter2::forced_response,
    qualitative::transients,
    qualitative::equilibrium,
    chapter2::stribeck_map,
    chapter2::decreasing_map,
    qualitative::upper_edge,
    chapter2::destabilisation,
    thresholds::tangential,
    qualitative::bursts,
    chapter3::waveforms,
    qualitative::mean_squares,
    qualitative::negative_slope,
    chapter3_formulas::formulas,
    chapter3::everywhere_stable,
    chapter3::thresholds,
    chapter3::destabilising_ranges,
    chapter3::responses,
    isocline::tangential,
    isocline::trends,
    isocline::straight,
    chapter4::responses,
    chapter4::effective_friction,
    qualitative::change_of_slope,
    chapter4::stability_maps,
    qualitative::lower_edge,
    isocline::normal,
    |sheet| attractors::tangential(sheet, "2.10"),
    |sheet| attractors::tangential(sheet, "2.11"),
    |sheet| attractors::tangential(sheet, "3.12"),
    |sheet| attractors::tangential(sheet, "3.13"),
    attractors::square,
    attractors::sine,
    attractors::other_starts,
    chapter4::formulas,
    chapter5::tables,
    bands::friction_alone,
    chapter5::thresholds,
    bands::more_bands,
    bands::newtons,
    bands::suppression,
    chapter5::normal,
    bands::plate_damping,
    bands::induced,
    chapter5::tangential,
    revived::undamped,
    bands::narrow,
    chapter5::damping,
    revived::damped,
    chapter5::floquet,
    |sheet| {
        chapter5::tangential_force(sheet);
        Ok(())
    },
    bands::chosen_speed,
    qualitative::always_quenched,
];

/// Measures every claim, in parallel on all cores, sharing measurements with the figures. The claims are in the order of the dissertation.
///
/// # Errors
/// [`Failure`] if a run stops or an average has no value.
fn measure(shared: &SharedMeasurements) -> Result<Vec<Claim>, Failure> {
    let sections: Result<Vec<Vec<Claim>>, Failure> = SECTIONS
        .in_parallel(|section| {
            let mut sheet = ClaimSheet { shared: shared.clone(), ..ClaimSheet::default() };
            section(&mut sheet).map(|()| sheet.claims)
        })
        .collect();
    Ok(sections?.concat())
}

/// The table as a product.
pub(super) fn product(source: &EntrySource) -> Result<Product, Failure> {
    let claims = measure(&source.shared)?;
    let columns = ["claim", "where", "statement", "printed", "measured", "verdict", "note"]
        .map(|name| (name, "1"));
    let mut table = DataTable::new("", &columns);
    for claim in &claims {
        let verdict = claim.verdict.to_string();
        let cells = [
            &claim.name,
            &claim.place,
            &claim.statement,
            &claim.printed,
            &claim.measured,
            &verdict,
            &claim.note,
        ];
        table.row(cells.map(|text| Cell::Text(text.clone())));
    }
    let caption = "Claims of the dissertation: printed, measured, verdict.".to_owned();
    Ok(Product { caption, tables: vec![table], claims, ..Product::default() })
}

/// The table as JSON.
pub fn json(claims: &[Claim]) -> Json {
    claims
        .iter()
        .map(|claim| {
            json!({
                "claim": claim.name,
                "statement_name": claim.is_of_a_statement().then(|| statement_of(&claim.name)),
                "where": claim.place,
                "statement": claim.statement,
                "printed": claim.printed,
                "measured": claim.measured,
                "measured_values": claim.values,
                "verdict": claim.verdict.to_string(),
                "deviation": claim.verdict.deviation(),
                "tolerance": claim.tolerance,
                "expected": claim.expected.map(Expected::name),
                "as_expected": claim.as_expected(),
                "why": claim.why(),
                "note": claim.note,
            })
        })
        .collect()
}

/// The table as Markdown.
pub fn markdown(claims: &[Claim]) -> String {
    let mut text = format!(
        "# Claims of the dissertation\n\n{}\n\n\
         | where | claim | printed | measured | verdict | note |\n|---|---|---|---|---|---|\n",
        summary(&statements(claims)),
    );
    for claim in claims {
        let verdict = claim.verdict.to_string();
        let cells = [
            &claim.place,
            &claim.statement,
            &claim.printed,
            &claim.measured,
            &verdict,
            &claim.note,
        ];
        let cells = cells.map(|cell| cell.replace('|', "\\|"));
        text += "| ";
        text += &cells.join(" | ");
        text += " |\n";
    }
    text
}
