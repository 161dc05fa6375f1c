//! The book is correct: every study in it is valid, every command in it runs, and the outputs shown are the actual ones.
//!
//! A page is processed from top to bottom in its own folder, which also contains the studies of the project:
//!
//! | block | action |
//! |---|---|
//! | `toml` | saved under the name in its first line, `# NAME.toml`, and checked |
//! | `csv` | saved under the name in its first line, `# NAME.csv` |
//! | `mtx` | saved under the name in its second line, `% NAME.mtx` |
//! | `toml` that begins with `[friction]` | replaces `[friction]` in the last belt; checked unless it names a data file |
//! | `sh` | every line that begins with `quell` is run and must succeed |
//! | `text` after `sh` | must equal the output of the last command |
//!
//! `QUELL_BLESS=1 cargo test -p quell-cli --test book` writes the answers into the pages.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};

/// One block of code.
struct Block {
    language: String,
    /// Lines between the fences.
    lines: Vec<String>,
    /// Line of the opening fence, counted from 0.
    begins: usize,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Every page of the book, and the README.
fn pages() -> Vec<PathBuf> {
    let mut pages = vec![root().join("README.md")];
    let mut folders = vec![root().join("docs/book/src")];
    while let Some(folder) = folders.pop() {
        for file in fs::read_dir(folder).expect("the book") {
            let path = file.expect("a file").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "md") {
                pages.push(path);
            }
        }
    }
    pages.sort();
    pages
}

fn blocks(text: &str) -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut open: Option<Block> = None;
    for (number, line) in text.lines().enumerate() {
        match (&mut open, line.strip_prefix("```")) {
            (None, Some(language)) => {
                open = Some(Block {
                    language: language.to_owned(),
                    lines: Vec::new(),
                    begins: number,
                });
            }
            (Some(_), Some(_)) => blocks.extend(open.take()),
            (Some(block), None) => block.lines.push(line.to_owned()),
            (None, None) => {}
        }
    }
    assert!(open.is_none(), "a block of code is not closed");
    blocks
}

/// Commands of a block; a backslash at the end of a line continues the command on the next line.
fn commands(block: &Block) -> Vec<String> {
    let joined = block.lines.join("\n").replace("\\\n", " ");
    joined.lines().filter(|line| line.starts_with("quell ")).map(str::to_owned).collect()
}

/// The arguments of a command; those between single quotes may have spaces.
fn arguments(command: &str) -> Vec<String> {
    let parts = command.split('\'').enumerate();
    let words = parts.flat_map(|(number, part)| {
        let is_quoted = number % 2 == 1;
        let plain = part.split_whitespace().filter(move |_| !is_quoted);
        plain.chain(is_quoted.then_some(part)).map(str::to_owned).collect::<Vec<_>>()
    });
    words.skip(1).collect()
}

/// Runs a command in `folder` and returns its standard output.
fn run(command: &str, folder: &Path, page: &Path) -> String {
    let words: Vec<String> = arguments(command);
    let output = Command::new(env!("CARGO_BIN_EXE_quell"))
        .args(&words)
        .current_dir(folder)
        .output()
        .expect("quell runs");
    assert!(
        output.status.success(),
        "{}: {command}\n{}",
        page.display(),
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout).expect("text")
}

/// A folder with the studies of the project.
fn workplace() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let studies = folder.path().join("studies");
    fs::create_dir(&studies).expect("made");
    for file in fs::read_dir(root().join("studies")).expect("studies") {
        let path = file.expect("a file").path();
        fs::copy(&path, studies.join(path.file_name().expect("a name"))).expect("copied");
    }
    folder
}

/// A study with its `[friction]` replaced.
fn with_friction(study: &str, friction: &str) -> String {
    let (before, rest) = study.split_once("[friction]").expect("a belt before");
    let after = rest.split_once("\n[").map_or("", |(_, after)| after);
    format!("{before}{friction}\n[{after}")
}

