//! New studies, help with its examples, completions, BibTeX; and sentences that answer the question.

use std::collections::BTreeSet;

use quell::template::TEMPLATES;

use crate::place::Place;

/// A folder with a file of every template.
fn place(name: &str) -> Place {
    let files: Vec<(String, &str)> =
        TEMPLATES.iter().map(|item| (format!("{}.toml", item.name), item.text)).collect();
    let mut files: Vec<(&str, &str)> =
        files.iter().map(|(name, text)| (name.as_str(), *text)).collect();
    let measured = include_str!("../../../studies/synthetic-friction.csv");
    files.push(("synthetic-friction.csv", measured));
    files.push(("synthetic-decay.csv", include_str!("../../../studies/synthetic-decay.csv")));
    files.push(("synthetic-squeal.csv", include_str!("../../../studies/synthetic-squeal.csv")));
    files.push(("synthetic-quenched.csv", include_str!("../../../studies/synthetic-quenched.csv")));
    files.push(("measured-belt.toml", include_str!("../../../studies/measured-belt.toml")));
    files.push(("design.toml", include_str!("../../../studies/design.toml")));
    files.push(("actuator.toml", include_str!("../../../studies/actuator.toml")));
    files.push(("probability.toml", include_str!("../../../studies/probability.toml")));
    Place::with(name, &files)
}

