//! The amplitudes of a point at which the verdict on the base response changes, by the tables.

use quell_dynamics::orbit::ThresholdKind;
use quell_numerics::roots::{Closeness, find_root};

use super::Atlas;
use super::grid::{AtlasAxis, reduced};
use super::point::AtlasPoint;
use super::table::AtlasSurface;

/// Shares of the grazing amplitude between which changes are sought. κ_n is a polynomial of degree 11 of the share: a finer grid
/// finds no further root.
const SHARES: usize = 256;

/// Relative error from which the amplitude of a change is sensitive: a thousandth, beyond the digits of a drawing.
pub(super) const SENSITIVE: f64 = 1e-3;

/// An amplitude at which the verdict changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtlasChange {
    /// D/v_m.
    pub amplitude: f64,
    /// The change of the amplitude that the errors of the tables can cause; `None` where they can remove this change.
    pub error: Option<f64>,
    /// The kind of bifurcation.
    pub kind: ThresholdKind,
    /// Whether slightly larger amplitudes are quiet.
    pub becomes_quiet: bool,
}

impl AtlasChange {
    /// The error over the amplitude.
    pub fn relative_error(&self) -> Option<f64> {
        self.error.map(|error| error / self.amplitude)
    }

    /// Whether the errors of the tables move the amplitude by more than a thousandth, or remove the change.
    pub fn is_sensitive(&self) -> bool {
        self.relative_error().is_none_or(|error| error > SENSITIVE)
    }
}

/// What the atlas knows about a point.
#[derive(Clone, Debug, PartialEq)]
pub struct AtlasAnswer {
    /// The point.
    pub point: AtlasPoint,
    /// D/v_m at which the base response grazes v_r = 0, and the error of the table.
    pub grazing: (f64, f64),
    /// κ_n of steady sliding without dither: it is unstable for less.
    pub neutral_without: f64,
    /// Whether steady sliding is stable without dither.
    pub quiet_without: bool,
    /// The changes of the verdict, in ascending order.
    pub changes: Vec<AtlasChange>,
    /// Whether the errors of the tables could add changes.
    pub may_change_more: bool,
}

impl AtlasAnswer {
    /// The change from which every larger amplitude is quiet; `None` where every amplitude is.
    pub fn last(&self) -> Option<&AtlasChange> {
        self.changes.last().filter(|change| change.becomes_quiet)
    }

    /// The change from which a belt that is loud without dither is quiet; `None` where sliding is stable without dither.
    pub fn least(&self) -> Option<&AtlasChange> {
        self.changes.first().filter(|change| change.becomes_quiet)
    }

    /// The first change at which dither makes a quiet belt loud.
    pub fn lost(&self) -> Option<&AtlasChange> {
        self.changes.iter().find(|change| !change.becomes_quiet)
    }

    /// Whether an amplitude D/v_m is quiet.
    pub fn is_quiet(&self, amplitude: f64) -> bool {
        let before = self.changes.iter().rev().find(|change| change.amplitude <= amplitude);
        before.map_or(self.quiet_without, |change| change.becomes_quiet)
    }
}

impl Atlas {
    /// The answer at a point; `None` if the atlas lacks its tables or their errors.
    pub fn answer(&self, point: &AtlasPoint) -> Option<AtlasAnswer> {
        let of = (point.law, &point.waveform);
        let per_cycle = point.damping_per_cycle();
        let error = |surface| self.stated_error(of, surface, per_cycle);
        let grazing = self.grazing_amplitude(point)?;
        let neutral = self.neutral_dampings(point)?;
        let damping_error = error(AtlasSurface::NeutralDamping)?;
        let error = grazing * error(AtlasSurface::Grazing)?;
        let crossings = ShareCrossings::of(&neutral, point.relative_damping, damping_error);
        let changes = crossings.found.iter().map(|crossing| AtlasChange {
            amplitude: crossing.share * grazing,
            error: crossing.error.map(|of_share| of_share.mul_add(grazing, crossing.share * error)),
            kind: crossing.kind,
            becomes_quiet: crossing.becomes_quiet,
        });
        Some(AtlasAnswer {
            point: point.clone(),
            grazing: (grazing, error),
            neutral_without: neutral.at(0.0),
            quiet_without: crossings.quiet_first,
            changes: changes.collect(),
            may_change_more: crossings.may_be_more,
        })
    }

