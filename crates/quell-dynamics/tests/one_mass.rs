//! Systems of one mass: the bits of the belt that each of them is, and the numbers of the engine for systems in general.

use quell_dynamics::motion::{
    ContactMeans, ContactMeter, MOTION_TOLERANCE, Motion, MotionRecorder, MotionSampler,
    MotionStart, MotionVariation, PlannedMotion, run_many,
};
use quell_dynamics::simulation::{DEFAULT_TOLERANCE, EventRecorder, Start, simulate};
use quell_model::system::{InputTarget, MassMatrix, Mechanical};
use quell_model::units::Scales;
use quell_model::{Belt, Direction, Dither, Friction, LawKind, System, Waveform};
use quell_numerics::matrix::Matrix;

const LAWS: [(LawKind, &[f64]); 4] = [
    (LawKind::Stribeck, &[0.4, 0.2857, 0.2]),
    (LawKind::Decreasing, &[0.4, 0.2857, 0.2]),
    (LawKind::Coulomb, &[0.2857, 0.4, 0.05]),
    (LawKind::StribeckExponential, &[0.2857, 0.4, 0.2, 2.0, 0.05]),
];

fn dither(direction: Direction, waveform: Waveform, amplitude: f64, ratio: f64) -> Dither {
    Dither { direction, waveform, amplitude, frequency_ratio: ratio, phase: 0.4, envelope: None }
}

fn law((kind, values): (LawKind, &[f64])) -> Friction {
    kind.build(values).expect("valid law")
}

/// Belts of every law, under every waveform of the dissertation, along both directions, and without dither.
fn belts() -> Vec<Belt> {
    let mut belts = Vec::new();
    for (place, values) in LAWS.into_iter().enumerate() {
        for waveform in [Waveform::Sine, Waveform::Square, Waveform::Triangle] {
            for directions in [
                &[][..],
                &[Direction::Tangential],
                &[Direction::Normal],
                &[Direction::Tangential, Direction::Normal],
            ] {
                let dithers = directions.iter().enumerate().map(|(index, direction)| {
                    let ratio = 5.3 + 2.0 * index as f64 + place as f64;
                    dither(*direction, waveform.clone(), 0.3, ratio)
                });
                let belt = Belt::new(0.02, 1.0, 0.05, law(values), dithers.collect());
                belts.push(belt.expect("valid belt"));
            }
        }
    }
    belts
}

fn start(time: f64, state: [f64; 2]) -> MotionStart {
    MotionStart { time, state: state.to_vec() }
}

#[test]
fn a_system_of_unit_mass_and_stiffness_has_the_bits_of_its_belt() {
    for belt in belts() {
        let mut events = EventRecorder::default();
        let end = simulate(&belt, Start::REST, 60.0, DEFAULT_TOLERANCE, &mut events);
        let end = end.expect("a run");
        let system = belt.system();
        let motion = Motion::new(&system).expect("a motion");
        let mut recorder = MotionRecorder::default();
        let from = start(0.0, [0.0; 2]);
        let same =
            motion.run(&from, 60.0, motion.run_tolerance(None), &mut recorder).expect("a run");
        assert_eq!(same.state, [end.displacement, end.velocity]);
        assert_eq!((same.steps, same.events, same.time), (end.steps, end.events, 60.0));
        assert_eq!(recorder.events.len(), events.events.len());
        for (found, event) in recorder.events.iter().zip(&events.events) {
            assert_eq!((found.time, found.kind), (event.time, event.kind));
            assert_eq!(found.slip_sign, event.slip_sign);
            assert_eq!(found.state, [event.displacement, event.velocity]);
        }
    }
}

#[test]
fn runs_side_by_side_have_the_bits_of_runs_alone() {
    let systems: Vec<System> = belts().iter().map(Belt::system).collect();
    let motions: Vec<Motion<'_>> =
        systems.iter().map(|system| Motion::new(system).expect("a motion")).collect();
    let mut meters = vec![ContactMeter::new(1); motions.len()];
    let from = start(0.0, [0.1, 0.0]);
    let runs = motions.iter().zip(&mut meters).map(|(motion, observer)| PlannedMotion {
        motion,
        start: from.clone(),
        until: 40.0,
        observer,
    });
    let together = run_many(runs.collect(), MOTION_TOLERANCE);
    for ((motion, end), meter) in motions.iter().zip(together).zip(&meters) {
        let mut alone = ContactMeter::new(1);
        assert_eq!(end, motion.run(&from, 40.0, MOTION_TOLERANCE, &mut alone));
        assert_eq!(*meter, alone);
    }
}

/// The system with a second coordinate that nothing moves: one mass no more, so that the engine for systems in general runs it.
fn in_general(system: &System) -> System {
    let given = system.structure.mechanical().expect("a mass");
    let two = |value: f64| Matrix::from_fn(2, 2, |i, j| if i == j { value } else { 0.0 });
    let mass = MassMatrix::dense(two(given.mass().matrix()[(0, 0)]));
    let names = vec!["x".to_owned(), "y".to_owned()];
    let (damping, stiffness) = (given.damping()[(0, 0)], given.stiffness()[(0, 0)]);
    let structure = Mechanical::new(names, mass, two(damping), two(stiffness));
    let mut other = system.clone();
    other.structure = structure.under(vec![given.force()[0], 0.0]).into();
    other.contacts[0].tangent.as_mut().expect("a tangent").push(0.0);
    for input in &mut other.inputs {
        if let InputTarget::Force(row) = &mut input.target {
            row.push(0.0);
        }
    }
    other
}

