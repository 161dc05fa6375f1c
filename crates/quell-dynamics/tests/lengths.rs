//! Lengths scale out: with F, v₀, v_m, D, x and x′, the values of profiles and the deflection of bristles multiplied by a power of two,
//! event times are equal in the last bit and states are multiplied exactly, in both engines.

use quell_dynamics::motion::{Motion, MotionEnd, MotionRecorder, MotionStart, RecordedEvent};
use quell_model::profile::{KnotShape, Knots, Profile, Wave};
use quell_model::waveform::{Burst, FourierWave, Harmonic, Hold, Noise, SampledWave};
use quell_model::{Belt, Direction, Dither, Friction, LawKind, Waveform};
use quell_zoo::BeltExt;

const SCALE: f64 = 1.0 / 1_048_576.0;

/// How long the runs are, τ.
const UNTIL: f64 = 40.0;

/// Displacement and velocity of a start that slips backwards, off every symmetric state.
const START: [f64; 2] = [0.1, -0.2];

fn knots(shape: KnotShape, times: &[f64], values: &[f64]) -> Knots {
    Knots::new(times.to_vec(), values.to_vec(), shape).expect("knots")
}

/// The lines of noise add up to 3.5 times its amplitude, and normal dither must not open the contact.
fn dither(direction: Direction, waveform: Waveform) -> Dither {
    let amplitude = if waveform.noise().is_some() { 0.2 } else { 0.7 };
    Dither { direction, waveform, amplitude, frequency_ratio: 5.0, phase: 0.3, envelope: None }
}

/// Every waveform that is data, and those that a name says.
fn waveforms() -> Vec<(&'static str, Waveform)> {
    let harmonic = |order, sine, cosine| Harmonic { order, sine, cosine };
    let fourier = FourierWave::new(vec![harmonic(1, 0.8, 0.0), harmonic(3, 0.2, 0.1)]);
    let values: Vec<f64> = (0..12).map(|k| (0.5 * f64::from(k * k % 7)).sin()).collect();
    let samples = |hold| SampledWave::new(values.clone(), hold).expect("samples");
    let burst = Burst::new(Waveform::Triangle, 2, 1).expect("a burst");
    let noise = Noise::new([4.0, 6.0], 12, 3).expect("noise");
    vec![
        ("sine", Waveform::Sine),
        ("triangle", Waveform::Triangle),
        ("square", Waveform::Square),
        ("fourier", Waveform::Fourier(fourier.expect("a sum").into())),
        ("linear samples", Waveform::Samples(samples(Hold::Linear).into())),
        ("held samples", Waveform::Samples(samples(Hold::Zero).into())),
        ("burst", burst.into_waveform()),
        ("noise", Waveform::Noise(noise.into())),
    ]
}

fn law(kind: LawKind, values: &[f64]) -> Friction {
    kind.build(values).expect("a law")
}

fn belt(friction: Friction, dithers: Vec<Dither>) -> Belt {
    Belt::new(0.01, 1.0, 0.1, friction, dithers).expect("a belt")
}

/// Contacts: rigid, an elastic slider with and without a falling law, bristles. The falling law has no viscous part: where friction at a
/// small slip exceeds the static level, an elastic slider under a varying load can neither adhere nor slide, and the run stops.
fn contacts(dithers: &[Dither]) -> Vec<(&'static str, Belt)> {
    let with = |friction: Friction| belt(friction, dithers.to_vec());
    let slider = |belt: Belt| belt.with_tangential_stiffness(Some(23.0)).expect("a slider");
    let falling = || law(LawKind::StribeckExponential, &[0.25, 0.4, 0.1, 2.0, 0.0]);
    vec![
        ("rigid", with(law(LawKind::Stribeck, &[0.4, 0.2857, 0.2]))),
        ("slider", slider(with(law(LawKind::Coulomb, &[0.3, 0.3, 0.0])))),
        ("falling slider", slider(with(falling()))),
        ("lugre", with(law(LawKind::Lugre, &[0.3, 0.4, 0.05, 100.0, 2.0, 0.02]))),
    ]
}

