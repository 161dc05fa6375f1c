//! Shards: parts of one map by several processes into one store.

use std::fs;
use std::process::{Child, Stdio};

use serde_json::Value as Json;

use crate::faults::{ask, large, undisturbed, wait_for};
use crate::place::{Place, ProcessOutput, same};

impl Place {
    /// Starts a shard of the large map.
    fn shard(&self, save: &str, shard: &str) -> Child {
        let arguments = ask(save, &["--json", "--shard", shard]);
        let mut command = self.command(&arguments);
        command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("quell runs")
    }
}

fn ends(child: Child) -> Json {
    let printed = ProcessOutput::of(&child.wait_with_output().expect("it ends"));
    assert_eq!(printed.status, Some(0), "{printed:?}");
    serde_json::from_str(&printed.output).expect("one JSON object")
}

#[test]
fn three_concurrent_shards_create_the_map() {
    let place = large("three");
    let (reference, _) = undisturbed();
    let shards = ["1/3", "2/3", "3/3"].map(|shard| place.shard("three.zarr", shard));
    let printed = shards.map(ends);
    let count =
        |name: &str| printed.iter().map(|printed| printed[name].as_u64().expect("a count")).sum();
    let all = printed[0]["map_chunks"].as_u64().expect("a count");
    let (chunks, computed): (u64, u64) = (count("chunks"), count("computed_chunks"));
    assert_eq!((chunks, computed), (all, all), "every chunk is in one shard");
    assert!(
        printed.iter().any(|printed| printed["left_chunks"] == 0),
        "who ends last sees the whole map"
    );
    // No merging is needed: the store equals that of one process.
    same(&place.store("three.zarr"), reference);
    let map = place.good(&ask("three.zarr", &["--resume"]));
    assert_eq!(map["resumed_points"], map["points"]);
    same(&place.store("three.zarr"), reference);
}

#[test]
fn a_killed_shard_is_repeated_while_another_runs() {
    let place = large("killed_shard");
    let (reference, _) = undisturbed();
    let (one, mut other) = (place.shard("k.zarr", "1/2"), place.shard("k.zarr", "2/2"));
    wait_for("a chunk", || place.records("k.zarr") > 1);
    other.kill().expect("it is ours");
    other.wait().expect("it ends");
    // Unfinished files of the killed process remain while other processes may be writing.
    fs::write(place.folder.join("k.zarr/.quell/unfinished/1.0.0"), "half").expect("a file");
    let again = place.shard("k.zarr", "2/2");
    // While shards are written, no process may write exclusively.
    let alone = place.printed(&ask("k.zarr", &["--resume"]));
    assert!(
        alone.status == Some(1) && alone.errors.contains("another process is writing"),
        "{alone:?}"
    );
    let (one, again) = (ends(one), ends(again));
    for printed in [&one, &again] {
        let own = |name: &str| printed[name].as_u64().expect("a count");
        assert_eq!(own("chunks"), own("computed_chunks") + own("there_chunks"));
    }
    assert!(place.folder.join("k.zarr/.quell/unfinished/1.0.0").exists());
    let map = place.good(&ask("k.zarr", &["--resume"]));
    assert_eq!(map["resumed_points"], map["points"]);
    same(&place.store("k.zarr"), reference);
}

#[test]
fn a_shard_reports_the_remaining_chunks_and_a_later_run_computes_them() {
    let place = large("left");
    let (reference, _) = undisturbed();
    let printed = ends(place.shard("left.zarr", "2/4"));
    assert_eq!(printed["left_shards"], serde_json::json!([1, 3, 4]));
    assert_eq!(printed["saved"][0], "left.zarr");
    let own = printed["chunks"].as_u64().expect("a count");
    let all = printed["map_chunks"].as_u64().expect("a count");
    assert_eq!(printed["left_chunks"], all - own);
    // Running the same shard again finds its chunks; a truncated one is recomputed.
    let path = place.folder.join("left.zarr/residual_vibration/c");
    let first = fs::read_dir(&path).expect("chunks").next().expect("a chunk").expect("a chunk");
    let chunk = fs::read_dir(first.path()).expect("chunks").next().expect("a chunk").expect("one");
    fs::write(chunk.path(), "short").expect("cut short");
    let printed = place.printed(&ask("left.zarr", &["--shard", "2/4"]));
    assert_eq!(printed.status, Some(0), "{printed:?}");
    assert!(printed.output.contains("Shard 2 of 4 of left.zarr"), "{printed:?}");
    assert!(
        printed.output.contains("1 computed") && printed.output.contains("shards 1,3,4"),
        "{printed:?}"
    );
    assert!(
        printed.errors.contains("recomputed 1 chunk of the store that was truncated"),
        "{printed:?}"
    );
    let map = place.good(&ask("left.zarr", &["--resume"]));
    assert!(map["resumed_points"].as_u64().is_some_and(|points| points > 0));
    same(&place.store("left.zarr"), reference);
}

#[test]
fn shards_of_another_map_are_rejected_in_either_order() {
    let place = Place::new("strangers");
    let small = fs::read_to_string(place.folder.join("small.toml")).expect("a study");
    place.write("other.toml", small.replace("= 0.005", "= 0.006"));
    for round in 0..5 {
        let save = format!("m{round}.zarr");
        let begin = |study: &str, shard: &str| {
            let arguments =
                ["map", study, "--quantity", "verdict", "--save", &save, "--shard", shard];
            let mut command = place.command(&arguments);
            command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("quell runs")
        };
        let both = [begin("small.toml", "1/1"), begin("other.toml", "1/1")];
        let printed =
            both.map(|child| ProcessOutput::of(&child.wait_with_output().expect("it ends")));
        let (good, bad): (Vec<_>, Vec<_>) =
            printed.iter().partition(|printed| printed.status == Some(0));
        assert_eq!((good.len(), bad[0].status), (1, Some(2)), "{printed:?}");
        assert!(bad[0].errors.contains("belt.damping_ratio is"), "{printed:?}");
    }
}

#[test]
fn an_invalid_shard_is_rejected_at_once() {
    let place = Place::new("no_shard");
    let ask = |more: &[&'static str]| {
        let mut arguments = vec!["map", "small.toml", "--quantity", "verdict"];
        arguments.extend(more);
        place.printed(&arguments)
    };
    let cases: &[(&[&str], &str)] = &[
        (&["--shard", "1/2"], "name it by --save FILE.zarr"),
        (&["--shard", "1/2", "--save", "m.csv"], "name it by --save FILE.zarr"),
        (&["--shard", "3/2", "--save", "m.zarr"], "k from 1 to n"),
        (&["--shard", "-1/2", "--save", "m.zarr"], "k from 1 to n"),
        (&["--shard", "1/2", "--save", "m.zarr", "--plot", "m.svg"], "not the whole map"),
        (&["--shard", "1/1", "--resume", "--save", "m.zarr"], "cannot be used with '--resume'"),
    ];
    for (arguments, word) in cases {
        let printed = ask(arguments);
        assert_eq!(
            (printed.status, printed.output.as_str()),
            (Some(2), ""),
            "{arguments:?}: {printed:?}"
        );
        assert!(printed.errors.contains(word), "{arguments:?}: {printed:?}");
    }
    assert_eq!(fs::read_dir(&place.folder).expect("a folder").count(), 2, "nothing is left behind");
    // More shards than chunks: shards without chunks report that and do no harm.
    let printed = ask(&["--shard", "9/9", "--save", "m.zarr"]);
    assert_eq!(printed.status, Some(0), "{printed:?}");
    assert!(printed.output.contains("0 of 1 chunks of the map"), "{printed:?}");
}
