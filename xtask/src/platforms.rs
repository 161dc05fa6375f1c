//! `cargo xtask platforms`: builds the command line for Windows and for 64-bit ARM, runs the same calls there and here, and compares the answers byte by
//! byte.
//!
//! Programs of Windows run under wine, those of ARM under qemu's emulation of a processor. The standard library of another platform is that of the
//! installed toolchain (`rustup target add`), or is built from Debian's sources of it. The packages of Debian 12 that are needed:
//!
//! ```text
//! mingw-w64 wine wine64  gcc-aarch64-linux-gnu libc6-dev-arm64-cross qemu-user  rustc-web cargo-web rust-web-src
//! ```
//!
//! It takes a quarter of an hour, most of it for the builds, and is no part of `cargo xtask test`.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::programs::{cargo, command};

/// The folder of programs and answers.
const PLACE: &str = "target/platforms";

/// Stands in a call for a folder of its own, whose files are answers too.
const FOLDER: &str = "FOLDER";

/// What is asked: every verb that computes, the engines of one mass and of systems, discs, maps, stores, pictures, and refusals.
const CALLS: &[&str] = &[
    "check studies/squealing-pad-si.toml --json",
    "simulate studies/two-blocks.toml --until 100 --events --json",
    "simulate studies/bowed-string.toml --until 50 --json",
    "simulate studies/figure-2.3.toml --until 200 --events --json --save FOLDER/run.csv",
    "simulate studies/figure-2.3.toml --until 50 --save FOLDER/run.wav",
    "response studies/will-this-dither-quench-it.toml --json --plot FOLDER/response.svg",
    "response studies/two-mass-drive.toml --settle 20 --record 20 --json",
    "orbit studies/two-mass-drive.toml --json",
    "attractor studies/can-dither-make-it-worse.toml --json",
    "thresholds studies/can-dither-make-it-worse.toml --from 0.5 --to 10.5 --json",
    "bifurcation studies/will-this-dither-quench-it.toml --parameter dither.amplitude --from 0.1 --to 0.5 --json",
    "friction studies/own-friction-law.toml --json",
    "friction studies/how-much-dither.toml --describing 0.1 --json",
    "stability studies/mode-coupling-dither.toml --json",
    "stability studies/figure-5.5.toml --json",
    "modes studies/table-5.1.toml --json",
    "modes studies/bowed-string.toml --json",
    "receptance studies/two-mass-drive.toml --json --save FOLDER/receptance.csv",
    "resonances studies/figure-5.9.toml --json",
    "waveforms studies/how-much-dither.toml --json",
    "actuator studies/actuator.toml --json",
    "probability studies/probability.toml --samples 2000 --json",
    "fit studies/synthetic-friction.csv --law decreasing --fix static_coefficient=0.38 --json",
    "fit studies/synthetic-decay.csv --decay --json",
    "map studies/figure-5.3.toml --quantity growth --set sweep[0].points=9 --json",
    "map studies/figure-2.8.toml --quantity residual-vibration --set sweep[0].points=4 --set sweep[1].points=4 --json --save FOLDER/map.csv",
    "map studies/figure-5.9.toml --quantity growth --set sweep[0].points=5 --set sweep[1].points=5 --json --save FOLDER/map.zarr",
    "sketch studies/two-mass-drive.toml --out FOLDER/sketch.svg",
    "response studies/will-this-dither-quench-it.toml --plot FOLDER/response.png",
    "check studies/no-such-study.toml",
    "thresholds studies/figure-2.3.toml --parameter belt.no_such_key --from 0 --to 1",
];

/// Where the command line runs.
struct Platform {
    name: &'static str,
    target: &'static str,
    linker: &'static str,
    /// Program and arguments that run a program of the platform.
    runner: &'static [&'static str],
    program: &'static str,
}

const PLATFORMS: &[Platform] = &[
    Platform {
        name: "Windows",
        target: "x86_64-pc-windows-gnu",
        linker: "x86_64-w64-mingw32-gcc",
        runner: &["wine"],
        program: "quell.exe",
    },
    Platform {
        name: "64-bit ARM",
        target: "aarch64-unknown-linux-gnu",
        linker: "aarch64-linux-gnu-gcc",
        runner: &["qemu-aarch64", "-L", "/usr/aarch64-linux-gnu"],
        program: "quell",
    },
];

