//! `new`: commented studies to start from, one per question, compiled in.
//!
//! A template is a complete study. Its first line is the question that it answers, and its comments contain the commands that
//! give the answer, the main one first. A test runs every command of every template.

use std::fs::OpenOptions;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde_json::{Value as Json, json};

use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::input::Inputs;
use crate::nearest;
use crate::output::Output;

/// Option that names the file.
const SAVE: &str = "--save";

/// A commented study.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CommentedStudy {
    /// Name of its file without the extension.
    pub name: &'static str,
    /// The study, with its comments.
    pub text: &'static str,
}

macro_rules! templates {
    ($($name:literal),+ $(,)?) => {
        /// Every template, in the order in which they are listed.
        pub const TEMPLATES: &[CommentedStudy] = &[
            $(CommentedStudy { name: $name, text: include_str!(concat!("template/", $name, ".toml")) }),+
        ];
    };
}

templates!(
    "quench",
    "brake-si",
    "drive",
    "driven-oscillator",
    "own-law",
    "measured-law",
    "every-start",
    "worse",
    "map",
    "disc",
    "disc-dither",
    "mode-coupling",
    "two-mass-drive",
    "modes",
    "controller",
);

impl CommentedStudy {
    /// The template of this name.
    ///
    /// # Errors
    /// A complaint that lists the names and suggests the closest one.
    pub fn find(name: &str) -> Result<&'static Self, Box<Complaint>> {
        TEMPLATES.iter().find(|template| template.name == name).ok_or_else(|| {
            let names = || TEMPLATES.iter().map(|template| template.name);
            let allowed = format!("one of {}", names().collect::<Vec<_>>().join(", "));
            let origin = Origin::Argument("question");
            let complaint = Complaint::new(Fault::Value, "question", origin, name, allowed);
            Box::new(complaint.suggesting(nearest::word(name, names())))
        })
    }

    /// The question that the template answers.
    pub fn question(&self) -> &'static str {
        self.text.lines().next().unwrap_or_default().trim_start_matches("# ")
    }

    /// The commands in its comments, the main one first.
    pub fn commands(&self) -> impl Iterator<Item = &'static str> {
        self.text
            .lines()
            .filter_map(|line| line.strip_prefix("#   "))
            .filter(|line| line.starts_with("quell "))
    }

    /// Writes the study to a new file, or with `overwrite` also to an existing one.
    ///
    /// # Errors
    /// A complaint if the file exists or its name does not end in `.toml`; [`Failure::Failed`] if it cannot be written.
    pub fn save(&self, path: &Path, overwrite: bool) -> Result<PathBuf, Failure> {
        if overwrite {
            return Output::prepare(path, SAVE, &["toml"], &Inputs::NONE)?
                .write(self.text.as_bytes());
        }
        let complaint = |allowed: String| {
            let given = path.display().to_string();
            Complaint::new(Fault::Path, SAVE, Origin::Argument(SAVE), given, allowed)
        };
        if path.extension().is_none_or(|extension| !extension.eq_ignore_ascii_case("toml")) {
            return Err(complaint("the file name must end in .toml".to_owned()).into());
        }
        // Creating the file and checking that it does not exist is one atomic step, so that nothing is overwritten.
        let mut file =
            OpenOptions::new().write(true).create_new(true).open(path).map_err(|error| {
                complaint(match error.kind() {
                    io::ErrorKind::AlreadyExists => {
                        "the file exists; --overwrite replaces it".to_owned()
                    }
                    _ => format!("cannot be written: {error}"),
                })
            })?;
        if let Err(error) = file.write_all(self.text.as_bytes()).and_then(|()| file.sync_all()) {
            // If removing the file fails too, nothing else can be done.
            let _ = std::fs::remove_file(path);
            let key = path.display().to_string();
            return Err(Failure::Failed { key, why: format!("cannot be written: {error}").into() });
        }
        Ok(path.to_owned())
    }

    /// The template as JSON, with the path of the file if it was saved.
    pub fn json(&self, saved: Option<&Path>) -> Json {
        let warnings: [&str; 0] = [];
        let mut object = json!({
            "ok": true,
            "name": self.name,
            "question": self.question(),
            "commands": self.commands().collect::<Vec<_>>(),
            "text": self.text,
            "warnings": warnings,
        });
        if let Some(path) = saved {
            object["saved"] = path.display().to_string().into();
        }
        object
    }
}

/// Names and questions of all templates, as JSON.
pub fn list() -> Json {
    let each = |template: &CommentedStudy| json!({ "name": template.name, "question": template.question() });
    let questions: Vec<Json> = TEMPLATES.iter().map(each).collect();
    let warnings: [&str; 0] = [];
    json!({ "ok": true, "questions": questions, "warnings": warnings })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::Study;

    #[test]
    fn every_template_is_a_commented_study_with_its_question() {
        for template in TEMPLATES {
            let CommentedStudy { name, text } = template;
            assert!(template.question().ends_with('?'), "{name}");
            assert!(text.starts_with("# ") && text.contains("\ntitle = "), "{name}");
            let file = format!("{name}.toml");
            assert!(template.commands().count() >= 2, "{name}");
            assert!(template.commands().all(|command| command.contains(&file)), "{name}");
            assert!(text.lines().all(|line| line.chars().count() <= 130), "{name}");
            Study::parse_in(text, &[], Path::new(""))
                .unwrap_or_else(|why| panic!("{name}: {why:?}"));
            assert_eq!(CommentedStudy::find(name).expect("found"), template);
        }
        let wrong = CommentedStudy::find("quenhc").expect_err("no such template");
        assert_eq!(wrong.suggestion.as_deref(), Some("quench"));
    }

    #[test]
    fn a_file_is_overwritten_only_on_request() {
        let folder = tempfile::tempdir().expect("folder");
        let path = folder.path().join("mine.toml");
        let [first, second] = [TEMPLATES[0], TEMPLATES[1]];
        first.save(&path, false).expect("written");
        assert!(matches!(second.save(&path, false), Err(Failure::Wrong(_))));
        assert_eq!(std::fs::read_to_string(&path).expect("there"), first.text);
        second.save(&path, true).expect("written");
        assert_eq!(std::fs::read_to_string(&path).expect("there"), second.text);
        for other in ["name.txt", "missing/name.toml"] {
            let refused = first.save(&folder.path().join(other), false);
            assert!(matches!(refused, Err(Failure::Wrong(_))), "{other}");
        }
        assert_eq!(folder.path().read_dir().expect("folder").count(), 1);
    }
}
