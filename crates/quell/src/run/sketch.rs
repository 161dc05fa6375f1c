//! `sketch`: the mechanism that a study describes, as a drawing.

use serde_json::{Value as Json, json};

use crate::complaint::Failure;
use crate::picture::sketch;
use crate::plot::Sketch;
use crate::study::Study;

/// A sketch with its study's title and its size.
#[derive(Clone, Debug, PartialEq)]
pub struct Sketched {
    /// The drawing.
    pub sketch: Sketch,
}

/// Draws a study of any kind on a sheet of this width (mm) [default: [`sketch::DEFAULT_WIDTH_MM`]].
///
/// # Errors
/// A width outside [`sketch::WIDTHS_MM`].
///
/// ```
/// use quell::Study;
/// use quell::run::sketch;
///
/// let text = "[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = 0.05\n\
///     [friction]\nlaw = \"coulomb\"\ncoefficient = 0.4\n";
/// let study = Study::parse(text, &[])?;
/// let drawn = sketch::run(&study, Some(85.0))?;
/// assert!(drawn.sketch.to_svg().contains("moving belt"));
/// # Ok::<(), quell::Failure>(())
/// ```
pub fn run(study: &Study, width_mm: Option<f64>) -> Result<Sketched, Failure> {
    let sketch = sketch::sketch(study, width_mm.unwrap_or(sketch::DEFAULT_WIDTH_MM))?;
    Ok(Sketched { sketch })
}

impl Sketched {
    /// As JSON: the size of the sheet, the parts with their labels, and the key.
    pub fn json(&self) -> Json {
        let Sketch { title, width_mm, parts, key, .. } = &self.sketch;
        let parts = parts.iter().filter(|part| !part.name.is_empty()).map(|part| {
            let labels: Vec<&str> = part.labels.iter().map(|label| label.text.as_str()).collect();
            json!({ "kind": part.class, "name": part.name, "labels": labels })
        });
        let key = key.iter().map(|entry| json!({ "head": entry.head, "items": entry.items }));
        json!({
            "ok": true,
            "title": title,
            "width_mm": width_mm,
            "height_mm": self.sketch.height_mm(),
            "text_size_pt": self.sketch.text_size(),
            "parts": parts.collect::<Vec<_>>(),
            "key": key.collect::<Vec<_>>(),
        })
    }
}
