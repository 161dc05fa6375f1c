//! One surface of one law and waveform at its nodes.

use quell_model::Waveform;
use quell_numerics::interval::RealInterval;

use super::AtlasLaw;
use super::grid::{AtlasAxis, grid_nodes, reduced};
use super::node::{NoAtlasNode, grazing_factor, neutral_damping};
use super::point::AtlasPoint;

/// What a table contains.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum AtlasSurface {
    /// The grazing amplitude over that of the structure without friction.
    Grazing,
    /// The neutral damping κ_n.
    NeutralDamping,
}

/// Largest 1/R of the tables. They reach beyond the range of answers, at whose ends interpolation is better for it.
const LARGEST_INVERSE_RATIO: f64 = 1.0 / 3.0;

/// Largest ζ_f/R of the tables.
const LARGEST_DAMPING_PER_CYCLE: f64 = 0.3;

impl AtlasSurface {
    /// Both surfaces.
    pub const ALL: [Self; 2] = [Self::Grazing, Self::NeutralDamping];

    /// Name in the file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Grazing => "grazing",
            Self::NeutralDamping => "neutral-damping",
        }
    }

    /// The surface of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|surface| surface.name() == name)
    }

    /// The axes for a law. The numbers of nodes balance the errors of the axes.
    pub fn axes(self, law: AtlasLaw) -> Vec<AtlasAxis> {
        let up_to = |upper: f64| RealInterval::new(0.0, upper);
        let velocity =
            |count| AtlasAxis::new("relative_velocity", up_to(law.largest_velocity()), count);
        let inverse = AtlasAxis::new("inverse_frequency_ratio", up_to(LARGEST_INVERSE_RATIO), 6);
        let damping =
            AtlasAxis::new("friction_damping_per_cycle", up_to(LARGEST_DAMPING_PER_CYCLE), 8);
        match self {
            Self::Grazing => {
                let relative = AtlasAxis::new("relative_damping", up_to(1.0), 4);
                vec![relative, velocity(12), inverse, damping]
            }
            Self::NeutralDamping => {
                let share = AtlasAxis::new("grazing_share", up_to(1.0), 12);
                vec![velocity(14), inverse, damping, share]
            }
        }
    }
}

/// One surface of one law and waveform.
#[derive(Clone, Debug, PartialEq)]
pub struct AtlasTable {
    /// The law.
    pub law: AtlasLaw,
    /// The waveform.
    pub waveform: Waveform,
    /// The surface.
    pub surface: AtlasSurface,
    /// The values at [`AtlasTable::nodes`].
    pub values: Vec<f64>,
}

impl AtlasTable {
    /// The nodes of a surface, the last axis fastest.
    pub fn nodes(law: AtlasLaw, surface: AtlasSurface) -> Vec<Vec<f64>> {
        grid_nodes(&surface.axes(law))
    }

    /// The exact value of a surface at a place on its axes.
    ///
    /// # Errors
    /// [`NoAtlasNode`].
    pub fn compute(
        law: AtlasLaw,
        waveform: &Waveform,
        surface: AtlasSurface,
        place: &[f64],
    ) -> Result<f64, NoAtlasNode> {
        let point = |relative_damping: f64, velocity: f64, inverse: f64, damping: f64| AtlasPoint {
            law,
            waveform: waveform.clone(),
            relative_damping,
            relative_velocity: velocity,
            frequency_ratio: 1.0 / inverse,
            friction_damping: damping / inverse,
        };
        match (surface, place) {
            (AtlasSurface::Grazing, [relative, velocity, inverse, damping]) => {
                grazing_factor(&point(*relative, *velocity, *inverse, *damping))
            }
            (AtlasSurface::NeutralDamping, [velocity, inverse, damping, share]) => {
                neutral_damping(&point(0.0, *velocity, *inverse, *damping), *share)
            }
            _ => Err(NoAtlasNode::NoBelt),
        }
    }

    /// The interpolated value at a place on the axes.
    pub fn at(&self, place: &[f64]) -> f64 {
        self.along_last(place).first().copied().unwrap_or(0.0)
    }

    /// The values at the nodes of the last axes, interpolated at a place in the first ones.
    pub fn along_last(&self, place: &[f64]) -> Vec<f64> {
        reduced(&self.surface.axes(self.law), &self.values, place)
    }
}
