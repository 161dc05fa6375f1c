//! Systems of one mass, whose runs are those of [`crate::simulation`], in the units and to the observers of a system.
//!
//! The engine for one mass knows stick in closed form, for as long as it lasts. Here it is shown in pieces, each a Taylor series with
//! the friction that holds the mass, so that one kind of observer sees every motion. What a run computes depends on no observer.

use std::cell::{OnceCell, RefCell};

use quell_model::friction::FrictionConstants;
use quell_model::{Belt, Direction, OneMass};
use quell_numerics::dispatch::{InstructionSet, Work, with_fused_multiply_add};
use quell_numerics::matrix::Matrix;
use quell_numerics::polynomial::{derivative, step_length, value};

use super::contact_series::ContactSeries;
use super::mass_piece::{MassPiece, MassStates, SIZE};
use super::observer::{
    MotionEvent, MotionMoment, MotionObserver, MotionSegment, RecordedEvent, SegmentSeries, Trigger,
};
use super::own_state::law_of;
use super::phase::{ContactNow, ContactPhase};
use super::state::{ContactEnd, MotionEnd, MotionStart};
use super::stopped::{MotionStopped, StopReason};
use crate::simulation::{
    Clock, Event, EventKind, EventRecorder, FinalState, Forcing, ORDER, Observer, Segment, Series,
    SimulationRun, Stalled, Start, Variation, continue_slip, simulate, simulate_many_with,
};

/// Slip velocities below this multiple of their rounding are zero at the start of a run, as for systems in general: a state of stick that
/// a search has computed comes to rest. With a much larger value a start that slips would stick.
const AT_REST: f64 = 32.0 * f64::EPSILON;

/// Last terms of a piece of stick over its friction and load: below their rounding. With a larger value means and samples of friction in
/// stick would be that much off; the motion takes no part in it.
const NEGLIGIBLE: f64 = 1e-15;

/// A run of a system of one mass.
pub(super) struct PlannedMass<'a> {
    pub(super) mass: &'a OneMass,
    pub(super) start: MotionStart,
    pub(super) until: f64,
    pub(super) observer: &'a mut dyn MotionObserver,
}

/// Integrates a run of a system of one mass; with a sign on that branch of slip, beyond v_r = 0 too.
pub(super) fn run_mass(
    PlannedMass { mass, start, until, observer }: PlannedMass<'_>,
    sign: Option<i8>,
    tolerance: f64,
) -> Result<MotionEnd, MotionStopped> {
    let mut view = MassView::new(mass, &start, observer);
    let (units, span) = (view.units, (view.start, mass.rate() * until));
    let sign = sign.map(|sign| units.sign(sign));
    let outcome = run_belt(mass.belt(), span, sign, tolerance, &mut view);
    units.outcome(outcome, until)
}

/// Integrates the belt of a mass, on a branch of slip or as it is.
fn run_belt(
    belt: &Belt,
    (start, until): (Start, f64),
    sign: Option<i8>,
    tolerance: f64,
    observer: &mut dyn Observer,
) -> Result<FinalState, Stalled> {
    let tolerance = OF_THE_LOAD * tolerance;
    match sign {
        Some(sign) => continue_slip(belt, f64::from(sign), start, until, tolerance, observer),
        None => simulate(belt, start, until, tolerance, observer),
    }
}

/// A run with the derivative of its end, and its events.
pub(crate) struct MassShot {
    pub(crate) end: MotionEnd,
    /// Derivative of the final state with respect to the initial state.
    pub(crate) derivative: Matrix,
    pub(crate) events: Vec<RecordedEvent>,
    /// Least slip velocity in the direction of slip; infinite without slip.
    pub(crate) least_slip: f64,
}

