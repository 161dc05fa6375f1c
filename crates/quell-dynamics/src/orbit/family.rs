//! A belt with dither as a family of period maps: what [`quell_numerics::continuation`] needs to know of it.
//!
//! The state is (x, x′) at τ = 0. An orbit in pure slip is continued beyond a touch of v_r = 0 on its branch of the
//! law, with its least slip velocity as the distance; what sticks or reverses is integrated as it is.

use quell_model::Belt;
use quell_numerics::continuation::{Family, Image};
use quell_numerics::matrix::Matrix as Dense;

use super::variation::Variation;
use super::{Matrix, NoOrbit, TOLERANCE, common_period};
use crate::simulation::{EventKind, Start, simulate, slide};

/// What happens along a period.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Signature {
    /// Slip without touching v_r = 0, with the sign of v_r.
    PureSlip(i8),
    /// Stick throughout.
    Stuck,
    /// These events in their cyclic order, with the sign of v_r afterwards; the order begins where it is least, so
    /// that it does not depend on where in the period τ = 0 lies.
    Events(Vec<(EventKind, i8)>),
}

impl Signature {
    /// Of the events of a period, the time in stick, and the sign of v_r at its end.
    pub(super) fn of(events: &[(EventKind, i8)], stuck: f64, sign: i8) -> Self {
        if events.is_empty() {
            return if stuck > 0.0 { Self::Stuck } else { Self::PureSlip(sign) };
        }
        let key = |turn: usize| {
            let turned = events[turn..].iter().chain(&events[..turn]);
            turned.map(|(kind, sign)| (*kind as u8, *sign)).collect::<Vec<_>>()
        };
        let turn = (0..events.len()).min_by_key(|turn| key(*turn)).unwrap_or(0);
        Self::Events([&events[turn..], &events[..turn]].concat())
    }

    /// Whether v_r = 0 is never touched.
    pub fn is_pure_slip(&self) -> bool {
        matches!(self, Self::PureSlip(_))
    }

    /// In words: how often it sticks and reverses in a period.
    pub fn words(&self) -> String {
        let Self::Events(events) = self else {
            return if self.is_pure_slip() { "pure slip" } else { "stick throughout" }.to_owned();
        };
        let count = |kind| events.iter().filter(|(it, _)| *it == kind).count();
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

/// What the parameters of a family set.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Setting<'a> {
    /// Nothing: the belt as it is.
    Given,
    /// The share of all amplitudes.
    Share,
    /// These paths of the registry, in order.
    Paths(&'a [&'a str]),
}

/// A belt over `periods` common periods of its dithers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Forced<'a> {
    pub(crate) belt: &'a Belt,
    pub(crate) setting: Setting<'a>,
    pub(crate) periods: u32,
}

impl Forced<'_> {
    /// The belt at given parameters.
    pub(crate) fn belt_at(&self, parameters: &[f64]) -> Result<Belt, NoOrbit> {
        let set = |belt: Belt, path: &str, value: f64| {
            belt.with(path, value).map_err(|_| NoOrbit::Invalid { value })
        };
        match self.setting {
            Setting::Given => Ok(self.belt.clone()),
            Setting::Share => {
                let dithers = self.belt.dithers();
                (0..dithers.len()).try_fold(self.belt.clone(), |belt, index| {
                    let share = parameters.first().copied().unwrap_or(1.0);
                    let path = belt.dither_path(index, "amplitude");
                    set(belt, &path, share * dithers[index].amplitude)
                })
            }
            Setting::Paths(paths) => paths
                .iter()
                .zip(parameters)
                .try_fold(self.belt.clone(), |belt, (path, value)| set(belt, path, *value)),
        }
    }

    /// The time over which states are mapped. Without dither, where steady sliding alone is followed, it is 1: far from
    /// the period 2π of its oscillation, whose multipliers would be 1.
    pub(crate) fn period_of(&self, belt: &Belt) -> Result<f64, NoOrbit> {
        match common_period(belt) {
            Ok(period) => Ok(f64::from(self.periods) * period),
            Err(NoOrbit::NoDither) if matches!(self.setting, Setting::Paths(_)) => Ok(1.0),
            Err(why) => Err(why),
        }
    }
}

impl Family for Forced<'_> {
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
        let (start, until) = (start_of(state), self.period_of(&belt)?);
        let mut variation = Variation::new(&belt);
        let end = if let Some(Signature::PureSlip(sign)) = held {
            slide(&belt, f64::from(*sign), start, until, TOLERANCE, &mut variation)
        } else {
            simulate(&belt, start, until, TOLERANCE, &mut variation)
        }
        .map_err(NoOrbit::Stalled)?;
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
            derivative: matrix_of(&variation.matrix),
            distance,
            signature,
        })
    }
}

/// A state at τ = 0.
pub(super) fn start_of(state: &[f64]) -> Start {
    match state {
        [displacement, velocity] => {
            Start { time: 0.0, displacement: *displacement, velocity: *velocity }
        }
        _ => Start::REST,
    }
}

pub(super) fn matrix_of(matrix: &Matrix) -> Dense {
    Dense::from_fn(2, 2, |i, j| matrix[i][j])
}
