//! A belt as a point of the atlas, and back.

use quell_linear::linear_cost::linear_cost;
use quell_model::parameter::{
    BELT_VELOCITY, DAMPING_RATIO, STATIC_COEFFICIENT, TANGENTIAL_STIFFNESS,
};
use quell_model::{Belt, Direction, Dither, InvalidValues, Waveform};
use quell_numerics::interval::RealInterval;

use super::WAVEFORMS;
use super::law::{AtlasLaw, viscous};

/// Ranges of the groups in which answers are given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtlasRange {
    /// κ.
    pub relative_damping: RealInterval,
    /// v₀/v_m over the largest of the law.
    pub velocity_share: RealInterval,
    /// R.
    pub frequency_ratio: RealInterval,
    /// ζ_f/R; 0 itself is excluded, as friction that does not fall drives no vibration.
    pub damping_per_cycle: RealInterval,
}

/// The range of the atlas. Beyond κ = 1 steady sliding is stable at every amplitude. Below R = 5 and under strong friction a flip
/// beyond the grazing can end the loud range, and above ζ_f/R = 0.2 the interpolation loses digits.
pub const RANGE: AtlasRange = AtlasRange {
    relative_damping: RealInterval::new(0.0, 1.0),
    velocity_share: RealInterval::new(0.02, 1.0),
    frequency_ratio: RealInterval::new(5.0, 200.0),
    damping_per_cycle: RealInterval::new(0.0, 0.2),
};

/// Rounding that a study in SI may add to a group at the end of a range, relative.
const ROUNDING: f64 = 1e-12;

/// A belt in dimensionless groups.
#[derive(Clone, Debug, PartialEq)]
pub struct AtlasPoint {
    /// The shape of the law.
    pub law: AtlasLaw,
    /// The waveform of the dither.
    pub waveform: Waveform,
    /// κ = ζ/ζ_f; a viscous part of the law counts as damping.
    pub relative_damping: f64,
    /// v₀/v_m.
    pub relative_velocity: f64,
    /// R.
    pub frequency_ratio: f64,
    /// ζ_f = F max|μ′|/2.
    pub friction_damping: f64,
}

/// Why a belt is not in the atlas.
#[derive(Clone, Debug, PartialEq)]
pub struct OutsideAtlas {
    /// The key of a study that places it outside.
    pub key: String,
    /// The value, if it is a number.
    pub value: Option<f64>,
    /// The value, if it is a word.
    pub word: Option<&'static str>,
    /// The least and the largest value that are allowed, in the numbers of the equations, if those of a number are.
    pub range: Option<RealInterval>,
    /// What is allowed, or why there is no more than the range.
    pub allowed: String,
}

impl OutsideAtlas {
    fn new(key: impl Into<String>, allowed: impl Into<String>) -> Self {
        Self { key: key.into(), value: None, word: None, range: None, allowed: allowed.into() }
    }

    fn of_number(
        key: impl Into<String>,
        value: f64,
        range: RealInterval,
        allowed: impl Into<String>,
    ) -> Self {
        Self { value: Some(value), range: Some(range), ..Self::new(key, allowed) }
    }
}

impl std::fmt::Display for OutsideAtlas {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { key, range, allowed, .. } = self;
        match range {
            Some(RealInterval { lower, upper }) => {
                write!(f, "{key} must be from {lower} to {upper}: {allowed}")
            }
            None => write!(f, "{key} must be {allowed}"),
        }
    }
}

impl std::error::Error for OutsideAtlas {}

impl AtlasPoint {
    /// ζ_f/R, the damping of friction per cycle of the dither.
    pub fn damping_per_cycle(&self) -> f64 {
        self.friction_damping / self.frequency_ratio
    }

    /// ζ with the viscous part of the law.
    pub fn damping_ratio(&self) -> f64 {
        self.relative_damping * self.friction_damping
    }

    /// The point of a belt; the amplitude of its dither is ignored.
    ///
    /// # Errors
    /// Every key that places the belt outside.
    pub fn of(belt: &Belt) -> Result<Self, Vec<OutsideAtlas>> {
        let mut outside = Vec::new();
        let friction = belt.friction();
        let law = AtlasLaw::of(friction).map_err(|(key, allowed)| {
            let value = friction.get(key);
            let word = value.is_none().then(|| friction.kind().name());
            outside.push(OutsideAtlas { value, word, ..OutsideAtlas::new(key, allowed) });
        });
        if belt.tangential_stiffness().is_some() {
            let allowed = "left out: the contact of the atlas is rigid";
            outside.push(OutsideAtlas::new(TANGENTIAL_STIFFNESS.path, allowed));
        }
        outside.extend(unsteady(belt));
        let dither = the_dither(belt).map_err(|why| outside.push(why));
        let (Ok(law), Ok(dither)) = (law, dither) else { return Err(outside) };
        let friction_damping = 0.5 * belt.normal_load() * law.steepest_slope(friction);
        if friction_damping <= 0.0 {
            let allowed =
                "above the other coefficient: friction that does not fall drives no vibration";
            let value = Some(friction.static_coefficient());
            let key = STATIC_COEFFICIENT.path;
            outside.push(OutsideAtlas { value, ..OutsideAtlas::new(key, allowed) });
            return Err(outside);
        }
        let damping = belt.damping_ratio() + 0.5 * belt.normal_load() * viscous(friction);
        let point = Self {
            law,
            waveform: dither.waveform.clone(),
            relative_damping: damping / friction_damping,
            relative_velocity: belt.belt_velocity() / friction.velocity_scale(),
            frequency_ratio: dither.frequency_ratio,
            friction_damping,
        };
        outside.extend(point.out_of_range(belt));
        if outside.is_empty() { Ok(point) } else { Err(outside) }
    }

