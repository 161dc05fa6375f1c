//! The verbs of a system.

use super::Verbs;
use crate::cite::{self, Sources};
use crate::outcome::check::Valid;
use crate::outcome::{Answered, Outcome};
use crate::study::SystemStudy;

impl Verbs for SystemStudy {
    fn kind(&self) -> &'static str {
        "system"
    }

    fn names(&self) -> &'static [&'static str] {
        &["check", "cite"]
    }

    fn check(&self) -> Box<dyn Outcome> {
        Box::new(Answered::new(self, Valid))
    }

    fn sources(&self) -> Sources {
        cite::sources_of_system(self)
    }

    fn cite(&self) -> Box<dyn Outcome> {
        Box::new(Answered::new(self, self.sources()))
    }
}
