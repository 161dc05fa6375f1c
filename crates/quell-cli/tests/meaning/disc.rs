//! A disc of two modes under one load, as `[disc]` and as `[system]`: in the frame of the load, as `studies/disc-as-system.toml` has it.

use std::f64::consts::FRAC_PI_2;
use std::fmt::Write as _;
use std::fs;

use crate::answer::Answer;
use crate::twins::{Random, Twin, words};

/// A mode and its two coordinates, the cosine and the sine of its nodal diameters.
struct Mode {
    diameters: f64,
    ratio: f64,
    shape: f64,
}

/// The matrices of the system, row by row; coordinates are the cosine and the sine of each mode.
fn matrices(modes: &[Mode], damping: f64, speed: f64, mass: f64) -> [Vec<Vec<f64>>; 3] {
    let n = modes.len();
    let [mut m, mut c, mut k] = [(); 3].map(|()| vec![vec![0.0; 2 * n]; 2 * n]);
    for (i, mode) in modes.iter().enumerate() {
        let turn = mode.diameters * speed;
        let (cosine, sine) = (2 * i, 2 * i + 1);
        for at in [cosine, sine] {
            m[at][at] = 1.0;
            c[at][at] = 2.0 * damping * mode.ratio;
            k[at][at] = mode.ratio * mode.ratio - turn * turn;
        }
        c[cosine][sine] = -2.0 * turn;
        c[sine][cosine] = 2.0 * turn;
        k[cosine][sine] = -2.0 * damping * mode.ratio * turn;
        k[sine][cosine] = 2.0 * damping * mode.ratio * turn;
        for (j, other) in modes.iter().enumerate() {
            m[cosine][2 * j] += mass * mode.shape * other.shape;
        }
    }
    [m, c, k]
}

/// A random study.
pub(crate) fn twin(random: &mut Random) -> Twin {
    let modes: Vec<Mode> = (0..2)
        .map(|number| Mode {
            diameters: f64::from(number + 1),
            ratio: random.between(0.8, 1.2) + f64::from(number),
            shape: random.between(0.8, 1.3),
        })
        .collect();
    let damping = random.between(1e-3, 2e-2);
    let speed = random.between(0.05, 0.4);
    let [mass, damper, spring] = [0.02, 0.05, 0.1].map(|most| random.between(0.0, most));
    let friction = random.between(0.02, 0.3);
    let tangential = random.share() < 0.3;
    let amplitude = random.between(0.1, 0.9);
    let frequency = random.between(2.0, 8.0);
    let mut own = format!("[disc]\nmodal_damping = {damping:?}\n");
    for Mode { diameters, ratio, shape } in &modes {
        let _ = write!(
            own,
            "[[disc.mode]]\ndiameters = {diameters}\nratio = {ratio:?}\nshape_at_load = {shape:?}\n"
        );
    }
    let _ = write!(
        own,
        "[disc.load]\nmass = {mass:?}\ndamping = {damper:?}\nstiffness = {spring:?}\nfriction = {friction:?}\nspeed = {speed:?}\n\
         [dither]\ndirection = '{}'\namplitude = {amplitude:?}\nfrequency_ratio = {frequency:?}\n",
        if tangential { "tangential" } else { "normal" }
    );
    let [m, c, k] = matrices(&modes, damping, speed, mass);
    let row =
        |entry: &dyn Fn(&Mode) -> [f64; 2]| modes.iter().flat_map(entry).collect::<Vec<f64>>();
    let normal = row(&|mode| [mode.shape, 0.0]);
    let slope = row(&|mode| [0.0, mode.diameters * mode.shape]);
    let system = format!(
        "[system]\ncoordinates = ['A0', 'B0', 'A1', 'B1']\nmass = {m:?}\ndamping = {c:?}\nstiffness = {k:?}\n[[contact]]\n\
         name = 'load 0'\nnormal = {normal:?}\nslope = {slope:?}\nnormal_load = 1.0\nnormal_stiffness = {spring:?}\n\
         normal_damping = {damper:?}\nbelt_velocity = 1.0\n[contact.friction]\nlaw = 'coulomb'\ncoefficient = {friction:?}\n\
         [[dither]]\ncontact = 'load 0'\ndirection = 'friction'\nmean = {}\nwaveform = 'sine'\namplitude = {amplitude:?}\n\
         frequency = {frequency:?}\nphase = {FRAC_PI_2:?}\n",
        if tangential { "0.0" } else { "1.0" }
    );
    let mut asked: Vec<Vec<String>> = ["check", "stability", "modes", "orbit", "attractor"]
        .map(|verb| words(&format!("{verb} STUDY")))
        .to_vec();
    asked.push(words("stability STUDY --exact"));
    asked.push(words("simulate STUDY --events --until 20"));
    asked.push(words(&format!(
        "thresholds STUDY --parameter dither.amplitude --from 0.0 --to {amplitude:?}"
    )));
    Twin {
        name: format!("disc, {} dither", if tangential { "tangential" } else { "normal" }),
        own,
        system,
        asked,
        scaled: false,
        renamed: vec![("dither.frequency_ratio", "dither.frequency")],
    }
}

/// The exponents of a disc, by the series of its friction, are those of its system over one period of the dither.
#[test]
fn a_dithered_disc_and_its_system_have_the_same_exponents() {
    for seed in 1..5 {
        let Twin { own, system, .. } = twin(&mut Random::new(seed));
        let folder = tempfile::tempdir().expect("a folder");
        for (name, text) in [("own.toml", &own), ("system.toml", &system)] {
            fs::write(folder.path().join(name), text).expect("written");
        }
        let disc = Answer::of(folder.path(), &["stability", "own.toml"]);
        let system = Answer::of(folder.path(), &["stability", "system.toml", "--exact"]);
        let [(one, error), (other, further)] =
            [&disc, &system].map(|answer| answer.number_with_error("growth_rate"));
        // Rates are rounded to some 1e-12 of the frequencies, which are of order 1.
        assert!((one - other).abs() <= error + further + 1e-11, "{one} against {other}\n{own}");
    }
}
