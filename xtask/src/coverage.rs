//! `cargo xtask coverage`: which lines of the crates no test reaches.
//!
//! cargo-tarpaulin builds with the compiler's own instrumentation and runs the tests of Rust, the command line in processes of
//! its own included; the table and the list of uncovered lines are made of its lcov file. Lines of lane code that is inlined
//! everywhere are counted where the compiler left them, so that shares are a guide and the list is what counts.
//!
//! cargo-tarpaulin would put counters into every crate. Those in other people's crates slow the tests down and say nothing about
//! ours, so this program stands between cargo and the compiler ([`compile`]) and takes the counters out of them again.

use std::collections::BTreeMap;
use std::env;
use std::ffi::OsString;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::{Command, ExitCode};

/// Set where cargo calls this program in place of the compiler.
pub(crate) const COMPILES: &str = "QUELL_COVERAGE_COMPILES";

/// Options of the compiler that only crates that are measured get: counters, and names of variables.
const MEASURED_ALONE: &[&str] = &["-Cinstrument-coverage", "-Cdebuginfo=2"];

/// Where it works, below the root.
const FOLDER: &str = "target/coverage";

/// The crate of the lanes. Counters in its inlined operations would be counters in every innermost loop of the others, a
/// hundred times slower: it is measured by its own tests, alone, and has none when the others are measured.
const LANES: &str = "quell-numerics";

/// What is not measured: other people's code, tests, and the crates whose tests are Python or chores.
const EXCLUDED: &[&str] = &[
    "target/*",
    "fuzz/*",
    "xtask/*",
    "crates/quell-python/*",
    "*/tests/*",
    "*/tests.rs",
    "*/benches/*",
    "*/examples/*",
];

/// Covered and all lines of a file or crate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Share {
    covered: usize,
    all: usize,
}

/// Measures, prints the table of crates, and writes the uncovered lines of each file.
///
/// # Errors
/// cargo-tarpaulin is missing or a test failed under it; the report cannot be read or written.
pub(crate) fn run(root: &Path) -> Result<(), String> {
    let root = fs::canonicalize(root).map_err(|why| why.to_string())?;
    let lanes = measure(&root, "lanes", &["--package", LANES])?;
    let mut packages = vec!["--workspace"];
    packages.extend([LANES, "quell-python", "xtask"].into_iter().flat_map(|it| ["--exclude", it]));
    let others = measure(&root, "others", &packages)?;
    let files = files(&(lanes + &others), &root);
    let list = root.join(FOLDER).join("uncovered.txt");
    fs::write(&list, uncovered(&files)).map_err(|why| format!("{}: {why}", list.display()))?;
    print!("{}", table(&files));
    eprintln!("coverage: {} names the lines", list.display());
    Ok(())
}

/// The lcov report of some crates, made in a folder of its own.
fn measure(root: &Path, name: &str, packages: &[&str]) -> Result<String, String> {
    let folder = format!("{FOLDER}/{name}");
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let program = env::current_exe().map_err(|why| format!("this program: {why}"))?;
    let mut command = Command::new(cargo);
    command.env("RUSTC_WRAPPER", program).env(COMPILES, "1");
    command.current_dir(root).args(["tarpaulin", "--engine", "llvm", "--skip-clean"]);
    command.args(packages);
    command.args(["--follow-exec", "--timeout", "3600", "--out", "Lcov"]);
    command.args(["--target-dir", &folder, "--output-dir", &folder]);
    command.args(["--objects", &format!("{folder}/debug/quell")]);
    for pattern in EXCLUDED {
        command.args(["--exclude-files", pattern]);
    }
    // Threads that share counters wait for each other's caches: tests and sweeps run on one.
    command.args(["--implicit-test-threads"]);
    command.env("RUST_TEST_THREADS", "1").env("RAYON_NUM_THREADS", "1");
    // Pictures drawn in full take many times as long; another test draws them coarsely.
    command.args(["--", "--skip", "pictures_are_those_of_reproduce"]);
    let status = command.status().map_err(|why| format!("cargo tarpaulin: {why}"))?;
    if !status.success() {
        return Err(format!("coverage: {status} (`cargo install cargo-tarpaulin` installs it)"));
    }
    let report = root.join(folder).join("lcov.info");
    fs::read_to_string(&report).map_err(|why| format!("{}: {why}", report.display()))
}