/// What wine 8 lacks and the standard library of Rust needs: random numbers for hash tables.
const RANDOM_NUMBERS: &str = "#include <windows.h>
BOOLEAN WINAPI SystemFunction036(PVOID, ULONG);
__declspec(dllexport) BOOL WINAPI ProcessPrng(PBYTE data, SIZE_T size) {
    return SystemFunction036(data, (ULONG)size);
}
";

/// An answer: exit status, standard output, and the files that were written.
type PlatformAnswer = BTreeMap<String, Vec<u8>>;

/// Compares the answers of all platforms, or of the one whose target contains `only`.
///
/// # Errors
/// A tool that is missing, a build that fails, and every call whose answer differs.
pub(crate) fn run(root: &Path, only: Option<&str>) -> Result<(), String> {
    let root = root.canonicalize().map_err(|why| format!("{}: {why}", root.display()))?;
    let place = root.join(PLACE);
    let wanted = |platform: &&Platform| only.is_none_or(|name| platform.target.contains(name));
    if !PLATFORMS.iter().any(|platform| wanted(&platform)) {
        let targets: Vec<_> = PLATFORMS.iter().map(|platform| platform.target).collect();
        return Err(format!("no such platform; there are {}", targets.join(", ")));
    }
    command(cargo().args(["build", "--release", "--package", "quell-cli"]).current_dir(&root))?;
    let own = root.join("target/release").join(format!("quell{}", std::env::consts::EXE_SUFFIX));
    let expected = answers(&root, &place.join("here"), |call| (own.clone(), call.to_vec()))?;
    let mut different = Vec::new();
    for platform in PLATFORMS.iter().filter(wanted) {
        let program = platform.build(&root, &place)?;
        let found = answers(&root, &place.join(platform.target), |call| {
            let [runner, arguments @ ..] = platform.runner else {
                return (program.clone(), call.to_vec());
            };
            let arguments = arguments.iter().map(|word| (*word).to_owned());
            let program = program.display().to_string();
            (runner.into(), arguments.chain([program]).chain(call.to_vec()).collect())
        })?;
        let mut equal = 0;
        for ((call, expected), found) in CALLS.iter().zip(&expected).zip(&found) {
            match difference(expected, found) {
                None => equal += 1,
                Some(what) => different.push(format!("{}: quell {call}: {what}", platform.name)),
            }
        }
        println!("{}: {equal} of {} answers are equal to the byte", platform.name, CALLS.len());
    }
    if different.is_empty() { Ok(()) } else { Err(different.join("\n")) }
}

impl Platform {
    /// Builds the command line; returns its program.
    fn build(&self, root: &Path, place: &Path) -> Result<PathBuf, String> {
        for tool in [self.linker, self.runner.first().unwrap_or(&self.linker)] {
            let found = Command::new(tool).arg("--version").output();
            found.map_err(|why| format!("{tool}: {why} ({} needs it)", self.name))?;
        }
        let linker =
            format!("CARGO_TARGET_{}_LINKER", self.target.to_uppercase().replace('-', "_"));
        let mut cargo = if has_library(self.target) {
            cargo()
        } else {
            let mut cargo = Command::new("/usr/bin/cargo");
            for set in ["CARGO", "RUSTC", "RUSTUP_TOOLCHAIN", "RUSTUP_HOME"] {
                cargo.env_remove(set);
            }
            cargo.args(["-Z", "build-std=std,panic_abort"]);
            cargo.env("RUSTC_BOOTSTRAP", "1").env("PATH", "/usr/bin:/bin");
            cargo
        };
        cargo.args(["build", "--release", "--package", "quell-cli", "--target", self.target]);
        cargo.arg("--target-dir").arg(place.join("build")).env(linker, self.linker);
        command(cargo.current_dir(root))?;
        let program = place.join("build").join(self.target).join("release").join(self.program);
        if self.runner == ["wine"] {
            let source = place.join("random-numbers.c");
            fs::write(&source, RANDOM_NUMBERS)
                .map_err(|why| format!("{}: {why}", source.display()))?;
            let mut compiler = Command::new(self.linker);
            compiler.arg("-shared").arg("-o").arg(program.with_file_name("bcryptprimitives.dll"));
            command(compiler.arg(&source).arg("-ladvapi32"))?;
        }
        Ok(program)
    }
}

