//! Event-exact motion of any system: a linear structure with friction contacts that slip, stick, open and land.
//!
//! * A phase of the motion is what every contact does. Within it the state, and slip velocity, load and friction of every
//!   contact, are Taylor series of order [`ORDER`](crate::simulation::ORDER) (`series`).
//! * A phase ends at the first root of its guards: the slip velocity of a slipping contact, the margin μ_s N ∓ T of a sticking
//!   one, the load of a compliant one. Every root of a step is isolated or proven absent (`guards`).
//! * What follows is decided for all contacts of that moment together (`selection`), by the selection declared there.
//! * Contacts that stick are held by the forces that keep their slip velocities at zero (`stuck`).
//! * Events that accumulate (Zeno behaviour), prescribed loads that vanish and decisions that are not unique end a run with
//!   time, state and contact ([`MotionStopped`]). With symmetric t_cᵀg_d events do not accumulate: friction dissipates, and a slipping
//!   contact under a load above some bound needs a finite change of force between two events. A P-matrix that is not symmetric does
//!   not exclude it (Filippov's relays, in the tests).
//!
//! | file | contents |
//! |---|---|
//! | `equations`, `contact_equation`, `rows`, `rates` | a system as the engine needs it |
//! | `variation`, `change_series` | small changes of the initial state |
//! | `series`, `contact_series`, `step_recurrence`, `expansion`, `stuck` | the Taylor series of a step |
//! | `plain_equations`, `plain_step`, `plain_contacts`, `plain_exchange` | the steps of few coordinates with plain contacts, in vectors |
//! | `own_state`, `own_friction`, `own_events` | contacts with a state of their own: elastic sliders and bristles |
//! | `departure` | how a number that is zero leaves zero |
//! | `contact_in_step` | what each contact does during a step |
//! | `change_block`, `law_along_slip` | several changes side by side, and the slope of a law along a slip |
//! | `guards`, `selection` | what ends a step, and what follows |
//! | `side_by_side` | many runs at once |
//! | `few` | lists of the contacts of a moment, which are few |
//! | `engine`, `drive`, `transitions` | a run, its loop, and what the contacts do at its events |
//! | `one_mass` | runs of systems of one mass, by their own engine |
//! | `phase`, `state`, `observer`, `stopped` | what goes into a run and comes out of it |
//! | `extremes` | extremes of a series on a step |
//! | `contact_meter`, `input_meter`, `row_meter` | integrals over a motion: what contacts do on average, the cost of inputs, a row |
//! | `reading_sampler` | what a sensor reads at given times |

mod change_block;
mod change_series;
mod contact_equation;
mod contact_in_step;
mod contact_meter;
mod contact_series;
mod departure;
mod drive;
mod engine;
mod equations;
mod expansion;
mod extremes;
mod few;
mod guards;
mod input_meter;
mod law_along_slip;
mod lyapunov;
mod mass_piece;
mod observer;
mod one_mass;
mod own_events;
mod own_friction;
mod own_state;
mod phase;
mod plain_contacts;
mod plain_equations;
mod plain_exchange;
mod plain_step;
mod rates;
mod reading_sampler;
mod row_meter;
mod rows;
mod selection;
mod series;
mod side_by_side;
mod speed_terms;
mod state;
mod step_recurrence;
mod stopped;
mod stuck;
mod transitions;
mod variation;

use std::sync::OnceLock;

use quell_model::{OneMass, Profile, System};
use quell_numerics::interval::RealInterval;

use engine::MotionRun;
use equations::MotionEquations;
use one_mass::{PlannedMass, run_mass, shoot_mass};
use selection::first_minor_not_positive;

use crate::simulation::DEFAULT_TOLERANCE;

pub use contact_meter::{ContactMeans, ContactMeter};
pub use engine::MOTION_TOLERANCE;
pub use input_meter::{FedCost, InputCost, InputMeter, NoPower, SeriesCost};
pub use lyapunov::{LyapunovExponent, LyapunovExponents, LyapunovVerdict, NoExponents};
pub use observer::{
    MotionEvent, MotionMoment, MotionObserver, MotionRecorder, MotionSampler, MotionSegment,
    RecordedEvent, Trigger,
};
pub(crate) use one_mass::MassShot;
pub(crate) use own_state::in_steady_sliding;
pub use phase::ContactPhase;
pub use reading_sampler::ReadingSampler;
pub use row_meter::RowMeter;
pub(crate) use row_meter::RowRange;
pub use side_by_side::{PlannedMotion, run_many, run_many_with};
pub use state::{ContactEnd, MotionEnd, MotionStart};
pub use stopped::{Immobile, MotionStopped, StopReason};
pub use variation::MotionVariation;

