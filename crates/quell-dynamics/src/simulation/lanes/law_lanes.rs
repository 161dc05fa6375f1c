//! What the lanes of a batch hold of their law: the part of a batch that is compiled per law and lane type.

use quell_model::friction::LawSeries;
use quell_numerics::lane::Lane;

use super::super::slip::SlipSeries;
use super::super::taylor::ORDER;
use super::batch::Batch;

/// The laws of the runs of a batch, and the series of the last step.
pub(super) struct LawLanes<V: Lane, L: LawSeries> {
    laws: Vec<L>,
    constants: Option<L::Constants<V>>,
    pub(super) series: SlipSeries<V>,
}

impl<V: Lane, L: LawSeries> LawLanes<V, L> {
    #[inline(always)]
    pub(super) fn new() -> Self {
        Self {
            laws: Vec::with_capacity(V::LANES),
            constants: None,
            series: SlipSeries {
                displacement: [V::splat(0.0); ORDER + 1],
                slip: [V::splat(0.0); ORDER + 1],
            },
        }
    }

    /// Takes over the laws of the runs of a batch. A lane without a run keeps the law of the run before.
    #[inline(never)]
    pub(super) fn refresh(&mut self, batch: &Batch<'_>) {
        for (lane, friction) in batch.frictions() {
            // Every run has this kind of law, by the choice of the group.
            let Some(law) = L::of(friction) else { continue };
            if self.laws.is_empty() {
                self.laws.resize(V::LANES, law.clone());
            }
            self.laws[lane] = law;
        }
        if !self.laws.is_empty() {
            self.constants = Some(L::constants::<V>(&self.laws));
        }
    }

    /// Takes one slip step in all lanes of a batch.
    #[inline(always)]
    pub(super) fn step(&mut self, batch: &mut Batch<'_>) {
        batch.round += 1;
        if let Some(constants) = &mut self.constants {
            batch.all_clear = batch.lanes.step::<V, L>(constants, &mut self.series);
        }
    }
}
