//! Sketches of the mechanism that a study describes: its masses, springs, contacts and dithers, with a key of their values.

mod actuator;
mod belt;
mod contact_state;
mod disc;
mod disc_load;
mod symbols;
mod system;

use super::PictureWidth;
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::output::Output;
use crate::plot::Sketch;
use crate::study::{Kind, Study, SystemStudy};

/// Width of a sketch where none is requested (mm).
pub const DEFAULT_WIDTH_MM: f64 = 120.0;
/// The narrowest and the widest sketch (mm).
pub const WIDTHS_MM: (f64, f64) = (80.0, 400.0);

/// A width with its unit in mm: mm, cm, in or pt (1/72 in).
///
/// # Errors
/// A complaint without a unit, or outside [`WIDTHS_MM`].
pub fn width(text: &str) -> Result<f64, Box<Complaint>> {
    PictureWidth::parse_between(text, "--width", WIDTHS_MM).map(PictureWidth::millimetres)
}

/// The sketch of a study on a sheet of this width (mm).
///
/// # Errors
/// A width outside [`WIDTHS_MM`].
pub fn sketch(study: &Study, width_mm: f64) -> Result<Sketch, Failure> {
    let (least, most) = WIDTHS_MM;
    if !(least..=most).contains(&width_mm) {
        let allowed = format!("a width from {least} to {most} mm");
        let origin = Origin::Argument("--width");
        return Err(Complaint::new(Fault::Value, "--width", origin, width_mm, allowed).into());
    }
    let mut sheet = Sketch::new(width_mm);
    sheet.title = study.picture_title().unwrap_or_else(|| "Sketch of the study".to_owned());
    let mut sheet = match study.kind() {
        Kind::Belt(setup) => belt::draw(sheet, &study.narrowed(setup.as_ref())),
        Kind::Disc(setup) => disc::draw(sheet, &study.narrowed(setup.as_ref())),
        Kind::System(setup) => system::draw(sheet, &study.narrowed(setup.as_ref())),
    };
    let names = sheet.parts.iter().map(|part| part.name.as_str());
    sheet.description = names.filter(|name| !name.is_empty()).collect::<Vec<_>>().join("; ");
    Ok(sheet)
}

/// The contacts and dithers of a system with their values, as in the key of its sketch.
pub(super) fn contacts_and_dithers(study: &SystemStudy) -> Vec<String> {
    let key = system::draw(Sketch::new(DEFAULT_WIDTH_MM), study).key;
    let rows = key
        .into_iter()
        .filter(|row| ["Contact", "Dither"].iter().any(|word| row.head.starts_with(word)));
    rows.map(|row| format!("{}: {}", row.head, row.items.join(", "))).collect()
}

/// Writes a sketch in the format of the output's extension.
///
/// # Errors
/// [`Failure::Failed`] if the sketch cannot be drawn or written.
pub fn write(sketch: &Sketch, output: Output) -> Result<String, Failure> {
    let bytes = match output.extension().as_str() {
        "png" => sketch.to_png().map_err(super::undrawable)?,
        "pdf" => sketch.to_pdf().map_err(super::undrawable)?,
        _ => sketch.to_svg().into_bytes(),
    };
    output.write(&bytes).map(|path| path.display().to_string())
}
