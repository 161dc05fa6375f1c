//! Files of a product: figure as SVG, PDF and PNG, data as CSV, claims as Markdown, JSON and CSV.

use std::fs;
use std::path::{Path, PathBuf};

use super::claims;
use super::product::Product;
use quell::complaint::{Complaint, Failure, Fault, Origin};
use quell::input::Inputs;
use quell::output::Output;
use quell::picture::PicturePage;

const OPTION: &str = "--out";

/// Creates the directory and checks that it can be written.
pub(super) fn prepare(directory: &Path) -> Result<(), Failure> {
    let reject = |why: String| {
        let given = directory.display().to_string();
        Failure::from(Complaint::new(Fault::Path, OPTION, Origin::Argument(OPTION), given, why))
    };
    fs::create_dir_all(directory).map_err(|error| reject(format!("cannot be created: {error}")))?;
    Output::prepare_plain(&directory.join("claims.csv"), OPTION, &["csv"], &Inputs::NONE)
        .map(drop)
        .map_err(|complaint| reject(complaint.allowed.into()))
}

/// Writes one file, completely or not at all.
pub(super) fn file(directory: &Path, name: &str, bytes: &[u8]) -> Result<PathBuf, Failure> {
    let extension = name.rsplit('.').next().unwrap_or_default();
    let output = Output::prepare_plain(&directory.join(name), OPTION, &[extension], &Inputs::NONE)?;
    output.write(bytes)
}

/// Writes a product; each of its files is written completely or not at all.
pub(super) fn product(
    product: &Product,
    stem: &str,
    directory: &Path,
    page: PicturePage,
) -> Result<Vec<PathBuf>, Failure> {
    let mut files = Vec::new();
    let mut put = |name: String, bytes: &[u8]| -> Result<(), Failure> {
        files.push(file(directory, &name, bytes)?);
        Ok(())
    };
    if let Some(figure) = &product.figure {
        let failed = |error| super::failure::failed(stem, &error);
        let figure = page.laid_out(figure.clone());
        put(format!("{stem}.svg"), figure.to_svg().as_bytes())?;
        put(format!("{stem}.pdf"), &figure.to_pdf().map_err(failed)?)?;
        put(format!("{stem}.png"), &figure.to_png().map_err(failed)?)?;
    }
    for table in &product.tables {
        let name = if table.part.is_empty() {
            format!("{stem}.csv")
        } else {
            format!("{stem}_{}.csv", table.part)
        };
        put(name, product.csv(table).as_bytes())?;
    }
    if !product.claims.is_empty() {
        put(format!("{stem}.md"), claims::markdown(&product.claims).as_bytes())?;
        let object = serde_json::json!({ "claims": claims::json(&product.claims) });
        put(format!("{stem}.json"), format!("{object:#}\n").as_bytes())?;
    }
    Ok(files)
}
