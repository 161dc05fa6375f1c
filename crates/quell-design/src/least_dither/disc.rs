//! A disc under rotating loads as one whose dither is designed.
//!
//! The dither of a disc multiplies the friction force of its loads (`quell-model/src/disc/dither.rs`), and its steady sliding is
//! the flat disc for every dither, so that exponents of small motions decide, and the dither moves nothing: it has no stroke.
//! What is least is therefore
//!
//! * the amplitude α of normal dither, the share by which the load varies. It keeps the mean friction. A forward and a backward
//!   wave that meet at a harmonic of the dither share their damping, which raises the threshold of squeal near their
//!   meeting; two waves of one direction grow from an amplitude on, so that more dither is not always quieter;
//! * of tangential dither the amplitude α of the force that remains once the direction of sliding alternates. The mean
//!   friction, which excites the waves without dither, vanishes for every α, so that the smallest α is the quietest, and what is to be
//!   chosen is the frequency. The motion of an actuator that makes the direction alternate follows from the slip ratio
//!   (`quell-disc/src/tangential.rs`).
//!
//! A tongue is narrower than the steps of any grid over speeds. The points of a box are therefore those of a grid and the meetings of
//! waves with a tongue at the largest amplitude, and a dither is accepted only if no exponent crosses the imaginary axis along
//! the whole range of speeds, by the search of `quell-disc/src/marginal.rs`, at every combination of the other coordinates.

use quell_disc::dithered;
use quell_disc::marginal::{DiscExponent, MarginalValue, exponents, marginal_values, tongue_grid};
use quell_disc::resonance::{Order, Resonance, Tongue, Waves};
use quell_disc::undithered;
use quell_linear::driven_point::DrivenPoint;
use quell_linear::growth::Verdict;
use quell_linear::linearised::Linearised;
use quell_model::disc::{Contributions, DiscDither};
use quell_model::system::InputTarget;
use quell_model::{Disc, RefusedNumbers};
use quell_numerics::interval::RealInterval;
use quell_numerics::order::ascending;

use super::search::grid;
use super::{DitherPrice, ExactVerdict, OperatingPoint, Plant, QuietAmplitudes};
use crate::actuator::{Actuator, ActuatorDemand};
use crate::{NoAnswer, NotOfDisc};

/// Steps of a line over amplitudes; intervals in which an exponent may cross are halved.
const STEPS: u32 = 8;

/// Steps of a line over speeds, in addition to the points in and next to predicted tongues.
const SPEEDS: u32 = 48;

/// Points of the box along each coordinate other than the speed where tongues are sought.
const OTHER_POINTS: [usize; 4] = [1, 5, 3, 2];

/// A disc at an operating point with an amplitude of the dither that is designed, or why it is no valid disc.
pub type DiscAtPoint<'a> =
    dyn Fn(OperatingPoint<'_>, f64) -> Result<Disc, RefusedNumbers> + Sync + 'a;

/// A disc one of whose dithers is designed.
#[derive(Clone, Copy)]
pub struct DiscPlant<'a> {
    /// The disc at an operating point with an amplitude.
    pub at: &'a DiscAtPoint<'a>,
    /// The coordinate of the box that is the speed of the loads.
    pub speed: Option<usize>,
}

/// Whether a motion grows by more than its error.
fn grows(found: &[DiscExponent]) -> bool {
    found.iter().any(|exponent| exponent.rate > exponent.error)
}

