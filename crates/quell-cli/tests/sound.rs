//! `quell simulate --save run.wav`: the file, what the answer says about it, and what is refused.

use std::fs;

use quell::template::TEMPLATES;

use crate::place::Place;

/// A folder with a belt in the units of the equations and one in SI.
fn place(name: &str) -> Place {
    let text = |name: &str| TEMPLATES.iter().find(|item| item.name == name).expect("there").text;
    Place::with(name, &[("quench.toml", text("quench")), ("pad.toml", text("brake-si"))])
}

/// A run of the belt with weak dither, which squeals.
const SQUEAL: [&str; 6] =
    ["simulate", "quench.toml", "--until", "3000", "--set", "dither.amplitude=0.1"];

/// The arguments of a run and further ones.
fn with<'a>(run: &[&'a str], more: &[&'a str]) -> Vec<&'a str> {
    [run, more].concat()
}

/// The samples of a file, whose header is checked.
fn samples(place: &Place, name: &str) -> Vec<i16> {
    let bytes = fs::read(place.folder.join(name)).expect("saved");
    let number = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes"));
    assert_eq!((&bytes[..4], &bytes[8..16]), (&b"RIFF"[..], &b"WAVEfmt "[..]));
    assert_eq!(number(4) as usize, bytes.len() - 8);
    assert_eq!((number(24), number(28), &bytes[36..40]), (44_100, 88_200, &b"data"[..]));
    let data = &bytes[44..44 + number(40) as usize];
    data.chunks_exact(2).map(|pair| i16::from_le_bytes([pair[0], pair[1]])).collect()
}

#[test]
fn a_squeal_is_saved_and_described() {
    let place = place("sound-squeal");
    place.write("run.wav", "what was there before");
    let object = place.good(&with(&SQUEAL, &["--save", "run.wav"]));
    assert_eq!(object["saved"], serde_json::json!(["run.wav"]));
    assert_eq!(place.files(), ["pad.toml", "quench.toml", "run.wav"]);
    let (sound, samples) = (&object["sound"], samples(&place, "run.wav"));
    // 3000/(2π·110) s.
    assert_eq!(samples.len(), 191_419);
    let number = |name: &str| sound[name].as_f64().expect("a number");
    assert!((number("duration_s") - 191_419.0 / 44_100.0).abs() < 1e-12);
    assert!((number("natural_frequency_hz") / 110.0 - 1.0).abs() < 1e-12);
    assert_eq!((number("sample_rate"), number("transposition")), (44_100.0, 1.0));
    assert_eq!(sound["clipped"], 0);
    assert_eq!(object["units"]["duration_s"], "s");
    // The frequency is that of the largest peak of the response, at 110 Hz per unit; both spectra resolve 0.4 Hz.
    let response = place.good(&["response", "quench.toml", "--set", "dither.amplitude=0.1"]);
    let peaks = response["peaks"].as_array().expect("a list").iter();
    let of = |peak: &serde_json::Value, name: &str| peak[name].as_f64().expect("a number");
    let largest = peaks.max_by(|a, b| of(a, "amplitude").total_cmp(&of(b, "amplitude")));
    let expected = 110.0 * of(largest.expect("a peak"), "frequency");
    let strongest = number("strongest_frequency_hz");
    assert!((strongest - expected).abs() < 0.4, "{strongest} {expected}");
    assert_eq!(samples.iter().map(|sample| sample.unsigned_abs()).max(), Some(23_197));
    let sentence = object["notes"][0].as_str().expect("a sentence");
    for part in [
        "transposition 1, lowest natural frequency at 110 Hz",
        "full scale is a velocity of",
        "(gain ",
    ] {
        assert!(sentence.contains(part), "{sentence}");
    }
    // The file itself has the sentence about the sound.
    let said = sentence;
    let bytes = fs::read(place.folder.join("run.wav")).expect("saved");
    assert!(bytes.windows(said.len()).any(|part| part == said.as_bytes()), "{said}");
}

#[test]
fn sounds_with_one_gain_can_be_compared() {
    let place = place("sound-gain");
    let object = place.good(&with(&SQUEAL, &["--save", "first.wav"]));
    let gain = object["sound"]["gain"].to_string();
    place.good(&with(&SQUEAL, &["--save", "second.wav", "--gain", &gain]));
    let files = ["first.wav", "second.wav"].map(|name| samples(&place, name));
    assert_eq!(files[0], files[1]);
    // The quenched belt is quieter at the same gain.
    let quenched = with(&SQUEAL, &["--set", "dither.amplitude=0.52", "--gain", &gain]);
    place.good(&with(&quenched, &["--save", "quenched.wav"]));
    let rms = |samples: &[i16]| {
        samples.iter().map(|sample| f64::from(*sample) * f64::from(*sample)).sum::<f64>()
    };
    assert!(rms(&samples(&place, "quenched.wav")) < 0.5 * rms(&files[0]));
    // Clipping is counted, and warned of.
    let output = place.quell(&with(&SQUEAL, &["--save", "loud.wav", "--gain", "1e3"]));
    let warned = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success() && warned.contains("clipped; a gain below"), "{warned}");
    let clipped = samples(&place, "loud.wav");
    assert!(clipped.contains(&i16::MAX) && clipped.contains(&-i16::MAX));
}

