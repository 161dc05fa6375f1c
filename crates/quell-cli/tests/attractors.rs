//! Tests of the binary: bifurcation diagrams and basins.

use serde_json::Value as Json;

use crate::repository::{quell, words};

/// Decreasing law, v₀ = 1, ζ = 0.005, sine tangential dither with R = 10, D = 2.5.
const STUDY: &str = "studies/will-every-start-fall-quiet.toml";

fn swept(study: &str, range: [&str; 3], more: &[&str]) -> Json {
    let [from, to, points] = range;
    let mut arguments = vec!["bifurcation", study, "--parameter", "dither.amplitude"];
    arguments.extend(["--from", from, "--to", to, "--points", points]);
    arguments.extend(more);
    let (found, status) = quell(&arguments);
    assert_eq!(status, 0, "{found}");
    found
}

fn pair(it: &Json) -> (f64, f64) {
    (it[0].as_f64().expect("from"), it[1].as_f64().expect("to"))
}

/// Swept up, the response is quiescent up to 4.3 and no longer at 4.4 (local threshold 4.3224); swept down, the vibration starts
/// below 9.9002 and persists down to 0.
#[test]
fn sweeps_up_and_down_differ_where_responses_coexist() {
    let found = swept(STUDY, ["0", "11", "12"], &[]);
    let hysteresis = found["hysteresis"].as_array().expect("stretches");
    assert_eq!(hysteresis.len(), 1, "{hysteresis:?}");
    assert_eq!(pair(&hysteresis[0]), (0.0, 4.0));
    let up = found["up"].as_array().expect("up");
    let down = found["down"].as_array().expect("down");
    assert_eq!((up.len(), down.len()), (12, 12));
    for (k, point) in up.iter().enumerate() {
        assert_eq!(point["value"], k as f64);
        assert_eq!(point["quiet"], k <= 4 || k >= 10, "{point}");
        let stable = if k <= 4 || k >= 10 { "stable" } else { "unstable" };
        assert_eq!(point["local_verdict"], stable);
        // Swept down: quiescent only above 9.9.
        assert_eq!(down[11 - k]["value"], k as f64);
        assert_eq!(down[11 - k]["quiet"], k >= 10);
    }
    assert_eq!(found["jumps"].as_array().expect("jumps").len(), 3);
    // Without dither, the peak-to-peak vibration is 2.09.
    let last = down[11]["peak_to_peak"].as_f64().expect("a size");
    assert!((last - 2.09).abs() < 0.01, "{last}");
    assert!(found["sentence"].as_str().expect("words").contains("from 0 to 4"));
}

#[test]
fn the_quiescent_response_is_lost_just_above_its_threshold() {
    let found = swept(STUDY, ["0", "4.8", "49"], &["--up"]);
    let jump = &found["jumps"][0];
    assert!((jump["before"].as_f64().expect("before") - 4.3).abs() < 1e-9, "{jump}");
    assert!((jump["after"].as_f64().expect("after") - 4.4).abs() < 1e-9, "{jump}");
    assert!(found["hysteresis"].is_null() && found["why"]["hysteresis"].is_string());
    let found = swept(STUDY, ["9.87", "9.93", "4"], &["--down"]);
    let jump = &found["jumps"][0];
    assert_eq!(
        (jump["direction"].as_str(), jump["becomes"].as_str()),
        (Some("down"), Some("not quiet"))
    );
    assert!((jump["before"].as_f64().expect("before") - 9.91).abs() < 1e-9, "{jump}");
    // Small at the threshold, and growing with the distance from it.
    let size = |k: usize| found["down"][k]["peak_to_peak"].as_f64().expect("a size");
    let quiet = size(1);
    assert!(size(2) - quiet < 0.05 && size(3) > size(2), "{} {} {quiet}", size(2), size(3));
}

#[test]
fn the_stribeck_law_has_no_hysteresis_and_locks() {
    let found = swept("studies/figure-2.3.toml", ["0.3", "0.6", "7"], &[]);
    assert_eq!(found["hysteresis"].as_array().map(Vec::len), Some(0), "{}", found["hysteresis"]);
    let first = &found["up"][0];
    assert_eq!(first["kind"], "locked");
    assert_eq!(first["locking"], serde_json::json!({ "turns": 5, "periods": 68 }));
    assert!((first["frequency"].as_f64().expect("a frequency") - 0.735_294).abs() < 1e-5);
    assert_eq!(first["section_displacement"].as_array().map(Vec::len), Some(68));
    assert!(first["multiplier"].as_f64().expect("one") < 1.0);
    let last = &found["up"][6];
    assert_eq!((&last["kind"], &last["quiet"]), (&"period-1".into(), &true.into()));
}