impl DiscPlant<'_> {
    fn exponents(
        &self,
        at: OperatingPoint<'_>,
        amplitude: f64,
    ) -> Result<Vec<DiscExponent>, NoAnswer> {
        Ok(exponents(&(self.at)(at, amplitude)?)?)
    }

    /// The parts of a line between its marginal values, each with the verdict at its middle.
    fn parts<'l>(
        line: &'l dyn Fn(f64) -> Result<Vec<DiscExponent>, NoAnswer>,
        RealInterval { lower: from, upper: to }: RealInterval,
        values: &'l [MarginalValue],
    ) -> impl Iterator<Item = Result<(f64, f64, bool), NoAnswer>> + 'l {
        let ends: Vec<f64> = std::iter::once(from)
            .chain(values.iter().map(|marginal| marginal.value))
            .chain([to])
            .collect();
        (1..ends.len()).map(move |place| {
            let (low, high) = (ends[place - 1], ends[place]);
            Ok((low, high, grows(&line(f64::midpoint(low, high))?)))
        })
    }

    /// The speeds at which tongues may be at the largest amplitude, or their centre.
    fn predicted(disc: &Disc, RealInterval { lower: from, upper: to }: RealInterval) -> Vec<f64> {
        let mut speeds = Vec::new();
        let Ok(waves) = Waves::new(disc) else { return speeds };
        for order in [Order::First, Order::Second] {
            let waves = waves.clone().with_order(order);
            let all = waves.undithered(from..=to).into_iter().chain(waves.dithered(from..=to));
            for resonance in all.filter(Resonance::pair_can_be_unstable) {
                match resonance.tongue {
                    Tongue::Absent => {}
                    Tongue::Between { peak_speed, .. } => {
                        speeds.extend([resonance.speed, peak_speed]);
                    }
                    Tongue::WaveUnstable { .. } => speeds.push(resonance.speed),
                }
            }
        }
        speeds.retain(|speed| (from..=to).contains(speed));
        ascending(&mut speeds);
        speeds.dedup_by(|a, b| (*a - *b).abs() <= 1e-6);
        speeds
    }

    /// The box without its speed, at a few points each with a place for the speed.
    fn at_other_coordinates(ranges: &[RealInterval], speed: usize) -> Vec<Vec<f64>> {
        let mut fixed = ranges.to_vec();
        fixed[speed] = RealInterval::new(ranges[speed].lower, ranges[speed].lower);
        grid(&fixed, OTHER_POINTS, false)
    }
}

