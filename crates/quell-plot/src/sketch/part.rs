//! Parts of a sketch, their labels, and rows of its key.

use super::shape::{SketchInk, SketchShape};

/// The side of a part on which a label is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LabelSide {
    /// Centred above.
    Above,
    /// Centred below.
    Below,
    /// To the left.
    Left,
    /// To the right.
    Right,
    /// At the centre of the part, over it.
    Inside,
}

/// A text next to a part: plain text with `$…$` for symbols.
#[derive(Debug, Clone, PartialEq)]
pub struct SketchLabel {
    /// The text.
    pub text: String,
    /// Sides in order of preference; the first without a collision is used.
    pub sides: Vec<LabelSide>,
}

/// One part of a mechanism: shapes drawn together, with a name and labels.
#[derive(Debug, Clone, PartialEq)]
pub struct SketchPart {
    /// What it is, such as `spring`: the class of its group in the SVG.
    pub class: &'static str,
    /// Its name in words: the title of its group in the SVG.
    pub name: String,
    /// Ink of all its shapes.
    pub ink: SketchInk,
    /// The shapes, at least one; labels are placed next to the first.
    pub shapes: Vec<SketchShape>,
    /// The labels.
    pub labels: Vec<SketchLabel>,
}

impl SketchPart {
    /// A part of one shape without a label.
    #[must_use]
    pub fn new(class: &'static str, name: impl Into<String>, shape: SketchShape) -> Self {
        let ink = SketchInk::Structure;
        Self { class, name: name.into(), ink, shapes: vec![shape], labels: Vec::new() }
    }

    /// Adds a shape.
    #[must_use]
    pub fn and(mut self, shape: SketchShape) -> Self {
        self.shapes.push(shape);
        self
    }

    /// Sets the ink.
    #[must_use]
    pub fn ink(self, ink: SketchInk) -> Self {
        Self { ink, ..self }
    }

    /// Adds a label at the first of these sides that is free.
    #[must_use]
    pub fn label(mut self, text: impl Into<String>, sides: &[LabelSide]) -> Self {
        self.labels.push(SketchLabel { text: text.into(), sides: sides.to_vec() });
        self
    }
}

/// A row of the key: a heading, and symbols with their values.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SketchKey {
    /// The heading, such as the name of a component.
    pub head: String,
    /// Items such as `$k_1$ = 4 N/m`; a line is broken between items only, where possible.
    pub items: Vec<String>,
}

impl SketchKey {
    /// A row of these items.
    #[must_use]
    pub fn new<I: Into<String>>(
        head: impl Into<String>,
        items: impl IntoIterator<Item = I>,
    ) -> Self {
        Self { head: head.into(), items: items.into_iter().map(Into::into).collect() }
    }
}