    /// The groups that are out of range, as keys of a study with the values that are allowed.
    fn out_of_range(&self, belt: &Belt) -> Vec<OutsideAtlas> {
        let AtlasRange { relative_damping, velocity_share, frequency_ratio, damping_per_cycle } =
            RANGE;
        let v_m = belt.friction().velocity_scale();
        let mut outside = Vec::new();
        if !within(self.relative_damping, relative_damping) {
            let viscous = self.damping_ratio() - belt.damping_ratio();
            let most = (relative_damping.upper * self.friction_damping - viscous).max(0.0);
            let allowed = "at the largest, κ = ζ/ζ_f = 1, and beyond it steady sliding is stable under every tangential dither";
            let (key, value) = (DAMPING_RATIO.path, belt.damping_ratio());
            let range = RealInterval::new(0.0, most);
            outside.push(OutsideAtlas::of_number(key, value, range, allowed));
        }
        let largest = self.law.largest_velocity();
        let velocities =
            RealInterval::new(velocity_share.lower * largest, velocity_share.upper * largest);
        if !within(self.relative_velocity, velocities) {
            let RealInterval { lower: low, upper: high } = velocities;
            let allowed = format!("v₀/v_m from {low} to {high} for this law");
            let (key, value) = (BELT_VELOCITY.path, belt.belt_velocity());
            let range = RealInterval::new(low * v_m, high * v_m);
            outside.push(OutsideAtlas::of_number(key, value, range, allowed));
        }
        let path = belt.dither_path(0, "frequency_ratio");
        let value = self.frequency_ratio;
        let least = self.friction_damping / damping_per_cycle.upper;
        if !within(value, frequency_ratio) {
            let RealInterval { lower: low, upper: high } = frequency_ratio;
            let range = RealInterval::new(low.max(least), high);
            let allowed = format!("R from {low} to {high}");
            outside.push(OutsideAtlas::of_number(path, value, range, allowed));
        } else if !within(self.damping_per_cycle(), damping_per_cycle) {
            let allowed = format!(
                "ζ_f/R, the damping of friction per cycle of the dither, is at most {} in the atlas",
                damping_per_cycle.upper
            );
            let range = RealInterval::new(least, frequency_ratio.upper);
            outside.push(OutsideAtlas::of_number(path, value, range, allowed));
        }
        outside
    }

    /// A belt of this point with v_m = 1 and the amplitude D, whose law falls by `fall`, which decides nothing.
    ///
    /// # Errors
    /// Values that make no belt.
    pub fn belt_with_fall(&self, amplitude: f64, fall: f64) -> Result<Belt, InvalidValues> {
        let law = self.law.build(0.5 * fall, fall)?;
        let load = 2.0 * self.friction_damping / self.law.steepest_slope(&law);
        let dither = Dither { amplitude, ..self.unit_dither() };
        Belt::new(self.damping_ratio(), load, self.relative_velocity, law, vec![dither])
    }

    /// [`AtlasPoint::belt_with_fall`] with a steep law, so that the load, the scale of tolerances, is not large against v_m.
    ///
    /// # Errors
    /// Values that make no belt.
    pub fn belt(&self, amplitude: f64) -> Result<Belt, InvalidValues> {
        self.belt_with_fall(amplitude, 4.0)
    }

    fn unit_dither(&self) -> Dither {
        Dither {
            direction: Direction::Tangential,
            waveform: self.waveform.clone(),
            amplitude: 1.0,
            frequency_ratio: self.frequency_ratio,
            phase: 0.0,
            envelope: None,
        }
    }

    /// The amplitude D/v_m at which the structure without friction, of damping κζ_f, is as fast as the belt.
    pub fn corner(&self) -> Option<f64> {
        let response = linear_cost(&self.unit_dither(), self.damping_ratio()).ok()?;
        Some(self.relative_velocity / response.velocity).filter(|corner| corner.is_finite())
    }
}

fn within(value: f64, range: RealInterval) -> bool {
    value >= range.lower * (1.0 - ROUNDING) && value <= range.upper * (1.0 + ROUNDING)
}

/// What varies in time.
fn unsteady(belt: &Belt) -> Option<OutsideAtlas> {
    let (key, allowed) = match (belt.drive(), belt.load()) {
        (Some(_), _) => ("belt.drive", "left out: the belt of the atlas has a constant velocity"),
        (None, Some(_)) => ("belt.load", "left out: the load of the atlas is constant"),
        (None, None) => return None,
    };
    Some(OutsideAtlas::new(key, allowed))
}

/// The one dither of a belt, if it is of a kind in the atlas.
fn the_dither(belt: &Belt) -> Result<&Dither, OutsideAtlas> {
    let [dither] = belt.dithers() else {
        let allowed = "one dither: the atlas is about a single one";
        let value = Some(belt.dithers().len() as f64);
        return Err(OutsideAtlas { value, ..OutsideAtlas::new("dither", allowed) });
    };
    let refused = |key: &str, word: Option<&'static str>, allowed: &str| {
        Err(OutsideAtlas { word, ..OutsideAtlas::new(belt.dither_path(0, key), allowed) })
    };
    if dither.direction != Direction::Tangential {
        return refused("direction", Some(dither.direction.name()), "tangential");
    }
    if !WAVEFORMS.contains(&dither.waveform) {
        let names: Vec<&str> = WAVEFORMS.iter().map(Waveform::name).collect();
        let allowed = format!("one of {}", names.join(", "));
        return refused("waveform", Some(dither.waveform.name()), &allowed);
    }
    if dither.envelope.is_some() {
        let allowed = "left out: the dither of the atlas has a constant amplitude";
        return refused("envelope", None, allowed);
    }
    Ok(dither)
}
