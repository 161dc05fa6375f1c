//! The help: verbs in groups, with examples of each.
//!
//! Examples use the files that `quell new NAME --save NAME.toml` creates, and the synthetic measurements in `studies`, so that each can be
//! run unchanged; a test does that.

use std::fmt::Write as _;

use clap::Command;

/// A verb and its examples.
type VerbExamples = (&'static str, &'static [&'static str]);

/// Headings with their verbs, in the order of the help.
const GROUPS: &[(&str, &[VerbExamples])] = &[
    (
        "Start here",
        &[
            ("new", &["quell new", "quell new quench --save quench.toml"]),
            ("check", &["quell check quench.toml", "quell check drive.toml --json"]),
            (
                "sketch",
                &[
                    "quell sketch quench.toml --out quench.svg",
                    "quell sketch two-mass-drive.toml --out drive.png --width 85mm",
                ],
            ),
            (
                "report",
                &[
                    "quell report quench.toml --out quench.html",
                    "quell report two-mass-drive.toml --out drive.html --without thresholds",
                ],
            ),
            ("schema", &["quell schema", "quell schema contact", "quell schema --json"]),
            ("completions", &["quell completions bash"]),
        ],
    ),
    (
        "Belts and systems",
        &[
            (
                "response",
                &[
                    "quell response quench.toml --plot response.svg",
                    "quell response brake-si.toml --set dither.amplitude_n=4000",
                ],
            ),
            (
                "thresholds",
                &[
                    "quell thresholds quench.toml --from-rest",
                    "quell thresholds drive.toml --parameter belt.belt_velocity_m_per_s --from 0.002 --to 0.04",
                    "quell thresholds two-mass-drive.toml --parameter dither.amplitude --from 3 --to 9 --along contact.guide.belt_velocity --between 0.04:0.06",
                ],
            ),
            (
                "waveforms",
                &[
                    "quell waveforms quench.toml",
                    "quell waveforms quench.toml --plot waveforms.svg",
                ],
            ),
            (
                "design",
                &[
                    "quell design design.toml",
                    "quell design design.toml --set design.limits.stroke=0.05 --plot design.svg",
                    "quell design actuator.toml",
                ],
            ),
            (
                "actuator",
                &[
                    "quell actuator actuator.toml",
                    "quell actuator actuator.toml --frequency 5kHz:60kHz --plot actuator.svg",
                ],
            ),
            (
                "probability",
                &[
                    "quell probability probability.toml",
                    "quell probability probability.toml --start local --samples 200 --plot probability.svg",
                ],
            ),
            (
                "friction",
                &[
                    "quell friction own-law.toml --measured --at 0.02,0.05,0.1",
                    "quell friction quench.toml --describing 0.1",
                    "quell friction quench.toml --save friction.inp",
                ],
            ),
            (
                "stability",
                &[
                    "quell stability quench.toml",
                    "quell stability mode-coupling.toml --parameter contact.pad.friction.coefficient --from 0.3 --to 0.9",
                ],
            ),
            (
                "orbit",
                &[
                    "quell orbit quench.toml",
                    "quell orbit driven-oscillator.toml --from-rest",
                    "quell orbit two-mass-drive.toml --plot orbit.svg",
                ],
            ),
            (
                "attractor",
                &[
                    "quell attractor every-start.toml --start 1.5,0",
                    "quell attractor driven-oscillator.toml --lyapunov",
                    "quell attractor two-mass-drive.toml --lyapunov --plot exponents.svg",
                ],
            ),
            (
                "simulate",
                &[
                    "quell simulate quench.toml --until 50 --events",
                    "quell simulate quench.toml --until 2000 --save quench.wav",
                    "quell simulate mode-coupling.toml --until 50 --start velocity.x=0.1 --plot motion.svg",
                ],
            ),
            (
                "bifurcation",
                &[
                    "quell bifurcation every-start.toml --parameter dither.amplitude --from 1 --to 2 --points 3",
                    "quell bifurcation every-start.toml --parameter dither.amplitude --from 1 --to 2 --points 3 --up",
                    "quell bifurcation two-mass-drive.toml --set dither.amplitude=0 --parameter contact.guide.belt_velocity --from 0.05 --to 0.15 --points 3",
                ],
            ),
            (
                "basins",
                &[
                    "quell basins every-start.toml --grid 4x3",
                    "quell basins every-start.toml --sample 10 --plot basins.svg",
                    "quell basins two-mass-drive.toml --plane carriage,velocity.carriage --grid 3x3",
                ],
            ),
        ],
    ),
    (
        "Discs and systems",
        &[
            ("modes", &["quell modes disc.toml", "quell modes mode-coupling.toml"]),
            (
                "resonances",
                &[
                    "quell resonances disc-dither.toml --clear 0.25:0.9 --frequency 2:6",
                    "quell resonances two-mass-drive.toml --frequency 1:100",
                ],
            ),
        ],
    ),
    (
        "Measurements",
        &[
            (
                "fit",
                &[
                    "quell fit synthetic-friction.csv --law decreasing --fix static_coefficient=0.38 --plot fit.svg",
                    "quell fit synthetic-decay.csv --decay --plot decay.svg",
                    "quell fit synthetic-squeal.csv --record --study measured-belt.toml --fix dither.amplitude_n=0 --free friction.static_coefficient,record.shift",
                ],
            ),
            (
                "compare",
                &[
                    "quell compare measured-belt.toml synthetic-squeal.csv --after synthetic-quenched.csv --plot compare.svg",
                    "quell compare measured-belt.toml synthetic-quenched.csv",
                ],
            ),
        ],
    ),
    (
        "Maps",
        &[(
            "map",
            &[
                "quell map map.toml --quantity residual-vibration --save map.zarr",
                "quell map disc-dither.toml --quantity growth",
            ],
        )],
    ),
    (
        "Papers",
        &[
            ("cite", &["quell cite quench.toml", "quell cite quench.toml --bibtex"]),
            ("reproduce", &["quell reproduce", "quell reproduce 2.3 --out figures"]),
        ],
    ),
];

/// Adds the groups of verbs and the examples to the help of the command line.
pub(crate) fn with_help(mut command: Command) -> Command {
    let mut listing = String::new();
    let verbs = || GROUPS.iter().flat_map(|(_, verbs)| *verbs);
    let width = verbs().map(|(verb, _)| verb.len()).max().unwrap_or(0);
    for (heading, verbs) in GROUPS {
        let _ = writeln!(listing, "{heading}:");
        for (verb, _) in *verbs {
            let about = command.find_subcommand(verb).and_then(Command::get_about);
            let about = about.map(ToString::to_string).unwrap_or_default();
            let _ = writeln!(listing, "  {verb:<width$}  {about}");
        }
        listing.push('\n');
    }
    for (verb, examples) in verbs() {
        command = command.mut_subcommand(verb, |command| {
            let mut text = String::from("Examples:\n");
            for example in *examples {
                let _ = writeln!(text, "  {example}");
            }
            if let Some(rest) = command.get_after_help() {
                let _ = write!(text, "\n{rest}");
            }
            command.after_help(text)
        });
    }
    command.help_template(format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n\n{listing}Options:\n{{options}}{{after-help}}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::command;

    #[test]
    fn every_verb_is_in_one_group_with_examples_that_parse() {
        let command = command();
        let mut grouped: Vec<&str> =
            GROUPS.iter().flat_map(|(_, verbs)| verbs.iter().map(|(verb, _)| *verb)).collect();
        let mut existing: Vec<&str> = command.get_subcommands().map(Command::get_name).collect();
        grouped.sort_unstable();
        existing.sort_unstable();
        assert_eq!(grouped, existing);
        for (verb, examples) in GROUPS.iter().flat_map(|(_, verbs)| *verbs) {
            // One for each kind of study at most.
            assert!((1..=3).contains(&examples.len()), "{verb}");
            for example in *examples {
                let words: Vec<&str> = example.split_whitespace().collect();
                assert_eq!(words[..2], ["quell", verb]);
                command.clone().try_get_matches_from(words).unwrap_or_else(|why| panic!("{why}"));
            }
        }
    }
}
