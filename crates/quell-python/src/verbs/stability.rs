//! `stability`: averaged stability of steady sliding; eigenvalues or Floquet exponents of a disc.

use quell::input::Inputs;
use quell::picture;
use quell::plot::Figure;
use quell::run::disc;
use quell::run::stability::{Stability, run as stability};
use quell::{DiscStudy, Failure, Study, Subject};
use serde_json::Value as Json;

use crate::answer::{Answer, NativeAnswer};

struct OfBelt {
    study: Study,
    done: Stability,
}

impl Answer for OfBelt {
    fn inputs(&self) -> Inputs {
        self.study.inputs()
    }

    fn json(&self) -> Json {
        self.done.json(&self.study)
    }

    fn figure(&self) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::stability(&self.study, &self.done)))
    }
}

struct OfDisc {
    study: DiscStudy,
    done: disc::stability::Stability,
}

impl Answer for OfDisc {
    fn inputs(&self) -> Inputs {
        self.study.inputs()
    }

    fn json(&self) -> Json {
        self.done.json(&self.study)
    }

    fn figure(&self) -> Option<Result<Figure, Failure>> {
        let last = disc::campbell::usual_end(&self.study);
        let campbell = disc::campbell::run(&self.study, last);
        Some(campbell.map(|it| picture::disc::stability(&self.study, &self.done, &it)))
    }
}

/// Answers.
pub(crate) fn run(subject: &Subject) -> Result<NativeAnswer, Failure> {
    Ok(match subject {
        Subject::Belt(study) => {
            let done = stability(study);
            NativeAnswer::new(OfBelt { study: study.as_ref().clone(), done })
        }
        Subject::Disc(study) => {
            let done = disc::stability::run(study)?;
            NativeAnswer::new(OfDisc { study: study.clone(), done })
        }
    })
}
