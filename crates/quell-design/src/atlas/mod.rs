//! The atlas: exact thresholds of a belt under one tangential dither, in dimensionless groups, as tables with an interpolation.
//!
//! # Groups
//!
//! With time in 1/ω₀ and velocities over the reference velocity v_m of the law, a mass on a belt in slip obeys
//! y″ + 2ζy′ + y = 2ζ_f f(w)/max|f′| + (D/v_m) g(Rτ), w = v₀/v_m − y′, where f is the shape of the law and ζ_f = F max|μ′|/2
//! is the largest negative damping ratio of friction. The static and the minimum coefficient enter through ζ_f alone, and a
//! viscous part σ_v of the law through the damping ζ + Fσ_v/2. So everything about the base response in slip depends on five
//! groups: κ = ζ/ζ_f, v₀/v_m, R, ζ_f/R (the damping of friction per cycle of the dither) and D/v_m.
//!
//! # Surfaces
//!
//! The base response is unstable while the mean damping of a period, ∮(2ζ + Fμ′)dτ, is negative, and grazes v_r = 0 at an
//! amplitude from which it sticks in every period and is stable. Two surfaces describe this, both analytic, so that a few
//! Chebyshev nodes suffice ([`AtlasTable`]):
//! * the grazing amplitude over κ, v₀/v_m, 1/R and ζ_f/R, divided by that of the structure without friction;
//! * the neutral damping κ_n, at which the mean damping is zero, over v₀/v_m, 1/R, ζ_f/R and the share of the grazing amplitude.
//!
//! A belt is quiet at the amplitudes where κ ≥ κ_n, and beyond the grazing. Where κ crosses κ_n a Neimark–Sacker bifurcation
//! ends the loud range, or begins one ([`Atlas::answer`]).
//!
//! # Accuracy and limits
//!
//! The nodes are exact to the digits printed. The interpolation has the errors in the file, measured at random points
//! ([`AtlasErrors`]); an answer states the change of amplitude that they can cause. The range is that of [`AtlasPoint::of`].
//! The answer holds for the base response: a run from rest or from squeal may need more amplitude.
//!
//! | file | contents |
//! |---|---|
//! | `law` | the laws, by shape |
//! | `point` | a belt as a point of the atlas and back, and why a belt is outside |
//! | `grid` | axes with Chebyshev nodes, and the interpolation |
//! | `table` | one surface of one law and waveform |
//! | `node` | the exact value at a node |
//! | `answer` | the amplitudes at which the verdict changes |
//! | `errors` | random points, and the errors of a table at them |
//! | `text` | the file `data/atlas-1.txt.gz` |

mod answer;
mod errors;
mod grid;
mod law;
mod node;
mod point;
mod table;
mod text;

use std::io::Read as _;
use std::sync::OnceLock;

use flate2::read::GzDecoder;
use quell_model::Waveform;

pub use answer::{AtlasAnswer, AtlasChange, NeutralDampings};
pub use errors::{AtlasErrors, ERROR_BANDS};
pub use grid::AtlasAxis;
pub use law::AtlasLaw;
pub use node::NoAtlasNode;
pub use point::{AtlasPoint, AtlasRange, OutsideAtlas, RANGE};
pub use table::{AtlasSurface, AtlasTable};
pub use text::{AtlasExpected, AtlasTextError};

/// The waveforms of the atlas.
pub const WAVEFORMS: [Waveform; 3] = [Waveform::Sine, Waveform::Triangle, Waveform::Square];

/// The tables of every law and waveform, and their errors.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Atlas {
    /// One table for each law, waveform and surface.
    pub tables: Vec<AtlasTable>,
    /// The errors of the tables in bands of ζ_f/R.
    pub errors: Vec<AtlasErrors>,
}

impl Atlas {
    /// The atlas of this version. A test reads it whole.
    pub fn shipped() -> &'static Self {
        static ATLAS: OnceLock<Atlas> = OnceLock::new();
        ATLAS.get_or_init(|| {
            let mut text = String::new();
            let file = GzDecoder::new(&include_bytes!("../../data/atlas-1.txt.gz")[..])
                .read_to_string(&mut text);
            file.ok().and_then(|_| Self::parse(&text).ok()).unwrap_or_default()
        })
    }

    /// The table of a surface; `None` for an atlas that lacks it.
    pub fn table(
        &self,
        law: AtlasLaw,
        waveform: &Waveform,
        surface: AtlasSurface,
    ) -> Option<&AtlasTable> {
        self.tables.iter().find(|table| {
            table.law == law && table.waveform == *waveform && table.surface == surface
        })
    }

    /// The error stated for a surface at a value of ζ_f/R: [`AtlasErrors::stated`] of its band; `None` for an atlas without it.
    pub fn stated_error(
        &self,
        (law, waveform): (AtlasLaw, &Waveform),
        surface: AtlasSurface,
        damping_per_cycle: f64,
    ) -> Option<f64> {
        let errors = self.errors.iter().find(|errors| {
            errors.law == law
                && errors.waveform == *waveform
                && errors.surface == surface
                && damping_per_cycle <= errors.band.upper
        });
        errors.map(AtlasErrors::stated)
    }
}
