//! The published sources that can be cited, entries of `references.bib`.

use super::bibliography;

/// A published source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Source {
    /// Key in `references.bib`.
    pub key: &'static str,
}

impl Source {
    /// The full reference.
    pub fn reference(self) -> String {
        bibliography::entry(self.key).map(bibliography::line).unwrap_or_default().replace('*', "")
    }
}

/// The dissertation that states the problem and whose equations are numbered here.
pub const MICHAUX_2005: Source = Source { key: "michaux2005" };
/// Averaging of the belt with tangential dither, and the Stribeck law used here.
pub const THOMSEN_1999: Source = Source { key: "thomsen1999" };
/// Stick-slip of the undithered belt.
pub const THOMSEN_FIDLIN_2003: Source = Source { key: "thomsen2003" };
/// Experiments with dither against squeal of a disc brake.
pub const CUNEFARE_GRAF_2002: Source = Source { key: "cunefare2002" };
/// Describing functions of a nonlinearity under several sinusoids and noise.
pub const GELB_VANDER_VELDE_1968: Source = Source { key: "gelb1968" };
/// Friction in machines, with a decreasing (Stribeck) and a viscous part.
pub const ARMSTRONG_HELOUVRY_1994: Source = Source { key: "armstrong1994" };
/// Friction by bristles that deflect before they slip (LuGre).
pub const CANUDAS_DE_WIT_1995: Source = Source { key: "canudas1995" };
/// Integration by Taylor series with step size control.
pub const JORBA_ZOU_2005: Source = Source { key: "jorba2005" };
/// Solutions of differential equations with set-valued right-hand sides.
pub const FILIPPOV_1988: Source = Source { key: "filippov1988" };
/// The Hann window and other windows.
pub const HARRIS_1978: Source = Source { key: "harris1978" };
/// Averages and rotation numbers of quasi-periodic motion.
pub const DAS_SAIKI_SANDER_YORKE_2017: Source = Source { key: "das2017" };
/// Basin stability: the share of starts that reach a state, as a complement to linear stability.
pub const MENCK_2013: Source = Source { key: "menck2013" };
/// Confidence interval of a sampled share.
pub const WILSON_1927: Source = Source { key: "wilson1927" };
/// Frequencies and shapes of annular plates.
pub const VOGEL_SKINNER_1965: Source = Source { key: "vogel1965" };
/// A disc under a moving mass, spring and damper.
pub const IWAN_STAHL_1973: Source = Source { key: "iwan1973" };
/// A disc under such a load with friction as a follower force.
pub const CHAN_1994: Source = Source { key: "chan1994" };
/// The method of multiple scales, and parametric excitation.
pub const NAYFEH_MOOK_1979: Source = Source { key: "nayfeh1979" };
/// Fourth-order splitting of exponentials.
pub const TAKAHASHI_IMADA_1984: Source = Source { key: "takahashi1984" };
/// Mode coupling in its smallest model: two degrees of freedom and Coulomb friction.
pub const HOFFMANN_2002: Source = Source { key: "hoffmann2002" };
/// Extrapolation of Gragg's midpoint steps.
pub const HAIRER_NORSETT_WANNER_1993: Source = Source { key: "hairer1993" };

/// The generator SplitMix64.
pub const STEELE_2014: Source = Source { key: "steele2014" };

/// Every source that can be cited.
pub const SOURCES: &[Source] = &[
    MICHAUX_2005,
    THOMSEN_1999,
    THOMSEN_FIDLIN_2003,
    CUNEFARE_GRAF_2002,
    ARMSTRONG_HELOUVRY_1994,
    CANUDAS_DE_WIT_1995,
    GELB_VANDER_VELDE_1968,
    JORBA_ZOU_2005,
    FILIPPOV_1988,
    HARRIS_1978,
    DAS_SAIKI_SANDER_YORKE_2017,
    MENCK_2013,
    WILSON_1927,
    VOGEL_SKINNER_1965,
    IWAN_STAHL_1973,
    CHAN_1994,
    NAYFEH_MOOK_1979,
    TAKAHASHI_IMADA_1984,
    HOFFMANN_2002,
    HAIRER_NORSETT_WANNER_1993,
    STEELE_2014,
];