impl Plant for DiscPlant<'_> {
    /// At first order where the flat disc is stable without the dither, and otherwise exactly: how dither quenches
    /// an unstable wave is not a matter of two waves alone.
    fn averaged(
        &self,
        at: OperatingPoint<'_>,
        range: RealInterval,
    ) -> Result<QuietAmplitudes, NoAnswer> {
        let disc = (self.at)(at, range.upper)?;
        let Ok(waves) = Waves::new(&disc) else { return self.exact(at, range) };
        let still = match disc.dither() {
            DiscDither::None | DiscDither::Normal { .. } => disc.undithered(),
            DiscDither::Tangential { .. } => disc.undithered().with_friction_times(0.0)?,
        };
        let growth = undithered::growth(&still)?;
        if growth.verdict() == Verdict::Unstable {
            return self.exact(at, range);
        }
        let end = waves.least_growing_amplitude(disc.speed());
        Ok(QuietAmplitudes::of_changes(range, true, end.map(|amplitude| (amplitude, false))))
    }

    fn exact(
        &self,
        at: OperatingPoint<'_>,
        range: RealInterval,
    ) -> Result<QuietAmplitudes, NoAnswer> {
        let RealInterval { lower: from, upper: to } = range;
        let line = |amplitude: f64| self.exponents(at, amplitude);
        if from >= to {
            let quiet = !grows(&line(from)?);
            return Ok(QuietAmplitudes::of_changes(range, quiet, []));
        }
        let steps: Vec<f64> = (0..=STEPS)
            .map(|k| (to - from).mul_add(f64::from(k) / f64::from(STEPS), from))
            .collect();
        let values = marginal_values(&line, &steps)?;
        let mut quiet_at_first = false;
        let mut changes = Vec::new();
        for part in Self::parts(&line, range, &values) {
            let (low, _, grown) = part?;
            if low == from {
                quiet_at_first = !grown;
            } else {
                changes.push((low, !grown));
            }
        }
        Ok(QuietAmplitudes::of_changes(range, quiet_at_first, changes))
    }

    fn verdict(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<ExactVerdict, NoAnswer> {
        let disc = (self.at)(at, amplitude)?;
        let found = exponents(&disc)?;
        let leading = found
            .iter()
            .max_by(|a, b| a.rate.total_cmp(&b.rate))
            .ok_or(NoAnswer::NotOfDisc(NotOfDisc::Motion))?;
        let period = dithered::prepared(&disc)?.map(|prepared| prepared.period());
        Ok(ExactVerdict {
            quiet: !grows(&found),
            multiplier: libm::exp(leading.rate * period.unwrap_or(1.0)),
            growth_rate: Some(leading.rate),
        })
    }

    fn least_averaged(&self, _: OperatingPoint<'_>) -> Result<f64, NoAnswer> {
        Err(NoAnswer::NotOfDisc(NotOfDisc::LeastAmplitude))
    }

    fn slip_amplitudes(&self, _: OperatingPoint<'_>) -> Result<Vec<f64>, NoAnswer> {
        Err(NoAnswer::NotOfDisc(NotOfDisc::SlipVelocity))
    }

    fn price(&self, _: OperatingPoint<'_>, _: f64) -> Result<DitherPrice, NoAnswer> {
        Err(NoAnswer::NotOfDisc(NotOfDisc::Price))
    }

    fn averaged_loss(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<f64, NoAnswer> {
        let disc = (self.at)(at, amplitude)?;
        Ok(1.0 - disc.dither().mean_and_amplitude().0)
    }

    fn exact_loss(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<f64, NoAnswer> {
        // The flat disc slides steadily under every dither: the mean is that of the factor on friction.
        self.averaged_loss(at, amplitude)
    }

    /// The dither of a disc moves nothing.
    fn slowness(&self, _: OperatingPoint<'_>) -> Result<f64, NoAnswer> {
        Ok(0.0)
    }

    fn minimum_normal_load(&self, at: OperatingPoint<'_>, amplitude: f64) -> Result<f64, NoAnswer> {
        let disc = (self.at)(at, amplitude)?;
        let DiscDither::Normal { amplitude, .. } = disc.dither() else {
            return Err(NoAnswer::NotOfDisc(NotOfDisc::VaryingLoad));
        };
        let left = amplitude.mul_add(disc.waveform().range().lower, 1.0);
        let loads = disc.loads().iter().filter_map(|load| load.normal_load);
        loads
            .map(|load| left * load)
            .min_by(f64::total_cmp)
            .ok_or(NoAnswer::NotOfDisc(NotOfDisc::NormalLoad))
    }

    /// Of an actuator behind the spring of every load, in SI.
    fn demand(
        &self,
        at: OperatingPoint<'_>,
        actuator: &Actuator,
    ) -> Result<ActuatorDemand, NoAnswer> {
        let disc = (self.at)(at, 0.0)?;
        let unknown = NoAnswer::NotOfDisc(NotOfDisc::Actuator);
        let system = disc.system_in_si(Contributions::ALL).ok_or_else(|| unknown.clone())??;
        let pressed = system.inputs.iter().find_map(|input| match input.target {
            InputTarget::NormalLoad { contact, .. } => {
                Some((input, input.profile.waves().first()?, contact))
            }
            InputTarget::Force(_) | InputTarget::Friction { .. } => None,
        });
        let (input, wave, contact) = pressed.ok_or(unknown)?;
        let sliding = Linearised::new(&system)?;
        let (waveform, frequency) = (&wave.waveform, wave.frequency);
        let point = DrivenPoint::of_input(&system, &sliding, &input.target, waveform, frequency)?;
        Ok(actuator.demand(&point)?.at(system.contacts[contact].normal_load))
    }

    fn special_points(
        &self,
        ranges: &[RealInterval],
        others: &[f64],
        largest: f64,
    ) -> Result<Vec<Vec<f64>>, NoAnswer> {
        let Some(speed) = self.speed else { return Ok(Vec::new()) };
        let mut points = Vec::new();
        for point in Self::at_other_coordinates(ranges, speed) {
            let disc = (self.at)(OperatingPoint { point: &point, others }, largest)?;
            for value in Self::predicted(&disc, ranges[speed]) {
                let mut point = point.clone();
                point[speed] = value;
                points.push(point);
            }
        }
        Ok(points)
    }

    fn loud_points(
        &self,
        ranges: &[RealInterval],
        others: &[f64],
        amplitude: f64,
    ) -> Result<Vec<Vec<f64>>, NoAnswer> {
        let Some(speed) = self.speed else { return Ok(Vec::new()) };
        let mut points = Vec::new();
        let range = ranges[speed];
        for place in Self::at_other_coordinates(ranges, speed) {
            let at = |value: f64| {
                let mut point = place.clone();
                point[speed] = value;
                point
            };
            let line = |value: f64| {
                self.exponents(OperatingPoint { point: &at(value), others }, amplitude)
            };
            let disc = (self.at)(OperatingPoint { point: &place, others }, amplitude)?;
            let speeds = tongue_grid(&disc, &(range.lower..=range.upper), SPEEDS);
            let values = marginal_values(&line, &speeds)?;
            for part in Self::parts(&line, range, &values) {
                let (low, high, grown) = part?;
                if grown {
                    points.push(at(f64::midpoint(low, high)));
                }
            }
        }
        Ok(points)
    }
}
