//! Settings of a continuation run: the window of the parameter and the step lengths.

/// Settings of a continuation run. Steps are in scaled coordinates, in which the window of the parameter has width 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Follow {
    /// First value of the parameter's window.
    pub from: f64,
    /// Last value.
    pub to: f64,
    /// Longest step, which is also the first one.
    pub longest: f64,
    /// Shortest step; below it the branch counts as lost.
    pub shortest: f64,
    /// Maximum number of points.
    pub most_points: u32,
    /// Whether the branch is followed only until it turns back ([`End::TurnsBack`](super::End::TurnsBack)). Thresholds at which it does
    /// not turn back are then not located; up to its end the branch is the same.
    pub only_forwards: bool,
}

impl Follow {
    /// Settings for a window covered in at least `steps` steps.
    pub fn window(from: f64, to: f64, steps: u32) -> Self {
        let longest = 1.0 / f64::from(steps.max(1));
        Self { from, to, longest, shortest: 1e-8, most_points: 4000, only_forwards: false }
    }

    /// The same for a branch that is followed only until it turns back.
    #[must_use]
    pub fn only_forwards(self) -> Self {
        Self { only_forwards: true, ..self }
    }
}