/// Standard output of a command that succeeds.
fn said(place: &Place, command: &str) -> String {
    let words: Vec<&str> = command.split_whitespace().skip(1).collect();
    let output = place.quell(&words);
    let printed = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{command}: {printed}");
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// The examples in the help of a verb.
fn examples(help: &str) -> Vec<String> {
    let after = help.split_once("Examples:\n").map_or("", |(_, after)| after);
    after.lines().map_while(|line| line.strip_prefix("  ")).map(str::to_owned).collect()
}

#[test]
fn the_help_lists_every_verb_in_its_group() {
    let place = place("doors-help");
    let help = said(&place, "quell --help");
    let mut at = 0;
    for heading in [
        "Start here:",
        "Belts and systems:",
        "Discs and systems:",
        "Measurements:",
        "Maps:",
        "Papers:",
        "Options:",
    ] {
        let found = help[at..].find(heading).unwrap_or_else(|| panic!("{heading}: {help}"));
        at += found;
    }
    let (before, _) = help.split_once("Belts and systems:").expect("groups");
    assert!(before.contains("\n  new ") && before.contains("\n  check "), "{help}");
    assert_eq!(said(&place, "quell help orbit"), said(&place, "quell orbit --help"));
}

/// Every command in a template or in the help of a verb, except `reproduce`, which takes a minute.
#[test]
fn every_example_runs() {
    let place = place("doors-examples");
    let mut commands: BTreeSet<String> = BTreeSet::new();
    for template in TEMPLATES {
        commands.extend(template.commands().map(str::to_owned));
    }
    let help = said(&place, "quell --help");
    let verbs = help.lines().filter_map(|line| line.strip_prefix("  ")?.split_once("  "));
    let verbs = verbs.map(|(verb, _)| verb).filter(|verb| verb.chars().all(char::is_alphabetic));
    let mut count = 0;
    for verb in verbs {
        let found = examples(&said(&place, &format!("quell {verb} --help")));
        assert!(!found.is_empty(), "{verb}");
        count += 1;
        commands.extend(found.into_iter().filter(|_| verb != "reproduce"));
    }
    assert!(count >= 17 && commands.len() > 40, "{count} {commands:?}");
    // One example creates a file that already exists.
    std::fs::remove_file(place.folder.join("quench.toml")).expect("there");
    said(&place, "quell new quench --save quench.toml");
    commands.remove("quell new quench --save quench.toml");
    let commands: Vec<String> = commands.into_iter().collect();
    std::thread::scope(|scope| {
        for half in 0..2 {
            let (place, commands) = (&place, &commands);
            scope.spawn(move || {
                for command in commands.iter().skip(half).step_by(2) {
                    let begun = std::time::Instant::now();
                    assert!(!said(place, command).is_empty(), "{command}");
                    eprintln!("{:8.2?}  {command}", begun.elapsed());
                }
            });
        }
    });
}

#[test]
fn a_new_study_is_printed_or_saved_without_overwriting() {
    let place = Place::with("doors-new", &[]);
    let list = said(&place, "quell new");
    for template in TEMPLATES {
        assert!(list.contains(template.name) && list.contains(template.question()), "{list}");
    }
    assert_eq!(said(&place, "quell new drive"), TEMPLATES[2].text);
    let saved = said(&place, "quell new drive --save my-drive.toml");
    assert!(saved.contains("  quell check my-drive.toml\n"), "{saved}");
    let errors = place.refused(&["new", "quench", "--save", "my-drive.toml"]);
    assert!(errors[0]["allowed"].as_str().expect("text").contains("--overwrite"), "{errors:?}");
    assert!(said(&place, "quell check my-drive.toml").contains("The study is valid"));
    said(&place, "quell new quench --save my-drive.toml --overwrite");
    let errors = place.refused(&["new", "qench"]);
    assert_eq!(errors[0]["suggestion"], "quench");
    place.refused(&["new", "--save", "x.toml"]);
    place.refused(&["new", "quench", "--save", "x.txt"]);
    assert_eq!(
        place.good(&["new"])["questions"].as_array().expect("a list").len(),
        TEMPLATES.len()
    );
}

#[test]
fn completions_are_printed_for_shells() {
    let place = Place::with("doors-completions", &[]);
    for (shell, word) in [
        ("bash", "complete "),
        ("zsh", "#compdef quell"),
        ("fish", "complete -c quell"),
        ("powershell", "Register-ArgumentCompleter"),
        ("elvish", "edit:completion"),
    ] {
        let script = said(&place, &format!("quell completions {shell}"));
        for word in [word, "thresholds", "from-squeal", "exact"] {
            assert!(script.contains(word), "{shell}: {word}");
        }
    }
    place.refused(&["completions", "tcsh"]);
}

#[test]
fn cite_prints_the_entries_that_a_study_uses() {
    let place = place("doors-bibtex");
    let keys = |study: &str| -> BTreeSet<String> {
        let text = said(&place, &format!("quell cite {study} --bibtex"));
        assert_eq!(place.good(&["cite", study, "--bibtex"])["bibtex"], text);
        let entries = text.lines().filter_map(|line| line.strip_prefix('@')?.split_once('{'));
        entries.map(|(_, key)| key.trim_end_matches(',').to_owned()).collect()
    };
    for study in ["quench.toml", "disc-dither.toml", "mode-coupling.toml"] {
        let object = place.good(&["cite", study]);
        let sources = object["sources"].as_array().expect("a list");
        let named = sources.iter().map(|source| source["key"].as_str().expect("a key").to_owned());
        assert_eq!(keys(study), named.collect());
    }
    assert!(keys("quench.toml").contains("jorba2005") && !keys("disc.toml").contains("jorba2005"));
}

/// The amplitude of a dither needs no range: it is searched up to the limit of maps, in the unit of its key.
#[test]
fn thresholds_of_an_amplitude_need_no_range() {
    let place = place("doors-no-range");
    let numbers = |words: &[&str]| {
        let found = place.good(&[&["thresholds"], words].concat());
        let number = |value: &serde_json::Value| value.as_f64().expect("a number");
        (number(&found["from"]), number(&found["to"]), number(&found["local"][0]["value"]))
    };
    let (from, to, value) = numbers(&["quench.toml"]);
    assert!(from == 0.0 && (0.98..1.0).contains(&to), "{to}");
    assert!((value - 0.496_561_891_28).abs() < 1e-10, "{value}");
    let own = numbers(&["brake-si.toml"]);
    let newtons = numbers(&["brake-si.toml", "--parameter", "dither.amplitude_n"]);
    assert!((own.1 / newtons.1 - 1.0).abs() < 1e-12 && own.2 == newtons.2, "{own:?} {newtons:?}");
    // One end is enough; a curve has the limit of all its values, and a slow dither that of static friction.
    assert_eq!(numbers(&["quench.toml", "--to", "0.6"]).1, 0.6);
    let fast = ["quench.toml", "--along", "belt.belt_velocity", "--between", "0.11:0.14"];
    let curves = place.good(&[&["thresholds"][..], &fast].concat());
    assert_eq!(curves["curves"].as_array().map(Vec::len), Some(1), "{curves}");
    let slow = numbers(&["quench.toml", "--set", "dither.frequency_ratio=2"]);
    assert!((slow.2 - 0.236_608).abs() < 1e-6, "{slow:?}");
    place.write("free.toml", FREE);
    for (words, key) in [
        (&["quench.toml", "--parameter", "belt.belt_velocity"][..], "--from"),
        (&["free.toml"], "dither"),
    ] {
        let errors = place.refused(&[&["thresholds"], words].concat());
        assert_eq!(errors[0]["key"], key, "{errors:?}");
        assert_eq!(errors[0]["fault"], "missing");
    }
}

/// A belt without dither.
const FREE: &str = r#"
[belt]
damping_ratio = 0.005
normal_load = 1.0
belt_velocity = 0.05
[friction]
law = "coulomb"
coefficient = 0.3
"#;

/// A belt beyond its critical velocity.
const DECREASING: [&str; 2] = ["friction.law=decreasing", "belt.belt_velocity=1"];

/// The sentence of `thresholds` contains the number, its condition, and every requested start.
#[test]
fn thresholds_answer_with_the_number() {
    let place = place("doors-thresholds");
    let sentence = |study: &str, parameter: &str, range: [&str; 2], more: &[&str]| -> String {
        let [from, to] = range;
        let mut words =
            vec!["thresholds", study, "--parameter", parameter, "--from", from, "--to", to];
        words.extend(more);
        let object = place.good(&words);
        let sentence = object["sentence"].as_str().expect("a sentence").to_owned();
        let text = String::from_utf8(place.quell(&words).stdout).expect("UTF-8");
        assert!(text.contains(&format!("{sentence}\n")), "{text}");
        sentence
    };
    let amplitude = "dither.amplitude";
    assert_eq!(
        sentence("quench.toml", amplitude, ["0.4", "0.6"], &["--from-rest", "--from-squeal"]),
        "The base response is stable from the dither amplitude 0.4966 on (grazing) and unstable below. \
         For runs from rest or from the undithered limit cycle, the dither quenches from the dither amplitude 0.4966 on (grazing)."
    );
    assert_eq!(
        sentence("quench.toml", amplitude, ["0.3", "0.4"], &["--from-rest"]),
        "The base response is unstable at every dither amplitude from 0.3 to 0.4 (no threshold in this range). \
         For runs from rest, the dither quenches at no dither amplitude from 0.3 to 0.4."
    );
    // Several intervals, and a branch that turns back.
    let law = DECREASING.map(|change| ["--set", change]).concat();
    let with = |more: &[&'static str]| [law.clone(), more.to_vec()].concat();
    assert_eq!(
        sentence(
            "quench.toml",
            amplitude,
            ["0.5", "10.5"],
            &with(&["--from-rest", "--from-squeal"])
        ),
        "The base response is stable up to the dither amplitude 4.322 (neimark-sacker, subcritical: the motion jumps) and from \
         9.9 on (grazing). \
         For runs from rest, which end quiet without dither, the motion stays quiet up to the dither amplitude 2.868 and from 9.9 on (grazing); \
         for runs from the undithered limit cycle, the dither quenches from the dither amplitude 9.9 on (grazing)."
    );
    assert_eq!(
        sentence(
            "quench.toml",
            amplitude,
            ["1e-4", "3e-3"],
            &with(&["--set", "dither.frequency_ratio=1"])
        ),
        "The base response is stable up to the dither amplitude 0.001572 (fold, opens towards smaller \
         dither amplitude)."
    );
    let turning = place.good(
        &[
            &[
                "thresholds",
                "quench.toml",
                "--parameter",
                amplitude,
                "--from",
                "1e-4",
                "--to",
                "3e-3",
            ][..],
            &with(&["--set", "dither.frequency_ratio=1"]),
        ]
        .concat(),
    );
    assert_eq!(
        turning["notes"][0],
        "There the response turns back; beyond, runs end on another motion."
    );
    let drive = sentence("drive.toml", "belt.belt_velocity_m_per_s", ["0.005", "0.04"], &[]);
    assert!(
        drive.starts_with("Steady sliding becomes stable at the belt velocity 0.02")
            && drive.contains("ceases to grow (supercritical: the vibration grows from zero)"),
        "{drive}"
    );
}

/// v₀ = 0: an oscillator with dry friction driven by a force, from rest.
#[test]
fn a_support_at_rest_has_orbits_from_rest() {
    let place = place("doors-driven");
    let file = "driven-oscillator.toml";
    let object = place.good(&["orbit", file]);
    let run = place.good(&["orbit", file, "--from-rest"]);
    assert_eq!(object["displacement"], run["displacement"]);
    let reversals = &object["contacts"][0]["reversals"];
    assert_eq!((&object["verdict"], reversals), (&"stable".into(), &2.into()));
    assert!(object["no_base_response"].is_string(), "{object}");
    assert!(run["no_base_response"].is_null(), "{run}");
    let errors = place.refused(&["orbit", file, "--periods", "2"]);
    assert_eq!(errors[0]["key"], "--periods");
    // With a support at rest, a dither weaker than stiction causes no motion.
    let weak = place.good(&["orbit", file, "--set", "dither.amplitude=0.2"]);
    assert_eq!(weak["contacts"][0]["stick_fraction"], 1.0);
    let range = ["--from", "1", "--to", "2"];
    let words = [
        "thresholds",
        file,
        "--parameter",
        "dither.amplitude",
        range[0],
        range[1],
        range[2],
        range[3],
    ];
    let (found, status) = place.json(&words);
    let why = found["errors"][0]["message"].as_str().unwrap_or_default();
    assert!(status == 1 && why.contains("does not move") && why.contains("--near"), "{found}");
}

/// An option that asks another question has an answer of another name, so that a reader of JSON knows its fields.
#[test]
fn answers_name_what_they_are() {
    let place = place("doors-names");
    let file = format!("{}/../../studies/stribeck-belt.toml", env!("CARGO_MANIFEST_DIR"));
    let belt = file.as_str();
    for (arguments, name) in [
        (&["response", belt][..], "response"),
        (&["response", belt, "--window", "10:20"], "window"),
        (&["stability", belt], "stability"),
        (&["stability", belt, "--exact", "--set", "dither.amplitude=0.1"], "exact-stability"),
        (&["friction", belt], "friction"),
        (&["friction", belt, "--describing", "0.1"], "describing-function"),
        (&["thresholds", belt], "thresholds"),
        (
            &["thresholds", belt, "--along", "belt.belt_velocity", "--between", "0.05:0.06"],
            "threshold-curves",
        ),
        (
            &[
                "stability",
                belt,
                "--parameter",
                "belt.belt_velocity",
                "--from",
                "0.1",
                "--to",
                "0.3",
            ],
            "tracked-stability",
        ),
        (&["resonances", belt], "reach"),
    ] {
        let object = place.good(arguments);
        assert_eq!(object["answer"], name, "{arguments:?}");
        let first: Vec<_> = object.as_object().expect("an object").keys().take(2).collect();
        assert_eq!(first, ["ok", "answer"]);
    }
}
