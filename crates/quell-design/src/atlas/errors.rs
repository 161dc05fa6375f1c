//! The errors of a table, measured at random points of the range.

use quell_model::Waveform;
use quell_numerics::interval::RealInterval;
use quell_numerics::order::ascending;
use quell_numerics::random::SplitMix;

use super::point::{AtlasRange, RANGE};
use super::{Atlas, AtlasLaw, AtlasSurface};

/// Bands of ζ_f/R, whose errors differ by powers of ten.
pub const ERROR_BANDS: [RealInterval; 4] = [
    RealInterval::new(0.0, 0.02),
    RealInterval::new(0.02, 0.05),
    RealInterval::new(0.05, 0.1),
    RealInterval::new(0.1, 0.2),
];

/// The error stated over the largest measured: a sample of two hundred points misses the largest by less.
const MARGIN: f64 = 2.0;

/// Least error of κ_n and of the factor of the grazing: the digits of the file.
const DIGITS: f64 = 1e-8;

/// The errors of a table in a band: absolute of κ_n, relative of the grazing amplitude.
#[derive(Clone, Debug, PartialEq)]
pub struct AtlasErrors {
    /// The law.
    pub law: AtlasLaw,
    /// The waveform.
    pub waveform: Waveform,
    /// The surface.
    pub surface: AtlasSurface,
    /// The band of ζ_f/R.
    pub band: RealInterval,
    /// Number of points.
    pub points: usize,
    /// The median, the quantile of 90 %, and the largest.
    pub quantiles: [f64; 3],
}

impl AtlasErrors {
    /// The errors at random points of a band; points without an exact value do not count.
    ///
    /// `exact` computes the values at many places: [`super::AtlasTable::compute`] on any number of threads. `None` if the atlas lacks the table.
    pub fn measured(
        atlas: &Atlas,
        (law, waveform, surface): (AtlasLaw, &Waveform, AtlasSurface),
        band: RealInterval,
        (points, seed): (usize, u64),
        exact: impl FnOnce(&[Vec<f64>]) -> Vec<Option<f64>>,
    ) -> Option<Self> {
        let table = atlas.table(law, waveform, surface)?;
        let places = random_places(law, surface, band, (points, seed));
        let found = exact(&places);
        let mut errors: Vec<f64> = places
            .iter()
            .zip(found)
            .filter_map(|(place, exact)| {
                let (exact, value) = (exact?, table.at(place));
                Some(match surface {
                    AtlasSurface::Grazing => (value / exact - 1.0).abs(),
                    AtlasSurface::NeutralDamping => (value - exact).abs(),
                })
            })
            .collect();
        ascending(&mut errors);
        let last = errors.len().checked_sub(1)?;
        let quantile = |percent: usize| errors[(percent * last).div_ceil(100)];
        Some(Self {
            law,
            waveform: waveform.clone(),
            surface,
            band,
            points: errors.len(),
            quantiles: [quantile(50), quantile(90), quantile(100)],
        })
    }

    /// The error that answers state: twice the largest measured, at least that of the digits of the table.
    pub fn stated(&self) -> f64 {
        (MARGIN * self.quantiles[2]).max(DIGITS)
    }
}

/// Random places on the axes of a surface, in the range of answers. 1/R is as dense in log R as v₀ is in v₀.
fn random_places(
    law: AtlasLaw,
    surface: AtlasSurface,
    band: RealInterval,
    (points, seed): (usize, u64),
) -> Vec<Vec<f64>> {
    let mut random = SplitMix::new(seed);
    let AtlasRange { relative_damping, velocity_share, frequency_ratio, .. } = RANGE;
    let mut within = |range: RealInterval| range.width().mul_add(random.share(), range.lower);
    let RealInterval { lower: shortest, upper: longest } = frequency_ratio;
    let logarithms = RealInterval::new(libm::log(shortest), libm::log(longest));
    let mut place = || {
        let relative = within(relative_damping);
        let velocity = law.largest_velocity() * within(velocity_share);
        let inverse = libm::exp(-within(logarithms));
        let damping = within(band);
        let share = within(RealInterval::new(0.0, 1.0));
        match surface {
            AtlasSurface::Grazing => vec![relative, velocity, inverse, damping],
            AtlasSurface::NeutralDamping => vec![velocity, inverse, damping, share],
        }
    };
    (0..points).map(|_| place()).collect()
}