/// Integrates a run with the matrix of changes of the belt ([`Variation`]): on the branch of slip with a sign, beyond v_r = 0 too, or as
/// it is.
pub(super) fn shoot_mass(
    mass: &OneMass,
    (start, until): (&MotionStart, f64),
    sign: Option<i8>,
    tolerance: f64,
) -> Result<MassShot, MotionStopped> {
    let (belt, units) = (mass.belt(), MassUnits { mass });
    let mut observer = (Variation::new(belt), EventRecorder::default());
    let span = (units.start(start), mass.rate() * until);
    let sign = sign.map(|sign| units.sign(sign));
    let outcome = run_belt(belt, span, sign, tolerance, &mut observer);
    let end = units.outcome(outcome, until)?;
    let (variation, recorder) = observer;
    // What one of each number of the belt's state is in that of the system.
    let scales = [mass.displacement(), 1.0 / mass.tangent()];
    let matrix = variation.matrix;
    let events = recorder.events.iter().map(|event| RecordedEvent {
        time: event.time / mass.rate(),
        contact: 0,
        kind: event.kind,
        slip_sign: units.sign(event.slip_sign),
        state: units.state(event.displacement, event.velocity).to_vec(),
    });
    Ok(MassShot {
        end,
        derivative: Matrix::from_fn(SIZE, SIZE, |i, j| matrix[i][j] * scales[i] / scales[j]),
        events: events.collect(),
        least_slip: variation.least.map_or(f64::INFINITY, |(least, _)| least),
    })
}

/// Bound on the last terms of a step relative to F, over that relative to the numbers of the state: with it judges run one mass at 10⁻¹⁴
/// of the load, as the orbits of belts are computed. With 1 the period of a limit cycle was 7·10⁻¹² off.
pub(super) const OF_THE_LOAD: f64 = 0.1;

/// Integrates runs of systems of one mass side by side. The results are in the order of the runs.
pub(super) fn run_masses(
    set: InstructionSet,
    runs: Vec<PlannedMass<'_>>,
    tolerance: f64,
) -> Vec<Result<MotionEnd, MotionStopped>> {
    let mut views: Vec<(f64, MassView<'_>)> = Vec::with_capacity(runs.len());
    for PlannedMass { mass, start, until, observer } in runs {
        views.push((until, MassView::new(mass, &start, observer)));
    }
    let planned = views.iter_mut().map(|(until, view)| {
        let (belt, start) = (view.units.mass.belt(), view.start);
        SimulationRun { belt, start, until: view.units.mass.rate() * *until, observer: view }
    });
    let outcomes = simulate_many_with(set, planned.collect(), OF_THE_LOAD * tolerance);
    let ends = outcomes.into_iter().zip(&views);
    ends.map(|(outcome, (until, view))| view.units.outcome(outcome, *until)).collect()
}

/// The numbers of a belt in those of its system.
#[derive(Clone, Copy)]
struct MassUnits<'a> {
    mass: &'a OneMass,
}

impl MassUnits<'_> {
    fn start(self, start: &MotionStart) -> Start {
        let mass = self.mass;
        let (displacement, velocity) = mass.of_state(&start.state);
        let surface = mass.belt().belt_velocity();
        let rests = (surface - velocity).abs() <= AT_REST * (surface.abs() + velocity.abs());
        Start {
            time: mass.rate() * start.time,
            displacement,
            velocity: if rests { surface } else { velocity },
        }
    }

    fn state(self, displacement: f64, velocity: f64) -> [f64; SIZE] {
        self.mass.state(displacement, velocity)
    }

    /// A sign of slip of the contact as that of the belt, or the reverse.
    fn sign(self, slip_sign: i8) -> i8 {
        if self.mass.direction() < 0.0 { -slip_sign } else { slip_sign }
    }

    fn phase(self, slip_sign: i8) -> ContactPhase {
        phase_of(self.sign(slip_sign))
    }

    /// A moment of the belt.
    fn clock(self, clock: Clock) -> Clock {
        let rate = self.mass.rate();
        if rate == 1.0 {
            return clock;
        }
        let time = clock.time() / rate;
        let rest = f64::mul_add(-time, rate, clock.time()) + clock.low();
        Clock::at(time).after(rest / rate)
    }

    fn outcome(
        self,
        outcome: Result<FinalState, Stalled>,
        until: f64,
    ) -> Result<MotionEnd, MotionStopped> {
        outcome.map(|end| self.end(&end, until)).map_err(|stalled| self.stopped(&stalled))
    }

    fn end(self, end: &FinalState, until: f64) -> MotionEnd {
        let (mass, belt) = (self.mass, self.mass.belt());
        let slip = if end.sticking { 0.0 } else { belt.belt_velocity() - end.velocity };
        let load = belt.normal_load_at(end.time);
        let friction = if end.sticking {
            holding_force(belt, end.displacement, end.time)
        } else {
            f64::from(end.slip_sign) * belt.friction().coefficient(slip.abs()) * load
        };
        let (phase, direction) = (self.phase(end.slip_sign), mass.direction());
        MotionEnd {
            time: if end.time == mass.rate() * until { until } else { end.time / mass.rate() },
            state: self.state(end.displacement, end.velocity).to_vec(),
            contacts: vec![ContactEnd {
                phase,
                slip_velocity: direction * slip,
                friction: direction * mass.force() * friction,
                normal_load: mass.force() * load,
                bristle: None,
            }],
            events: end.events,
            steps: end.steps,
            near_tangential_releases: end.near_tangential_releases,
            dependent: Vec::new(),
        }
    }

    fn stopped(self, stalled: &Stalled) -> MotionStopped {
        let Stalled { time, displacement, velocity, why } = *stalled;
        MotionStopped {
            time: time / self.mass.rate(),
            state: self.state(displacement, velocity).to_vec(),
            reason: StopReason::Stalled(why),
        }
    }
}