/// A system whose motion can be computed.
#[derive(Clone, Debug)]
pub struct Motion<'s> {
    system: &'s System,
    engine: MotionEngine,
}

/// What runs a system.
#[derive(Clone, Debug)]
enum MotionEngine {
    /// The engine of one mass runs the belt that the system is; the equations are made where they are asked for.
    OneMass(Box<OneMass>, Box<OnceLock<Result<MotionEquations, Immobile>>>),
    /// The engine for any system.
    General(Box<MotionEquations>),
}

/// Whether a surface has no velocity about which it moves; of one over knots, whether it ever stands still.
fn may_rest(surface: &Profile) -> bool {
    let RealInterval { lower: least, upper: most } = surface.bounds();
    match surface.knots() {
        Some(_) => least <= 0.0 && most >= 0.0,
        None => surface.mean() == 0.0,
    }
}

impl<'s> Motion<'s> {
    /// Checks that sticking has one solution, as far as that does not depend on the state.
    ///
    /// # Errors
    /// [`Immobile`] with the contact and the reason.
    pub fn new(system: &'s System) -> Result<Self, Immobile> {
        if let Some(mass) = system.one_mass() {
            let engine = MotionEngine::OneMass(Box::new(mass), Box::default());
            return Ok(Self { system, engine });
        }
        let equations = MotionEquations::new(system)?;
        let name = |contact: usize| system.contacts[contact].name.clone();
        let mut able = Vec::new();
        for (index, contact) in equations.contacts.iter().enumerate() {
            if contact.own.is_some() {
                continue;
            }
            if contact.can_stick() {
                able.push(index);
                if equations.coupling[(index, index)] <= 0.0 {
                    return Err(Immobile::Unopposed { contact: name(index) });
                }
            } else if may_rest(&system.contacts[index].surface_velocity) {
                return Err(Immobile::AtRest { contact: name(index) });
            }
        }
        let matrix = stuck::coupling(&equations, &able, &vec![0.0; equations.contacts.len()]);
        let is_symmetric = system.structure.mechanical().is_some();
        if !is_symmetric && let Some(set) = first_minor_not_positive(&matrix) {
            return Err(Immobile::NotUnique {
                contacts: set.into_iter().map(|place| name(able[place])).collect(),
            });
        }
        Ok(Self { system, engine: MotionEngine::General(Box::new(equations)) })
    }

