//! Transitions of a run: what the contacts do at the start, and at a moment at which guards have reached zero.

use quell_model::friction::{BranchSeries, FrictionConstants};
use quell_numerics::dispatch::{Work, with_fused_multiply_add};
use smallvec::SmallVec;

use super::contact_equation::ContactEquation;
use super::engine::{MotionProgress, MotionRun, PATIENCE};
use super::few::Few;
use super::guards::GuardReached;
use super::observer::{MotionEvent, MotionMoment, Trigger};
use super::phase::{ContactNow, ContactPhase};
use super::selection::{LoneMoment, Moment};
use super::stopped::{MotionStopped, StopReason};
use super::stuck::{coupling, independent};
use crate::simulation::EventKind;

/// Rate of a margin, over its size and the time scale, below which a release counts as nearly tangential.
const NEARLY_TANGENTIAL: f64 = 1e-6;

/// Slip velocities below this multiple of their rounding are zero at the start of a run.
const AT_REST: f64 = 32.0 * f64::EPSILON;

/// Time over the time scale within which a slip velocity is negligible at the start of a run if friction can stop it.
const NEGLIGIBLE: f64 = 1e-13;

/// A load beyond zero by this share of N₀ has jumped there: a root of a series leaves 10⁻¹², a jump of a square wave its amplitude. A
/// smaller jump is taken for a root, and its contact closes or opens at the next step.
const JUMP: f64 = 1e-9;

/// So many moments with events per contact within [`ACCUMULATED`] of the time scale are Zeno behaviour. A contact that slips needs a
/// finite change of force between two events, so that motions without accumulation have few in a time so short; if one had more, it
/// would end with this reason.
const MOST_EVENTS_OF_A_CONTACT: u64 = 48;

/// Time within which events accumulate, over the time scale. Guards within 10⁻¹² of it are one moment: events whose distances shrink
/// by a third or more pass from here to there in fewer than [`MOST_EVENTS_OF_A_CONTACT`], and the run goes on from the point of
/// accumulation.
const ACCUMULATED: f64 = 1e-6;