/// The friction that holds the mass of a belt in stick, a length: 2ζv₀ + x − Σ D_T g_T.
fn holding_force(belt: &Belt, displacement: f64, time: f64) -> f64 {
    let damper = 2.0 * belt.damping_ratio() * belt.belt_velocity();
    damper + displacement - belt.dither_force(Direction::Tangential, time)
}

fn phase_of(slip_sign: i8) -> ContactPhase {
    if slip_sign == 0 { ContactPhase::Stick } else { ContactPhase::Slip(slip_sign) }
}

/// Shows a run of the belt to an observer of the system.
struct MassView<'a> {
    units: MassUnits<'a>,
    start: Start,
    observer: &'a mut dyn MotionObserver,
    law: RefCell<FrictionConstants>,
    /// Length unit of the engine: the law's velocity scale.
    unit: f64,
    tangential: Forcing,
    normal: Forcing,
    /// The series of the last piece, and its length.
    states: MassStates,
    contact: ContactSeries,
    now: ContactNow,
    length: f64,
    /// Powers of ω.
    rates: Series,
}

impl<'a> MassView<'a> {
    fn new(mass: &'a OneMass, start: &MotionStart, observer: &'a mut dyn MotionObserver) -> Self {
        let units = MassUnits { mass };
        let start = units.start(start);
        let belt = mass.belt();
        let (unit, clock) = (belt.friction().velocity_scale(), Clock::at(start.time));
        let (tangential, normal) = Forcing::acting(belt, unit, clock);
        let mut rates = [1.0; ORDER + 1];
        for k in 1..=ORDER {
            rates[k] = rates[k - 1] * mass.rate();
        }
        let mut contact = ContactSeries::zero();
        contact.surface[0] = mass.direction() * belt.belt_velocity();
        let mut view = Self {
            start,
            observer,
            law: RefCell::new(law_of(belt.friction())),
            unit,
            tangential,
            normal,
            states: [0.0; (ORDER + 1) * SIZE],
            contact,
            now: ContactNow::of(ContactPhase::Stick),
            length: 0.0,
            rates,
            units,
        };
        view.now = ContactNow::of(view.phase_at_start());
        if view.normal.is_constant() {
            view.contact.load[0] = units.mass.force() * belt.normal_load();
            view.contact.given[0] = view.contact.load[0];
            view.contact.pressed[0] = view.contact.load[0];
        }
        view
    }

    /// What the contact does first, as far as no event says it.
    fn phase_at_start(&self) -> ContactPhase {
        let (belt, start) = (self.units.mass.belt(), &self.start);
        let slip = belt.belt_velocity() - start.velocity;
        let direction = if slip == 0.0 {
            let force = holding_force(belt, start.displacement, start.time);
            let holds = force.abs()
                <= belt.friction().static_coefficient() * belt.normal_load_at(start.time);
            if holds { 0.0 } else { force }
        } else {
            slip
        };
        self.units.phase(i8::from(direction > 0.0) - i8::from(direction < 0.0))
    }

