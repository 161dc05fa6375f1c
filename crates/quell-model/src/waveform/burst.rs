//! Bursts: whole periods of a carrier, and a pause.

use std::f64::consts::TAU;

use super::shape::Piece;
use super::table::WaveTable;
use super::{Waveform, WaveformError};

/// Most periods of the carrier in one burst and its pause: every piece is a break of a table, and a longer period only takes longer.
pub(super) const MOST_CYCLES: u32 = 10_000;

/// Periods of a carrier and a pause. The phase is that of the carrier.
#[derive(Clone, Debug, PartialEq)]
pub struct Burst {
    carrier: Waveform,
    on: u32,
    off: u32,
    table: WaveTable,
}

impl Burst {
    /// `on` periods of a carrier (sine, triangle or square) and a pause of `off` periods.
    ///
    /// # Errors
    /// No period, more than 10 000 in all, or another carrier.
    pub fn new(carrier: Waveform, on: u32, off: u32) -> Result<Self, WaveformError> {
        let wrong = |key, allowed: String| Err(WaveformError { key, allowed });
        if !carrier.is_symmetric() {
            return wrong("carrier", "sine, triangle or square".to_owned());
        }
        if !(1..=MOST_CYCLES).contains(&on) {
            return wrong("on", format!("a whole number from 1 to {MOST_CYCLES}"));
        }
        if off > MOST_CYCLES - on {
            let most = MOST_CYCLES - on;
            return wrong("off", format!("a whole number from 0 to {most}, {MOST_CYCLES} less on"));
        }
        let table = table(&carrier, on, off);
        Ok(Self { carrier, on, off, table })
    }

    /// The waveform: the carrier itself where there is no pause.
    pub fn into_waveform(self) -> Waveform {
        if self.off == 0 { self.carrier } else { Waveform::Burst(self.into()) }
    }

    /// The carrier.
    pub fn carrier(&self) -> &Waveform {
        &self.carrier
    }

    /// Periods of the carrier in a burst.
    pub fn on(&self) -> u32 {
        self.on
    }

    /// Periods of the carrier in a pause.
    pub fn off(&self) -> u32 {
        self.off
    }

    /// Periods of the carrier in a burst and its pause.
    pub fn cycles(&self) -> u32 {
        self.on + self.off
    }

    pub(super) fn table(&self) -> &WaveTable {
        &self.table
    }
}

/// The pieces of the burst and of the pause, in the phase of the carrier.
fn table(carrier: &Waveform, on: u32, off: u32) -> WaveTable {
    let mut breaks = Vec::new();
    let mut pieces = Vec::new();
    let mut push = |at: f64, piece: Piece| {
        breaks.push(at);
        pieces.push(piece);
    };
    if carrier.breaks().is_empty() {
        push(0.0, Piece::Harmonic);
    } else {
        // A piece of the triangle extends over the start of a cycle, at which the burst begins.
        if carrier.breaks()[0] > 0.0 {
            push(0.0, Piece::Affine { value: carrier.value(0.0), slope: carrier.slope(0.0) });
        }
        for cycle in 0..on {
            let start = TAU * f64::from(cycle);
            for (at, piece) in carrier.breaks().iter().zip(carrier.pieces()) {
                push(start + at, *piece);
            }
        }
    }
    if off > 0 {
        push(TAU * f64::from(on), Piece::Affine { value: 0.0, slope: 0.0 });
    }
    WaveTable::new(breaks, pieces, TAU * f64::from(on + off))
}