/// Whether the toolchain has the standard library of a target.
fn has_library(target: &str) -> bool {
    let printed =
        Command::new("rustc").args(["--print", "target-libdir", "--target", target]).output();
    printed.is_ok_and(|printed| Path::new(String::from_utf8_lossy(&printed.stdout).trim()).is_dir())
}

/// The answers to all calls, each made as `program` says.
fn answers(
    root: &Path,
    place: &Path,
    program: impl Fn(&[String]) -> (PathBuf, Vec<String>),
) -> Result<Vec<PlatformAnswer>, String> {
    let failed = |path: &Path, why: std::io::Error| format!("{}: {why}", path.display());
    if place.exists() {
        fs::remove_dir_all(place).map_err(|why| failed(place, why))?;
    }
    let mut all = Vec::new();
    for (number, call) in CALLS.iter().enumerate() {
        let folder = place.join(number.to_string());
        fs::create_dir_all(&folder).map_err(|why| failed(&folder, why))?;
        // Relative and the same on every platform: paths are in answers.
        let within = folder.strip_prefix(root).unwrap_or(&folder).display().to_string();
        let call: Vec<String> = call.split(' ').map(|word| word.replace(FOLDER, &within)).collect();
        let (program, arguments) = program(&call);
        let output = Command::new(&program)
            .args(arguments)
            .current_dir(root)
            .env("WINEDEBUG", "-all")
            .output()
            .map_err(|why| failed(&program, why))?;
        let text = String::from_utf8_lossy(&output.stdout).replace(&within, FOLDER);
        // Names of further files are joined with the separator of the platform.
        let text = text.replace("FOLDER\\\\", "FOLDER/");
        let mut answer = PlatformAnswer::from([
            ("exit status".to_owned(), format!("{:?}", output.status.code()).into_bytes()),
            ("standard output".to_owned(), text.into_bytes()),
        ]);
        files(&folder, &folder, &mut answer).map_err(|why| failed(&folder, why))?;
        all.push(answer);
    }
    Ok(all)
}

/// Adds the files of a folder.
fn files(folder: &Path, top: &Path, answer: &mut PlatformAnswer) -> std::io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            files(&path, top, answer)?;
        } else {
            let name = path.strip_prefix(top).unwrap_or(&path).display().to_string();
            answer.insert(name, fs::read(&path)?);
        }
    }
    Ok(())
}

/// The first part in which two answers differ, with the surroundings of the difference.
fn difference(expected: &PlatformAnswer, found: &PlatformAnswer) -> Option<String> {
    let parts: std::collections::BTreeSet<_> = expected.keys().chain(found.keys()).collect();
    parts.into_iter().find_map(|part| match (expected.get(part), found.get(part)) {
        (Some(here), Some(there)) if here == there => None,
        (Some(here), Some(there)) => {
            let at = here.iter().zip(there).position(|(a, b)| a != b);
            let at = at.unwrap_or(here.len().min(there.len()));
            let near = |bytes: &[u8]| {
                let shown = &bytes[at.saturating_sub(40)..bytes.len().min(at + 24)];
                String::from_utf8_lossy(shown).replace('\n', "\\n")
            };
            Some(format!("{part} from byte {at}:\n  here  {}\n  there {}", near(here), near(there)))
        }
        (Some(_), None) => Some(format!("{part} is missing")),
        (None, _) => Some(format!("{part} is one more")),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn calls_name_studies_that_exist() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let words = CALLS.iter().flat_map(|call| call.split(' '));
        let studies = words.filter(|word| word.starts_with("studies/"));
        let missing: Vec<_> = studies.filter(|name| !root.join(name).exists()).collect();
        assert_eq!(missing, ["studies/no-such-study.toml"]);
    }

    #[test]
    fn planted_differences_are_found() {
        let answer = |text: &str| PlatformAnswer::from([("x".to_owned(), text.into())]);
        assert_eq!(difference(&answer("1.5"), &answer("1.5")), None);
        let off = difference(&answer("a 1.5"), &answer("a 1.6")).expect("a digit");
        assert!(off.starts_with("x from byte 4"), "{off}");
        assert_eq!(
            difference(&answer("1"), &PlatformAnswer::new()).as_deref(),
            Some("x is missing")
        );
    }

    #[test]
    fn unknown_platforms_are_refused_before_anything_is_built() {
        let why = run(Path::new("."), Some("no-such-platform")).expect_err("unknown");
        assert!(why.contains("aarch64-unknown-linux-gnu"), "{why}");
    }
}
