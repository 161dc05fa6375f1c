//! The loop of runs: in vectors where their contacts are plain, else step by step.

use quell_numerics::dispatch::{LaneWork, only_in_four_lanes};
use quell_numerics::lane::Lane;

use super::engine::{MotionProgress, MotionRun};
use super::plain_contacts::{PlainVectors, plain_of};
use super::plain_equations::MOST;
use super::plain_step::runs_of;
use super::state::MotionEnd;
use super::stopped::MotionStopped;

impl MotionRun<'_> {
    /// Runs to the end.
    pub(super) fn run(mut self) -> Result<MotionEnd, MotionStopped> {
        self.open()?;
        run_to_end(&mut self)?;
        self.end()
    }
}

/// A run to its end, in vectors where its contacts are plain.
fn run_to_end(run: &mut MotionRun<'_>) -> MotionProgress {
    let mut ended = Ok(());
    to_their_ends(&mut [run], &mut |_, end| ended = end);
    ended
}

/// Runs to their ends, which begin in their order: in vectors where the contacts of all are plain and their laws alike. Each end is
/// reported with the number of its run.
pub(super) fn to_their_ends(
    runs: &mut [&mut MotionRun<'_>],
    finish: &mut dyn FnMut(usize, MotionProgress),
) {
    if let Err(PlainRuns(runs, finish)) = only_in_four_lanes(PlainRuns(runs, finish)) {
        one_by_one(runs, finish);
    }
}

/// Runs by the equations of any system.
pub(super) fn one_by_one(
    runs: &mut [&mut MotionRun<'_>],
    finish: &mut dyn FnMut(usize, MotionProgress),
) {
    for (number, run) in runs.iter_mut().enumerate() {
        finish(number, step_by_step(run));
    }
}

/// A run by the equations of any system.
fn step_by_step(run: &mut MotionRun<'_>) -> MotionProgress {
    while !run.is_over() {
        run.step()?;
    }
    Ok(())
}

/// The places that the coordinates and contacts of a run take in vectors; `None` if it does not suit them.
pub(super) fn places_of(run: &MotionRun<'_>) -> Option<usize> {
    let plain = plain_of(run)?;
    // Places without a coordinate or a contact hold zeros, and cost time alone.
    Some(if plain.coordinates.max(plain.contacts) <= 2 { 2 } else { MOST })
}

struct PlainRuns<'r, 'm, 'a>(
    &'r mut [&'m mut MotionRun<'a>],
    &'r mut dyn FnMut(usize, MotionProgress),
);

impl LaneWork for PlainRuns<'_, '_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lane>(self) {
        let Self(runs, finish) = self;
        let places = runs.iter().map(|run| places_of(run)).max().flatten();
        let are_plain = runs.iter().all(|run| places_of(run).is_some());
        match places.filter(|_| are_plain) {
            Some(2) => in_vectors::<V, 2>(runs, finish),
            Some(_) => in_vectors::<V, MOST>(runs, finish),
            None => one_by_one(runs, finish),
        }
    }
}

