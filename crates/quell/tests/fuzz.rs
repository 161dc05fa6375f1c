//! Random and mutated input: the reader of studies and the reader of map stores must not panic, and must reject it
//! with complaints. A short run with fixed seeds; `fuzz/` holds the same two targets for long runs with cargo-fuzz.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use quell::map::run;
use quell::running::Running;
use quell::store::{ChunkState, Store};
use quell::sweep::{MapQuantity, Plan};
use quell::{BeltStudy, Failure, Fault, Study};

/// Random numbers with a fixed seed (splitmix64).
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    fn below(&mut self, end: usize) -> usize {
        usize::try_from(self.next() % end.max(1) as u64).unwrap_or(0)
    }
}

/// Replacements for a piece of a study: extreme numbers, other types, broken text.
const PIECES: &[&str] = &[
    "0",
    "-1",
    "1e400",
    "nan",
    "-inf",
    "1e-320",
    "9223372036854775808",
    "0x10",
    "\"\"",
    "\"sine\"",
    "true",
    "[]",
    "[1, 2]",
    "{}",
    "[[",
    "]]",
    "=",
    "\n",
    "\"",
    "'''",
    "#",
    "[belt]",
    "[[dither]]",
    "[disc]",
    "[[disc.load]]",
    "[[sweep]]",
    "[[disc.mode]]",
    "schema = 1",
    "points = 99999999999",
    "values = []",
    "1979-05-27",
    "\u{0}",
    "ζ",
    "_hz",
];

fn mutated(text: &str, dice: &mut Dice) -> String {
    let mut letters: Vec<char> = text.chars().collect();
    for _ in 0..=dice.below(4) {
        let at = dice.below(letters.len() + 1);
        let length = dice.below(12).min(letters.len() - at);
        match dice.below(5) {
            0 => drop(letters.drain(at..at + length)),
            1 => drop(letters.splice(at..at + length, PIECES[dice.below(PIECES.len())].chars())),
            2 => {
                // A value: the text after an equals sign.
                let signs: Vec<usize> =
                    (0..letters.len()).filter(|place| letters[*place] == '=').collect();
                if let Some(&sign) = signs.get(dice.below(signs.len())) {
                    let end = letters[sign..].iter().position(|letter| *letter == '\n');
                    let end = end.map_or(letters.len(), |end| sign + end);
                    let piece = PIECES[dice.below(PIECES.len())];
                    drop(letters.splice(sign + 1..end, format!(" {piece}").chars()));
                }
            }
            3 => {
                let copied: Vec<char> = letters[at..at + length].to_vec();
                let to = dice.below(letters.len() + 1);
                drop(letters.splice(to..to, copied));
            }
            _ => {
                let letter = char::from(u8::try_from(32 + dice.below(95)).unwrap_or(b' '));
                letters.insert(at, letter);
            }
        }
    }
    letters.into_iter().collect()
}

fn studies() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies");
    let mut files: Vec<PathBuf> =
        fs::read_dir(folder).expect("studies").map(|file| file.expect("a file").path()).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    files.sort();
    files.iter().map(|path| fs::read_to_string(path).expect("a study")).collect()
}

/// Every text is a valid study or gives complaints, each with a key and the allowed values; an accepted study is accepted again.
#[test]
fn the_reader_of_studies_rejects_with_complaints() {
    let (studies, mut dice) = (studies(), Dice(1));
    let (mut accepted, mut refused) = (0, 0);
    for round in 0..6000 {
        let text = mutated(&studies[round % studies.len()], &mut dice);
        match Study::parse_in(&text, &[], Path::new("")) {
            Ok(subject) => {
                accepted += 1;
                // A map point without changed numbers is the study itself, checked again from its document.
                let again =
                    subject.at([]).unwrap_or_else(|complaints| panic!("{complaints:?}\n{text}"));
                assert_eq!(again.settings(), subject.settings(), "{text}");
                if let Ok(study) = subject.belt() {
                    let belt = study.belt();
                    assert!(belt.normal_load() > 0.0 && belt.damping_ratio().is_finite(), "{text}");
                }
            }
            Err(complaints) => {
                refused += 1;
                assert!(!complaints.is_empty(), "{text}");
                for complaint in complaints {
                    let message = complaint.to_string();
                    assert!(
                        complaint.fault == Fault::Syntax || message.contains(&complaint.key),
                        "{message}"
                    );
                    assert!(!complaint.allowed.is_empty(), "{message}");
                    assert_ne!(complaint.suggestion.as_ref(), Some(&complaint.key), "{message}");
                }
            }
        }
    }
    assert!(
        accepted > 100 && refused > 1000,
        "{accepted} {refused}: the mutations are too tame or too wild"
    );
}

