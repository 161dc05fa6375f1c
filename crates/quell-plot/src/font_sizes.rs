//! Font sizes of the texts of a figure.

/// Font sizes of one figure (pixels).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct FontSizes {
    pub(super) figure_title: u32,
    pub(super) title: u32,
    pub(super) label: u32,
    pub(super) number: u32,
    pub(super) legend: u32,
    pub(super) note: u32,
    pub(super) caption: u32,
}

impl FontSizes {
    /// Sizes that suit a frame of this width.
    pub(super) fn for_frame(width: f64) -> Self {
        if width >= 260.0 {
            Self {
                figure_title: 14,
                title: 12,
                label: 12,
                number: 11,
                legend: 11,
                note: 11,
                caption: 10,
            }
        } else {
            Self {
                figure_title: 13,
                title: 11,
                label: 11,
                number: 10,
                legend: 10,
                note: 10,
                caption: 10,
            }
        }
    }
}