/// Processes a page in a folder, in which the files of its commands are left, and returns it with the actual outputs.
fn page_in(path: &Path, folder: &tempfile::TempDir) -> String {
    let text = fs::read_to_string(path).expect("a page");
    let mut answer: Option<String> = None;
    // The last complete study of a belt on the page.
    let mut belt = String::new();
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    // From the last block to the first, so that the line numbers of earlier blocks remain valid.
    let mut answers: Vec<(usize, usize, String)> = Vec::new();
    for block in blocks(&text) {
        match block.language.as_str() {
            "toml" if block.lines.first().is_some_and(|line| line == "[friction]") => {
                let part = block.lines.join("\n");
                if !part.contains("file =") {
                    let study = with_friction(&belt, &part);
                    fs::write(folder.path().join("part.toml"), study).expect("written");
                    run("quell check part.toml", folder.path(), path);
                }
                answer = None;
            }
            "toml" => {
                if block.lines.iter().any(|line| line == "[belt]") {
                    belt = block.lines.join("\n");
                }
                let name = block.lines.first().and_then(|line| line.strip_prefix("# "));
                let named =
                    |name: &&str| Path::new(name).extension().is_some_and(|item| item == "toml");
                let name = name.filter(named).unwrap_or("study.toml");
                fs::write(folder.path().join(name), block.lines.join("\n")).expect("written");
                run(&format!("quell check {name}"), folder.path(), path);
                answer = None;
            }
            "csv" => {
                let name = block.lines.first().and_then(|line| line.strip_prefix("# "));
                let name = name.expect("the name of the file in its first line");
                fs::write(folder.path().join(name), block.lines.join("\n")).expect("written");
            }
            "mtx" => {
                let name = block.lines.get(1).and_then(|line| line.strip_prefix("% "));
                let name = name.expect("the name of the file in its second line");
                fs::write(folder.path().join(name), block.lines.join("\n")).expect("written");
            }
            "sh" => {
                answer = None;
                for command in commands(&block) {
                    answer = Some(run(&command, folder.path(), path));
                }
            }
            "text" => {
                if let Some(answer) = answer.take() {
                    answers.push((block.begins, block.lines.len(), answer));
                }
            }
            _ => answer = None,
        }
    }
    for (begins, count, answer) in answers.into_iter().rev() {
        let shown: Vec<String> = answer.trim_end().lines().map(str::to_owned).collect();
        lines.splice(begins + 1..=begins + count, shown);
    }
    lines.join("\n") + "\n"
}

/// Every answer shown is the one that its command gives, and every picture next to a page is the one that a command of the page draws,
/// `--plot NAME.svg`. `QUELL_BLESS=1` writes them.
#[test]
fn studies_commands_answers_and_pictures_are_true() {
    let pages = pages();
    assert!(pages.len() > 15);
    // Each thread takes the next page when it is free: some pages take a hundred times as long as others.
    let next = AtomicUsize::new(0);
    let done: Vec<(usize, Vec<String>)> = std::thread::scope(|scope| {
        let reader = || {
            let (mut count, mut wrong) = (0, Vec::new());
            while let Some(path) = pages.get(next.fetch_add(1, Ordering::Relaxed)) {
                let folder = workplace();
                let (before, now) =
                    (fs::read_to_string(path).expect("a page"), page_in(path, &folder));
                if before != now {
                    if blesses() {
                        fs::write(path, now).expect("written");
                    } else {
                        wrong.push(path.display().to_string());
                    }
                }
                let (pictures, others) = pictures_of(path, &before, &folder);
                count += pictures;
                wrong.extend(others);
            }
            (count, wrong)
        };
        let readers = [(); 2].map(|()| scope.spawn(reader));
        readers.into_iter().map(|reader| reader.join().expect("a reader")).collect()
    });
    let wrong: Vec<&String> = done.iter().flat_map(|(_, wrong)| wrong).collect();
    assert!(
        wrong.is_empty(),
        "answers differ: {wrong:?}; QUELL_BLESS=1 writes the present ones into the pages"
    );
    assert!(done.iter().map(|(count, _)| count).sum::<usize>() > 4);
}

/// Every question of the README is answered by its command as it stands.
#[test]
fn questions_of_the_readme_run() {
    let path = root().join("README.md");
    let text = fs::read_to_string(&path).expect("the README");
    let rows = text.lines().filter(|line| line.starts_with("| ")).flat_map(|line| line.split('`'));
    let commands: Vec<&str> = rows.filter(|part| part.starts_with("quell ")).collect();
    assert!((10..=14).contains(&commands.len()), "{}", commands.len());
    let folder = workplace();
    for command in commands {
        assert!(!run(command, folder.path(), &path).is_empty(), "{command}");
    }
}

fn blesses() -> bool {
    std::env::var_os("QUELL_BLESS").is_some()
}

/// The number of pictures next to a page, and those that are not what its commands drew in a folder.
fn pictures_of(path: &Path, text: &str, folder: &tempfile::TempDir) -> (usize, Vec<String>) {
    let links = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    let own = |link: &&str| {
        Path::new(link).extension().is_some_and(|end| end == "svg") && !link.contains(['/', ':'])
    };
    let (mut count, mut wrong) = (0, Vec::new());
    for link in links.filter(own) {
        count += 1;
        let kept = path.with_file_name(link);
        let Ok(now) = fs::read_to_string(folder.path().join(link)) else {
            wrong.push(format!("{}: no command draws {link}", path.display()));
            continue;
        };
        if blesses() {
            fs::write(&kept, &now).expect("written");
        }
        if !fs::read_to_string(&kept).is_ok_and(|before| before == now) {
            wrong.push(kept.display().to_string());
        }
    }
    (count, wrong)
}