const MAP: &str = "schema = 1\n[belt]\ndamping_ratio = 0.005\nnormal_load = 1\nbelt_velocity = 0.05\n\
    [friction]\nlaw = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n\
    [dither]\ndirection = \"tangential\"\nwaveform = \"sine\"\namplitude = 0.4\nfrequency_ratio = 10\n\
    [[sweep]]\nparameter = \"dither.amplitude\"\nfrom = 0.1\nto = 0.9\npoints = 3\n";

fn plan() -> Plan {
    let study = BeltStudy::parse(MAP, &[]).expect("valid");
    Plan::new(&study, &[MapQuantity::named("verdict", "test").expect("known")]).expect("a plan")
}

/// Every file below a folder, with its bytes.
fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for file in fs::read_dir(next).expect("a folder") {
            let path = file.expect("a file").path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path.strip_prefix(folder).expect("inside").to_owned();
                found.insert(name, fs::read(&path).expect("read"));
            }
        }
    }
    found
}

fn damaged(bytes: &[u8], dice: &mut Dice) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    match dice.below(4) {
        0 => bytes.truncate(dice.below(bytes.len())),
        1 => bytes.extend((0..=dice.below(9)).map(|_| dice.next().to_le_bytes()[0])),
        2 => bytes = (0..dice.below(64)).map(|_| dice.next().to_le_bytes()[0]).collect(),
        _ => {
            for _ in 0..=dice.below(3) {
                let place = dice.below(bytes.len());
                if let Some(byte) = bytes.get_mut(place) {
                    *byte ^= 1 << dice.below(8);
                }
            }
        }
    }
    bytes
}

/// A store with one changed file is rejected, or its chunk is reported as damaged, or it gives the original values: never others.
#[test]
fn the_reader_of_stores_detects_damage() {
    let folder = tempfile::tempdir().expect("a folder");
    let whole = folder.path().join("whole.zarr");
    let (plan, never) = (plan(), AtomicBool::new(false));
    let store = Store::open(&whole, &plan, false).expect("made");
    run(plan.clone(), Some(&store), Running { threads: Some(1), stop: &never, progress: &() })
        .expect("computed");
    let known = store.read(&plan, 0);
    assert!(matches!(known, ChunkState::Whole(_)));
    drop(store);
    let files = files(&whole);
    let names: Vec<&PathBuf> = files.keys().collect();
    let mut dice = Dice(2);
    let (mut refused, mut seen) = (0, 0);
    for round in 0..400 {
        let path = folder.path().join("damaged.zarr");
        let chosen = names[round % names.len()];
        for (name, bytes) in &files {
            let place = path.join(name);
            fs::create_dir_all(place.parent().expect("a folder")).expect("made");
            let bytes = if name == chosen { damaged(bytes, &mut dice) } else { bytes.clone() };
            fs::write(place, bytes).expect("written");
        }
        let opened = Store::open(&path, &plan, true);
        if opened.is_ok() {
            // Readers of Zarr rely on metadata and coordinates.
            for name in names.iter().filter(|name| !name.starts_with(".quell")) {
                let of_chunks = name.to_string_lossy().starts_with("verdict");
                if !of_chunks || name.ends_with("zarr.json") {
                    assert_eq!(fs::read(path.join(name)).ok().as_ref(), files.get(*name));
                }
            }
        }
        match opened {
            Ok(store) => match store.read(&plan, 0) {
                ChunkState::Whole(values) => {
                    assert_eq!(ChunkState::Whole(values), known, "{}", chosen.display());
                }
                ChunkState::Damaged | ChunkState::Nothing => seen += 1,
            },
            Err(Failure::Wrong(complaints)) => {
                refused += 1;
                assert!(complaints.iter().all(|complaint| !complaint.allowed.is_empty()));
            }
            Err(Failure::Failed { why, .. }) => {
                refused += 1;
                assert!(!why.is_empty());
            }
        }
        fs::remove_dir_all(&path).expect("removed");
    }
    assert!(refused > 10 && seen > 10, "{refused} refused, {seen} damaged");
}
