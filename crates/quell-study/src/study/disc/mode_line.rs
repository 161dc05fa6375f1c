//! A mode as a study or a file lists it.

/// One mode of a list, with its frequency as given.
#[derive(Clone, Copy, Debug)]
pub(super) struct ModeLine {
    pub(super) diameters: f64,
    pub(super) ratio: Option<f64>,
    pub(super) hertz: Option<f64>,
    pub(super) shape_at_load: f64,
    pub(super) damping: Option<f64>,
    pub(super) centrifugal: Option<f64>,
}
