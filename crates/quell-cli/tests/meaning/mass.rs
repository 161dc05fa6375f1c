//! One mass, as `[belt]` and as `[system]`.

use crate::twins::{Random, Twin, words};
use std::f64::consts::TAU;

/// The unit systems of the two forms.
#[derive(Clone, Copy, PartialEq)]
enum Units {
    /// Both without units.
    None,
    /// Both in SI.
    Si,
    /// The belt in SI, the system in millimetres, tonnes and seconds.
    Millimetres,
}

/// Scales of a belt in SI: kg and N/m.
const MASS: f64 = 2.0;
const STIFFNESS: f64 = 800.0;

const RENAMED: &[(&str, &str)] = &[
    ("belt.belt_velocity", "contact.belt.belt_velocity"),
    ("belt.normal_load", "contact.belt.normal_load"),
    ("dither.frequency_ratio", "dither.frequency"),
];

/// The law in both forms; `speed` is the unit of slip velocities of each.
fn law(random: &mut Random, units: Units, kind: &str) -> [String; 2] {
    let level = random.between(0.35, 0.5);
    let least = level * random.between(0.6, 0.8);
    let unit = match units {
        Units::None => [1.0, 1.0],
        Units::Si => [1.0; 2].map(|unit| unit * (STIFFNESS / MASS).sqrt() / 10.0),
        Units::Millimetres => [1.0, 1000.0].map(|unit| unit * (STIFFNESS / MASS).sqrt() / 10.0),
    };
    let key =
        if units == Units::None { "reference_velocity" } else { "reference_velocity_m_per_s" };
    [0, 1].map(|form| {
        let speed = 0.2 * unit[form];
        let key = if form == 0 { key } else { "reference_velocity" };
        match kind {
            "coulomb" => format!("law = 'coulomb'\ncoefficient = {least:?}\nstatic_coefficient = {level:?}\n"),
            "expression" => format!(
                "law = 'expression'\ncoefficient = '{least:?} + {:?}*exp(-abs(v)/v_c)'\n[{}.constants]\nv_c = {speed:?}\n",
                level - least,
                if form == 0 { "friction" } else { "contact.friction" }
            ),
            "samples" => {
                let column = if form == 0 && units != Units::None { "slip_velocity_m_per_s" } else { "slip_velocity" };
                let speeds: Vec<f64> = (0..24).map(|i| f64::from(i) * 0.1 * speed).collect();
                let coefficients: Vec<f64> =
                    (0..24).map(|i| least + (level - least) * (-0.1 * f64::from(i)).exp()).collect();
                format!("law = 'samples'\n{column} = {speeds:?}\ncoefficient = {coefficients:?}\n")
            }
            "lugre" => format!(
                "law = 'lugre'\nstatic_coefficient = {level:?}\ncoefficient = {least:?}\n{key} = {speed:?}\n\
                 bristle_stiffness = 50.0\nbristle_damping = 0.5\n"
            ),
            _ => format!(
                "law = '{kind}'\nstatic_coefficient = {level:?}\nminimum_coefficient = {least:?}\n{key} = {speed:?}\n"
            ),
        }
    })
}

/// Number in the belt's unit and in the system's, of a quantity that is `si` in SI and `mm` in millimetres, tonnes and seconds.
fn two(units: Units, value: f64, si: f64, mm: f64) -> [f64; 2] {
    match units {
        Units::None => [value, value],
        Units::Si => [value * si; 2],
        Units::Millimetres => [value * si, value * mm],
    }
}

/// The same text in both forms, with what differs between them.
#[derive(Default)]
struct Forms {
    own: String,
    system: String,
}

impl Forms {
    fn add(&mut self, own: &str, system: &str) {
        self.own += own;
        self.system += system;
    }

    fn add_both(&mut self, text: &str) {
        self.add(text, text);
    }
}

/// The mass and its contact.
struct Mass {
    units: Units,
    kind: &'static str,
    /// Whether its contact has a state.
    state: bool,
    law: [String; 2],
    damping: f64,
    velocity: f64,
    load: f64,
    driven: bool,
}

impl Mass {
    fn random(random: &mut Random) -> Self {
        let units = match random.one_of(&["none", "none", "SI", "mm-t-s"]) {
            "none" => Units::None,
            "SI" => Units::Si,
            _ => Units::Millimetres,
        };
        let state = units == Units::None && random.share() < 0.25;
        let kinds: &[&'static str] = if state {
            &["lugre", "coulomb"]
        } else {
            &["stribeck", "decreasing", "coulomb", "stribeck", "expression", "samples"]
        };
        let kind = random.one_of(kinds);
        let law = law(random, units, kind);
        let damping = (10f64.powf(-2.5 + 1.5 * random.share()) * 1e6).round() / 1e6;
        let (velocity, load) = (random.between(0.02, 0.25), random.between(0.5, 1.5));
        let driven = !state && units == Units::None && random.share() < 0.15;
        Self { units, kind, state, law, damping, velocity, load, driven }
    }