/// At D = 2.5 the base response is stable, and only a part of all starts reaches it; the number of threads changes no bit.
#[test]
fn basins_have_shares_with_bounds() {
    let window = ["--displacement", "-1.5:2", "--velocity", "-1.5:1.5", "--grid", "21x15"];
    let run = |threads: &str| {
        let mut arguments = vec!["basins", STUDY, "--threads", threads];
        arguments.extend(window);
        quell(&arguments)
    };
    let ((found, status), (again, _)) = (run("1"), run("3"));
    assert_eq!(status, 0, "{found}");
    assert_eq!(found, again);
    let attractors = found["attractors"].as_array().expect("attractors");
    assert_eq!(attractors.len(), 2, "{found}");
    let number = |item: &Json, name: &str| item[name].as_f64().expect("a number");
    let quiet = &attractors[0];
    assert_eq!((&quiet["quiet"], &quiet["kind"]), (&true.into(), &"period-1".into()));
    assert_eq!(found["local_verdict"], "stable");
    let fraction = number(quiet, "fraction");
    // A grid of 41 × 31 starts over the same window gives 4.2 %.
    let within = number(quiet, "fraction_low")..number(quiet, "fraction_high");
    assert!(within.contains(&0.042), "{within:?}");
    assert!(number(quiet, "fraction_low") < fraction && fraction < number(quiet, "fraction_high"));
    let sum: f64 = attractors.iter().map(|item| number(item, "fraction")).sum();
    assert!((sum - 1.0).abs() < 1e-12 && number(&found["unknown"], "starts") == 0.0, "{found}");
    let ends = found["ends"].as_array().expect("ends");
    assert_eq!(ends.len(), 21 * 15);
    assert_eq!(ends.iter().filter(|item| **item == 0).count() as f64, number(quiet, "starts"));
    assert!(found["sentence"].as_str().expect("words").starts_with("Only "));
    // A random sample of the same window agrees within its own interval and the grid's.
    let mut arguments = vec!["basins", STUDY, "--sample", "300", "--seed", "7"];
    arguments.extend(&window[..4]);
    let (sample, _) = quell(&arguments);
    let low = number(&sample["attractors"][0], "fraction_low");
    let high = number(&sample["attractors"][0], "fraction_high");
    assert!(low < number(quiet, "fraction_high") && number(quiet, "fraction_low") < high);
    assert!(sample["error_meaning"].as_str().expect("words").contains("Wilson"));
}

#[test]
fn basins_without_dither_and_over_a_parameter() {
    // Above the critical velocity sliding is stable, and coexists with squeal.
    let (found, status) =
        quell(&["basins", "studies/can-it-squeal-although-stable.toml", "--grid", "9x7"]);
    assert_eq!(status, 0, "{found}");
    let kinds: Vec<&str> = found["attractors"]
        .as_array()
        .expect("attractors")
        .iter()
        .filter_map(|item| item["kind"].as_str())
        .collect();
    assert_eq!(kinds, ["rest", "limit-cycle"]);
    // Between the local thresholds no start becomes quiescent; above the upper one every start does.
    let mut arguments = vec!["basins", STUDY, "--grid", "5x4", "--over", "dither.amplitude"];
    arguments.extend(["--from", "2", "--to", "10", "--points", "3"]);
    let (found, status) = quell(&arguments);
    assert_eq!(status, 0, "{found}");
    let portraits = found["portraits"].as_array().expect("portraits");
    let shares: Vec<f64> =
        portraits.iter().map(|item| item["quiet_fraction"].as_f64().expect("a share")).collect();
    assert!(
        0.0 < shares[0] && shares[0] < 1.0 && shares[1] == 0.0 && shares[2] == 1.0,
        "{shares:?}"
    );
    let verdicts: Vec<&str> =
        portraits.iter().filter_map(|item| item["local_verdict"].as_str()).collect();
    assert_eq!(verdicts, ["stable", "unstable", "stable"]);
    // The printed table has the same rows.
    let rows: Vec<Vec<String>> = words(&arguments)
        .lines()
        .skip_while(|line| !line.contains("stability      share of starts"))
        .skip(1)
        .take(3)
        .map(|line| line.split_whitespace().map(str::to_owned).collect())
        .collect();
    for (row, (verdict, share)) in rows.iter().zip(verdicts.iter().zip(&shares)) {
        assert_eq!(row[1], *verdict, "{rows:?}");
        let percent = row[2].parse::<f64>().expect("a share");
        assert!((percent - 100.0 * share).abs() < 0.06, "{rows:?}");
    }
    assert_eq!(rows.len(), 3);
}

