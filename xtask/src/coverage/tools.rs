//! `llvm-profdata` and `llvm-cov` of the toolchain.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::source;

/// Where the programs are.
pub(super) struct Tools {
    profdata: PathBuf,
    cov: PathBuf,
}

impl Tools {
    /// The programs named by `LLVM_PROFDATA` and `LLVM_COV`, else those of the toolchain's component `llvm-tools`.
    ///
    /// # Errors
    /// A program that does not exist.
    pub(super) fn find(root: &Path) -> Result<Self, String> {
        let compiler = env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
        let mut command = Command::new(compiler);
        let libraries = output(command.args(["--print", "target-libdir"]).current_dir(root))?;
        let folder = Path::new(libraries.trim()).with_file_name("bin");
        let find = |name: &str, variable: &str| {
            let program = folder.join(format!("{name}{}", env::consts::EXE_SUFFIX));
            let program = env::var_os(variable).map_or(program, PathBuf::from);
            let advice = "`rustup component add llvm-tools` installs it";
            let missing = || format!("coverage: {} does not exist ({advice})", program.display());
            if program.is_file() { Ok(program) } else { Err(missing()) }
        };
        Ok(Self {
            profdata: find("llvm-profdata", "LLVM_PROFDATA")?,
            cov: find("llvm-cov", "LLVM_COV")?,
        })
    }

    /// The lcov report of programs that have written the profiles in a folder.
    ///
    /// # Errors
    /// A folder that cannot be read, a program of LLVM that fails.
    pub(super) fn lcov(
        &self,
        profiles: &Path,
        merged: &Path,
        executables: &[PathBuf],
    ) -> Result<String, String> {
        let profiles = source::files(profiles)?;
        let mut merge = Command::new(&self.profdata);
        output(merge.args(["merge", "--sparse", "--output"]).arg(merged).args(profiles))?;
        let mut export = Command::new(&self.cov);
        export.args(["export", "--format=lcov", "--instr-profile"]).arg(merged);
        for executable in executables {
            export.arg("--object").arg(executable);
        }
        output(&mut export)
    }
}

/// The standard output of a program that succeeds; its errors are shown.
///
/// # Errors
/// A program that is missing or fails.
pub(super) fn output(command: &mut Command) -> Result<String, String> {
    let name = command.get_program().display().to_string();
    let output = command.stderr(std::process::Stdio::inherit()).output();
    let output = output.map_err(|why| format!("{name}: {why}"))?;
    if !output.status.success() {
        return Err(format!("{name}: {}", output.status));
    }
    String::from_utf8(output.stdout).map_err(|why| format!("{name}: {why}"))
}
