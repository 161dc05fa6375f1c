//! Elastic sliders on a surface that does not move: every reversal is a zero of γ, at which the slip ends.
//!
//! Against plain steps of Runge–Kutta of order 4, which share nothing with the engine: the modes of the slider are switched where a
//! step has passed an event, which bisection then locates. Their error is some 10⁻¹⁰ with the step below.

use std::f64::consts::TAU;

use quell_dynamics::motion::{
    MOTION_TOLERANCE, Motion, MotionRecorder, MotionStart, ReadingSampler,
};
use quell_dynamics::simulation::EventKind;
use quell_model::profile::{Profile, Wave};
use quell_model::system::{Contact, Input, InputTarget, MassMatrix, Mechanical};
use quell_model::{Friction, LawKind, System, Waveform};
use quell_numerics::matrix::Matrix;

/// Step of the plain integration.
const STEP: f64 = 5e-4;

/// c + (s − c) exp(−(|γ|/v)²) + σ|γ|.
#[derive(Clone, Copy, Debug)]
struct Law {
    sliding: f64,
    at_rest: f64,
    velocity: f64,
    viscous: f64,
    /// The static level.
    static_level: f64,
}

impl Law {
    fn level(self, gamma: f64) -> f64 {
        let drop = (-(gamma / self.velocity).powi(2)).exp();
        self.sliding + (self.at_rest - self.sliding) * drop + self.viscous * gamma
    }

    fn slope(self, gamma: f64) -> f64 {
        let drop = (-(gamma / self.velocity).powi(2)).exp();
        -2.0 * gamma / self.velocity.powi(2) * (self.at_rest - self.sliding) * drop + self.viscous
    }

    fn friction(self) -> Friction {
        let law = if self.at_rest == self.sliding {
            LawKind::Coulomb.build(&[self.sliding, self.static_level, self.viscous])
        } else {
            let values = [self.sliding, self.at_rest, self.velocity, 2.0, self.viscous];
            LawKind::StribeckExponential.build(&values)
        };
        law.expect("a law")
    }
}

/// amplitude · sin(frequency t + phase)
#[derive(Clone, Copy, Debug)]
struct Sine {
    amplitude: f64,
    frequency: f64,
    phase: f64,
}

impl Sine {
    fn at(self, time: f64) -> f64 {
        self.amplitude * (self.frequency * time + self.phase).sin()
    }

    fn rate(self, time: f64) -> f64 {
        self.amplitude * self.frequency * (self.frequency * time + self.phase).cos()
    }

    fn wave(self) -> Wave {
        let Self { amplitude, frequency, phase } = self;
        Wave { waveform: Waveform::Sine, amplitude, frequency, phase, envelope: None }
    }
}

/// A chain of unit masses with a slider between the first and a surface at rest.
#[derive(Clone, Debug)]
struct Case {
    size: usize,
    damping: f64,
    /// Of the springs to the ground and between neighbours.
    springs: (f64, f64),
    slider: f64,
    load: f64,
    /// Of the load.
    load_wave: Sine,
    /// On the last mass.
    push: Sine,
    law: Law,
    start: Vec<f64>,
}

impl Case {
    fn stiffness(&self, i: usize, j: usize) -> f64 {
        let (ground, between) = self.springs;
        let neighbours = usize::from(i > 0) + usize::from(i + 1 < self.size);
        match i.abs_diff(j) {
            0 => ground + between * neighbours as f64,
            1 => -between,
            _ => 0.0,
        }
    }