/// The compiler as cargo calls it (its path, its arguments), without counters in crates that are not measured.
pub(crate) fn compile(arguments: impl Iterator<Item = OsString>) -> ExitCode {
    let mut arguments: Vec<OsString> = arguments.collect();
    if arguments.is_empty() {
        eprintln!("{COMPILES} is set, and no compiler is named");
        return ExitCode::FAILURE;
    }
    let compiler = arguments.remove(0);
    // cargo sets it for the packages that it was asked for.
    if env::var_os("CARGO_PRIMARY_PACKAGE").is_none() {
        arguments.retain(|word| !MEASURED_ALONE.iter().any(|option| word == option));
    }
    match Command::new(&compiler).args(arguments).status() {
        Ok(status) if status.success() => ExitCode::SUCCESS,
        Ok(status) => {
            let code = status.code().and_then(|code| u8::try_from(code).ok());
            code.map_or(ExitCode::FAILURE, ExitCode::from)
        }
        Err(why) => {
            eprintln!("{}: {why}", compiler.display());
            ExitCode::FAILURE
        }
    }
}

/// Lines of each file, from the root of the project, with how often they ran.
fn files(lcov: &str, root: &Path) -> BTreeMap<String, BTreeMap<usize, u64>> {
    let mut files: BTreeMap<String, BTreeMap<usize, u64>> = BTreeMap::new();
    let mut file = None;
    for line in lcov.lines() {
        if let Some(path) = line.strip_prefix("SF:") {
            let path = Path::new(path);
            file = Some(path.strip_prefix(root).unwrap_or(path).display().to_string());
        } else if let (Some(rest), Some(file)) = (line.strip_prefix("DA:"), &file) {
            let mut numbers = rest.split(',').filter_map(|number| number.parse::<u64>().ok());
            if let (Some(number), Some(hits)) = (numbers.next(), numbers.next()) {
                let lines = files.entry(file.clone()).or_default();
                *lines.entry(usize::try_from(number).unwrap_or(0)).or_default() += hits;
            }
        }
    }
    files
}

/// Crates with their shares, as Markdown.
fn table(files: &BTreeMap<String, BTreeMap<usize, u64>>) -> String {
    let mut crates: BTreeMap<&str, Share> = BTreeMap::new();
    for (file, lines) in files {
        let Some(name) = file.strip_prefix("crates/").and_then(|rest| rest.split('/').next())
        else {
            continue;
        };
        for key in [name, "all"] {
            let share = crates.entry(key).or_default();
            share.all += lines.len();
            share.covered += lines.values().filter(|hits| **hits > 0).count();
        }
    }
    let mut text = "| crate | lines | covered | share |\n|---|---|---|---|\n".to_owned();
    for (name, Share { covered, all }) in crates {
        let share = 100.0 * covered as f64 / all.max(1) as f64;
        let _ = writeln!(text, "| `{name}` | {all} | {covered} | {share:.1} % |");
    }
    text
}

/// `file: 3-7, 12`, the files with most uncovered lines first.
fn uncovered(files: &BTreeMap<String, BTreeMap<usize, u64>>) -> String {
    let mut rows: Vec<(usize, String)> = Vec::new();
    for (file, lines) in files {
        let missed: Vec<usize> =
            lines.iter().filter(|(_, hits)| **hits == 0).map(|(line, _)| *line).collect();
        let mut ranges: Vec<(usize, usize)> = Vec::new();
        for line in &missed {
            match ranges.last_mut() {
                Some((_, last)) if *last + 1 == *line => *last = *line,
                _ => ranges.push((*line, *line)),
            }
        }
        let words: Vec<String> = ranges
            .iter()
            .map(|(a, b)| if a == b { a.to_string() } else { format!("{a}-{b}") })
            .collect();
        if !missed.is_empty() {
            rows.push((missed.len(), format!("{file}: {}\n", words.join(", "))));
        }
    }
    rows.sort_by(|one, other| other.0.cmp(&one.0).then(one.1.cmp(&other.1)));
    rows.into_iter().map(|(_, row)| row).collect()
}

#[cfg(test)]
mod tests {
    use super::{files, table, uncovered};
    use std::path::Path;

    #[test]
    fn lines_are_counted_by_crate_and_listed_by_file() {
        let lcov = "SF:/p/crates/a/src/x.rs\nDA:1,4\nDA:2,0\nDA:3,0\nDA:9,0\nend_of_record\n\
                    SF:/p/crates/b/src/y.rs\nDA:5,1\nend_of_record\n";
        let files = files(lcov, Path::new("/p"));
        let table = table(&files);
        assert!(table.contains("| `a` | 4 | 1 | 25.0 % |"), "{table}");
        assert!(table.contains("| `all` | 5 | 2 | 40.0 % |"), "{table}");
        assert_eq!(uncovered(&files), "crates/a/src/x.rs: 2-3, 9\n");
    }
}