/// Every picture in the book and the README is that of `reproduce`. `QUELL_BLESS=1` writes them.
#[test]
fn pictures_are_those_of_reproduce() {
    let mut count = 0;
    let mut made: Vec<PathBuf> = Vec::new();
    for page in pages() {
        let text = fs::read_to_string(&page).expect("a page");
        let folder = page.parent().expect("a folder");
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let Some((_, file)) = link.split_once("reproduction/") else { continue };
            count += 1;
            let path = folder.join(link);
            let stem = file.trim_end_matches(".svg");
            let entry = quell_reproduce::ENTRIES.iter().find(|entry| entry.stem() == stem);
            let entry = entry.unwrap_or_else(|| panic!("{}: {link}", page.display()));
            if made.contains(&path) {
                continue;
            }
            let now = entry.product().expect("made").figure.expect("a picture").to_svg();
            if blesses() {
                fs::write(&path, &now).expect("written");
            }
            let before = fs::read_to_string(&path).expect("QUELL_BLESS=1 writes it");
            assert!(now == before, "{}: QUELL_BLESS=1 writes the present picture", path.display());
            made.push(path);
        }
    }
    assert!(count > 8);
}

/// Every link to a file is valid, and every page is in the table of contents.
#[test]
fn links_are_valid() {
    let book = root().join("docs/book/src");
    let contents = fs::read_to_string(book.join("SUMMARY.md")).expect("contents");
    for path in pages() {
        let text = fs::read_to_string(&path).expect("a page");
        let folder = path.parent().expect("a folder");
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let outside = link.starts_with("http");
            let file = link.split('#').next().unwrap_or_default();
            if !outside && !file.is_empty() {
                assert!(folder.join(file).exists(), "{}: {link}", path.display());
            }
        }
        if let Ok(name) = path.strip_prefix(&book) {
            let name = name.display().to_string();
            let listed = name == "SUMMARY.md" || contents.contains(&format!("({name})"));
            assert!(listed, "{name} is not in SUMMARY.md");
        }
    }
}

/// Examples and benches named in a page exist: `--package NAME … --example NAME`.
#[test]
fn programs_named_in_pages_exist() {
    let mut files = pages();
    files.extend(
        ["docs/speed.md", "docs/many-machines.md", "benches/peers/README.md"]
            .map(|item| root().join(item)),
    );
    files.extend(
        ["compare.py", "compare_disc.py", "plot_cost.py"]
            .map(|item| root().join("benches/peers").join(item)),
    );
    let mut count = 0;
    for file in files {
        let text =
            fs::read_to_string(&file).expect("a file").replace(['"', ',', '`', '[', ']'], " ");
        let words: Vec<&str> = text.split_whitespace().collect();
        for (place, pair) in words.windows(2).enumerate() {
            let folder = match pair[0] {
                "--example" => "examples",
                "--bench" => "benches",
                _ => continue,
            };
            let package =
                words[..place].iter().rposition(|word| matches!(*word, "--package" | "-p"));
            let package = words[package.expect("a package before it") + 1];
            let program = root().join(format!("crates/{package}/{folder}/{}.rs", pair[1]));
            assert!(program.exists(), "{}: {} of {package}", file.display(), pair[1]);
            count += 1;
        }
    }
    assert!(count >= 5, "{count}");
}

/// The page of errata is generated from the list of corrections.
#[test]
fn errata_equal_the_list_of_corrections() {
    let path = root().join("docs/book/src/errata.md");
    let now = quell::cite::errata::markdown("../../..");
    if std::env::var_os("QUELL_BLESS").is_some() {
        fs::write(&path, &now).expect("written");
    }
    let page = fs::read_to_string(&path).expect("QUELL_BLESS=1 writes it");
    assert_eq!(page, now, "QUELL_BLESS=1 writes the present registry into the page");
}

/// The page of sources is generated from the bibliography, so that it lists every source.
#[test]
fn sources_equal_the_bibliography() {
    let path = root().join("docs/book/src/sources.md");
    let now = quell::cite::page::markdown();
    if std::env::var_os("QUELL_BLESS").is_some() {
        fs::write(&path, &now).expect("written");
    }
    let page = fs::read_to_string(&path).expect("QUELL_BLESS=1 writes it");
    assert_eq!(page, now, "QUELL_BLESS=1 writes the present bibliography into the page");
}

/// The README counts the laws and waveforms that there are, and lists the names of the laws.
#[test]
fn the_readme_counts_laws_and_waveforms() {
    let text = fs::read_to_string(root().join("README.md")).expect("the README");
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let words = ["four", "five", "six", "seven", "eight", "nine", "ten"];
    let in_words = |count: usize| words[count - 4];
    let laws = quell_model::LawKind::NUMERIC;
    assert!(text.contains(&format!(
        "with {} friction laws, a formula or measured samples",
        in_words(laws.len())
    )));
    for law in laws {
        assert!(text.contains(&format!("\"{}\"", law.name())), "{}", law.name());
    }
    let waveforms = ["sine", "triangle", "square", "fourier", "samples", "burst", "noise"];
    assert!(text.contains(&format!("dither of {} waveforms", in_words(waveforms.len()))));
    let listed = waveforms.map(|name| format!("\"{name}\""));
    assert!(listed.iter().all(|name| text.contains(name.as_str())), "{listed:?}");
    // Every kind that a study may name is among them.
    let schema = quell::schema::schema().to_string();
    for name in waveforms {
        assert!(schema.contains(&format!("\"{name}\"")), "{name}");
    }
}
