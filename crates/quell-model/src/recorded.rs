//! What a recorded time series shows.

/// What a record shows of the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordedQuantity {
    /// x.
    Displacement,
    /// ẋ.
    Velocity,
    /// ẍ.
    Acceleration,
}

impl RecordedQuantity {
    /// Name in data files and JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Displacement => "displacement",
            Self::Velocity => "velocity",
            Self::Acceleration => "acceleration",
        }
    }
}