    fn system(&self) -> System {
        let n = self.size;
        let mut stiffness = Matrix::zeros(n, n);
        let mut damping = Matrix::zeros(n, n);
        for i in 0..n {
            damping.row_mut(i)[i] = self.damping;
            for j in 0..n {
                stiffness.row_mut(i)[j] = self.stiffness(i, j);
            }
        }
        let names = (0..n).map(|i| format!("q{i}")).collect();
        let mass = MassMatrix::dense(Matrix::identity(n));
        let unit = |at: usize| (0..n).map(|i| if i == at { 1.0 } else { 0.0 }).collect::<Vec<_>>();
        let input = |target, wave: Sine| Input {
            target,
            profile: Profile::constant(0.0).with(wave.wave()),
        };
        let mut inputs = vec![input(InputTarget::Force(unit(n - 1)), self.push)];
        if self.load_wave.amplitude > 0.0 {
            let target = InputTarget::NormalLoad { contact: 0, reaction: false };
            inputs.push(input(target, self.load_wave));
        }
        let contact = Contact {
            name: "rub".to_owned(),
            tangent: Some(unit(0)),
            force: None,
            normal: None,
            slope: None,
            normal_load: self.load,
            normal_stiffness: 0.0,
            tangential_stiffness: Some(self.slider),
            normal_damping: 0.0,
            surface_velocity: Profile::constant(0.0),
            friction: self.law.friction(),
            varying_load: None,
        };
        let structure = Mechanical::new(names, mass, damping, stiffness).into();
        System { structure, contacts: vec![contact], inputs }
    }
}

/// What the slider does, with the sign of T and that of γ where it slides.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Mode {
    Adheres,
    Slides(f64, f64),
}

/// The plain integration.
struct Plain<'a> {
    case: &'a Case,
    time: f64,
    /// Displacements, velocities, T.
    state: Vec<f64>,
    mode: Mode,
    events: Vec<(f64, EventKind)>,
}

impl<'a> Plain<'a> {
    fn new(case: &'a Case) -> Self {
        let mut state = case.start.clone();
        state.push(0.0);
        Self { case, time: 0.0, state, mode: Mode::Adheres, events: Vec::new() }
    }

    fn load(&self, time: f64) -> f64 {
        self.case.load + self.case.load_wave.at(time)
    }

    fn gamma(&self, state: &[f64]) -> f64 {
        -state[self.case.size]
    }

    fn force(&self, time: f64, state: &[f64], mode: Mode) -> f64 {
        match mode {
            Mode::Adheres => state[2 * self.case.size],
            Mode::Slides(side, branch) => {
                side * self.case.law.level(branch * self.gamma(state)) * self.load(time)
            }
        }
    }

    fn rates(&self, time: f64, state: &[f64], mode: Mode) -> Vec<f64> {
        let n = self.case.size;
        let mut rates = vec![0.0; 2 * n + 1];
        for i in 0..n {
            rates[i] = state[n + i];
            let spring: f64 = (0..n).map(|j| self.case.stiffness(i, j) * state[j]).sum();
            rates[n + i] = -spring - self.case.damping * state[n + i];
        }
        rates[2 * n - 1] += self.case.push.at(time);
        rates[n] += self.force(time, state, mode);
        rates[2 * n] = match mode {
            Mode::Adheres => self.case.slider * self.gamma(state),
            Mode::Slides(..) => 0.0,
        };
        rates
    }

    /// The own speed of a slider that slides, in the direction of its slip.
    fn own_speed(&self, time: f64, state: &[f64], mode: Mode) -> f64 {
        let Mode::Slides(side, branch) = mode else { return 1.0 };
        let (law, gamma) = (self.case.law, self.gamma(state));
        let rate = -self.rates(time, state, mode)[self.case.size];
        let changes = law.slope(branch * gamma) * branch * rate * self.load(time)
            + law.level(branch * gamma) * self.case.load_wave.rate(time);
        side * gamma - changes / self.case.slider
    }

    fn stepped(&self, step: f64) -> Vec<f64> {
        let add = |rates: &[f64], share: f64| -> Vec<f64> {
            self.state.iter().zip(rates).map(|(x, rate)| x + share * step * rate).collect()
        };
        let at = |share: f64, state: &[f64]| self.rates(self.time + share * step, state, self.mode);
        let a = at(0.0, &self.state);
        let b = at(0.5, &add(&a, 0.5));
        let c = at(0.5, &add(&b, 0.5));
        let d = at(1.0, &add(&c, 1.0));
        let sum = (0..a.len()).map(|i| (a[i] + 2.0 * (b[i] + c[i]) + d[i]) / 6.0);
        add(&sum.collect::<Vec<_>>(), 1.0)
    }

