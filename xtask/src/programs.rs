//! Programs that tasks run.

use std::process::Command;

/// The `cargo` that runs this task.
pub(crate) fn cargo() -> Command {
    Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// Runs a program that must succeed.
///
/// # Errors
/// The program with its arguments, and its exit status or why it could not start.
pub(crate) fn command(program: &mut Command) -> Result<(), String> {
    let name = program.get_program().to_string_lossy().into_owned();
    let words: Vec<_> =
        program.get_args().map(|word| word.to_string_lossy().into_owned()).collect();
    match program.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{name} {}: {status}", words.join(" "))),
        Err(why) => Err(format!("{name}: {why}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_is_reported_with_its_arguments() {
        let report = command(cargo().arg("no-such-task")).expect_err("no such task");
        assert!(report.contains("no-such-task"), "{report}");
        assert!(command(&mut Command::new("no-such-program")).is_err());
    }
}
