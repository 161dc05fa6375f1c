//! `sketch`: the mechanism that a study describes, as a drawing.

use std::path::Path;

use quell::output::Output;
use quell::picture::{EXTENSIONS, sketch};
use quell::{Failure, Study};

/// Runs the verb: the drawing as SVG, and in a file if `path` is given, in the format of its name.
pub(crate) fn run(
    study: &Study,
    path: Option<&Path>,
    width: Option<&str>,
) -> Result<String, Failure> {
    let inputs = study.inputs();
    let output = path.map(|path| Output::prepare(path, "path", EXTENSIONS, &inputs));
    let output = output.transpose()?;
    let drawn = sketch::sketch(study, width.map(sketch::width).transpose()?)?;
    if let Some(output) = output {
        sketch::write(&drawn, output)?;
    }
    Ok(drawn.to_svg())
}