    /// A key of the belt.
    fn key(&self, si: &'static str, plain: &'static str) -> &'static str {
        if self.units == Units::None { plain } else { si }
    }

    /// A force of the belt in both forms. Lengths of a belt are those of 0.1 m in SI, so that its numbers are alike in both.
    fn force(&self, value: f64) -> [f64; 2] {
        two(self.units, value, 0.1 * STIFFNESS, 0.1 * STIFFNESS)
    }

    fn write(&self, forms: &mut Forms) {
        let Self { units, damping, velocity, .. } = self;
        let rate = (STIFFNESS / MASS).sqrt();
        let damper = 2.0 * damping * (MASS * STIFFNESS).sqrt();
        let scales = format!("mass_kg = {MASS:?}\nstiffness_n_per_m = {STIFFNESS:?}\n");
        let (scales, mass, damper, stiffness, named) = match units {
            Units::None => ("", 1.0, 2.0 * damping, 1.0, ""),
            Units::Si => (scales.as_str(), MASS, damper, STIFFNESS, "units = 'SI'\n"),
            Units::Millimetres => {
                (scales.as_str(), MASS / 1e3, damper / 1e3, STIFFNESS / 1e3, "units = 'mm-t-s'\n")
            }
        };
        let ([own_load, load], [own_velocity, speed]) =
            (self.force(self.load), two(*units, *velocity, 0.1 * rate, 100.0 * rate));
        let key = self.key("normal_force_n", "normal_load");
        forms.add(
            &format!("[belt]\n{scales}damping_ratio = {damping:?}\n{key} = {own_load:?}\n"),
            &format!(
                "[system]\n{named}coordinates = ['x']\nmass = [{mass:?}]\ndamping = [{damper:?}]\nstiffness = [{stiffness:?}]\n\
                 [[contact]]\nname = 'belt'\ntangent = {{ x = 1.0 }}\nnormal_load = {load:?}\n"
            ),
        );
        if self.state && self.kind == "coulomb" {
            forms.add_both("tangential_stiffness = 20.0\n");
        }
        if self.driven {
            let knots =
                format!("time = [0.0, 40.0]\nvelocity = [{velocity:?}, {:?}]\n", 2.0 * velocity);
            forms.add(&format!("[belt.drive]\n{knots}"), &format!("[contact.drive]\n{knots}"));
        } else {
            let key = self.key("belt_velocity_m_per_s", "belt_velocity");
            forms.add(
                &format!("{key} = {own_velocity:?}\n"),
                &format!("belt_velocity = {speed:?}\n"),
            );
        }
        let [own, system] = &self.law;
        forms.add(&format!("[friction]\n{own}"), &format!("[contact.friction]\n{system}"));
    }
}

/// Its dithers, whose frequencies are multiples of the first.
struct Shaking {
    count: i32,
    ratio: f64,
    normal: bool,
    amplitude: f64,
}

impl Shaking {
    fn random(random: &mut Random, mass: &Mass) -> Self {
        let count = if random.share() < 0.2 { 2 } else { 1 };
        let ratio = random.between(5.0, 20.0);
        let normal = random.share() < 0.3;
        let amplitude = if normal {
            random.between(0.1, 0.8) * mass.load
        } else {
            random.between(0.3, 1.6) * mass.velocity * ratio
        };
        Self { count, ratio, normal, amplitude: amplitude / f64::from(count) }
    }

    fn write(&self, random: &mut Random, mass: &Mass, forms: &mut Forms) {
        let [own_amplitude, amplitude] = mass.force(self.amplitude);
        let amplitude_key = mass.key("amplitude_n", "amplitude");
        let direction = if self.normal { "normal" } else { "tangential" };
        let place = if self.normal {
            "contact = 'belt'\ndirection = 'normal'\n"
        } else {
            "at = { x = 1.0 }\n"
        };
        for number in 0..self.count {
            let ratio = self.ratio * f64::from(number + 1);
            let wave = match random.one_of(&["sine", "triangle", "square", "fourier", "samples"]) {
                "fourier" => "waveform = 'fourier'\nharmonics = [{ order = 1, sine = 1.0 }, { order = 3, sine = 0.3 }]\n".to_owned(),
                "samples" => {
                    "waveform = 'samples'\nvalues = [0.0, 1.0, 0.4, -0.7, -0.7]\n".to_owned()
                }
                plain => format!("waveform = '{plain}'\n"),
            };
            forms.add(
                &format!(
                    "[[dither]]\ndirection = '{direction}'\n{wave}{amplitude_key} = {own_amplitude:?}\n"
                ),
                &format!("[[dither]]\n{place}{wave}amplitude = {amplitude:?}\n"),
            );
            if mass.units == Units::None {
                forms.add(
                    &format!("frequency_ratio = {ratio:?}\n"),
                    &format!("frequency = {ratio:?}\n"),
                );
            } else {
                let hertz = ratio * (STIFFNESS / MASS).sqrt() / TAU;
                forms.add_both(&format!("frequency_hz = {hertz:?}\n"));
            }
        }
    }
}

