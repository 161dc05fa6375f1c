use super::*;

/// A motion whose unit of time is the second.
fn seconds(duration: f64, fastest_forcing: Option<f64>) -> RecordedMotion {
    let fastest_forcing = fastest_forcing.map(|hertz| TAU * hertz);
    RecordedMotion { duration, time_per_second: 1.0, natural_frequency: None, fastest_forcing }
}

/// The plan, and the sound of tones given by amplitude and frequency: means over the intervals of the plan.
fn tones(motion: &RecordedMotion, options: SoundOptions, tones: &[(f64, f64)]) -> Sound {
    let plan = SoundPlan::new(motion, options).expect("a sound");
    let displacement = |time: f64| -> f64 {
        let of = |(amplitude, hertz): &(f64, f64)| {
            -amplitude / (TAU * hertz) * libm::cos(TAU * hertz * time)
        };
        tones.iter().map(of).sum()
    };
    let step = plan.interval();
    let mean = |index: usize| {
        let (from, to) = (index as f64 * step, (index + 1) as f64 * step);
        (displacement(to) - displacement(from)) / step
    };
    Sound::of((0..plan.intervals()).map(mean), &plan)
}

/// Amplitude of a tone in the middle of a sound, in velocities: a least-squares fit of sine and cosine, with a window.
fn level(sound: &Sound, hertz: f64) -> f64 {
    let gain = sound.gain.expect("a gain") * f64::from(i16::MAX);
    let samples = &sound.samples[2000..sound.samples.len() - 2000];
    let count = samples.len() as f64;
    let mut sums = [0.0; 3];
    for (index, sample) in samples.iter().enumerate() {
        let window = 1.0 - libm::cos(TAU * (index as f64 + 0.5) / count);
        let angle = TAU * hertz * index as f64 / f64::from(SAMPLE_RATE);
        let value = window * f64::from(*sample) / gain;
        sums = [
            sums[0] + value * libm::cos(angle),
            sums[1] + value * libm::sin(angle),
            sums[2] + window,
        ];
    }
    2.0 * libm::hypot(sums[0], sums[1]) / sums[2]
}

#[test]
fn a_tone_keeps_its_frequency_and_its_level() {
    let options = SoundOptions { gain: Some(2.0), ..SoundOptions::default() };
    for hertz in [55.0, 440.0, 9_000.0, 19_000.0] {
        let sound = tones(&seconds(1.0, None), options, &[(0.25, hertz)]);
        assert_eq!(sound.samples.len(), 44_100);
        // The window resolves 1 Hz.
        assert!((sound.strongest.expect("a line") - hertz).abs() < 0.5, "{sound:?}");
        // Means lose sin(x)/x with x = π·19000/176400, which is 1.9 %; 16 bits add 10⁻⁵.
        let x = std::f64::consts::PI * hertz / (4.0 * f64::from(SAMPLE_RATE));
        let expected = 0.25 * libm::sin(x) / x;
        assert!((level(&sound, hertz) / expected - 1.0).abs() < 3e-4, "{hertz}");
        assert!(!sound.mostly_inaudible && sound.clipped == 0);
    }
}

#[test]
fn a_transposition_multiplies_frequencies() {
    for (transposition, count) in [(0.5, 88_200), (1.0, 44_100), (2.0, 22_050)] {
        let options = SoundOptions { transposition, gain: None };
        let motion = RecordedMotion { natural_frequency: Some(TAU * 300.0), ..seconds(1.0, None) };
        let sound = tones(&motion, options, &[(1.0, 300.0)]);
        assert_eq!(sound.samples.len(), count);
        let hertz = sound.natural_frequency.expect("given");
        assert!((hertz / (300.0 * transposition) - 1.0).abs() < 1e-12);
        assert!((sound.strongest.expect("a line") - hertz).abs() < 1.0);
    }
}

/// Tones above the file's range would be folded to lower frequencies: 30 kHz to 14.1 kHz.
#[test]
fn tones_above_the_range_are_suppressed() {
    let rate = f64::from(SAMPLE_RATE);
    for (hertz, forcing) in [
        (30_000.0, None),
        (75_000.0, None),
        (57_000.0, Some(57_000.0)),
        (1_100_000.0, Some(1_100_000.0)),
        (4.0 * rate + 5_000.0, Some(4.0 * rate + 5_000.0)),
    ] {
        let motion = seconds(0.3, forcing);
        let options = SoundOptions { gain: Some(0.5), ..SoundOptions::default() };
        let sound = tones(&motion, options, &[(1.0, hertz), (0.5, 440.0)]);
        let folded = (hertz - rate * (hertz / rate).round()).abs();
        let suppressed = level(&sound, folded);
        // −70 dB; the steps of 16 bits alone are −90 dB.
        assert!(suppressed < 3.2e-4, "{hertz}: {suppressed}");
        assert!((level(&sound, 440.0) - 0.5).abs() < 1e-3, "{hertz}");
        assert_eq!(sound.mostly_inaudible, forcing.is_none());
    }
}

/// A triangle wave, the velocity under square dither: its harmonics fold back too.
#[test]
fn harmonics_of_a_fast_forcing_are_suppressed() {
    let forcing = 31_000.0;
    let series: Vec<(f64, f64)> = (0..200)
        .map(|index| f64::from(2 * index + 1))
        .map(|order| (1.0 / (order * order), order * forcing))
        .collect();
    let options = SoundOptions { gain: Some(0.5), ..SoundOptions::default() };
    let sound = tones(&seconds(0.3, Some(forcing)), options, &series);
    let steps = sound.samples[2000..10_000].iter().map(|sample| sample.unsigned_abs()).max();
    // −60 dB of the amplitude 1 are 16 steps.
    assert!(steps.expect("samples") <= 16, "{steps:?}");
}

