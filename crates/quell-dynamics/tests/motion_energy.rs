//! The energy of random systems changes by exactly the work of dither, friction and dampers, through stick, slip and separation;
//! the integrals are those of the meters.

use std::sync::LazyLock;

use quell_dynamics::motion::{
    ContactMeter, ContactPhase, InputMeter, MOTION_TOLERANCE, Motion, MotionObserver,
    MotionRecorder, MotionSegment, MotionStart,
};
use quell_dynamics::simulation::EventKind;
use quell_model::profile::{Profile, Wave};
use quell_model::system::{InputTarget, MassMatrix, Mechanical};
use quell_model::{Contact, Coulomb, Friction, Input, Structure, System, Waveform};
use quell_numerics::gauss_legendre::GaussLegendre;
use quell_numerics::matrix::Matrix;

/// Coordinates of a random system.
const SIZE: usize = 3;

/// Nodes of a rule that is exact for the square of a Taylor polynomial of a step.
const NODES: usize = 17;

static RULE: LazyLock<[[f64; NODES]; 2]> =
    LazyLock::new(|| GaussLegendre::new(NODES).on_unit_interval());

/// Numbers between −1 and 1 (a linear congruential generator).
struct Random(u64);

impl Random {
    fn number(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn row(&mut self) -> Vec<f64> {
        (0..SIZE).map(|_| self.number()).collect()
    }

    /// A symmetric positive definite matrix.
    fn positive(&mut self, diagonal: f64, rest: f64) -> Matrix {
        let mut matrix = Matrix::from_fn(SIZE, SIZE, |i, j| f64::from(u8::from(i == j)) * diagonal);
        for _ in 0..SIZE {
            matrix.add_outer(rest, &self.row());
        }
        matrix
    }
}

fn wave(waveform: Waveform, amplitude: f64, frequency: f64) -> Profile {
    Profile::constant(0.0).with(Wave { waveform, amplitude, frequency, phase: 0.4, envelope: None })
}

/// Two contacts, the first compliant with a modulated load, and two forces.
fn random_system(random: &mut Random) -> System {
    let names = ["a", "b", "c"].map(str::to_owned).to_vec();
    let mass = MassMatrix::dense(random.positive(1.0, 0.3));
    let (damping, stiffness) = (random.positive(0.02, 0.02), random.positive(1.0, 1.0));
    let law = |level| Friction::Coulomb(Coulomb::new(0.4, Some(level), 0.0).expect("valid"));
    let contact = |name: &str, random: &mut Random| Contact {
        name: name.to_owned(),
        tangent: Some(random.row()),
        force: None,
        normal: None,
        slope: None,
        normal_load: 1.0,
        normal_stiffness: 0.0,
        tangential_stiffness: None,
        normal_damping: 0.0,
        surface_velocity: Profile::constant(0.3 * (1.2 + random.number())),
        friction: law(0.6),
        varying_load: None,
    };
    let mut pad = contact("pad", random);
    (pad.normal, pad.normal_stiffness, pad.normal_damping) = (Some(random.row()), 2.0, 0.05);
    let inputs = vec![
        Input { target: InputTarget::Force(random.row()), profile: wave(Waveform::Sine, 0.5, 3.0) },
        Input {
            target: InputTarget::Force(random.row()),
            profile: wave(Waveform::Square, 0.2, 1.7),
        },
        Input {
            target: InputTarget::NormalLoad { contact: 0, reaction: true },
            profile: wave(Waveform::Triangle, 0.6, 2.3),
        },
    ];
    let force = random.row();
    let structure = Mechanical::new(names, mass, damping, stiffness).under(force);
    let contacts = vec![pad, contact("guide", random)];
    System { structure: Structure::Mechanical(structure), contacts, inputs }
}

fn product(row: &[f64], values: &[f64]) -> f64 {
    row.iter().zip(values).map(|(a, b)| a * b).sum()
}

/// xᵀ A x.
fn quadratic(matrix: &Matrix, x: &[f64]) -> f64 {
    (0..SIZE).map(|i| x[i] * product(matrix.row(i), x)).sum()
}

/// Work of dampers, constant forces and rest loads, and changes of the energy of closed contact springs.
struct Balance<'s> {
    system: &'s System,
    dampers: f64,
    constant: f64,
    springs: f64,
    released: f64,
}