/// What observers see of a motion.
struct Seen {
    times: Vec<f64>,
    means: ContactMeans,
    samples: MotionSampler,
    /// ∂(x, v)/∂(x, v) at the start, row by row.
    changes: [f64; 4],
    end: Vec<f64>,
}

fn seen(system: &System, until: f64) -> Seen {
    let motion = Motion::new(system).expect("a motion");
    let size = system.structure.size();
    let mut state = vec![0.0; 2 * size];
    state[0] = 0.1 * until / 12.0;
    let from = MotionStart { time: 0.0, state };
    let mut meter = ContactMeter::new(1);
    let mut samples = MotionSampler::new(0.0, until / 97.0, 97);
    let mut variation = MotionVariation::new(&motion).expect("equations");
    let observer = &mut (&mut meter, (&mut samples, &mut variation));
    let end = motion.run(&from, until, MOTION_TOLERANCE, observer).expect("a run");
    assert!(!variation.has_failed);
    let matrix = variation.matrix();
    let changes = [(0, 0), (0, size), (size, 0), (size, size)].map(|place| matrix[place]);
    let means = meter.means().expect("some time")[0];
    let end = vec![end.state[0], end.state[size], end.contacts[0].friction];
    Seen { times: variation.events.iter().map(|e| e.time).collect(), means, samples, changes, end }
}

#[test]
fn observers_see_what_the_engine_for_systems_in_general_shows_them() {
    let scales = Scales::new(2.0, 50.0).expect("valid");
    // Surfaces that move forwards and backwards.
    for (belt, direction) in
        belts().into_iter().flat_map(|belt| [(belt.clone(), 1.0), (belt, -1.0)])
    {
        let belt = belt.in_si(Some(scales));
        let mut system = belt.system_in_units().expect("in SI").expect("a law");
        // Along a tangent of 2, under a constant force.
        let given = system.structure.mechanical().expect("a mass");
        let one = |value: f64| Matrix::from_fn(1, 1, |_, _| value);
        let structure = Mechanical::new(
            vec!["x".to_owned()],
            given.mass().clone(),
            given.damping().clone(),
            one(given.stiffness()[(0, 0)]),
        );
        system.structure = structure.under(vec![3.0]).into();
        system.contacts[0].tangent = Some(vec![2.0]);
        let surface = &mut system.contacts[0].surface_velocity;
        *surface = surface.scaled(direction);
        assert!(system.one_mass().is_some_and(|mass| mass.direction() == direction));
        let (found, known) = (seen(&system, 2.4), seen(&in_general(&system), 2.4));
        let close = |found: f64, known: f64, scale: f64, what: &str| {
            assert!(
                (found - known).abs() <= 1e-9 * scale,
                "{what}: {found:?} {known:?} of {belt:?}"
            );
        };
        assert_eq!(found.times.len(), known.times.len());
        for (found, known) in found.times.iter().zip(&known.times) {
            close(*found, *known, 1.0, "event");
        }
        let load = system.contacts[0].normal_load;
        close(found.means.friction, known.means.friction, load, "mean friction");
        close(found.means.normal_load, known.means.normal_load, load, "mean load");
        close(found.means.stick_fraction, known.means.stick_fraction, 1.0, "stick fraction");
        close(found.means.friction_power, known.means.friction_power, load, "friction power");
        for (found, known) in found.samples.friction.iter().zip(&known.samples.friction) {
            close(*found, *known, load, "friction");
        }
        for (found, known) in
            found.samples.slip_velocities.iter().zip(&known.samples.slip_velocities)
        {
            close(*found, *known, 1.0, "slip velocity");
        }
        for (found, known) in found.changes.iter().zip(&known.changes) {
            close(*found, *known, 10.0, "change");
        }
        for (found, known) in found.end.iter().zip(&known.end) {
            close(*found, *known, load, "end");
        }
    }
}

#[test]
fn a_run_goes_on_from_its_end() {
    for belt in belts() {
        let scales = Scales::new(3.0, 11.0).expect("valid");
        let system = belt.in_si(Some(scales)).system_in_units().expect("in SI").expect("a law");
        let motion = Motion::new(&system).expect("a motion");
        let from = start(0.0, [0.01, 0.0]);
        let run = |from: &MotionStart, until: f64| {
            motion.run(from, until, MOTION_TOLERANCE, &mut ()).expect("a run")
        };
        let whole = run(&from, 3.0);
        for cut in [0.3, 1.1, 1.7, 2.9] {
            let (first, rest) = (run(&from, cut), run(&run(&from, cut).restart(), 3.0));
            assert_eq!((first.time, rest.time), (cut, 3.0));
            for (found, known) in rest.state.iter().zip(&whole.state) {
                assert!((found - known).abs() < 1e-10, "{cut}: {found} {known}");
            }
        }
    }
}
