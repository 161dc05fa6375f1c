//! Reports: made of the answers of the verbs, complete in themselves, and with what was not examined.

use std::path::{Path, PathBuf};

use quell::Study;
use quell::report::{ReportRequest, StudyReport, run};
use quell::run::orbit::Wanted;
use quell::run::response::ResponseRequest;
use quell::study::Kind;
use quell::verbs::verbs;
use serde_json::Value as Json;

fn studies() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies")
}

fn study(name: &str) -> Study {
    let path = studies().join(format!("{name}.toml"));
    Study::read(&path, &[]).unwrap_or_else(|why| panic!("{name}: {why}"))
}

fn report(study: &Study) -> StudyReport {
    run(study, &ReportRequest::default()).expect("a report")
}

/// The search for thresholds, which takes longest, if the report of a study has one: if a dither acts.
fn thresholds_of(study: &Study) -> Vec<String> {
    let acts = match study.kind() {
        Kind::Belt(setup) => !setup.belt().dithers().is_empty(),
        Kind::Disc(_) => false,
        Kind::System(setup) => setup.system().is_dithered(),
    };
    if acts { vec!["thresholds".to_owned()] } else { Vec::new() }
}

/// The facts of a verb in a report.
fn facts<'a>(object: &'a Json, verb: &str) -> Option<&'a Json> {
    let answers = object["answers"].as_array().expect("answers");
    answers.iter().find(|answer| answer["verb"] == verb).map(|answer| &answer["facts"])
}

/// The sentence of a verb in a report.
fn sentence<'a>(object: &'a Json, verb: &str) -> Option<&'a str> {
    let answers = object["answers"].as_array().expect("answers");
    answers.iter().find(|answer| answer["verb"] == verb)?["sentence"].as_str()
}

/// Text as the page writes it in a table of numbers.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Every number of an object outside of long lists, as JSON writes it.
fn numbers(value: &Json, found: &mut Vec<String>) {
    match value {
        Json::Number(number) => found.push(number.to_string()),
        Json::Array(list) if list.len() <= 12 => {
            for inner in list {
                numbers(inner, found);
            }
        }
        Json::Object(object) => object.values().for_each(|inner| numbers(inner, found)),
        _ => {}
    }
}

#[test]
fn numbers_and_sentences_are_those_of_the_verbs() {
    for name in [
        "stribeck-belt",
        "does-it-squeal",
        "squealing-pad-si",
        "which-dither-frequency",
        "two-mass-drive",
    ] {
        let study = study(name);
        let request = ReportRequest { without: thresholds_of(&study) };
        let report = run(&study, &request).expect("a report");
        let (object, page) = (report.json(), report.html());
        let verbs = verbs(&study);
        let asked = [
            ("stability", verbs.stability()),
            ("response", verbs.response(&ResponseRequest::default())),
            ("orbit", verbs.orbit(&Wanted::default())),
            ("modes", verbs.modes()),
        ];
        let mut compared = 0;
        for (verb, reply) in asked {
            let Some(found) = facts(&object, verb) else {
                assert!(
                    reply.is_err() || !verbs.names().contains(&verb),
                    "{name}: {verb} is missing"
                );
                continue;
            };
            let outcome = reply.unwrap_or_else(|why| panic!("{name} {verb}: {why}"));
            assert_eq!(*found, outcome.facts(), "{name} {verb}");
            assert_eq!(sentence(&object, verb), outcome.sentence().as_deref(), "{name} {verb}");
            assert!(
                page.contains(&escaped(&outcome.table())),
                "{name} {verb}: the table is missing"
            );
            let mut wanted = Vec::new();
            numbers(found, &mut wanted);
            assert!(!wanted.is_empty(), "{name} {verb}");
            for number in &wanted {
                assert!(page.contains(number.as_str()), "{name} {verb}: {number} is missing");
            }
            compared += wanted.len();
        }
        assert!(compared > 20, "{name}: {compared}");
    }
}

#[test]
fn a_page_needs_nothing_else() {
    for name in
        ["stribeck-belt", "which-dither-frequency", "two-mass-drive", "bowed-string", "pid-drive"]
    {
        let without = ["response", "orbit"].map(str::to_owned).to_vec();
        let without = if name.starts_with("which") { Vec::new() } else { without };
        let without = [without, thresholds_of(&study(name))].concat();
        let report = run(&study(name), &ReportRequest { without }).expect("a report");
        let page = report.html();
        assert!(page.starts_with("<!DOCTYPE html>\n<html lang=\"en\">"), "{name}");
        for forbidden in
            ["<script", "<link", "src=\"http", "href=\"http", "url(http", "@import", "NaN", "inf<"]
        {
            assert!(!page.contains(forbidden), "{name}: {forbidden}");
        }
        // Every reference is within the page, and every anchor is there once.
        for reference in page.split("href=\"").skip(1) {
            let target = reference.split('"').next().unwrap_or_default();
            if let Some(anchor) = target.strip_prefix('#') {
                let count = page.matches(&format!("id=\"{anchor}\"")).count();
                assert_eq!(count, 1, "{name}: {anchor}");
            } else {
                assert!(target.starts_with("data:"), "{name}: {target}");
            }
        }
        for tag in [
            "section", "details", "summary", "article", "table", "tr", "ul", "li", "figure", "svg",
            "g", "h2", "h3", "p", "pre",
        ] {
            let opened = page.matches(&format!("<{tag}>")).count()
                + page.matches(&format!("<{tag} ")).count();
            assert_eq!(opened, page.matches(&format!("</{tag}>")).count(), "{name}: {tag}");
        }
        for heading in [
            "The answer",
            "The system",
            "Verdicts",
            "Cost of the dither",
            "What was not examined",
            "Assumptions",
            "Values of the study",
            "Every answer",
            "Versions and sources",
        ] {
            assert_eq!(
                page.matches(&format!("<h2>{heading}</h2>")).count(),
                1,
                "{name}: {heading}"
            );
        }
    }
}

