//! What each contact does during a step, in every lane.

use quell_numerics::lane::Lane;

use super::phase::{ContactNow, ContactPhase, OwnNow};

/// What a contact does during a step. Each mask is positive in the lanes where it holds, and each `bool` or number next to them
/// combines all lanes, so that work which no lane needs is left out.
#[expect(
    clippy::struct_excessive_bools,
    reason = "each says of one mask whether any lane needs its work"
)]
#[derive(Clone, Debug)]
pub(super) struct ContactMasks<V = f64> {
    /// Sign of the slip velocity; 0 where the contact does not slip.
    pub(super) sign: V,
    pub(super) slipping: V,
    pub(super) sticking: V,
    pub(super) open: V,
    /// Sign of the bound at which the friction of a sticking contact stands; 0 where it is below its bound.
    pub(super) saturated: V,
    /// 1 where slip velocity or bound give the friction.
    pub(super) acting: V,
    /// 1 where the contact sticks below its bound: its margins are guards.
    pub(super) holding: V,
    /// Multiplicity of the zeros of γ and of the load at the start.
    pub(super) slip_zeros: V,
    pub(super) load_zeros: V,
    pub(super) any_slips: bool,
    pub(super) any_sticks: bool,
    pub(super) any_open: bool,
    pub(super) any_saturated: bool,
    pub(super) any_holds: bool,
    pub(super) all_act: bool,
    pub(super) most_slip_zeros: usize,
    pub(super) most_load_zeros: usize,
    /// Whether the series of the law along γ is needed: where the contact slips, or adheres beyond its static bound.
    pub(super) follows_law: bool,
    /// Direction of an elastic slider's slip times the sign of γ; not read of rigid contacts.
    pub(super) turned: f64,
}

/// `yes` where `mask` is positive, which it is in one lane at least: alone `yes`.
#[inline(always)]
pub(super) fn chosen<V: Lane>(mask: V, yes: V, no: V) -> V {
    if const { V::LANES == 1 } { yes } else { mask.where_positive(yes, no) }
}

#[inline(always)]
fn mask(holds: bool) -> f64 {
    f64::from(u8::from(holds))
}

impl ContactMasks {
    /// Of one run.
    #[inline(always)]
    pub(super) fn of(now: &ContactNow) -> Self {
        let slips = matches!(now.phase, ContactPhase::Slip(_));
        let is_saturated = now.sticks() && now.saturated != 0;
        let direction = f64::from(now.phase.slip_sign());
        // The law is evaluated on the branch of γ.
        let (sign, is_beyond) = match now.own {
            OwnNow::Elastic(own) => (f64::from(own.branch), own.beyond != 0),
            OwnNow::Rigid | OwnNow::Bristles => (direction, false),
        };
        Self {
            sign,
            slipping: mask(slips),
            sticking: mask(now.sticks()),
            open: mask(now.is_open()),
            saturated: if is_saturated { f64::from(now.saturated) } else { 0.0 },
            acting: mask(slips || is_saturated),
            holding: mask(now.sticks() && !is_saturated),
            slip_zeros: now.slip_zeros as f64,
            load_zeros: now.load_zeros as f64,
            any_slips: slips,
            any_sticks: now.sticks(),
            any_open: now.is_open(),
            any_saturated: is_saturated,
            any_holds: now.sticks() && !is_saturated,
            all_act: slips || is_saturated,
            most_slip_zeros: now.slip_zeros,
            most_load_zeros: now.load_zeros,
            follows_law: slips || is_beyond,
            turned: direction * sign,
        }
    }
}

impl<V: Lane> ContactMasks<V> {
    /// Of lanes without a run.
    #[inline(always)]
    pub(super) fn empty() -> Self {
        let zero = V::splat(0.0);
        Self {
            sign: zero,
            slipping: zero,
            sticking: zero,
            open: zero,
            saturated: zero,
            acting: zero,
            holding: zero,
            slip_zeros: zero,
            load_zeros: zero,
            any_slips: false,
            any_sticks: false,
            any_open: false,
            any_saturated: false,
            any_holds: false,
            all_act: false,
            most_slip_zeros: 0,
            most_load_zeros: 0,
            follows_law: false,
            turned: 0.0,
        }
    }

    /// Sets one lane; [`ContactMasks::combine`] must follow.
    #[inline(always)]
    pub(super) fn set(&mut self, lane: usize, now: &ContactNow) {
        let one = ContactMasks::of(now);
        self.sign.set_lane(lane, one.sign);
        self.slipping.set_lane(lane, one.slipping);
        self.sticking.set_lane(lane, one.sticking);
        self.open.set_lane(lane, one.open);
        self.saturated.set_lane(lane, one.saturated);
        self.acting.set_lane(lane, one.acting);
        self.holding.set_lane(lane, one.holding);
        self.slip_zeros.set_lane(lane, one.slip_zeros);
        self.load_zeros.set_lane(lane, one.load_zeros);
    }

    /// Combines the masks of all lanes.
    #[inline(always)]
    pub(super) fn combine(&mut self) {
        let most = |zeros: V| {
            let reaches = |count: f64| (zeros - V::splat(count - 0.5)).any_positive();
            usize::from(reaches(1.0)) + usize::from(reaches(2.0))
        };
        self.any_slips = self.slipping.any_positive();
        self.follows_law = self.any_slips;
        self.any_sticks = self.sticking.any_positive();
        self.any_open = self.open.any_positive();
        self.any_saturated = self.saturated.abs().any_positive();
        self.any_holds = self.holding.any_positive();
        self.all_act = !(V::splat(0.5) - self.acting).any_positive();
        self.most_slip_zeros = most(self.slip_zeros);
        self.most_load_zeros = most(self.load_zeros);
    }
}