    /// The system.
    pub fn system(&self) -> &'s System {
        self.system
    }

    /// Length of the state: that of the structure, and after it one number for each contact with a state of its own, in the order of
    /// the contacts ([`Contact::has_state`](quell_model::Contact::has_state)).
    pub fn size(&self) -> usize {
        match &self.engine {
            MotionEngine::OneMass(..) => mass_piece::SIZE,
            MotionEngine::General(equations) => equations.size,
        }
    }

    /// Length of the state of the structure.
    pub fn structure_size(&self) -> usize {
        match &self.engine {
            MotionEngine::OneMass(..) => mass_piece::SIZE,
            MotionEngine::General(equations) => equations.structure_size,
        }
    }

    /// The state of the structure with the contacts' own numbers at zero, as a study begins: sliders and bristles without load.
    ///
    /// # Panics
    /// If `structure` has not as many numbers as the state of the structure.
    pub fn relaxed(&self, structure: &[f64]) -> Vec<f64> {
        assert_eq!(structure.len(), self.structure_size(), "numbers of the structure");
        let mut state = structure.to_vec();
        state.resize(self.size(), 0.0);
        state
    }

    /// Time scale of the system: the reciprocal of its fastest rate.
    pub fn time_scale(&self) -> f64 {
        let own = self.one_mass().map_or(1.0, OneMass::rate);
        1.0 / self.equations().map_or(own, |equations| equations.rates.of_all)
    }

    /// The equations of the engine for any system.
    fn equations(&self) -> Result<&MotionEquations, Immobile> {
        match &self.engine {
            MotionEngine::OneMass(_, equations) => equations
                .get_or_init(|| MotionEquations::new(self.system))
                .as_ref()
                .map_err(Clone::clone),
            MotionEngine::General(equations) => Ok(equations),
        }
    }

    /// The belt that the system is; `None` if it is none.
    fn one_mass(&self) -> Option<&OneMass> {
        match &self.engine {
            MotionEngine::OneMass(mass, _) => Some(mass),
            MotionEngine::General(_) => None,
        }
    }

    /// The bound on the last terms of a step for runs from which no periodic motion is computed: [`MOTION_TOLERANCE`], of a system of one
    /// mass that of a belt ([`DEFAULT_TOLERANCE`]); or `asked`, relative to the load, of other systems where it is smaller.
    pub fn run_tolerance(&self, asked: Option<f64>) -> f64 {
        let bound = self.bound_of_runs(asked);
        if self.one_mass().is_some() { bound / one_mass::OF_THE_LOAD } else { bound }
    }

    /// What [`Motion::run_tolerance`] bounds: the last terms over the numbers of the state, or of one mass over the load.
    pub fn bound_of_runs(&self, asked: Option<f64>) -> f64 {
        match self.one_mass() {
            Some(_) => asked.unwrap_or(DEFAULT_TOLERANCE),
            None => asked.map_or(MOTION_TOLERANCE, |asked| asked.min(MOTION_TOLERANCE)),
        }
    }

    /// Integrates from `start` to t = `until` and passes every segment and event to `observer`.
    ///
    /// `tolerance` bounds the last two retained Taylor terms of a step ([`MOTION_TOLERANCE`]), relative to each number of the state; of
    /// a system of one mass a tenth of it bounds them relative to the load, as a displacement.
    ///
    /// # Errors
    /// [`MotionStopped`] with time, state and reason.
    ///
    /// A start with the state of the structure alone begins with the contacts' own numbers at zero ([`Motion::relaxed`]).
    ///
    /// # Panics
    /// If `start` has not as many numbers as the state, or as the state of the structure.
    pub fn run(
        &self,
        start: &MotionStart,
        until: f64,
        tolerance: f64,
        observer: &mut dyn MotionObserver,
    ) -> Result<MotionEnd, MotionStopped> {
        self.continued(start, &[], (until, tolerance), observer)
    }

    /// The state with T of the elastic sliders that nearly are at their sliding levels put at them, where they slide from there on, and
    /// these contacts; `None` where no T changes.
    pub(crate) fn at_sliding_levels(&self, state: &[f64]) -> Option<(Vec<f64>, Vec<usize>)> {
        if !self.system.contacts.iter().any(|contact| contact.tangential_stiffness.is_some()) {
            return None;
        }
        let MotionEngine::General(equations) = &self.engine else { return None };
        let parts = (self.system, equations.as_ref());
        let start = MotionStart { time: 0.0, state: state.to_vec() };
        MotionRun::new(parts, &start, f64::INFINITY, MOTION_TOLERANCE, &mut ()).at_sliding_levels()
    }

    /// A run of one mass from a state at t = 0 with its derivative, on the branch of slip with a sign or as it is; `None` for other
    /// systems.
    pub(crate) fn mass_shot(
        &self,
        (state, until): (&[f64], f64),
        sign: Option<i8>,
        tolerance: f64,
    ) -> Option<Result<MassShot, MotionStopped>> {
        let mass = self.one_mass()?;
        let start = MotionStart { time: 0.0, state: state.to_vec() };
        Some(shoot_mass(mass, (&start, until), sign, tolerance))
    }

    /// [`Motion::run`] with some contacts kept in these phases: the smooth continuation of a motion beyond the borders of the phases,
    /// which is no motion of the system there. A kept contact has no events.
    pub(crate) fn continued(
        &self,
        start: &MotionStart,
        phases: &[Option<ContactPhase>],
        (until, tolerance): (f64, f64),
        observer: &mut dyn MotionObserver,
    ) -> Result<MotionEnd, MotionStopped> {
        let equations = match &self.engine {
            MotionEngine::OneMass(mass, _) => {
                let sign = phases.first().copied().flatten().map(ContactPhase::slip_sign);
                let run = PlannedMass { mass, start: start.clone(), until, observer };
                return run_mass(run, sign, tolerance);
            }
            MotionEngine::General(equations) => equations.as_ref(),
        };
        let relaxed;
        let start = if start.state.len() == self.size() {
            start
        } else {
            relaxed = MotionStart { time: start.time, state: self.relaxed(&start.state) };
            &relaxed
        };
        let parts = (self.system, equations);
        MotionRun::new(parts, start, until, tolerance, observer).keeping(phases).run()
    }
}