/// ẋ of a run now, without the friction of some contacts.
struct RatesWithout<'r, 'a>(&'r MotionRun<'a>, &'r [usize]);

impl Work for RatesWithout<'_, '_> {
    type Output = SmallVec<[f64; 8]>;

    #[inline(always)]
    fn run(self) -> SmallVec<[f64; 8]> {
        self.0.rates_without(self.1)
    }
}

impl MotionRun<'_> {
    /// A slip velocity that friction brings to rest within a time too short to be distinguished from zero.
    fn negligible_slip(&self, contact: usize, load: f64) -> f64 {
        let level = self.equations.contacts[contact].static_coefficient * load;
        let own = self.equations.coupling[(contact, contact)];
        NEGLIGIBLE * self.time_scale * own * level
    }

    /// The contacts at the start of a run: no event.
    pub(super) fn begin(&mut self) -> MotionProgress {
        let mut resting: Few<usize> = Few::new();
        for contact in 0..self.now.len() {
            if self.now[contact].kept {
                continue;
            }
            let (slip, size) = self.slip(contact);
            let load = self.load(contact);
            let is_compliant = self.equations.contacts[contact].is_compliant();
            if !is_compliant && load <= 0.0 {
                let contact = self.name(contact);
                return Err(self.stopped(StopReason::LoadVanishes { contact }));
            }
            let phase = if load < 0.0 {
                ContactPhase::Open
            } else if self.equations.contacts[contact].own.is_some() {
                let now = self.now_in(contact, ContactPhase::Slip(if slip < 0.0 { -1 } else { 1 }));
                let slip_zeros = usize::from(slip.abs() <= AT_REST * size);
                self.now[contact] = ContactNow { slip_zeros, ..now };
                continue;
            } else if self.equations.contacts[contact].can_stick()
                && slip.abs() <= (AT_REST * size).max(self.negligible_slip(contact, load))
            {
                resting.push(contact);
                ContactPhase::Stick
            } else {
                ContactPhase::Slip(if slip > 0.0 { 1 } else { -1 })
            };
            self.now[contact] = self.now_in(contact, phase);
        }
        if !resting.is_empty() {
            self.decide(&resting, &[], false)?;
        }
        self.begin_own()
    }

    /// Decides what follows from guards that have reached zero.
    pub(super) fn moment(
        &mut self,
        first: GuardReached,
        triggers: &[GuardReached],
    ) -> MotionProgress {
        let before: Few<ContactPhase> = self.now.iter().map(|now| now.phase).collect();
        let mut arrived: Few<usize> = Few::new();
        let mut reached: Few<(usize, i8)> = Few::new();
        // A load that jumps through zero changes forces at once, which may release others.
        let mut jumped = false;
        for trigger in triggers {
            match trigger.what {
                Trigger::Load(contact) => jumped |= self.open_or_close(contact)?,
                _ if self.own_transition(trigger)? => {}
                Trigger::Slip(contact) | Trigger::Turn(contact) => arrived.push(contact),
                Trigger::Margin(contact, side) => {
                    self.count_tangential(contact, trigger);
                    reached.push((contact, side));
                }
            }
        }
        let open = |contact: &usize| self.now[*contact].is_open();
        arrived.retain(|contact| !open(contact));
        reached.retain(|(contact, _)| !open(contact));
        if jumped || !(arrived.is_empty() && reached.is_empty()) {
            let holds = self.idle >= PATIENCE;
            self.decide(&arrived, &reached, holds)?;
        }
        self.report(&before, first, triggers)
    }

    /// What a contact with a state of its own does; whether it is one.
    fn own_transition(&mut self, trigger: &GuardReached) -> Result<bool, MotionStopped> {
        let (Trigger::Slip(contact)
        | Trigger::Turn(contact)
        | Trigger::Margin(contact, _)
        | Trigger::Load(contact)) = trigger.what;
        if self.now[contact].is_rigid() {
            return Ok(false);
        }
        if !self.now[contact].is_open() {
            match trigger.what {
                Trigger::Slip(_) => self.own_slip_ends(contact, trigger.after == 0.0)?,
                Trigger::Turn(_) => self.own_turn(contact)?,
                Trigger::Margin(_, side) => self.own_release(contact, side)?,
                Trigger::Load(_) => {}
            }
        }
        Ok(true)
    }

    fn count_tangential(&mut self, contact: usize, trigger: &GuardReached) {
        let level = self.equations.contacts[contact].static_coefficient * self.load(contact);
        if trigger.after > 0.0 && trigger.rate * self.time_scale < NEARLY_TANGENTIAL * level {
            self.near_tangential_releases += 1;
        }
    }

    /// The load of a contact has reached zero, or jumped through it: whether it jumped.
    fn open_or_close(&mut self, contact: usize) -> Result<bool, MotionStopped> {
        if !self.equations.contacts[contact].is_compliant() {
            let contact = self.name(contact);
            return Err(self.stopped(StopReason::LoadVanishes { contact }));
        }
        self.is_stale = true;
        let phase = if self.now[contact].is_open() {
            ContactPhase::Slip(if self.slip(contact).0 < 0.0 { -1 } else { 1 })
        } else {
            ContactPhase::Open
        };
        let jumped = self.load(contact).abs() > JUMP * self.equations.contacts[contact].normal_load;
        let load_zeros = usize::from(!jumped);
        self.now[contact] = ContactNow { load_zeros, ..self.now_in(contact, phase) };
        if !self.now[contact].is_open() {
            self.own_landing(contact)?;
        }
        Ok(jumped)
    }

    /// The contacts at zero slip velocity decide together what they do.
    fn decide(
        &mut self,
        arrived: &[usize],
        reached: &[(usize, i8)],
        holds: bool,
    ) -> MotionProgress {
        let members: Few<usize> =
            (0..self.now.len()).filter(|c| self.now[*c].sticks() || arrived.contains(c)).collect();
        self.is_stale = true;
        if holds {
            for &contact in &members {
                let load_zeros = self.now[contact].load_zeros;
                let stick = ContactNow::of(ContactPhase::Stick);
                self.now[contact] = ContactNow { held: true, load_zeros, ..stick };
            }
            return Ok(());
        }
        if self.are_apart(&members) {
            return self.decide_each(&members, reached);
        }
        if self.equations.follows {
            self.check_unique(&members, &self.tilts())?;
        }
        let Some(selected) = self.moment_of(&members, reached).decide() else {
            let contacts = members.iter().map(|c| self.name(*c)).collect();
            return Err(self.stopped(StopReason::NotUnique { contacts }));
        };
        for (place, &contact) in members.iter().enumerate() {
            let load_zeros = self.now[contact].load_zeros;
            let direction = selected.directions[place];
            let next = if direction == 0 {
                let stick = ContactNow::of(ContactPhase::Stick);
                ContactNow { saturated: selected.saturated[place], ..stick }
            } else {
                let slip = ContactNow::of(ContactPhase::Slip(direction));
                ContactNow { slip_zeros: if selected.is_smooth[place] { 2 } else { 1 }, ..slip }
            };
            self.now[contact] = ContactNow { load_zeros, ..next };
        }
        Ok(())
    }

    /// Whether no contact of a set moves another of them at once.
    pub(super) fn are_apart(&self, members: &[usize]) -> bool {
        let coupling = &self.equations.coupling;
        let apart = |c: &usize| members.iter().all(|d| c == d || coupling[(*c, *d)] == 0.0);
        !self.equations.follows && members.iter().all(apart)
    }

    /// Each contact of such a set decides what it does.
    fn decide_each(&mut self, members: &[usize], reached: &[(usize, i8)]) -> MotionProgress {
        let rates = with_fused_multiply_add(RatesWithout(self, members));
        for &contact in members {
            let equation = &self.equations.contacts[contact];
            let pressed = self.load(contact).max(0.0) * self.factor(contact);
            let moment = LoneMoment {
                coupling: self.equations.coupling[(contact, contact)],
                acceleration: self.acceleration(contact, &rates),
                holding: equation.static_coefficient * pressed,
                sliding: equation.sliding_coefficient * pressed,
                reached: reached.iter().find(|(at, _)| *at == contact).map_or(0, |(_, side)| *side),
            };
            let Some((direction, is_smooth)) = moment.decide() else {
                let contacts = members.iter().map(|c| self.name(*c)).collect();
                return Err(self.stopped(StopReason::NotUnique { contacts }));
            };
            let load_zeros = self.now[contact].load_zeros;
            let phase =
                if direction == 0 { ContactPhase::Stick } else { ContactPhase::Slip(direction) };
            let slip_zeros = if direction == 0 { 0 } else { 1 + usize::from(is_smooth) };
            self.now[contact] = ContactNow { slip_zeros, load_zeros, ..ContactNow::of(phase) };
        }
        Ok(())
    }

    /// γ̇ of a contact, from the rates of the state.
    fn acceleration(&self, contact: usize, rates: &[f64]) -> f64 {
        let surface = &self.forcings.contacts[contact].surface;
        let surface = if surface.is_constant() { 0.0 } else { surface.series(self.clock)[1] };
        surface - self.equations.contacts[contact].tangent.dot(rates)
    }

    /// The conditions of a decision of some contacts.
    pub(super) fn moment_of(&self, members: &[usize], reached: &[(usize, i8)]) -> Moment {
        let rates = with_fused_multiply_add(RatesWithout(self, members));
        let tilts = self.tilts();
        let matrix = coupling(self.equations, members, &tilts);
        let places: Few<usize> = (0..members.len()).collect();
        let is_dependent = independent(&matrix, &places).len() < members.len();
        let accelerations = members.iter().map(|&c| self.acceleration(c, &rates));
        let pressed: Few<f64> =
            members.iter().map(|&c| self.load(c).max(0.0) * self.factor(c)).collect();
        let level = |coefficient: fn(&ContactEquation) -> f64| {
            let contacts = members.iter().map(|c| coefficient(&self.equations.contacts[*c]));
            contacts.zip(&pressed).map(|(coefficient, pressed)| coefficient * pressed).collect()
        };
        Moment {
            accelerations: accelerations.collect(),
            holding: level(|contact| contact.static_coefficient),
            sliding: level(|contact| contact.sliding_coefficient),
            reached: members
                .iter()
                .map(|c| reached.iter().find(|(at, _)| at == c).map_or(0, |(_, side)| *side))
                .collect(),
            coupling: matrix,
            is_dependent,
        }
    }

    pub(super) fn factor(&self, contact: usize) -> f64 {
        let factor = &self.forcings.contacts[contact].factor;
        factor.as_ref().map_or(1.0, |factor| factor.value(self.clock))
    }

    /// ẋ now, without the friction of some contacts.
    #[inline(always)]
    fn rates_without(&self, members: &[usize]) -> SmallVec<[f64; 8]> {
        let state = self.series.start();
        let mut rates: SmallVec<[f64; 8]> = SmallVec::from_elem(0.0, state.len());
        self.equations.matrix.times(state, &mut rates);
        if let (Some(matrices), Some(speed)) = (&self.equations.by_speed, &self.forcings.speed) {
            matrices.add_now(speed, self.clock, state, &mut rates);
        }
        for (rate, constant) in rates.iter_mut().zip(&self.equations.constant) {
            *rate += constant;
        }
        for (push, forcing) in self.equations.pushes.iter().zip(&self.forcings.pushes) {
            push.add_to(forcing.value(self.clock), &mut rates);
        }
        for (index, contact) in self.equations.contacts.iter().enumerate() {
            let forcing = &self.forcings.contacts[index];
            let load = if self.now[index].is_open() { 0.0 } else { self.load(index) };
            let carried = contact.normal_load + forcing.guided.value(self.clock);
            contact.across.add_to(carried - load, &mut rates);
            if let Some(force) = self.own_force(index) {
                contact.along.add_to(force, &mut rates);
                contact.across.add_to(force * contact.slope.dot(state), &mut rates);
                continue;
            }
            let ContactPhase::Slip(sign) = self.now[index].phase else { continue };
            if members.contains(&index) {
                continue;
            }
            let slip = self.slip(index).0;
            let coefficient = if self.now[index].kept {
                // Beyond the border the branch of its phase goes on.
                let mut law = FrictionConstants::of(&self.system.contacts[index].friction);
                let sign = f64::from(sign);
                sign * law.series::<1>(sign, slip / contact.scale).first()
            } else {
                self.system.contacts[index].friction.coefficient(slip.abs())
            };
            let force = f64::from(sign) * coefficient * load * self.factor(index);
            contact.along.add_to(force, &mut rates);
            contact.across.add_to(force * contact.slope.dot(state), &mut rates);
        }
        rates
    }

    /// Reports what has changed, in the order of contacts.
    fn report(
        &mut self,
        before: &[ContactPhase],
        first: GuardReached,
        triggers: &[GuardReached],
    ) -> MotionProgress {
        let after: Few<ContactPhase> = self.now.iter().map(|now| now.phase).collect();
        if after[..] == *before {
            return Ok(());
        }
        let clock = self.clock;
        let others = triggers.iter().filter(|other| other.what != first.what);
        let reached = [&first].into_iter().chain(others).map(|guard| (guard.what, guard.rate));
        // A sign change of γ under an elastic slider changes no rate.
        let decisive = triggers.iter().filter(|guard| !matches!(guard.what, Trigger::Turn(_)));
        self.observer.moment(&MotionMoment {
            after: &after,
            triggers: &reached.collect::<Few<_>>(),
            is_jump: first.after == 0.0 && self.last_break == clock.time(),
            is_one_sided: decisive.count() > 1 && !self.stuck.is_dependent,
        });
        let mut last = None;
        for (contact, (was, is)) in before.iter().zip(&after).enumerate() {
            let Some(kind) = kind_of(*was, *is) else { continue };
            self.events += 1;
            last = Some(contact);
            self.observer.event(&MotionEvent {
                time: clock.time(),
                contact,
                kind,
                slip_sign: is.slip_sign(),
                is_smooth: self.now[contact].slip_zeros == 2,
                state: self.series.start(),
            });
        }
        if clock.time() - self.window.0 > ACCUMULATED * self.time_scale {
            self.window = (clock.time(), 0);
        }
        self.window.1 += 1;
        match last {
            Some(contact) if self.window.1 > MOST_EVENTS_OF_A_CONTACT * before.len() as u64 => {
                let contact = self.name(contact);
                Err(self.stopped(StopReason::Zeno { contact }))
            }
            _ => Ok(()),
        }
    }
}

/// The event between two phases of a contact; `None` where nothing happened.
fn kind_of(was: ContactPhase, is: ContactPhase) -> Option<EventKind> {
    match (was, is) {
        (ContactPhase::Open, ContactPhase::Open) => None,
        (ContactPhase::Open, _) => Some(EventKind::Landing),
        (_, ContactPhase::Open) => Some(EventKind::Separation),
        (ContactPhase::Slip(_), ContactPhase::Stick) => Some(EventKind::Stick),
        (ContactPhase::Stick, ContactPhase::Slip(_)) => Some(EventKind::Release),
        (ContactPhase::Slip(a), ContactPhase::Slip(b)) if a != b => Some(EventKind::Reversal),
        _ => None,
    }
}