    /// D/v_m at the grazing; `None` if the atlas lacks its table.
    pub fn grazing_amplitude(&self, point: &AtlasPoint) -> Option<f64> {
        let table = self.table(point.law, &point.waveform, AtlasSurface::Grazing)?;
        let inverse = point.frequency_ratio.recip();
        let place =
            [point.relative_damping, point.relative_velocity, inverse, point.damping_per_cycle()];
        Some(table.at(&place) * point.corner()?)
    }

    /// κ_n over the share of the grazing amplitude, at the other groups of a point; `None` if the atlas lacks its table.
    pub fn neutral_dampings(&self, point: &AtlasPoint) -> Option<NeutralDampings> {
        let table = self.table(point.law, &point.waveform, AtlasSurface::NeutralDamping)?;
        let inverse = point.frequency_ratio.recip();
        let values =
            table.along_last(&[point.relative_velocity, inverse, point.damping_per_cycle()]);
        let axis = AtlasSurface::NeutralDamping.axes(point.law).pop()?;
        Some(NeutralDampings { axis, values })
    }
}

/// κ_n over the share of the grazing amplitude.
#[derive(Clone, Debug, PartialEq)]
pub struct NeutralDampings {
    axis: AtlasAxis,
    values: Vec<f64>,
}

impl NeutralDampings {
    /// κ_n at a share.
    pub fn at(&self, share: f64) -> f64 {
        let axis = std::slice::from_ref(&self.axis);
        reduced(axis, &self.values, &[share]).first().copied().unwrap_or(0.0)
    }
}

/// A share of the grazing amplitude at which the verdict changes.
#[derive(Clone, Copy, Debug)]
struct ShareCrossing {
    share: f64,
    kind: ThresholdKind,
    becomes_quiet: bool,
    /// The change of the share that the error of κ_n can cause; `None` where it can remove the crossing.
    error: Option<f64>,
}

struct ShareCrossings {
    found: Vec<ShareCrossing>,
    /// Whether a share of zero is quiet.
    quiet_first: bool,
    /// Whether the error of κ_n could add crossings.
    may_be_more: bool,
}

impl ShareCrossings {
    fn of(neutral: &NeutralDampings, kappa: f64, error: f64) -> Self {
        let shares: Vec<f64> = (0..=SHARES).map(|k| k as f64 / SHARES as f64).collect();
        let excess: Vec<f64> = shares.iter().map(|share| kappa - neutral.at(*share)).collect();
        // The crossings with κ_n less this.
        let crossed = |offset: f64| -> Vec<ShareCrossing> {
            let is_quiet = |k: usize| excess[k] + offset >= 0.0;
            let at = |k: usize| {
                let function = |share| kappa - neutral.at(share) + offset;
                let found = find_root(function, shares[k], shares[k + 1], Closeness::default());
                ShareCrossing {
                    share: found.map_or(shares[k], |root| root.location),
                    kind: ThresholdKind::NeimarkSacker,
                    becomes_quiet: is_quiet(k + 1),
                    error: None,
                }
            };
            let inside = (0..SHARES).filter(|k| is_quiet(*k) != is_quiet(k + 1)).map(at);
            let grazing = ShareCrossing {
                share: 1.0,
                kind: ThresholdKind::Grazing,
                becomes_quiet: true,
                error: None,
            };
            inside.chain((!is_quiet(SHARES)).then_some(grazing)).collect()
        };
        let mut found = crossed(0.0);
        let moved = [crossed(error), crossed(-error)];
        let before = found.clone();
        for crossing in &mut found {
            let shifts = moved.iter().map(|moved| {
                let other = nearest(moved, crossing)?;
                let back = nearest(&before, other)?;
                (back.share == crossing.share).then_some((other.share - crossing.share).abs())
            });
            let both = shifts.collect::<Option<Vec<f64>>>();
            crossing.error = both.map(|both| both.into_iter().fold(0.0, f64::max));
        }
        Self {
            quiet_first: excess[0] >= 0.0,
            may_be_more: moved.iter().any(|moved| moved.len() > found.len()),
            found,
        }
    }
}

/// The crossing of the same direction nearest to another.
fn nearest<'a>(crossings: &'a [ShareCrossing], to: &ShareCrossing) -> Option<&'a ShareCrossing> {
    let alike = crossings.iter().filter(|other| other.becomes_quiet == to.becomes_quiet);
    let distance = |crossing: &ShareCrossing| (crossing.share - to.share).abs();
    alike.min_by(|a, b| distance(a).total_cmp(&distance(b)))
}