#[test]
fn numbers_and_pictures_are_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (csv, svg) = (path("up.csv"), path("up.svg"));
    let found = swept(STUDY, ["9.6", "10.2", "4"], &["--up", "--save", &csv, "--plot", &svg]);
    let points = found["up"].as_array().expect("points");
    let states: usize =
        points.iter().map(|item| item["section_velocity"].as_array().map_or(0, Vec::len)).sum();
    let text = std::fs::read_to_string(&csv).expect("saved");
    let rows: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).collect();
    assert_eq!(rows.len(), states + 1);
    assert!(rows[0].starts_with("row,direction,parameter,kind,quiet,local_verdict"), "{}", rows[0]);
    assert!(std::fs::read_to_string(&svg).expect("drawn").starts_with("<svg"));
    let (csv, png) = (path("map.csv"), path("map.png"));
    let (found, status) =
        quell(&["basins", STUDY, "--grid", "4x3", "--save", &csv, "--plot", &png]);
    assert_eq!(status, 0, "{found}");
    let text = std::fs::read_to_string(&csv).expect("saved");
    assert_eq!(text.lines().filter(|line| !line.starts_with('#')).count(), 13);
    assert!(text.contains("velocity.x,x,attractor,quiet"));
}

#[test]
fn all_errors_are_reported_at_once() {
    let keys = |arguments: &[&str]| -> Vec<String> {
        let (printed, status) = quell(arguments);
        assert_eq!(status, 2, "{printed}");
        let errors = printed["errors"].as_array().expect("errors");
        errors.iter().map(|item| item["key"].as_str().expect("a key").to_owned()).collect()
    };
    let sweep = |range: [&'static str; 4]| {
        let [path, from, to, points] = range;
        vec![
            "bifurcation",
            STUDY,
            "--parameter",
            path,
            "--from",
            from,
            "--to",
            to,
            "--points",
            points,
        ]
    };
    assert_eq!(keys(&sweep(["dither.amplitude", "2", "1", "1"])), ["--to", "--points"]);
    assert_eq!(keys(&sweep(["dither.amplitude", "a", "b", "c"])), ["--from", "--to", "--points"]);
    assert_eq!(keys(&sweep(["dither.amplitude", "-1", "1", "3"])), ["--from"]);
    assert_eq!(keys(&sweep(["dither.colour", "0", "1", "3"])), ["--parameter"]);
    assert_eq!(keys(&sweep(["solver.tolerance", "1e-9", "1e-8", "3"])), ["--parameter"]);
    let without = [
        "bifurcation",
        "studies/does-it-squeal.toml",
        "--parameter",
        "dither.amplitude",
        "--from",
        "0",
        "--to",
        "1",
    ];
    assert_eq!(keys(&without), ["--parameter"]);
    let basins = ["basins", STUDY, "--displacement", "1:-1", "--velocity", "x", "--grid", "big"];
    assert_eq!(keys(&basins), ["--displacement", "--velocity", "--grid"]);
    assert_eq!(keys(&["basins", STUDY, "--grid", "1x9"]), ["--grid"]);
    let over = ["--over", "dither.amplitude", "--from", "0", "--to", "1", "--points", "100000"];
    let many = [&["basins", STUDY, "--grid", "3000x3000"], &over[..]].concat();
    assert_eq!(keys(&many), ["--points"]);
    let (printed, status) = quell(&["basins", STUDY, "--points", "5"]);
    assert!(status == 2 && printed.to_string().contains("--over <PATH>"), "{printed}");
    let (printed, _) = quell(&without);
    let message = printed["errors"][0]["message"].as_str().expect("a message");
    assert!(message.contains("dither") && !message.contains("change:"), "{message}");
    assert_eq!(keys(&["basins", STUDY, "--sample", "0"]), ["--sample"]);
    // For a missing study it is unknown whether it is in SI.
    assert_eq!(keys(&["basins", "studies/nowhere.toml", "--displacement", "0mm:2mm"]).len(), 1);
    // On a belt at rest nothing squeals.
    let at_rest = ["basins", STUDY, "--set", "belt.belt_velocity=0", "--grid", "3x3"];
    let (found, status) = quell(&at_rest);
    assert_eq!((status, &found["quiet_fraction"]), (0, &1.0.into()), "{found}");
}