fn run(name: &str, belt: &Belt, scale: f64) -> (MotionEnd, Vec<RecordedEvent>) {
    let mut record = MotionRecorder::default();
    let system = belt.system();
    let mut state = START.map(|number| scale * number).to_vec();
    // A contact with a state begins without load.
    state.resize(system.state_size(), 0.0);
    let motion = Motion::new(&system).unwrap_or_else(|why| panic!("{name}: {why:?}"));
    let start = MotionStart { time: 0.0, state };
    let end = motion
        .run(&start, UNTIL, motion.run_tolerance(None), &mut record)
        .unwrap_or_else(|why| panic!("{name}: {why:?}"));
    (end, record.events)
}

/// Numbers of two runs that differ by the unit of length.
fn assert_scaled(name: &str, large: &[f64], small: &[f64]) {
    for (large, small) in large.iter().zip(small) {
        assert_eq!(SCALE * large, *small, "{name}");
    }
}

/// Number of events of the two runs, which are the same but for the unit of length.
fn compared(name: &str, belt: &Belt) -> usize {
    let (end, events) = run(name, belt, 1.0);
    let (small, small_events) = run(name, &belt.scaled(SCALE), SCALE);
    assert_eq!(events.len(), small_events.len(), "{name}");
    for (event, small) in events.iter().zip(&small_events) {
        assert_eq!(event.time.to_bits(), small.time.to_bits(), "{name}: {event:?} {small:?}");
        assert_eq!((event.kind, event.slip_sign), (small.kind, small.slip_sign), "{name}");
        assert_scaled(name, &event.state, &small.state);
    }
    assert_scaled(name, &end.state, &small.state);
    for (contact, small) in end.contacts.iter().zip(&small.contacts) {
        assert_eq!(SCALE * contact.friction, small.friction, "{name}");
        assert_eq!(contact.bristle.map(|z| SCALE * z), small.bristle, "{name}");
    }
    events.len()
}

#[test]
fn of_every_waveform_and_contact() {
    let mut events = 0;
    for (name, waveform) in waveforms() {
        for direction in [Direction::Tangential, Direction::Normal] {
            for (contact, belt) in contacts(&[dither(direction, waveform.clone())]) {
                events += compared(&format!("{name}, {direction:?}, {contact}"), &belt);
            }
        }
    }
    assert!(events > 3000, "{events}");
}

#[test]
fn of_profiles() {
    let times = [0.0, 9.0, 21.0];
    let wave = |amplitude: f64| Wave {
        waveform: Waveform::Sine,
        amplitude,
        frequency: 0.37,
        phase: 0.2,
        envelope: None,
    };
    let mut events = 0;
    for shape in [KnotShape::Linear, KnotShape::Smooth] {
        let drive = Profile::over(knots(shape, &times, &[0.2, 0.05, -0.1]));
        let turning = Profile::constant(0.05).with(wave(0.15));
        let load = Profile::over(knots(shape, &times, &[1.0, 1.4, 0.8]));
        let jumping = Profile::over(knots(shape, &[0.0, 8.0, 8.0, 20.0], &[1.0, 1.2, 0.8, 1.0]));
        let envelope = knots(shape, &times, &[0.0, 1.0, 0.3]);
        let grown =
            Dither { envelope: Some(envelope), ..dither(Direction::Tangential, Waveform::Sine) };
        for (contact, belt) in contacts(&[grown]) {
            let driven = |drive: &Profile| belt.clone().driven(drive.clone()).expect("a drive");
            let loaded = |belt: Belt, load: &Profile| belt.loaded(load.clone()).expect("a load");
            let cases = [
                ("envelope", belt.clone()),
                ("drive", driven(&drive)),
                ("turning drive", driven(&turning)),
                ("load", loaded(belt.clone(), &load)),
                ("jumping load", loaded(belt.clone(), &jumping)),
                ("drive and load", loaded(driven(&drive), &load)),
            ];
            for (name, belt) in cases {
                events += compared(&format!("{name}, {shape:?}, {contact}"), &belt);
            }
        }
    }
    assert!(events > 1500, "{events}");
}
