//! The contributions to the equations of a disc, each of which can be switched off.

/// One part of the equations of motion M y″ + C y′ + K y = 0, y the coordinates A, B of every mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Contribution {
    /// Inertia and elasticity of the plate: y″ + β²y.
    Plate,
    /// The waves in the frame of the loads: −2qΩB′, +2qΩA′ and −q²Ω², and where the speed varies −qΩ′B and +qΩ′A.
    Gyroscopic,
    /// Damping by the velocity in the frame of the loads, 2ξβA′, 2ξβB′.
    DiscDamping,
    /// The rest of the damping, because the damping rotates with the disc: −2ξβqΩB, +2ξβqΩA. Without it the medium
    /// would rotate with the loads, and the free disc would be unstable beyond Ω = β/q.
    CirculatoryDamping,
    /// Mass of the loads.
    LoadMass,
    /// Dampers of the loads.
    Damper,
    /// Springs of the loads.
    Spring,
    /// Mean follower force of friction.
    FollowerForce,
    /// The periodic part of the follower force, due to dither.
    Dither,
    /// Centrifugal stress of a disc that rotates: κΩ².
    Centrifugal,
}

impl Contribution {
    /// All of them, in the order in which they are summed.
    pub const ALL: &'static [Self] = &[
        Self::Plate,
        Self::Gyroscopic,
        Self::DiscDamping,
        Self::CirculatoryDamping,
        Self::LoadMass,
        Self::Damper,
        Self::Spring,
        Self::FollowerForce,
        Self::Dither,
        Self::Centrifugal,
    ];

    /// Name in outputs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Plate => "plate",
            Self::Gyroscopic => "gyroscopic",
            Self::DiscDamping => "disc-damping",
            Self::CirculatoryDamping => "circulatory-damping",
            Self::LoadMass => "load-mass",
            Self::Damper => "damper",
            Self::Spring => "spring",
            Self::FollowerForce => "follower-force",
            Self::Dither => "dither",
            Self::Centrifugal => "centrifugal",
        }
    }

    /// The contribution of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|contribution| contribution.name() == name)
    }
}

/// A set of contributions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Contributions(u16);

impl Contributions {
    /// All contributions: the complete disc.
    pub const ALL: Self = Self((1 << 10) - 1);

    /// Whether a contribution is switched on.
    pub fn contains(self, contribution: Contribution) -> bool {
        self.0 & (1 << contribution as u16) != 0
    }

    /// The same set without one. The plate itself may also be switched off, which leaves free masses.
    #[must_use]
    pub fn without(self, contribution: Contribution) -> Self {
        Self(self.0 & !(1 << contribution as u16))
    }

    /// The same set with one more.
    #[must_use]
    pub fn with(self, contribution: Contribution) -> Self {
        Self(self.0 | 1 << contribution as u16)
    }
}
