//! Files about a study: `sketch` and `report`.

use std::fs;

use quell::template::CommentedStudy;
use serde_json::Value as Json;

use crate::place::Place;

fn place(name: &str) -> Place {
    let text = CommentedStudy::find("quench").expect("a template").text;
    Place::with(name, &[("quench.toml", text)])
}

#[test]
fn a_sketch_is_written_in_each_format() {
    let place = place("pages-sketch");
    for (name, begins) in
        [("a.svg", &b"<svg"[..]), ("a.png", &b"\x89PNG"[..]), ("a.pdf", &b"%PDF"[..])]
    {
        let (object, status) =
            place.json(&["sketch", "quench.toml", "--out", name, "--width", "85mm"]);
        assert_eq!((status, &object["saved"][0]), (0, &Json::from(name)), "{object}");
        assert_eq!(object["width_mm"], 85.0);
        assert!(object["text_size_pt"].as_f64().expect("a size") >= 7.0);
        let kinds: Vec<&str> = object["parts"]
            .as_array()
            .expect("parts")
            .iter()
            .filter_map(|part| part["kind"].as_str())
            .collect();
        for kind in ["mass", "spring", "damper", "surface", "load", "friction", "dither"] {
            assert!(kinds.contains(&kind), "{kind}: {kinds:?}");
        }
        assert!(fs::read(place.folder.join(name)).expect("a file").starts_with(begins), "{name}");
    }
}

#[test]
fn a_changed_value_changes_the_sketch() {
    let place = place("pages-change");
    let before = place.good(&["sketch", "quench.toml", "--out", "a.svg"]);
    let after =
        place.good(&["sketch", "quench.toml", "--out", "b.svg", "--set", "dither.amplitude=0.125"]);
    assert!(!before["key"].to_string().contains("0.125"));
    assert!(after["key"].to_string().contains("$D$ = 0.125"), "{after}");
}

#[test]
fn outputs_that_cannot_be_written_are_refused_before_anything_is_computed() {
    let place = place("pages-refused");
    fs::create_dir(place.folder.join("folder.svg")).expect("made");
    fs::create_dir(place.folder.join("folder.html")).expect("made");
    for words in [
        &["sketch", "quench.toml", "--out", "folder.svg"][..],
        &["sketch", "quench.toml", "--out", "quench.toml"],
        &["sketch", "quench.toml", "--out", "a.gif"],
        &["sketch", "quench.toml", "--out", "none/a.svg"],
        &["report", "quench.toml", "--out", "folder.html"],
        &["report", "quench.toml", "--out", "quench.toml"],
        &["report", "quench.toml", "--out", "a.pdf"],
        &["report", "quench.toml", "--out", "none/a.html"],
    ] {
        assert_eq!(place.refused(words)[0]["key"], "--out", "{words:?}");
    }
    for width in ["85", "40mm", "wide"] {
        let words = ["sketch", "quench.toml", "--out", "a.svg", "--width", width];
        assert_eq!(place.refused(&words)[0]["key"], "--width");
    }
    let words = ["report", "quench.toml", "--out", "a.html", "--without", "basins"];
    assert_eq!(place.refused(&words)[0]["key"], "--without");
}

#[test]
fn a_report_is_one_file() {
    let place = place("pages-report");
    let without = "response,orbit,thresholds";
    let (object, status) =
        place.json(&["report", "quench.toml", "--out", "page.html", "--without", without]);
    assert_eq!(status, 0, "{object}");
    let page = fs::read_to_string(place.folder.join("page.html")).expect("a page");
    assert!(page.starts_with("<!DOCTYPE html>"));
    assert!(page.contains(object["question"].as_str().expect("a question")));
    let verbs: Vec<&str> = object["answers"]
        .as_array()
        .expect("answers")
        .iter()
        .filter_map(|one| one["verb"].as_str())
        .collect();
    assert_eq!(verbs, ["stability", "modes", "friction"]);
}