/// The tables of a map or of a design, if one is asked for.
fn asked_tables(asked: &[Vec<String>], mass: &Mass, shaking: &Shaking, forms: &mut Forms) {
    let amplitude = shaking.amplitude;
    let asks = |verb: &str| asked.iter().any(|command| command[0] == verb);
    if asks("map") {
        forms.add_both(&format!(
            "[[sweep]]\nparameter = 'dither.amplitude'\nfrom = {:?}\nto = {amplitude:?}\npoints = 3\n",
            0.5 * amplitude
        ));
    }
    if asks("design") {
        let most = if shaking.normal { amplitude } else { 4.0 * amplitude };
        forms.add_both(&format!(
            "[design]\nminimise = 'amplitude'\nvary = ['dither.amplitude']\nfrom = [{:?}]\nto = [{most:?}]\n[design.over]\n",
            0.1 * amplitude
        ));
        let over =
            format!("belt.belt_velocity' = [{:?}, {:?}]\n", mass.velocity, 1.5 * mass.velocity);
        forms.add(&format!("'{over}"), &format!("'contact.{over}"));
    }
}

/// A random study.
pub(crate) fn twin(random: &mut Random) -> Twin {
    let mass = Mass::random(random);
    let shaking = Shaking::random(random, &mass);
    let mut forms = Forms::default();
    mass.write(&mut forms);
    shaking.write(random, &mass, &mut forms);
    let asked = asked(random, &mass, &shaking);
    asked_tables(&asked, &mass, &shaking, &mut forms);
    let units = match mass.units {
        Units::None => "",
        Units::Si => "SI, ",
        Units::Millimetres => "mm-t-s, ",
    };
    let direction = if shaking.normal { "normal" } else { "tangential" };
    let drive = if mass.driven { "drive, " } else { "" };
    Twin {
        name: format!("{}, {units}{drive}{} {direction} dither", mass.kind, shaking.count),
        own: forms.own,
        system: forms.system,
        asked,
        scaled: mass.units == Units::Millimetres,
        renamed: RENAMED.to_vec(),
    }
}

/// What is asked about a study: the quick verbs, and some that follow long runs.
fn asked(random: &mut Random, mass: &Mass, shaking: &Shaking) -> Vec<Vec<String>> {
    let (low, high) = (0.3 * shaking.amplitude, 1.8 * shaking.amplitude);
    let high =
        if shaking.normal { high.min(0.97 * mass.load / f64::from(shaking.count)) } else { high };
    let [speed, end] = match mass.units {
        Units::None => ["0.02,0.3", "30"],
        _ => ["0.1 m/s,1 m/s", "1 s"],
    };
    let verbs = ["check", "stability", "orbit", "modes", "receptance", "resonances"];
    let mut asked: Vec<Vec<String>> =
        verbs.iter().map(|verb| vec![(*verb).to_owned(), "STUDY".to_owned()]).collect();
    for [verb, option, value] in [["friction", "--at", speed], ["simulate", "--until", end]] {
        asked.push([verb, "STUDY", option, value].map(str::to_owned).to_vec());
    }
    let long = [
        "response STUDY",
        "attractor STUDY",
        "waveforms STUDY",
        "basins STUDY --sample 2 --seed 1",
    ];
    asked.push(words(random.one_of(&long)));
    if mass.units == Units::None && shaking.count == 1 && !mass.driven {
        let range = format!("--parameter dither.amplitude --from {low:?} --to {high:?}");
        let over = [
            format!("bifurcation STUDY {range} --points 2"),
            format!("thresholds STUDY {range}"),
            format!("thresholds STUDY {range} --from-rest"),
            format!("thresholds STUDY {range} --from-squeal"),
            "map STUDY --quantity residual-vibration".to_owned(),
            "design STUDY".to_owned(),
        ];
        asked.push(words(random.one_of(&over.each_ref().map(String::as_str))));
    }
    asked
}