#[test]
fn what_was_not_examined_is_about_this_study() {
    let subject = |object: &Json, name: &str| -> String {
        let gaps = object["not_examined"].as_array().expect("gaps");
        let found = gaps.iter().filter(|gap| gap["subject"] == name);
        found
            .map(|gap| gap["fact"].as_str().expect("text").to_owned())
            .collect::<Vec<_>>()
            .join(" ")
    };
    let squeal = report(&study("will-this-dither-quench-it")).json();
    assert!(subject(&squeal, "Other starts").contains("from the undithered limit cycle"));
    assert!(subject(&squeal, "Other dither frequencies").contains("the angular frequency 10 only"));
    assert!(
        subject(&squeal, "Other amplitudes").contains("`dither.amplitude` from 0 to "),
        "{squeal}"
    );
    assert!(subject(&squeal, "Uncertainty of the parameters").contains("belt.damping_ratio"));
    let disc = report(&study("which-dither-frequency")).json();
    assert!(subject(&disc, "Modes left out").contains("2 nodal diameters"));
    assert_eq!(subject(&disc, "Other starts"), "");
    // Steady sliding does not exist at v₀ = 0: its verbs refuse, with the reason.
    let request = ReportRequest { without: vec!["response".to_owned(), "orbit".to_owned()] };
    let still = run(&study("two-masses-nlvib"), &request).expect("a report").json();
    assert!(
        subject(&still, "Stability of steady sliding").contains("`quell stability` gave no answer"),
        "{still}"
    );
    let string = run(
        &study("bowed-string"),
        &ReportRequest { without: vec!["response".to_owned(), "orbit".to_owned()] },
    );
    let string = string.expect("a report").json();
    assert!(subject(&string, "Modes left out").contains("40 modes"));
    assert!(subject(&string, "Steady response").contains("left out by --without"));
}

#[test]
fn text_of_the_study_is_escaped() {
    let text = "# <script>alert(1)</script>?\ntitle = \"<script>alert('x')</script> & \\\"y\\\"\"\n[belt]\ndamping_ratio = 0.005\n\
                normal_load = 1.0\nbelt_velocity = 0.05\n[friction]\nlaw = \"coulomb\"\ncoefficient = 0.4\n";
    let study = Study::parse(text, &[]).expect("valid");
    let page = report(&study).html();
    assert!(!page.contains("<script"), "{page}");
    assert!(page.contains("<h1>&lt;script&gt;"));
    assert!(page.contains("<p class=\"lead\">&lt;script&gt;alert(1)&lt;/script&gt;?</p>"));
}

#[test]
fn a_verb_that_the_report_does_not_have_is_refused() {
    let request = ReportRequest { without: vec!["basins".to_owned()] };
    let refused = run(&study("stribeck-belt"), &request).err().expect("refused").to_string();
    assert!(refused.contains("basins") && refused.contains("thresholds"), "{refused}");
}

#[test]
fn equal_studies_have_equal_reports() {
    let study = study("does-it-squeal");
    assert_eq!(report(&study).html(), report(&study).html());
}

/// The tables that ask a question have sections with the answers of their verbs.
#[test]
fn questions_of_a_study_have_sections() {
    let actuated = study("actuator");
    let without = ["response", "orbit", "thresholds", "friction", "stability"].map(str::to_owned);
    let request = ReportRequest { without: without.to_vec() };
    let object = run(&actuated, &request).expect("a report").json();
    let own = verbs(&actuated);
    for (verb, done) in [("design", own.design()), ("actuator", own.actuator(None))] {
        let done = done.unwrap_or_else(|why| panic!("{verb}: {why}"));
        assert_eq!(sentence(&object, verb).map(str::to_owned), done.sentence());
        assert_eq!(facts(&object, verb), Some(&done.facts()));
    }
    assert_eq!(facts(&object, "probability"), None);
    let uncertain = study("probability");
    let without = ["response", "orbit", "thresholds", "friction", "stability"].map(str::to_owned);
    let known: Vec<String> = without
        .into_iter()
        .filter(|verb| verb != "thresholds" || !thresholds_of(&uncertain).is_empty())
        .collect();
    let object = run(&uncertain, &ReportRequest { without: known }).expect("a report").json();
    assert!(sentence(&object, "probability").is_some());
    assert_eq!(facts(&object, "design"), None);
}
