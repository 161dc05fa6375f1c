//! The native part of the Python package `quell`: studies, their verbs, and the answers.
//!
//! Like the command line, it converts arguments, calls the library `quell` without the interpreter's lock, and converts the
//! numbers. Studies are validated by the library only; classes, plots and datasets are written in Python (`python/quell`).
//!
//! | file | content |
//! |---|---|
//! | `study` | a checked study and its verbs |
//! | `verbs` | one file per verb: arguments in, answer out |
//! | `answer` | facts, arrays and the picture of an answer |
//! | `reference` | reference numbers for a self-test |
//! | `shared` | maps that several processes compute into one store |
//! | `call` | computations without the interpreter's lock; Ctrl-C; panics become errors |
//! | `convert`, `errors`, `words` | JSON, arrays and complaints as Python objects |

mod answer;
mod arguments;
mod call;
mod convert;
mod errors;
mod reference;
mod shared;
mod study;
mod verbs;
mod words;

use pyo3::prelude::*;

/// The native module.
#[pymodule]
mod _quell {
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::answer::NativeAnswer;
    #[pymodule_export]
    use crate::reference::{readable_unit, reference};
    #[pymodule_export]
    use crate::shared::NativeShared;
    #[pymodule_export]
    use crate::study::NativeStudy;
    #[pymodule_export]
    use crate::verbs::fit::{fit_decay, fit_laws};
    #[pymodule_export]
    use crate::verbs::new::new;
    #[pymodule_export]
    use crate::verbs::reproduce::{reproduce, reproduce_names};
    #[pymodule_export]
    use crate::verbs::schema::{keys, quantities, schema};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
