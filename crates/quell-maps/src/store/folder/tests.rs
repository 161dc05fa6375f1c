//! The same tests for both implementations of `Folder`.

use std::fs;
use std::io::{self, Write};
use std::os::unix::fs::symlink;
use std::process::Command;

macro_rules! both {
    ($($module:ident::$folder:ident),*) => { $(
        mod $module {
            use super::super::$module::$folder as Folder;
            use super::super::EntryType;
            use super::*;

            fn text(error: io::Result<impl Sized>) -> String {
                error.err().map_or_else(String::new, |error| error.to_string())
            }

            #[test]
            fn files_are_created_read_and_renamed_inside() {
                let place = tempfile::tempdir().expect("a folder");
                let root = Folder::open(place.path()).expect("open");
                let inner = root.made("inner").and_then(|_| root.made("inner")).expect("made");
                inner.create("new").and_then(|mut file| file.write_all(b"four")).expect("written");
                assert!(inner.create("new").is_err(), "it is there");
                assert_eq!(inner.read("new", 4).expect("read"), b"four");
                assert!(text(inner.read("new", 3)).contains("longer than the 3 bytes"));
                inner.link("new", &root, "second").expect("linked");
                assert!(inner.link("new", &root, "second").is_err(), "it is there");
                inner.rename("new", &root, "second").expect("renamed");
                assert_eq!(root.read("second", 9).expect("read"), b"four");
                root.lockable("lock").and_then(|_| root.lockable("lock")).expect("lockable");
                root.modified("lock").expect("a time");
                root.remove("lock").expect("removed");
                let mut entries = root.entries().expect("entries");
                entries.sort_by(|one, other| one.0.cmp(&other.0));
                let inner = ("inner".to_owned(), EntryType::Folder);
                assert!(entries.contains(&inner) && entries.contains(&("second".to_owned(), EntryType::File)));
            }

            #[test]
            fn links_and_pipes_are_reported_and_left_alone() {
                let place = tempfile::tempdir().expect("a folder");
                let (inside, outside) = (place.path().join("in"), place.path().join("out"));
                fs::create_dir(&inside).expect("a folder");
                fs::create_dir(&outside).expect("a folder");
                fs::write(outside.join("theirs"), "theirs").expect("a file");
                symlink(&outside, inside.join("link")).expect("a link");
                symlink(outside.join("theirs"), inside.join("file")).expect("a link");
                symlink(outside.join("new"), inside.join("nowhere")).expect("a link");
                let made = Command::new("mkfifo").arg(inside.join("pipe")).status();
                assert!(made.expect("mkfifo").success());
                let root = Folder::open(&inside).expect("open");
                assert!(text(root.folder("link")).contains("link is a symbolic link; expected a folder"));
                assert!(text(root.made("link")).contains("a symbolic link"));
                assert!(text(root.made("pipe")).contains("a pipe"));
                for name in ["file", "nowhere", "link"] {
                    assert!(text(root.read(name, 100)).contains("a symbolic link"), "{name}");
                    assert!(text(root.lockable(name)).contains("a symbolic link"), "{name}");
                    assert!(root.create(name).is_err(), "{name}");
                }
                assert!(text(root.read("pipe", 100)).contains("pipe is a pipe, a socket or a device"));
                assert!(text(root.lockable("pipe")).contains("expected a file"));
                // A link that replaces a folder after it was opened is not followed either.
                let late = root.made("late").expect("made");
                fs::rename(inside.join("late"), inside.join("moved")).expect("moved");
                symlink(&outside, inside.join("late")).expect("a link");
                let _ = late.create("new");
                let _ = late.remove("theirs");
                let listed = fs::read_dir(&outside).expect("a folder").count();
                assert_eq!((listed, fs::read_to_string(outside.join("theirs")).expect("a file")), (1, "theirs".to_owned()));
            }
        }
    )* };
}

both!(handles::HandleFolder, paths::PathFolder);