impl MotionObserver for Balance<'_> {
    fn segment(&mut self, segment: &MotionSegment<'_>) {
        let structure = self.system.structure.mechanical().expect("masses");
        let duration = segment.duration();
        let mut state = vec![0.0; 2 * SIZE];
        let [nodes, weights] = &*RULE;
        for (node, weight) in nodes.iter().zip(weights) {
            segment.state(node * duration, &mut state);
            let velocity = &state[SIZE..];
            let mut power = quadratic(structure.damping(), velocity);
            for (index, contact) in self.system.contacts.iter().enumerate() {
                if let (Some(normal), true) =
                    (&contact.normal, segment.phase(index) != ContactPhase::Open)
                {
                    power += contact.normal_damping * product(normal, velocity).powi(2);
                }
            }
            self.dampers -= weight * duration * power;
        }
        let mut end = state.clone();
        segment.state(0.0, &mut state);
        segment.state(duration, &mut end);
        let moved: Vec<f64> = end.iter().zip(&state).map(|(b, a)| b - a).collect();
        self.constant += product(structure.force(), &moved);
        for (index, contact) in self.system.contacts.iter().enumerate() {
            let Some(normal) = &contact.normal else { continue };
            let ends = [&state, &end].map(|state| product(normal, &state[..SIZE]));
            if segment.phase(index) == ContactPhase::Open {
                self.released += contact.normal_load * (ends[1] - ends[0]);
            } else {
                self.springs +=
                    0.5 * contact.normal_stiffness * (ends[1].powi(2) - ends[0].powi(2));
            }
        }
    }
}

#[test]
fn energy_changes_by_the_work_of_dither_friction_and_dampers() {
    let mut random = Random(7);
    let mut counts = [0_usize; 5];
    let kinds = [
        EventKind::Stick,
        EventKind::Release,
        EventKind::Reversal,
        EventKind::Separation,
        EventKind::Landing,
    ];
    for case in 0..40 {
        let system = random_system(&mut random);
        let motion = Motion::new(&system).expect("a motion");
        let start =
            MotionStart { time: 0.0, state: (0..2 * SIZE).map(|_| random.number()).collect() };
        let (mut contacts, mut inputs) = (ContactMeter::new(2), InputMeter::new(&system));
        let mut balance =
            Balance { system: &system, dampers: 0.0, constant: 0.0, springs: 0.0, released: 0.0 };
        let mut recorder = MotionRecorder::default();
        let mut observer = ((&mut contacts, &mut inputs), (&mut balance, &mut recorder));
        let end = motion.run(&start, 40.0, MOTION_TOLERANCE, &mut observer).expect("a run");
        for event in &recorder.events {
            counts[kinds.iter().position(|kind| *kind == event.kind).expect("a kind")] += 1;
        }
        let structure = system.structure.mechanical().expect("masses");
        let mass = structure.mass().matrix();
        let energy = |state: &[f64]| {
            0.5 * (quadratic(&mass, &state[SIZE..]) + quadratic(structure.stiffness(), state))
        };
        let length = contacts.length();
        let friction: f64 = contacts
            .means()
            .expect("a duration")
            .iter()
            .zip(&system.contacts)
            .map(|(means, contact)| {
                length * (contact.surface_velocity.mean() * means.friction - means.friction_power)
            })
            .sum();
        let costs = inputs.costs().expect("a duration");
        let dither: Vec<f64> =
            costs.iter().map(|cost| length * cost.fed.expect("a force").power).collect();
        let terms = [
            energy(&end.state) - energy(&start.state),
            balance.springs,
            -balance.released,
            -balance.dampers,
            -balance.constant,
            -friction,
            -dither.iter().sum::<f64>(),
        ];
        let size = terms.iter().fold(0.0, |most: f64, term| most.max(term.abs()));
        let rest: f64 = terms.iter().sum();
        assert!(rest.abs() <= 1e-11 * size, "case {case}: {rest:e} of {size:e}: {terms:?}");
        assert!(dither.iter().all(|work| work.abs() > 1e-6 * size), "{dither:?}");
    }
    assert!(counts.iter().all(|count| *count > 50), "{counts:?}");
}