/// Runs in vectors of `N` places for each: as many at a time as there are places for, the next when one has ended.
#[inline(always)]
fn in_vectors<V: Lane, const N: usize>(
    runs: &mut [&mut MotionRun<'_>],
    finish: &mut dyn FnMut(usize, MotionProgress),
) {
    let mut waiting = runs.iter_mut().enumerate();
    let mut slots: Vec<&mut MotionRun<'_>> = Vec::with_capacity(2);
    let mut numbers = Vec::with_capacity(2);
    for (number, run) in waiting.by_ref().take(runs_of(N)) {
        numbers.push(number);
        slots.push(run);
    }
    let mut vectors = PlainVectors::<V, N>::of(&slots);
    while !slots.is_empty() {
        let ended = match &mut vectors {
            Some(vectors) => vectors.advance(&mut slots),
            // Laws that differ in more than numbers.
            None => [Some(step_by_step(slots[0])), None],
        };
        for (place, end) in ended.into_iter().enumerate().rev() {
            let Some(end) = end else { continue };
            finish(numbers[place], end);
            if let Some((number, run)) = waiting.next() {
                (numbers[place], slots[place]) = (number, run);
                vectors = vectors
                    .and_then(|mut vectors| vectors.replace(place, &slots).map(|()| vectors));
            } else {
                numbers.remove(place);
                slots.remove(place);
                vectors = PlainVectors::of(&slots);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use quell_model::friction::{Expression, Friction, Surroundings};
    use quell_model::profile::{Profile, Wave};
    use quell_model::system::{Contact, Input, InputTarget, MassMatrix, Mechanical};
    use quell_model::{LawKind, System, Waveform};
    use quell_numerics::matrix::Matrix;

    use super::*;
    use crate::motion::{
        ContactPhase, MOTION_TOLERANCE, Motion, MotionObserver, MotionRecorder, MotionSegment,
        MotionStart, RecordedEvent,
    };
    use crate::simulation::ORDER;

    fn wave(waveform: Waveform, amplitude: f64, frequency: f64) -> Wave {
        Wave { waveform, amplitude, frequency, phase: 0.3, envelope: None }
    }

    fn law(kind: LawKind, contact: usize) -> Friction {
        let level = 0.4 - 0.03 * contact as f64;
        if kind == LawKind::Expression {
            let constants = [("a".to_owned(), 0.3 * level), ("b".to_owned(), 0.1)];
            let text = "0.2 + a*exp(-(v/b)^2) + 0.02*tanh(abs(v))/(1 + abs(v))";
            let law = Expression::new(text, &constants, Some(level), 1.0).expect(text);
            let around = Surroundings { normal_load: 1.0, slip: 1.0 };
            return Friction::Expression(law).placed(&around).expect(text);
        }
        let values = match kind {
            LawKind::Coulomb => vec![0.7 * level, level, 0.02],
            LawKind::StribeckExponential => vec![0.7 * level, level, 0.1, 1.0, 0.02],
            _ => vec![level, 0.7 * level, 0.2],
        };
        kind.build(&values).expect("values within their bounds")
    }

    /// A chain of masses, each on a surface of its own, with off-diagonal masses, a moving surface and two forces.
    fn chain(coordinates: usize, contacts: usize, kind: LawKind) -> System {
        let mass = Matrix::from_fn(coordinates, coordinates, |i, j| match i.abs_diff(j) {
            0 => 1.0 + 0.2 * i as f64,
            1 => 0.1,
            _ => 0.0,
        });
        let stiffness = Matrix::from_fn(coordinates, coordinates, |i, j| match i.abs_diff(j) {
            0 => 2.2,
            1 => -0.9,
            _ => 0.0,
        });
        let damping =
            Matrix::from_fn(coordinates, coordinates, |i, j| if i == j { 0.02 } else { 0.0 });
        let at = |place: usize| {
            (0..coordinates).map(|i| f64::from(u8::from(i == place))).collect::<Vec<_>>()
        };
        let contact = |number: usize| Contact {
            name: format!("pad {number}"),
            tangent: Some(at(number % coordinates)),
            force: None,
            normal: None,
            slope: None,
            normal_load: 1.0 + 0.3 * number as f64,
            normal_stiffness: 0.0,
            tangential_stiffness: None,
            normal_damping: 0.0,
            surface_velocity: match number {
                1 => Profile::constant(0.06).with(wave(Waveform::Sine, 0.02, 3.0)),
                _ => Profile::constant(0.05),
            },
            friction: law(kind, number),
            varying_load: None,
        };
        let force = |place: usize, wave| Input {
            target: InputTarget::Force(at(place)),
            profile: Profile::default().with(wave),
        };
        let names = (0..coordinates).map(|i| format!("x{i}")).collect();
        System {
            structure: Mechanical::new(names, MassMatrix::dense(mass), damping, stiffness).into(),
            contacts: (0..contacts).map(contact).collect(),
            inputs: vec![
                force(0, wave(Waveform::Sine, 0.35, 10.0)),
                force(coordinates - 1, wave(Waveform::Triangle, 0.1, 7.0)),
            ],
        }
    }

    /// Keeps every series that observers read of a step.
    #[derive(Default)]
    struct SeriesRecorder(Vec<[f64; ORDER + 1]>);

    impl MotionObserver for SeriesRecorder {
        fn segment(&mut self, segment: &MotionSegment<'_>) {
            let states = segment.states();
            let size = states.len() / (ORDER + 1);
            self.0.extend((0..size).map(|i| std::array::from_fn(|k| states[k * size + i])));
            self.0.extend((0..).map_while(|push| segment.force(push)));
            for number in 0..segment.now.len() {
                let contact = segment.contact(number);
                let (load, pressed) = (contact.load, contact.pressed);
                self.0.extend([contact.slip, contact.friction, contact.surface, load, pressed]);
                // The law's variable is that of a contact that slips.
                if matches!(segment.phase(number), ContactPhase::Slip(_)) {
                    self.0.push(contact.scaled);
                }
            }
        }
    }

    #[test]
    fn observers_read_the_same_series_of_both_loops() {
        for (coordinates, contacts) in [(1, 2), (2, 2), (3, 2), (4, 4)] {
            let system = chain(coordinates, contacts, LawKind::Stribeck);
            let motion = Motion::new(&system).expect("a system that moves");
            let series = |all: fn(&mut MotionRun<'_>) -> MotionProgress| {
                let start = MotionStart { time: 0.0, state: vec![0.0; motion.size()] };
                let mut recorder = SeriesRecorder::default();
                let system = (motion.system, motion.equations().expect("equations"));
                let mut run = MotionRun::new(system, &start, 20.0, MOTION_TOLERANCE, &mut recorder);
                run.open().expect("a start");
                all(&mut run).expect("a motion to the end");
                recorder.0
            };
            let (one, other) = (series(run_to_end), series(step_by_step));
            assert!(
                one.len() > 1000 && one == other,
                "{coordinates} coordinates, {contacts} contacts"
            );
        }
    }

    /// The end and the events of a run that takes its steps by `all`.
    fn run_by(
        motion: &Motion<'_>,
        all: fn(&mut MotionRun<'_>) -> MotionProgress,
    ) -> (Result<MotionEnd, MotionStopped>, Vec<RecordedEvent>) {
        let start = MotionStart { time: 0.0, state: vec![0.0; motion.size()] };
        let mut recorder = MotionRecorder::default();
        let system = (motion.system, motion.equations().expect("a mass for each coordinate"));
        let mut run = MotionRun::new(system, &start, 60.0, MOTION_TOLERANCE, &mut recorder);
        run.open().expect("a start");
        let end = all(&mut run).and_then(|()| run.end());
        (end, recorder.events)
    }

    #[test]
    fn vectors_have_the_bits_of_the_equations_of_any_system() {
        let kinds = [
            LawKind::Stribeck,
            LawKind::Coulomb,
            LawKind::StribeckExponential,
            LawKind::Decreasing,
            LawKind::Expression,
        ];
        let mut events = 0;
        for (coordinates, contacts) in [(1, 2), (2, 1), (2, 2), (3, 2), (3, 4), (4, 4)] {
            for kind in kinds {
                let system = chain(coordinates, contacts, kind);
                let motion = Motion::new(&system).expect("a system that moves");
                let plain = motion.equations().expect("equations").plain.as_ref();
                assert!(plain.is_some(), "{coordinates} coordinates, {contacts} contacts");
                let (one, other) = (run_by(&motion, run_to_end), run_by(&motion, step_by_step));
                assert_eq!(one, other, "{coordinates} coordinates, {contacts} contacts, {kind:?}");
                assert!(one.0.is_ok(), "{:?}", one.0);
                events += one.1.len();
            }
        }
        assert!(events > 2000, "{events} events");
    }

    #[test]
    fn contacts_that_open_or_tilt_and_long_chains_are_left_to_the_general_equations() {
        let is_plain = |system: &System| {
            let motion = Motion::new(system).expect("a system that moves");
            motion.equations().is_ok_and(|equations| equations.plain.is_some())
        };
        assert!(is_plain(&chain(2, 2, LawKind::Stribeck)));
        assert!(!is_plain(&chain(5, 2, LawKind::Stribeck)));
        assert!(!is_plain(&chain(2, 5, LawKind::Stribeck)));
        let mut system = chain(2, 2, LawKind::Stribeck);
        (system.contacts[0].normal, system.contacts[0].normal_stiffness) =
            (Some(vec![0.0, 1.0]), 4.0);
        assert!(!is_plain(&system));
        let mut system = chain(2, 2, LawKind::Stribeck);
        system.contacts[1].slope = Some(vec![0.1, 0.0]);
        assert!(!is_plain(&system));
    }
}
