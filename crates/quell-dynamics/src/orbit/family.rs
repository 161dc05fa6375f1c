//! A belt with dither as a family of period maps, as [`quell_numerics::continuation`] needs it.
//!
//! The state is (x, x′) at τ = 0. An orbit in pure slip is continued beyond a grazing of v_r = 0 on its branch of the
//! law, with its least slip velocity as the distance. Orbits that stick or reverse are integrated as they are.

use quell_model::{Belt, Dither};
use quell_numerics::continuation::{Image, PeriodMap};
use quell_numerics::cyclic::least_rotation;

use super::no_orbit::NoOrbit;
use super::period::common_period;
use super::period_map::{TOLERANCE, dense};
use super::variation::Variation;
use crate::simulation::{EventKind, Start, continue_slip, count_taken, simulate};

/// Steps of a request that the variation of one step counts for. It takes 1.2 (a dither of 4000 times the load) to 3.7 (stick and slip)
/// times the instructions of the step itself; the count is above that, because a search that is stopped early says so, and one that
/// is not stopped keeps its user waiting. No result depends on it.
const VARIATION: u64 = 16;

/// The sequence of events in a period.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Signature {
    /// Slip without reaching v_r = 0, with the sign of v_r.
    PureSlip(i8),
    /// Stick throughout.
    Stuck,
    /// These events in their cyclic order, with the sign of v_r afterwards. Of the cyclic permutations the
    /// lexicographically least one is taken, so that the order does not depend on the phase of τ = 0 in the period.
    Events(Vec<(EventKind, i8)>),
}

impl Signature {
    /// The signature of a period, from its events, the time in stick, and the sign of v_r at its end.
    pub(super) fn of(events: &[(EventKind, i8)], stuck: f64, sign: i8) -> Self {
        if events.is_empty() {
            return if stuck > 0.0 { Self::Stuck } else { Self::PureSlip(sign) };
        }
        let first = least_rotation(events, |(kind, sign)| (*kind as u8, *sign));
        Self::Events([&events[first..], &events[..first]].concat())
    }

    /// Whether v_r = 0 is never reached.
    pub fn is_pure_slip(&self) -> bool {
        matches!(self, Self::PureSlip(_))
    }

    /// A description: the number of sticks and reversals in a period.
    pub fn words(&self) -> String {
        let Self::Events(events) = self else {
            return if self.is_pure_slip() { "pure slip" } else { "stick throughout" }.to_owned();
        };
        let count = |kind| events.iter().filter(|(event, _)| *event == kind).count();
        let times = |count: usize, one: &str, many: &str| match count {
            0 => None,
            1 => Some(format!("1 {one}")),
            count => Some(format!("{count} {many}")),
        };
        let parts = [
            times(count(EventKind::Stick), "stick", "sticks"),
            times(count(EventKind::Reversal), "reversal", "reversals"),
        ];
        parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
    }
}

/// The belt at values of some of its numbers; `None` where they form none.
pub type BeltAt<'a> = &'a dyn Fn(&[f64]) -> Option<Belt>;

/// The meaning of the parameters of a family.
#[derive(Clone, Copy)]
pub(crate) enum FamilyParameters<'a> {
    /// No parameters: the belt as it is.
    Unchanged,
    /// The common factor of all amplitudes.
    CommonFactor,
    /// Numbers of the belt.
    Numbers(BeltAt<'a>),
}

/// A belt over `periods` common periods of its dithers.
#[derive(Clone, Copy)]
pub(crate) struct Forced<'a> {
    /// The belt whose numbers are not varied.
    pub(crate) belt: &'a Belt,
    pub(crate) parameters: FamilyParameters<'a>,
    pub(crate) periods: u32,
}

impl Forced<'_> {
    /// The belt at given parameters.
    pub(crate) fn belt_at(&self, parameters: &[f64]) -> Result<Belt, NoOrbit> {
        let first = parameters.first().copied();
        let invalid = || NoOrbit::Invalid { value: first.unwrap_or(f64::NAN) };
        match self.parameters {
            FamilyParameters::Unchanged => Ok(self.belt.clone()),
            FamilyParameters::CommonFactor => {
                let factor = first.unwrap_or(1.0);
                let scaled = |dither: &Dither| Dither {
                    amplitude: factor * dither.amplitude,
                    ..dither.clone()
                };
                let dithers = self.belt.dithers().iter().map(scaled).collect();
                self.belt.dithered_by(dithers).map_err(|_| invalid())
            }
            FamilyParameters::Numbers(at) => at(parameters).ok_or_else(invalid),
        }
    }

    /// The time over which states are mapped. Without dither, where only steady sliding is followed, it is 1: far from
    /// the period 2π of its oscillation, over which the multipliers would be 1.
    pub(crate) fn period_of(&self, belt: &Belt) -> Result<f64, NoOrbit> {
        match common_period(belt) {
            Ok(period) => Ok(f64::from(self.periods) * period),
            Err(NoOrbit::NoDither) if matches!(self.parameters, FamilyParameters::Numbers(_)) => {
                Ok(1.0)
            }
            Err(why) => Err(why),
        }
    }
}

impl PeriodMap for Forced<'_> {
    type Signature = Signature;
    type Error = NoOrbit;

    fn dimension(&self) -> usize {
        2
    }

    fn scale(&self) -> f64 {
        self.belt.normal_load()
    }

    fn image(
        &self,
        state: &[f64],
        parameters: &[f64],
        held: Option<&Signature>,
    ) -> Result<Image<Signature>, NoOrbit> {
        let belt = self.belt_at(parameters)?;
        let (start, until) = (Start::of_state(state), self.period_of(&belt)?);
        let mut variation = Variation::new(&belt);
        let end = if let Some(Signature::PureSlip(sign)) = held {
            continue_slip(&belt, f64::from(*sign), start, until, TOLERANCE, &mut variation)
        } else {
            simulate(&belt, start, until, TOLERANCE, &mut variation)
        }
        .map_err(NoOrbit::Stalled)?;
        count_taken(VARIATION * end.steps);
        let signature = match held {
            Some(Signature::PureSlip(sign)) => Signature::PureSlip(*sign),
            _ => Signature::of(&variation.events, variation.stuck, end.slip_sign),
        };
        let distance = match (&signature, variation.least) {
            (Signature::PureSlip(_), Some((least, _))) => least,
            _ => f64::INFINITY,
        };
        Ok(Image {
            state: vec![end.displacement, end.velocity],
            derivative: dense(&variation.matrix),
            distance,
            signature,
        })
    }

    fn smoother(&self, signature: &Signature, parameters: &[f64]) -> Vec<Signature> {
        let velocity = self.belt_at(parameters).map_or(0.0, |belt| belt.belt_velocity());
        match signature {
            Signature::PureSlip(_) => Vec::new(),
            _ if velocity == 0.0 => Vec::new(),
            _ => vec![Signature::PureSlip(if velocity < 0.0 { -1 } else { 1 })],
        }
    }
}
