//! The largest line M of a record, of any structure: when it has settled, and how accurate it is.

use quell_numerics::spectrum::low_band::LargestLines;

/// Two halves of a record agree if their M differ by less than this fraction.
pub const HALVES_AGREE: f64 = 0.01;

/// … or by less than this fraction of the undithered M: E is then known to a thousandth. A
/// quenched response is a remnant whose halves never agree relatively.
pub const HALVES_NEGLIGIBLE: f64 = 1e-3;

/// Amplitude, relative to the length that scales the motion, that is only the engine's error and rounding: it need not settle.
const NOTHING: f64 = 1e-9;

/// Relative error of M due to the engine and to rounding, presumed if its halves agree by chance: a thousand times the
/// tolerance of a step, as [`NOTHING`]. If it were smaller, noise would decide whether a dither increases or reduces.
const ROUNDING: f64 = NOTHING;

/// Slow vibration below this fraction of the length that scales the motion is negligible: the distance within which a state counts as the base response.
const NEGLIGIBLE: f64 = 1e-6;

/// M of a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecordLines {
    /// M of the record and of its halves.
    pub lines: LargestLines,
    /// A length that scales the motion: F of a belt.
    pub scale: f64,
}

impl RecordLines {
    /// M of the whole record.
    pub fn whole(&self) -> f64 {
        self.lines.whole
    }

    /// Whether the vibration is too small to count.
    pub fn is_negligible(&self) -> bool {
        self.lines.whole <= NEGLIGIBLE * self.scale
    }

    /// Whether M of the halves agree, relatively or against `reference`.
    pub fn is_settled(&self, reference: f64) -> bool {
        let [first, second] = self.lines.halves;
        let difference = (first - second).abs();
        difference <= HALVES_AGREE * first.max(second)
            || difference <= HALVES_NEGLIGIBLE * reference
            || first.max(second) <= NOTHING * self.scale
    }

    /// Whether the vibration is smaller in the second half.
    pub fn decays(&self) -> bool {
        self.lines.halves[1] < self.lines.halves[0]
    }

    /// The relative difference of M between the halves: the accuracy to which the record determines M.
    pub fn unsteadiness(&self) -> f64 {
        let [first, second] = self.lines.halves;
        let largest = first.max(second);
        let difference = (first - second).abs();
        if largest > 0.0 { (difference / largest).max(ROUNDING) } else { 0.0 }
    }

    /// Whether M of the halves agree relatively: the vibration does not change by more than a hundredth over half a record.
    pub fn is_steady(&self) -> bool {
        self.is_settled(0.0)
    }
}