    /// Passes on a piece of stick, whose series have been written.
    fn emit_stick(&mut self, clock: Clock, duration: f64) {
        let series = SegmentSeries::Known {
            states: &self.states,
            contacts: std::slice::from_ref(&self.contact),
            pushes: &[],
        };
        self.length = duration / self.units.mass.rate();
        let segment = Shown { clock, duration, series, now: &self.now };
        self.observer.segment(&segment.in_units(self.units));
    }

    /// Passes on a step of slip.
    fn emit_slip(&mut self, segment: &Segment<'_>) {
        let (clock, duration) = (segment.clock(), segment.duration());
        let piece = MassPiece {
            mass: self.units.mass,
            raw: segment.series(),
            unit: self.unit,
            rates: &self.rates,
            sign: f64::from(self.now.phase.slip_sign()),
            law: &self.law,
            contact: &self.contact,
            states: OnceCell::new(),
            complete: OnceCell::new(),
        };
        self.length = duration / self.units.mass.rate();
        let segment =
            Shown { clock, duration, series: SegmentSeries::OfMass(&piece), now: &self.now };
        self.observer.segment(&segment.in_units(self.units));
    }

    /// The rate at which the guard that ended the last piece reached zero.
    fn rate(&self, trigger: Trigger) -> f64 {
        let (contact, after) = (&self.contact, self.length);
        let slope = |series: &Series| value(&derivative(series), after);
        match trigger {
            Trigger::Margin(_, side) => {
                let level = self.units.mass.belt().friction().static_coefficient();
                f64::from(side) * slope(&contact.friction) - level * slope(&contact.pressed)
            }
            _ => -f64::from(self.now.phase.slip_sign()) * slope(&contact.slip),
        }
    }
}

impl Observer for MassView<'_> {
    fn segment(&mut self, segment: &Segment<'_>) {
        self.now = ContactNow::of(self.units.phase(segment.slip_sign()));
        let (mut clock, mut rest) = (segment.clock(), segment.duration());
        if segment.slip_sign() != 0 {
            self.pass_breaks(clock);
            with_fused_multiply_add(SlipWritten { view: self, clock, slip: segment.series().1 });
            self.emit_slip(segment);
            return;
        }
        let mut displacement = segment.displacement(0.0);
        while rest > 0.0 {
            self.pass_breaks(clock);
            let room = clock.until(self.tangential.next_break().min(self.normal.next_break()));
            let longest = with_fused_multiply_add(StickWritten { view: self, clock, displacement });
            let duration = longest.min(room).min(rest);
            self.emit_stick(clock, duration);
            displacement =
                f64::mul_add(self.units.mass.belt().belt_velocity(), duration, displacement);
            clock = clock.after(duration);
            rest -= duration;
        }
    }

    fn event(&mut self, event: &Event) {
        let slip_sign = self.units.sign(event.slip_sign);
        let after = phase_of(slip_sign);
        let trigger = match event.kind {
            EventKind::Release => Trigger::Margin(0, slip_sign),
            _ => Trigger::Slip(0),
        };
        let rate = self.rate(trigger);
        let state = self.units.state(event.displacement, event.velocity);
        let time = event.time / self.units.mass.rate();
        self.now = ContactNow::of(after);
        self.observer.moment(&MotionMoment {
            after: &[after],
            triggers: &[(trigger, rate)],
            is_jump: event.is_jump,
            is_one_sided: false,
        });
        let law = self.units.mass.belt().friction();
        self.observer.event(&MotionEvent {
            time,
            contact: 0,
            kind: event.kind,
            slip_sign,
            is_smooth: event.kind == EventKind::Release
                && !event.is_jump
                && law.starts_at_static_level(),
            state: &state,
        });
    }

    fn watches(&self) -> bool {
        self.observer.watches()
    }
}

