//! The same equations written twice have one answer: random studies as `[belt]` or `[disc]` and as `[system]`, through every verb.
//!
//! What still differs is listed in `known.txt`: a difference that is not there fails, and `cargo xtask twins`, which asks
//! many studies, also fails where a listed one is gone. So the list can only shrink. `cargo xtask twins --bless`
//! removes what is gone; nothing adds to the list.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{fs, thread};

use crate::answer::{Answer, differences};
use crate::{disc, mass};

/// Studies in a plain run of the tests; `QUELL_TWINS` asks for another number.
const STUDIES: usize = 20;

/// Every fourth study is a disc.
const DISC: usize = 4;

/// The differences that are known, one a line: verb, what differs, key.
const KNOWN: &str = include_str!("known.txt");

/// A study in both forms, and what is asked about it.
pub(crate) struct Twin {
    /// What it has, for the report.
    pub(crate) name: String,
    pub(crate) own: String,
    pub(crate) system: String,
    /// Arguments of `quell`, the study in place of `STUDY`.
    pub(crate) asked: Vec<Vec<String>>,
    /// Whether the numbers of the two are in units that differ by powers of ten.
    pub(crate) scaled: bool,
    /// Words of the study's own kind, and those of the system.
    pub(crate) renamed: Vec<(&'static str, &'static str)>,
}

/// Random numbers, the same on any machine: SplitMix64 (Steele, Lea and Flood 2014).
pub(crate) struct Random {
    state: u64,
}

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number in [0, 1).
    pub(crate) fn share(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A number from `low` to `high` with four digits.
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        let value = low + (high - low) * self.share();
        (value * 1e4).round() / 1e4
    }

    /// One of some words.
    pub(crate) fn one_of<'a>(&mut self, words: &[&'a str]) -> &'a str {
        let share = self.share();
        let at = (1..words.len()).take_while(|at| *at as f64 <= share * words.len() as f64).count();
        words[at]
    }
}

/// Words of a command.
pub(crate) fn words(text: &str) -> Vec<String> {
    text.split_whitespace().map(str::to_owned).collect()
}

fn twin(number: usize) -> Twin {
    let mut random = Random::new(number as u64 + 1);
    if number % DISC == DISC - 1 { disc::twin(&mut random) } else { mass::twin(&mut random) }
}

/// All differences of a study, as lines of the list.
fn of_one(number: usize) -> Vec<(String, String)> {
    let twin = twin(number);
    let folder = tempfile::tempdir().expect("a folder");
    let write =
        |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("written");
    write("own.toml", &twin.own);
    write("system.toml", &twin.system);
    let mut found = Vec::new();
    for command in &twin.asked {
        let ask = |study: &str| {
            let words: Vec<&str> =
                command.iter().map(|word| if word == "STUDY" { study } else { word }).collect();
            Answer::of(folder.path(), &words)
        };
        let (own, system) = (ask("own.toml"), ask("system.toml"));
        let verb = &command[0];
        let is_wrong = verb == "check" && (own.is_refused() || system.is_refused());
        assert!(!is_wrong, "study {number} is wrong\n{}\n{}", twin.own, twin.system);
        for difference in differences(&own, &system, &twin) {
            let at = format!("study {number}, {}: {}", twin.name, difference.detail);
            found.push((format!("{verb} {}", difference.kind), at));
        }
    }
    found
}

/// The differences of many studies, each with an example.
fn of_all(count: usize) -> BTreeMap<String, String> {
    let (next, found) = (AtomicUsize::new(0), Mutex::new(BTreeMap::new()));
    let work = || loop {
        let number = next.fetch_add(1, Ordering::Relaxed);
        if number >= count {
            break;
        }
        let of_one = of_one(number);
        let mut found = found.lock().expect("no thread fails");
        for (line, example) in of_one {
            found.entry(line).or_insert(example);
        }
    };
    let threads = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| (0..threads).for_each(|_| drop(scope.spawn(work))));
    found.into_inner().expect("no thread fails")
}

#[test]
fn a_study_written_twice_has_one_answer() {
    let asked = std::env::var("QUELL_TWINS").ok().map(|text| text.parse().expect("a number"));
    let found = of_all(asked.unwrap_or(STUDIES));
    let known: BTreeSet<&str> = KNOWN.lines().filter(|line| !line.starts_with('#')).collect();
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meaning/known.txt");
    if asked.is_some() && std::env::var_os("QUELL_BLESS").is_some() {
        let kept = KNOWN.lines().filter(|line| line.starts_with('#') || found.contains_key(*line));
        let text = kept.fold(String::new(), |text, line| text + line + "\n");
        fs::write(file, text).expect("written");
        return;
    }
    let new: Vec<_> = found.iter().filter(|(line, _)| !known.contains(line.as_str())).collect();
    let report = new.iter().fold(String::new(), |mut report, (line, example)| {
        let _ = writeln!(report, "{line}\n    {example}");
        report
    });
    assert!(new.is_empty(), "{} differences that are not in the list:\n{report}", new.len());
    if asked.is_some() {
        let gone: Vec<_> = known.iter().filter(|line| !found.contains_key(**line)).collect();
        assert!(
            gone.is_empty(),
            "{} differences are gone, remove them by `cargo xtask twins --bless`: {gone:#?}",
            gone.len()
        );
    }
}