    /// Whether the mode has ended after a step, and whether γ has turned while it slides.
    fn ended(&self, step: f64) -> (bool, bool) {
        let (time, state) = (self.time + step, self.stepped(step));
        match self.mode {
            Mode::Adheres => {
                let gamma = self.gamma(&state).abs();
                let bound = self.case.law.static_level.max(self.case.law.level(gamma));
                let margin = bound * self.load(time) - state[2 * self.case.size].abs();
                (margin < -1e-13, false)
            }
            mode @ Mode::Slides(_, branch) => {
                let turned = branch * self.gamma(&state) < 0.0;
                (self.own_speed(time, &state, mode) < 0.0, turned)
            }
        }
    }

    fn advance(&mut self, step: f64) {
        self.state = self.stepped(step);
        self.time += step;
        if matches!(self.mode, Mode::Slides(..)) {
            let last = 2 * self.case.size;
            self.state[last] = self.force(self.time, &self.state, self.mode);
        }
    }

    fn slide(&mut self, side: f64, branch: f64) {
        self.mode = Mode::Slides(side, branch);
        let last = 2 * self.case.size;
        self.state[last] = self.force(self.time, &self.state, self.mode);
    }

    fn run(&mut self, until: f64) {
        while self.time < until {
            let step = STEP.min(until - self.time);
            let passed = |(ended, turned): (bool, bool)| ended || turned;
            if !passed(self.ended(step)) {
                self.advance(step);
                continue;
            }
            let (mut low, mut high) = (0.0, step);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if passed(self.ended(middle)) {
                    high = middle;
                } else {
                    low = middle;
                }
            }
            let (ended, turned) = self.ended(high);
            self.advance(high);
            let last = 2 * self.case.size;
            match self.mode {
                Mode::Adheres => {
                    let rate = self.case.slider * self.gamma(&self.state);
                    let side = self.state[last].signum();
                    self.events.push((self.time, EventKind::Release));
                    self.slide(side, if rate < 0.0 { -1.0 } else { 1.0 });
                    if self.own_speed(self.time, &self.state, self.mode) < 0.0 {
                        self.events.push((self.time, EventKind::Stick));
                        self.mode = Mode::Adheres;
                    }
                }
                Mode::Slides(side, branch) => {
                    if turned {
                        self.slide(side, -branch);
                    }
                    if ended || self.own_speed(self.time, &self.state, self.mode) < 0.0 {
                        self.events.push((self.time, EventKind::Stick));
                        self.mode = Mode::Adheres;
                    }
                }
            }
        }
    }
}

/// The forced mass with a Coulomb slider of `jenkins_1dof`.
fn jenkins() -> Case {
    let law = Law { sliding: 1.0, at_rest: 1.0, velocity: 1.0, viscous: 0.0, static_level: 1.0 };
    Case {
        size: 1,
        damping: 0.02,
        springs: (1.0, 0.0),
        slider: 0.6,
        load: 0.3,
        load_wave: Sine { amplitude: 0.0, frequency: 1.0, phase: 0.0 },
        push: Sine { amplitude: 1.5, frequency: 0.9, phase: 0.0 },
        law,
        start: vec![0.0, 0.0],
    }
}

/// The engine's events, and the state at the end.
fn found(case: &Case, until: f64) -> (MotionRecorder, Vec<f64>) {
    let system = case.system();
    let motion = Motion::new(&system).expect("a motion");
    let start = MotionStart { time: 0.0, state: motion.relaxed(&case.start) };
    let mut events = MotionRecorder::default();
    let end = motion.run(&start, until, MOTION_TOLERANCE, &mut events);
    let end = end.unwrap_or_else(|why| panic!("{why}: {case:?}"));
    (events, end.state)
}