#[test]
fn a_study_in_si_sounds_in_real_time() {
    let place = place("sound-si");
    let run = ["simulate", "pad.toml", "--until", "0.3s", "--events", "--save", "pad.WAV"];
    let object = place.good(&run);
    let sentence = object["notes"][0].as_str().expect("a sentence");
    assert!(sentence.contains("The sound lasts 0.3 s in real time (transposition 1"), "{sentence}");
    assert!(sentence.contains(" m/s (gain ") && sentence.contains(" s/m)"), "{sentence}");
    assert_eq!(place.files(), ["pad.WAV", "pad.toml", "quench.toml"]);
    assert_eq!(samples(&place, "pad.WAV").len(), 13_230);
    let gain = object["sound"]["gain"].to_string();
    let again = place.good(&with(&run, &["--gain", &gain]));
    assert_eq!(object["sound"]["clipped"], again["sound"]["clipped"]);
    let slow = place.good(&with(&run, &["--transpose", "0.5"]));
    assert_eq!(slow["sound"]["duration_s"], 0.6);
    let ultrasonic = place.good(&with(&run, &["--set", "dither.frequency_hz=60kHz"]));
    let warnings = ultrasonic["warnings"].to_string();
    assert!(warnings.contains("dither at 60000 Hz is not in it"), "{warnings}");
}

#[test]
fn sounds_out_of_range_and_useless_options_are_refused() {
    let place = place("sound-refused");
    fs::create_dir(place.folder.join("folder.wav")).expect("a folder");
    fs::copy(place.folder.join("quench.toml"), place.folder.join("study.wav")).expect("a copy");
    let run = ["simulate", "quench.toml", "--until", "50"];
    let to = ["--save", "run.wav"];
    for (more, key) in [
        (&["--transpose", "0"][..], "--transpose"),
        (&["--transpose", "-2"], "--transpose"),
        (&["--transpose", "inf"], "--transpose"),
        (&["--transpose", "octave"], "--transpose"),
        (&["--transpose", "1e-6"], "--until"),
        (&["--transpose", "1e9"], "--until"),
        (&["--gain", "0"], "--gain"),
        (&["--gain", "nan"], "--gain"),
        (&["--gain", "2s/m"], "--gain"),
    ] {
        let errors = place.refused(&with(&with(&run, &to), more));
        assert_eq!(errors[0]["key"], key, "{more:?}: {errors:?}");
    }
    for option in ["--gain", "--transpose"] {
        for more in [&[option, "2"][..], &[option, "2", "--save", "run.csv"]] {
            let errors = place.refused(&with(&run, more));
            assert_eq!((&errors[0]["key"], errors.len()), (&option.into(), 1));
        }
    }
    for path in ["folder.wav", "nowhere/run.wav", "run.mp3"] {
        let errors = place.refused(&with(&run, &["--save", path]));
        assert_eq!(errors[0]["key"], "--save");
    }
    // Only a motion has a sound, and it replaces no study.
    place.refused(&["response", "quench.toml", "--save", "run.wav"]);
    place.refused(&["simulate", "study.wav", "--until", "50", "--save", "study.wav"]);
    // A run of this length would take days.
    let errors = place.refused(&with(&["simulate", "quench.toml", "--until", "1e9"], &to));
    assert_eq!(errors[0]["key"], "--until");
    assert!(errors[0]["allowed"].as_str().expect("text").contains("600 s"), "{errors:?}");
}