impl MassView<'_> {
    fn pass_breaks(&mut self, clock: Clock) {
        for forcing in [&mut self.tangential, &mut self.normal] {
            if clock.until(forcing.next_break()) <= 0.0 {
                forcing.pass_breaks(clock);
            }
        }
    }
}

/// A piece in the time of the belt.
struct Shown<'p> {
    clock: Clock,
    duration: f64,
    series: SegmentSeries<'p>,
    now: &'p ContactNow,
}

impl<'p> Shown<'p> {
    fn in_units(self, units: MassUnits<'_>) -> MotionSegment<'p> {
        MotionSegment {
            clock: units.clock(self.clock),
            duration: self.duration / units.mass.rate(),
            size: SIZE,
            series: self.series,
            now: std::slice::from_ref(self.now),
        }
    }
}

/// Writes load and slip of a step of slip.
struct SlipWritten<'v, 'a, 's> {
    view: &'v mut MassView<'a>,
    clock: Clock,
    slip: &'s [f64],
}

impl Work for SlipWritten<'_, '_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { view, clock, slip } = self;
        view.load(clock, view.unit * view.units.mass.force());
        let (contact, unit) = (&mut view.contact, view.unit);
        let direction = view.units.mass.direction();
        // A step of slip has all terms; with a known number of them the compiler needs no checks.
        let Some(slip) = slip.first_chunk::<{ ORDER + 1 }>() else { return };
        for (scaled, (slip, rate)) in contact.scaled.iter_mut().zip(slip.iter().zip(&view.rates)) {
            *scaled = direction * slip * rate;
        }
        contact.slip = contact.scaled.map(|term| unit * term);
    }
}

/// Writes the series of stick from a displacement on. Returns how long a piece they describe, in the time of the belt.
struct StickWritten<'v, 'a> {
    view: &'v mut MassView<'a>,
    clock: Clock,
    displacement: f64,
}

impl Work for StickWritten<'_, '_> {
    type Output = f64;

    #[inline(always)]
    fn run(self) -> f64 {
        let Self { view, clock, displacement } = self;
        let belt = view.units.mass.belt();
        let unit = view.unit;
        let load = view.load(clock, unit * view.units.mass.force());
        let velocity = belt.belt_velocity();
        let dither = view.tangential.series(clock);
        let damper = 2.0 * belt.damping_ratio() * velocity;
        let mut friction = dither.map(|term| -unit * term);
        friction[0] += damper + displacement;
        friction[1] += velocity;
        view.show_stick(displacement, &friction);
        let size = friction.iter().take(2).fold(belt.normal_load(), |a, b| a.max(b.abs()));
        let last = |k: usize| {
            let load = load.as_ref().map_or(0.0, |load| unit * load[k]);
            friction[k].abs() + load.abs()
        };
        step_length(NEGLIGIBLE * size, last(ORDER), last(ORDER - 1), ORDER)
    }
}

impl MassView<'_> {
    /// Writes the series of the load where it varies, and returns it in the units of the engine.
    #[inline(always)]
    fn load(&mut self, clock: Clock, force: f64) -> Option<Series> {
        if self.normal.is_constant() {
            return None;
        }
        let load = self.normal.series(clock);
        let terms = self.contact.load.iter_mut().zip(&load).zip(&self.rates);
        terms.for_each(|((term, load), rate)| *term = force * load * rate);
        self.contact.given = self.contact.load;
        self.contact.pressed = self.contact.load;
        Some(load)
    }

    #[inline(always)]
    fn show_stick(&mut self, displacement: f64, friction: &Series) {
        let Self { units, contact, states, rates, .. } = self;
        let mass = units.mass;
        let velocity = mass.belt().belt_velocity();
        states.fill(0.0);
        [states[0], states[1]] = units.state(displacement, velocity);
        states[2] = states[1];
        contact.slip = [0.0; ORDER + 1];
        contact.scaled = [0.0; ORDER + 1];
        contact.coefficient = [0.0; ORDER + 1];
        for k in 0..=ORDER {
            contact.friction[k] = mass.direction() * mass.force() * friction[k] * rates[k];
        }
    }
}
