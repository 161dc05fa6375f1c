//! Why a run has not settled.

/// Why a run has not settled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Unsettled {
    /// It still moved when its periods were over.
    Moving,
    /// It dwells in slip where areas grow: near an unstable curve between two basins.
    Dwelling,
}

impl Unsettled {
    /// A description.
    pub fn about(self) -> &'static str {
        match self {
            Self::Moving => "it still moved when its periods were over",
            Self::Dwelling => "it dwells near an unstable curve between two basins",
        }
    }
}
