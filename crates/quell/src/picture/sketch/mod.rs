//! Sketches of the mechanism that a study describes: its masses, springs, contacts and dithers, with a key of their values.

mod actuator;
mod belt;
mod contact_state;
mod disc;
mod disc_load;
mod symbols;
mod system;

use quell_numerics::interval::RealInterval;
use serde_json::{Value as Json, json};

use super::PictureWidth;
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::output::Output;
use crate::plot::Sketch;
use crate::study::{Kind, Study, SystemStudy};

/// Width of a sketch where none is requested (mm).
pub const DEFAULT_WIDTH_MM: f64 = 120.0;
/// The narrowest and the widest sketch (mm).
pub const WIDTHS_MM: RealInterval = RealInterval::new(80.0, 400.0);

/// A width with its unit in mm: mm, cm, in or pt (1/72 in).
///
/// # Errors
/// A complaint without a unit, or outside [`WIDTHS_MM`].
pub fn width(text: &str) -> Result<f64, Box<Complaint>> {
    PictureWidth::parse_between(text, "--width", WIDTHS_MM).map(PictureWidth::millimetres)
}

/// The sketch of a study of any kind on a sheet of this width (mm) [default: [`DEFAULT_WIDTH_MM`]].
///
/// # Errors
/// A width outside [`WIDTHS_MM`].
///
/// ```
/// use quell::Study;
/// use quell::picture::sketch::sketch;
///
/// let text = "[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = 0.05\n\
///     [friction]\nlaw = \"coulomb\"\ncoefficient = 0.4\n";
/// let study = Study::parse(text, &[])?;
/// assert!(sketch(&study, Some(85.0))?.to_svg().contains("moving belt"));
/// # Ok::<(), quell::Failure>(())
/// ```
pub fn sketch(study: &Study, width_mm: Option<f64>) -> Result<Sketch, Failure> {
    let RealInterval { lower: least, upper: most } = WIDTHS_MM;
    let width_mm = width_mm.unwrap_or(DEFAULT_WIDTH_MM);
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

/// A sketch as JSON: the size of the sheet, the parts with their labels, and the key.
pub fn json(sketch: &Sketch) -> Json {
    let parts = sketch.parts.iter().filter(|part| !part.name.is_empty()).map(|part| {
        let labels: Vec<&str> = part.labels.iter().map(|label| label.text.as_str()).collect();
        json!({ "kind": part.class, "name": part.name, "labels": labels })
    });
    let key = sketch.key.iter().map(|entry| json!({ "head": entry.head, "items": entry.items }));
    json!({
        "ok": true,
        "title": sketch.title,
        "width_mm": sketch.width_mm,
        "height_mm": sketch.height_mm(),
        "text_size_pt": sketch.text_size(),
        "parts": parts.collect::<Vec<_>>(),
        "key": key.collect::<Vec<_>>(),
    })
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