fn assert_agrees(case: &Case, until: f64, tolerance: f64) -> usize {
    let (events, state) = found(case, until);
    let mut plain = Plain::new(case);
    plain.run(until);
    let pairs = events.events.iter().zip(&plain.events);
    for (event, (time, kind)) in pairs {
        assert!(
            event.kind == *kind && (event.time - time).abs() < tolerance,
            "{event:?} {time} {kind:?} {case:?}"
        );
    }
    assert_eq!(events.events.len(), plain.events.len(), "{case:?}");
    for (found, expected) in state.iter().zip(&plain.state) {
        assert!((found - expected).abs() < tolerance, "{found} {expected} {case:?}");
    }
    plain.events.len()
}

#[test]
fn a_forced_slider_on_a_surface_at_rest_settles() {
    let case = jenkins();
    assert_eq!(found(&case, 800.0).0.events.len(), 459);
    assert_agrees(&case, 200.0, 1e-8);
    let system = case.system();
    let motion = Motion::new(&system).expect("a motion");
    let start = MotionStart { time: 0.0, state: motion.relaxed(&case.start) };
    let times: Vec<f64> =
        (0..40_000).map(|k| 800.0 - 4.0 * TAU / 0.9 * f64::from(k) / 4e4).collect();
    let times: Vec<f64> = times.into_iter().rev().collect();
    let mut sampler = ReadingSampler::new(&[1.0], 0, &times);
    motion.run(&start, 801.0, MOTION_TOLERANCE, &mut sampler).expect("an end");
    let least = sampler.values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = sampler.values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    assert!((0.5 * (most - least) - 6.807_866).abs() < 2e-6, "{}", 0.5 * (most - least));
}

/// Pseudo-random numbers in [0, 1), from a linear congruence.
fn uniform(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1_u64 << 53) as f64
}

fn random(seed: &mut u64, number: usize) -> Case {
    let mut next = |low: f64, high: f64| low + (high - low) * uniform(seed);
    let size = 1 + number % 3;
    let sliding = next(0.2, 0.8);
    let rises = next(0.02, 0.3);
    let law = Law {
        sliding,
        at_rest: if number % 4 == 2 { sliding + rises } else { sliding },
        velocity: next(0.2, 1.0),
        viscous: if number % 4 == 3 { next(0.05, 0.3) } else { 0.0 },
        static_level: if number.is_multiple_of(4) { sliding } else { sliding + rises },
    };
    let load = next(0.2, 1.0);
    let varies = number % 2 == 1;
    Case {
        size,
        damping: next(0.01, 0.1),
        springs: (next(0.5, 2.0), next(0.5, 2.0)),
        slider: 10_f64.powf(next(-0.7, 1.5)),
        load,
        load_wave: Sine {
            amplitude: if varies { load * next(0.1, 0.6) } else { 0.0 },
            frequency: next(0.5, 4.0),
            phase: next(0.0, TAU),
        },
        push: Sine { amplitude: next(0.3, 2.0), frequency: next(0.4, 2.5), phase: next(0.0, TAU) },
        law,
        start: (0..2 * size).map(|_| next(-0.5, 0.5)).collect(),
    }
}

#[test]
fn random_sliders_on_a_surface_at_rest_agree_with_plain_steps() {
    let (mut seed, mut events) = (5, 0);
    for number in 0..48 {
        let case = random(&mut seed, number);
        events += assert_agrees(&case, 40.0, 1e-6);
    }
    assert!(events > 1000, "{events}");
}

/// Long runs of many more: none is stopped.
#[test]
fn random_sliders_on_a_surface_at_rest_run_to_their_ends() {
    let mut seed = 77;
    for number in 0..400 {
        let case = random(&mut seed, number);
        found(&case, 300.0);
        // Free decay from the same start, to rest.
        let push = Sine { amplitude: 0.0, ..case.push };
        found(&Case { push, ..case }, 300.0);
    }
}
