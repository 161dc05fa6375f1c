//! One verb, one file, one `run`; the table has a line for each verb.

use clap::Subcommand;
use quell::Failure;

use crate::answer::Answer;

pub(crate) mod completions;
mod numbers;
mod shard;

/// A verb and its examples.
type VerbExamples = (&'static str, &'static [&'static str]);

/// A heading of the help with its verbs.
pub(crate) type VerbGroup = (&'static str, &'static [VerbExamples]);

/// The verbs in groups: module, variant and dispatch of each, and the groups of the help. A verb's module has the arguments and the run;
/// its words in the help are the documentation of the arguments.
macro_rules! verbs {
    ($($heading:literal {$($verb:ident($module:ident): [$($example:literal),+ $(,)?]),+ $(,)?})+) => {
        $($(mod $module;)+)+

        /// The verbs that answer.
        #[derive(Debug, Subcommand)]
        pub(crate) enum Verb {
            $($($verb($module::Arguments),)+)+
        }

        impl Verb {
            /// The answer of the verb.
            pub(crate) fn run(&self) -> Result<Answer, Failure> {
                match self {
                    $($(Self::$verb(arguments) => $module::run(arguments),)+)+
                }
            }
        }

        /// Headings with their verbs and examples, in the order of the help.
        ///
        /// Examples use the files that `quell new NAME --save NAME.toml` creates, and the synthetic measurements in `studies`, so that
        /// each can be run unchanged; a test does that.
        pub(crate) const GROUPS: &[VerbGroup] = &[
            $(($heading, &[$((stringify!($module), &[$($example),+])),+])),+
        ];
    };
}

verbs! {
    "Start here" {
        New(new): [
            "quell new",
            "quell new quench --save quench.toml",
        ],
        Check(check): [
            "quell check quench.toml",
            "quell check drive.toml --json",
        ],
        Sketch(sketch): [
            "quell sketch quench.toml --out quench.svg",
            "quell sketch two-mass-drive.toml --out drive.png --width 85mm",
        ],
        Report(report): [
            "quell report quench.toml --out quench.html",
            "quell report two-mass-drive.toml --out drive.html --without thresholds",
        ],
        Convert(convert): [
            "quell convert quench.toml",
            "quell convert disc.toml --to system --save disc-as-system.toml",
        ],
        Schema(schema): [
            "quell schema",
            "quell schema contact",
            "quell schema --json",
        ],
    }
    "Belts and systems" {
        Response(response): [
            "quell response quench.toml --plot response.svg",
            "quell response brake-si.toml --set dither.amplitude_n=4000",
        ],
        Thresholds(thresholds): [
            "quell thresholds quench.toml --from-rest",
            "quell thresholds drive.toml --parameter belt.belt_velocity_m_per_s --from 0.002 --to 0.04",
            "quell thresholds two-mass-drive.toml --parameter dither.amplitude --from 3 --to 9 --along contact.guide.belt_velocity --between 0.04:0.06",
        ],
        Waveforms(waveforms): [
            "quell waveforms quench.toml",
            "quell waveforms quench.toml --plot waveforms.svg",
        ],
        Design(design): [
            "quell design design.toml",
            "quell design design.toml --set design.limits.stroke=0.05 --plot design.svg",
            "quell design actuator.toml",
        ],
        Actuator(actuator): [
            "quell actuator actuator.toml",
            "quell actuator actuator.toml --frequency 5kHz:60kHz --plot actuator.svg",
        ],
        Probability(probability): [
            "quell probability probability.toml",
            "quell probability probability.toml --start local --samples 200 --plot probability.svg",
        ],
        Friction(friction): [
            "quell friction own-law.toml --measured --at 0.02,0.05,0.1",
            "quell friction quench.toml --describing 0.1",
            "quell friction quench.toml --save friction.inp",
        ],
        Stability(stability): [
            "quell stability quench.toml",
            "quell stability mode-coupling.toml --parameter contact.pad.friction.coefficient --from 0.3 --to 0.9",
        ],
        Orbit(orbit): [
            "quell orbit quench.toml",
            "quell orbit driven-oscillator.toml --from-rest",
            "quell orbit two-mass-drive.toml --plot orbit.svg",
        ],
        Attractor(attractor): [
            "quell attractor every-start.toml --start 1.5,0",
            "quell attractor driven-oscillator.toml --lyapunov",
            "quell attractor two-mass-drive.toml --lyapunov --plot exponents.svg",
        ],
        Simulate(simulate): [
            "quell simulate quench.toml --until 50 --events",
            "quell simulate quench.toml --until 2000 --save quench.wav",
            "quell simulate mode-coupling.toml --until 50 --start velocity.x=0.1 --plot motion.svg",
        ],
        Bifurcation(bifurcation): [
            "quell bifurcation every-start.toml --parameter dither.amplitude --from 1 --to 2 --points 3",
            "quell bifurcation every-start.toml --parameter dither.amplitude --from 1 --to 2 --points 3 --up",
            "quell bifurcation two-mass-drive.toml --set dither.amplitude=0 --parameter contact.guide.belt_velocity --from 0.05 --to 0.15 --points 3",
        ],
        Basins(basins): [
            "quell basins every-start.toml --grid 4x3",
            "quell basins every-start.toml --sample 10 --plot basins.svg",
            "quell basins two-mass-drive.toml --plane carriage,velocity.carriage --grid 3x3",
        ],
    }
    "Discs and systems" {
        Modes(modes): [
            "quell modes disc.toml",
            "quell modes mode-coupling.toml",
        ],
        Receptance(receptance): [
            "quell receptance mode-coupling.toml --plot receptance.svg",
            "quell receptance two-mass-drive.toml --outputs carriage --inputs carriage --frequency 0:20 --save carriage.csv",
        ],
        Resonances(resonances): [
            "quell resonances disc-dither.toml --clear 0.25:0.9 --frequency 2:6",
            "quell resonances two-mass-drive.toml --frequency 1:100",
        ],
    }
    "Measurements" {
        Fit(fit): [
            "quell fit synthetic-friction.csv --law decreasing --fix static_coefficient=0.38 --plot fit.svg",
            "quell fit synthetic-decay.csv --decay --plot decay.svg",
            "quell fit synthetic-squeal.csv --record --study measured-belt.toml --fix dither.amplitude_n=0 --free friction.static_coefficient,record.shift",
        ],
        Compare(compare): [
            "quell compare measured-belt.toml synthetic-squeal.csv --after synthetic-quenched.csv --plot compare.svg",
            "quell compare measured-belt.toml synthetic-quenched.csv",
        ],
    }
    "Maps" {
        Map(map): [
            "quell map map.toml --quantity residual-vibration --save map.zarr",
            "quell map disc-dither.toml --quantity growth",
        ],
    }
    "Papers" {
        Cite(cite): [
            "quell cite quench.toml",
            "quell cite quench.toml --bibtex",
        ],
        Reproduce(reproduce): [
            "quell reproduce",
            "quell reproduce 2.3 --out figures",
        ],
    }
}