#[test]
fn the_default_gain_leaves_three_decibels() {
    let sound = tones(&seconds(0.5, None), SoundOptions::default(), &[(1e-12, 100.0)]);
    let largest = sound.samples.iter().map(|sample| sample.unsigned_abs()).max();
    // 32767·10^(−3/20)
    assert_eq!(largest, Some(23_197));
    let again = SoundOptions { gain: sound.gain, ..SoundOptions::default() };
    let same = tones(&seconds(0.5, None), again, &[(1e-12, 100.0)]);
    assert_eq!(same.samples, sound.samples);
}

#[test]
fn clipping_is_counted() {
    // |sin| > 1/2 two thirds of the time.
    let options = SoundOptions { gain: Some(2.0), ..SoundOptions::default() };
    let sound = tones(&seconds(1.0, None), options, &[(1.0, 441.0)]);
    let limit = sound.samples.iter().filter(|sample| sample.unsigned_abs() == 32_767).count();
    assert!(limit.abs_diff(29_400) < 900 && limit.abs_diff(sound.clipped) < 900, "{limit}");
    let warnings = sound.warnings(|_, value| digits(value));
    assert!(warnings.len() == 1 && warnings[0].contains("of 44100 samples"), "{warnings:?}");
}

#[test]
fn the_transposition_is_stated() {
    let said = |motion: &RecordedMotion, in_real_time: bool, transposition: f64| {
        let options = SoundOptions { transposition, gain: Some(4.0) };
        let sound = tones(motion, options, &[(0.1, 200.0)]);
        sound.sentence(in_real_time, |_, value| digits(value))
    };
    let rest = ", and full scale is a velocity of 0.25 (gain 4).";
    let motion = seconds(0.5, None);
    assert_eq!(
        said(&motion, true, 1.0),
        format!("The sound lasts 0.5 s in real time (transposition 1){rest}")
    );
    assert_eq!(
        said(&motion, false, 0.5),
        format!("The sound lasts 1 s (transposition 0.5, 0.5 units of time per second){rest}")
    );
    let natural = RecordedMotion { natural_frequency: Some(TAU * 200.0), ..motion };
    assert_eq!(
        said(&natural, false, 2.0),
        format!(
            "The sound lasts 0.25 s (transposition 2, lowest natural frequency at 400 Hz){rest}"
        )
    );
}

#[test]
fn a_motion_at_rest_is_silent_and_has_no_gain() {
    let plan = SoundPlan::new(&seconds(0.5, None), SoundOptions::default()).expect("a plan");
    let sound = Sound::of(std::iter::empty(), &plan);
    assert!(sound.samples.len() == 22_050 && sound.samples.iter().all(|sample| *sample == 0));
    assert_eq!((sound.gain, sound.strongest, sound.clipped), (None, None, 0));
    assert!(sound.sentence(true, |_, value| digits(value)).ends_with("nothing moves."));
    assert!(sound.warnings(|_, value| digits(value)).is_empty());
}

#[test]
fn inaudible_vibration_is_warned_of() {
    let warned = |motion: &RecordedMotion, hertz: f64| {
        tones(motion, SoundOptions::default(), &[(1.0, hertz)]).warnings(|_, value| digits(value))
    };
    let slow = warned(&seconds(2.0, None), 3.0);
    assert!(slow.len() == 1 && slow[0].contains("below the audible range"), "{slow:?}");
    let fast = warned(&seconds(0.5, None), 40_000.0);
    assert!(fast.len() == 1 && fast[0].contains("most of the vibration"), "{fast:?}");
    let dither = warned(&seconds(0.5, Some(30_000.0)), 300.0);
    assert!(dither.len() == 1 && dither[0].contains("30000 Hz"), "{dither:?}");
    assert!(warned(&seconds(0.5, Some(20_000.0 * (1.0 + 1e-15))), 300.0).is_empty());
}

#[test]
fn lengths_are_limited_before_anything_is_computed() {
    let options = SoundOptions::default();
    for (duration, transposition, advice) in [
        (601.0, 1.0, "raise"),
        (1.0, 1e-9, "raise"),
        (0.0, 1.0, "lower"),
        (1.0, 1e9, "lower"),
        (1.0, 1e308, "lower"),
    ] {
        let motion = RecordedMotion { time_per_second: 100.0, ..seconds(100.0 * duration, None) };
        let wrong = SoundPlan::new(&motion, SoundOptions { transposition, ..options });
        let wrong = wrong.expect_err("out of range").to_string();
        assert!(wrong.starts_with("--until: ") && wrong.contains(advice), "{wrong}");
    }
    let longest = SoundPlan::new(&seconds(600.0, Some(1e12)), options).expect("allowed");
    assert_eq!(longest.intervals(), 600 * 44_100 * MOST_OVERSAMPLING);
}

#[test]
fn options_are_read() {
    assert_eq!(SoundOptions::transposition(" 0.5"), Ok(0.5));
    for wrong in ["0", "-1", "nan", "inf", "high", "2s"] {
        assert_eq!(SoundOptions::transposition(wrong).expect_err("wrong").key, "--transpose");
    }
    for units in [UnitSystem::None, UnitSystem::Si] {
        assert_eq!(SoundOptions::gain("3", units), Ok(3.0));
    }
    for wrong in ["0", "-1", "nan", "loud"] {
        assert_eq!(SoundOptions::gain(wrong, UnitSystem::None).expect_err("wrong").key, "--gain");
    }
}
