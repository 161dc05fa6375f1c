//! Stores with untrusted content: no file outside the store is touched, no call blocks, and no changed file is accepted.
#![cfg(unix)]

use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::place::{Place, ProcessOutput, files, same};

const ASK: [&str; 6] =
    ["map", "small.toml", "--quantity", "residual-vibration", "--save", "m.zarr"];

/// Arguments that open a store again.
const AGAIN: [&[&str]; 2] = [&["--resume"], &["--shard", "1/1"]];

/// A folder with a complete store, and the files of the store.
fn whole(name: &str) -> (Place, BTreeMap<String, Vec<u8>>) {
    let place = Place::new(name);
    place.good(&ASK);
    let store = place.store("m.zarr");
    (place, store)
}

fn restore(place: &Place, store: &BTreeMap<String, Vec<u8>>) {
    let path = place.folder.join("m.zarr");
    fs::remove_dir_all(&path).expect("removed");
    for (name, bytes) in store {
        let file = path.join(name);
        fs::create_dir_all(file.parent().expect("a folder")).expect("made");
        fs::write(file, bytes).expect("written");
    }
}

fn remove(path: &Path) {
    match fs::symlink_metadata(path) {
        Ok(found) if found.is_dir() => fs::remove_dir_all(path).expect("removed"),
        Ok(_) => fs::remove_file(path).expect("removed"),
        Err(_) => {}
    }
}

/// Opens the store exclusively and shared; both are rejected in time with these words.
#[track_caller]
fn refused(place: &Place, words: &[&str]) {
    for again in AGAIN {
        let arguments = [&ASK, again].concat();
        let mut command = place.command(&arguments);
        let mut child =
            command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("quell runs");
        let begun = Instant::now();
        while child.try_wait().expect("it is ours").is_none() {
            if begun.elapsed() > Duration::from_secs(30) {
                child.kill().expect("it is ours");
                panic!("{words:?} {again:?}: it hangs");
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        let printed = ProcessOutput::of(&child.wait_with_output().expect("it ended"));
        assert_eq!(printed.status, Some(2), "{words:?} {again:?}: {printed:?}");
        for word in words {
            assert!(printed.errors.contains(word), "{word}: {printed:?}");
        }
    }
}

#[test]
fn links_in_a_store_are_not_followed() {
    let (place, store) = whole("links");
    let outside = place.folder.join("outside");
    for name in [
        ".quell",
        ".quell/unfinished",
        ".quell/done",
        ".quell/done/0.0.json",
        ".quell/lock",
        ".quell/map.json",
        ".quell/new",
        "zarr.json",
        "residual_vibration",
        "residual_vibration/zarr.json",
        "residual_vibration/c",
        "residual_vibration/c/0",
        "residual_vibration/c/0/0",
        "dither_amplitude/c",
    ] {
        restore(&place, &store);
        remove(&outside);
        let path = place.folder.join("m.zarr").join(name);
        // The original files are now outside the store: all are valid, and none may be changed.
        if path.exists() {
            fs::rename(&path, &outside).expect("moved");
        } else {
            fs::create_dir_all(&path).expect("a folder");
            fs::rename(&path, &outside).expect("moved");
        }
        if outside.is_dir() {
            fs::write(outside.join("theirs"), "theirs").expect("a file");
        }
        symlink(&outside, &path).expect("a link");
        let before = if outside.is_dir() { files(&outside) } else { BTreeMap::new() };
        let bytes = fs::read(&outside).ok();
        refused(&place, &["contains a symbolic link at", name]);
        if outside.is_dir() {
            same(&files(&outside), &before);
        }
        assert_eq!(fs::read(&outside).ok(), bytes, "{name}");
        // A dangling link: its target is not created.
        remove(&outside);
        refused(&place, &["contains a symbolic link at", name]);
        assert!(fs::symlink_metadata(&outside).is_err(), "{name}: something was made outside");
    }
}

#[test]
fn a_store_of_another_map_is_left_as_it_is() {
    let (place, _) = whole("of-another-map");
    place.write("m.zarr/.quell/unfinished/theirs", "half");
    fs::remove_file(place.folder.join("m.zarr/.quell/lock")).expect("a lock");
    let before = files(&place.folder.join("m.zarr"));
    let text = fs::read_to_string(place.folder.join("small.toml")).expect("a study");
    place.write("small.toml", text.replace("= 0.005", "= 0.006"));
    refused(&place, &["is the store of another map"]);
    same(&files(&place.folder.join("m.zarr")), &before);
    assert!(
        !place.folder.join("m.zarr/.quell/lock").exists(),
        "it was written before it was refused"
    );
}

/// A change of the bytes of a file.
type Changed<'c> = &'c dyn Fn(&[u8]) -> Vec<u8>;

#[test]
fn metadata_are_verified() {
    let (place, store) = whole("metadata");
    let changes: [(&str, Changed<'_>); 6] = [
        ("residual_vibration/zarr.json", &|bytes| {
            let text = String::from_utf8_lossy(bytes);
            assert!(text.contains("little"));
            text.replace("little", "big").into_bytes()
        }),
        ("residual_vibration_status/zarr.json", &|_| Vec::new()),
        ("zarr.json", &|_| Vec::new()),
        ("zarr.json", &|bytes| {
            String::from_utf8_lossy(bytes).replace("Stribeck", "Coulomb").into_bytes()
        }),
        ("dither_amplitude/zarr.json", &|bytes| [bytes, b" "].concat()),
        ("belt_velocity/c/0", &|bytes| {
            let mut bytes = bytes.to_vec();
            bytes[3] ^= 1;
            bytes
        }),
    ];
    for (name, change) in changes {
        restore(&place, &store);
        let path = place.folder.join("m.zarr").join(name);
        let Some(bytes) = store.get(name) else { panic!("{name} is not in {:?}", store.keys()) };
        fs::write(&path, change(bytes)).expect("changed");
        refused(&place, &[name, "differs from what this map must contain"]);
        // As the message says: without the file it is written again.
        fs::remove_file(&path).expect("removed");
        place.good(&[&ASK[..], &["--resume"]].concat());
        same(&place.store("m.zarr"), &store);
    }
}

#[test]
fn pipes_and_folders_in_place_of_files_are_rejected() {
    let (place, store) = whole("pipes");
    for name in [
        "residual_vibration/c/0/0",
        ".quell/done/0.0.json",
        ".quell/map.json",
        ".quell/lock",
        ".quell/unfinished/half",
        "residual_vibration/zarr.json",
        "zarr.json",
    ] {
        for kind in ["pipe", "folder"] {
            restore(&place, &store);
            let path = place.folder.join("m.zarr").join(name);
            fs::create_dir_all(path.parent().expect("a folder")).expect("made");
            remove(&path);
            if kind == "pipe" {
                assert!(Command::new("mkfifo").arg(&path).status().expect("mkfifo").success());
                refused(&place, &["contains a pipe", name]);
            } else {
                fs::create_dir(&path).expect("made");
                let last = name.rsplit('/').next().expect("a name");
                refused(&place, &[last]);
            }
        }
    }
}
