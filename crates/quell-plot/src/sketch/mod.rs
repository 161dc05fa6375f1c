//! Mechanical drawings: masses, springs, dampers, supports, moving surfaces, discs, arrows and the symbols next to them.
//!
//! A [`Sketch`] is data like a figure: parts with their shapes in pixels of 1/96 inch, labels that find a free position next
//! to their parts, and a key that gives the meaning and value of each symbol below the drawing. It knows no physics: the caller
//! decides what is drawn where.
//!
//! ```
//! use quell_plot::{PlotPoint, LabelSide, Sketch, SketchKey, SketchPart, SketchShape};
//!
//! let spring = SketchShape::Spring { from: PlotPoint::new(20.0, 40.0), to: PlotPoint::new(80.0, 40.0) };
//! let sketch = Sketch::new(85.0)
//!     .with(SketchPart::new("spring", "spring of the wall", spring).label("$k$", &[LabelSide::Above]))
//!     .with_key(SketchKey::new("spring", ["$k$ = 4 N/m"]));
//! assert!(sketch.to_svg().contains("<title>spring of the wall</title>"));
//! assert!(sketch.collisions().is_empty());
//! ```

mod draw;
mod labels;
mod outline;
mod part;
mod render;
mod shape;
mod sheet;

pub use outline::WaveGlyph;
pub use part::{LabelSide, SketchKey, SketchLabel, SketchPart};
pub use shape::{SketchInk, SketchShape};
pub use sheet::Sketch;
