//! Every entry of `reproduce` is computed, its data have the documented columns, and its claims the verdicts on record.

use std::path::Path;
use std::sync::OnceLock;

use quell::{Change, Failure, Study};
use quell_reproduce::claims::{self, Claim, ClaimVerdict, LEDGER};
use quell_reproduce::{
    CatalogueEntry, Cell, ENTRIES, Product, Reproduction, ReproductionOptions, Resolution, find,
    run,
};
use serde_json::Value;

/// Points along each axis of a figure where its numbers are not asked for.
const POINTS: usize = 6;

fn entry(name: &str) -> &'static CatalogueEntry {
    ENTRIES.iter().find(|entry| entry.name == name).expect(name)
}

/// Every entry with few points and all claims, made once for all tests, and what is said of it as JSON.
fn everything() -> &'static (Reproduction, Value) {
    static MADE: OnceLock<(Reproduction, Value)> = OnceLock::new();
    MADE.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a folder");
        let options =
            ReproductionOptions { resolution: Resolution::AtMost(POINTS), ..Default::default() };
        let made = run(ENTRIES, folder.path(), &options, |_| ()).expect("made");
        for file in made.written.iter().flat_map(|done| &done.files) {
            let size = std::fs::metadata(file).expect("a file").len();
            assert!(size > 400, "{}: {size} bytes", file.display());
        }
        let json = made.json(folder.path(), &options);
        (made, json)
    })
}

/// The claims as they are measured.
fn measured_claims() -> &'static [Claim] {
    let written = &everything().0.written;
    &written.iter().find(|done| done.entry.name == "claims").expect("claims").product.claims
}

/// An entry with few points.
fn product(name: &str) -> &'static Product {
    &everything().0.written.iter().find(|done| done.entry.name == name).expect(name).product
}

/// Names of the columns of each table of an entry.
fn columns(name: &str) -> Vec<Vec<String>> {
    product(name)
        .tables
        .iter()
        .map(|table| table.columns.iter().map(|column| column.name.clone()).collect())
        .collect()
}

#[test]
fn every_entry_is_made() {
    // The verdicts of claims are compared below, and the pictures of the book are compared with those of all points by its own test.
    for entry in ENTRIES.iter().filter(|entry| entry.name != "claims") {
        let product = product(entry.name);
        assert!(!product.tables.is_empty(), "{} has data", entry.name);
        for table in &product.tables {
            assert!(table.rows.len() > 3, "{} has rows", entry.name);
            for row in &table.rows {
                assert_eq!(row.len(), table.columns.len(), "{}", entry.name);
                let finite =
                    |cell: &Cell| !matches!(cell, Cell::Number(value) if !value.is_finite());
                assert!(row.iter().all(finite), "{}: {row:?}", entry.name);
            }
            let csv = product.csv(table);
            let written = csv.lines().filter(|line| !line.starts_with('#')).count();
            assert_eq!(written, table.rows.len() + 1, "{}", entry.name);
        }
        let Some(figure) = &product.figure else {
            let number = entry.name.trim_start_matches("table-");
            assert!(
                product.caption.starts_with(&format!("Table {number}. ")),
                "{}",
                product.caption
            );
            continue;
        };
        let caption = format!("Figure {}. ", entry.name);
        assert!(product.caption.starts_with(&caption), "{}", product.caption);
        assert!(!product.plain_caption().contains(['$', '{', '\\']), "{}", product.plain_caption());
        assert!(figure.to_svg().len() > 5000);
    }
}

#[test]
fn data_have_the_documented_columns() {
    let names = |list: &str| -> Vec<String> { list.split(' ').map(str::to_owned).collect() };
    let curves = "waveform amplitude_ratio_over_reference slip_velocity_over_reference effective_coefficient \
         effective_slope printed_coefficient";
    let map = "waveform damping_ratio curve amplitude_ratio belt_velocity";
    let measured = "amplitude slip_velocity measured_coefficient stick_fraction averaged_coefficient law_coefficient";
    let laws = "slip_velocity_over_reference stribeck_coefficient decreasing_coefficient";
    for (name, list) in [
        ("2.2", laws),
        ("4.2", laws),
        ("2.4", curves),
        ("3.4", curves),
        ("2.6", map),
        ("4.8", map),
        ("3.2", "cycles sine_g sine_G triangle_g triangle_G square_g square_G"),
    ] {
        assert_eq!(columns(name), [names(list)], "{name}");
    }
    let decays = "amplitude slip_velocity measured_coefficient windows";
    assert_eq!(columns("4.5"), [names(measured), names(decays)]);
    let histories = "time undithered_displacement undithered_velocity a_displacement a_velocity b_displacement \
         b_velocity c_displacement c_velocity";
    let spectra = "frequency undithered_amplitude a_amplitude b_amplitude c_amplitude";
    assert_eq!(columns("2.3"), [names(histories), names(spectra)]);
}

#[test]
fn study_files_are_valid_and_belong_to_their_figures() {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies");
    let mut count = 0;
    for file in std::fs::read_dir(&directory).expect("studies") {
        let path = file.expect("a file").path();
        // The directory also contains data files to which studies refer.
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let text = std::fs::read_to_string(&path).expect("text");
        let study = Study::parse_in(&text, &[], &directory)
            .unwrap_or_else(|complaints| panic!("{}: {complaints:?}", path.display()));
        let title = study.title().expect("a title").to_owned();
        let stem = path.file_stem().and_then(|stem| stem.to_str()).expect("a name").to_owned();
        if let Some(number) = stem.strip_prefix("figure-") {
            assert!(title.starts_with(&format!("Figure {number}: ")), "{title}");
            assert_eq!(entry(number).source().text, text);
        } else if let Some(number) = stem.strip_prefix("table-") {
            assert!(title.starts_with(&format!("Table {number}: ")), "{title}");
            assert_eq!(entry(&stem).source().text, text);
        }
        count += 1;
    }
    assert!(count > ENTRIES.len());
}

/// Values of figure 2.3 known from other integrators: the undithered amplitude M₀, and E at D_T = 0.3, 0.4.
#[test]
fn spectra_of_figure_2_3_have_the_known_peaks() {
    let product = entry("2.3").product().expect("made");
    let spectra = &product.tables[1];
    let largest = |column: usize| {
        let cells = spectra.rows.iter().filter_map(|row| match (&row[0], &row[column]) {
            (Cell::Number(frequency), Cell::Number(amplitude)) if *frequency <= 1.9 => {
                Some(*amplitude)
            }
            _ => None,
        });
        cells.fold(0.0, f64::max)
    };
    let undithered = largest(1);
    assert!((undithered - 0.128_794).abs() < 1e-3 * undithered, "{undithered}");
    for (column, residual_vibration) in [(2, 0.4999), (3, 0.2589)] {
        let found = largest(column) / undithered;
        assert!(
            (found - residual_vibration).abs() < 0.01 * residual_vibration,
            "{found} {residual_vibration}"
        );
    }
    assert!(largest(4) < 1e-6);
}

/// Every claim has the verdict on record, and every verdict on record has its claim.
#[test]
fn verdicts_are_those_on_record() {
    let claims = measured_claims();
    let changed: Vec<String> = claims
        .iter()
        .filter(|claim| !claim.as_expected())
        .map(|claim| format!("{}: {}, on record {:?}", claim.name, claim.verdict, claim.expected))
        .collect();
    assert!(changed.is_empty(), "claims::LEDGER differs:\n{}", changed.join("\n"));
    let measured: Vec<&str> = claims.iter().map(|claim| claim.name.as_str()).collect();
    let on_record: Vec<&str> = LEDGER.iter().map(|(name, _)| *name).collect();
    assert_eq!(measured, on_record, "one line of claims::LEDGER for each claim, in their order");
    for claim in claims {
        let holds =
            claim.verdict.holds() || matches!(claim.verdict, ClaimVerdict::FormulaWrong { .. });
        assert_eq!(holds, claim.why().is_empty(), "{} says why it does not hold", claim.name);
        assert_eq!(claim.tolerance.is_some(), !claim.printed.is_empty(), "{}", claim.name);
    }
    // Five slips are behind the wrong formulas, and what the dissertation does not state counts for nothing.
    let found = claims::statements(claims);
    assert_eq!(claims::slips(&found).len(), 5);
    assert!(
        found.iter().all(|one| one.claims.iter().all(|claim| claim.verdict.name() != "finding"))
    );
    let findings: Vec<&str> = claims
        .iter()
        .filter(|claim| !claim.is_of_a_statement())
        .map(|claim| claim.name.as_str())
        .collect();
    for name in ["2.7-undithered-from-afar", "4.11-sine-columns", "5.30-fundamental"] {
        assert!(findings.contains(&name), "{name}");
    }
    // Wrong formulas, each of which is in the errata.
    let wrong =
        claims.iter().filter(|claim| matches!(claim.verdict, ClaimVerdict::FormulaWrong { .. }));
    assert_eq!(wrong.count(), 14);
    let value = |name: &str| claims.iter().find(|claim| claim.name == name).expect(name).values[0];
    for (name, known, tolerance) in [
        ("2.3-undithered-fundamental", 0.654_435, 1e-6),
        ("2.3-dithered-fundamental", 0.735_29, 1e-4),
        ("2.7-undithered", 0.809_135_878_048, 1e-11),
        ("2.7-v1-unstable", 4.366_05, 1e-5),
        ("3.38a", 0.092_020_364_605_888_12, 1e-13),
        ("B.4", 2.068_384_752_523, 1e-11),
        ("3.61-triangle-stable", 40.0 / std::f64::consts::PI, 1e-11),
        ("4.38", 0.379_493_225_521, 1e-11),
    ] {
        assert!((value(name) - known).abs() <= tolerance, "{name}: {} {known}", value(name));
    }
    // The book quotes the counts.
    let book = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/book/src/reproduction.md");
    let book = std::fs::read_to_string(book).expect("the book");
    let words: Vec<&str> = book.split_whitespace().filter(|word| *word != ">").collect();
    let summary = claims::summary(&claims::statements(claims));
    assert!(words.join(" ").contains(&summary), "the book does not say: {summary}");
    paper_quotes(claims, &summary);
    let mut names: Vec<&str> = claims.iter().map(|claim| claim.name.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), claims.len(), "names are unique");
    assert!(claims::markdown(claims).contains("| (3.38a), (B.10a) |"));
}

/// The claims in JSON; statements are counted, not claims.
#[test]
fn statements_are_counted_not_claims() {
    let (made, json) = everything();
    assert_eq!((&json["ok"], &json["quick"]), (&Value::Bool(true), &Value::Bool(true)));
    let entries = json["entries"].as_array().expect("entries");
    assert_eq!(entries.len(), made.written.len());
    let claims = entries.iter().find(|entry| entry["name"] == "claims").expect("claims");
    let claims = claims["claims"].as_array().expect("claims");
    assert!(claims.len() > 60 && claims.iter().all(|claim| claim["verdict"].is_string()));
    let names: std::collections::BTreeSet<&str> =
        claims.iter().filter_map(|claim| claim["statement_name"].as_str()).collect();
    let summary = json["summary"].as_str().expect("a sentence");
    let counted = claims.iter().filter(|claim| claim["verdict"] != "finding").count();
    let counts =
        format!("{} statements of the dissertation, measured by {counted} claims: ", names.len());
    assert!(names.len() < claims.len() && summary.starts_with(&counts), "{summary}");
}

/// The paper quotes the counts, rows of the ledger, and the comparison with other programs of the README.
fn paper_quotes(claims: &[Claim], summary: &str) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let path = root.join("docs/paper/paper.md");
    let paper = std::fs::read_to_string(&path).expect("the paper");
    let readme = std::fs::read_to_string(root.join("README.md")).expect("the README");
    let comparison: Vec<&str> = readme
        .split("## Comparison with other tools")
        .nth(1)
        .expect("the comparison")
        .lines()
        .skip_while(|line| !line.starts_with('|'))
        .take_while(|line| line.starts_with('|'))
        .collect();
    let comparison = comparison.join("\n") + "\n";
    let table = |names: &str| -> String {
        let rows = names.split(',').map(|name| {
            let name = name.trim();
            let claim = claims.iter().find(|claim| claim.name == name).expect(name);
            format!(
                "| {} | {} | {} | {} | {} |\n",
                claim.place, claim.statement, claim.printed, claim.measured, claim.verdict
            )
        });
        let head = "| place | claim | printed | measured | verdict |\n|---|---|---|---|---|\n";
        head.to_owned() + &rows.collect::<String>()
    };
    let mut present = String::new();
    let mut lines = paper.lines().peekable();
    while let Some(line) = lines.next() {
        present += line;
        present.push('\n');
        let made = match line {
            "<!-- comparison -->" => comparison.clone(),
            "<!-- summary -->" => format!("> {summary}\n"),
            _ => {
                match line.strip_prefix("<!-- claims: ").and_then(|rest| rest.strip_suffix(" -->"))
                {
                    Some(names) => table(names),
                    None => continue,
                }
            }
        };
        present += &made;
        while lines.next_if(|line| line.starts_with(['|', '>'])).is_some() {}
    }
    if std::env::var_os("QUELL_BLESS").is_some() {
        std::fs::write(&path, &present).expect("written");
    }
    let paper = std::fs::read_to_string(&path).expect("the paper");
    assert!(paper == present, "QUELL_BLESS=1 writes the present claims into the paper");
    assert!(present.matches("| ").count() > 60);
}

#[test]
fn names_are_known_or_listed() {
    let all = find(&[]).expect("all");
    assert_eq!(all.len(), ENTRIES.len());
    let some = find(&["figure-3.2".to_owned(), "2.2".to_owned()]).expect("two");
    assert_eq!(some.iter().map(|entry| entry.name).collect::<Vec<_>>(), ["2.2", "3.2"]);
    let complaints =
        find(&["2.3".to_owned(), "claim".to_owned(), "9.9".to_owned()]).expect_err("two unknown");
    assert_eq!(complaints.len(), 2);
    assert_eq!(complaints[0].suggestion.as_deref(), Some("claims"));
    assert!(complaints[1].allowed.contains("2.2, 2.3, 2.4"));
}

#[test]
fn files_are_written_to_a_new_directory() {
    let folder = tempfile::tempdir().expect("a folder");
    let directory = folder.path().join("new/deeper");
    let entries = find(&["2.2".to_owned(), "2.6".to_owned(), "3.2".to_owned()]).expect("known");
    let options = ReproductionOptions::default();
    let written = run(&entries, &directory, &options, |_| ()).expect("written").written;
    assert_eq!(
        written.iter().map(|done| done.entry.name).collect::<Vec<_>>(),
        ["2.2", "2.6", "3.2"]
    );
    let mut names: Vec<String> = std::fs::read_dir(&directory)
        .expect("made")
        .map(|file| file.expect("a file").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    let expected: Vec<String> = ["2.2", "2.6", "3.2"]
        .iter()
        .flat_map(|name| {
            ["csv", "pdf", "png", "svg"].map(|extension| format!("figure-{name}.{extension}"))
        })
        .chain(["report.html".to_owned(), "report.md".to_owned()])
        .collect();
    assert_eq!(names, expected);
    // The report is self-contained: figures are embedded, and nothing is fetched.
    let page = std::fs::read_to_string(directory.join("report.html")).expect("a report");
    assert_eq!(page.matches("<img ").count(), 3);
    assert_eq!(page.matches("src=\"data:image/svg+xml;base64,").count(), 3);
    for outside in ["<script", "src=\"http", "<link", "@import", "url("] {
        assert!(!page.contains(outside), "{outside}");
    }
    for inside in [
        "id=\"figure-2.6\"",
        "Corrections applied",
        "Equations used",
        "law = &quot;stribeck&quot;",
        "Run time",
    ] {
        assert!(page.contains(inside), "{inside}");
    }
    let table = std::fs::read_to_string(directory.join("report.md")).expect("a table");
    assert!(table.contains("[figure-2.6.csv](figure-2.6.csv)"), "{table}");
    // Overwriting the files gives the same bytes.
    let first = std::fs::read(directory.join("figure-2.6.png")).expect("read");
    run(&entries, &directory, &options, |_| ()).expect("written again");
    assert_eq!(std::fs::read(directory.join("figure-2.6.png")).expect("read"), first);
}

#[test]
fn a_directory_that_cannot_be_created_is_rejected_before_any_work() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("occupied");
    std::fs::write(&file, "a file").expect("written");
    let all = find(&[]).expect("all");
    let failure = run(&all, &file, &ReproductionOptions::default(), |_| panic!("nothing is made"))
        .expect_err("refused");
    let Failure::Wrong(complaints) = failure else { panic!("{failure}") };
    assert_eq!(complaints[0].key, "--out");
    assert!(complaints[0].to_string().contains("occupied"), "{}", complaints[0]);
}

/// A figure with numbers of one's own.
fn own(name: &str, changes: &[&str]) -> Result<Reproduction, Failure> {
    let folder = tempfile::tempdir().expect("a folder");
    let changes =
        changes.iter().map(|text| Change::parse(text, "--set").expect("a change")).collect();
    let options =
        ReproductionOptions { resolution: Resolution::QUICK, changes, ..Default::default() };
    run(&find(&[name.to_owned()]).expect("known"), folder.path(), &options, |_| ())
}

/// One command per figure: any number of it, and the families that it varies. The result says that it is no figure of the dissertation,
/// in its caption, its files and its report.
#[test]
fn a_figure_with_ones_own_numbers_is_captioned_as_such() {
    let numbers = |done: &Reproduction, column: &str| -> Vec<f64> {
        let table = &done.written[0].product.tables[0];
        let index = table.columns.iter().position(|known| known.name == column).expect(column);
        let mut values: Vec<f64> = table
            .rows
            .iter()
            .filter_map(|row| if let Cell::Number(value) = row[index] { Some(value) } else { None })
            .collect();
        values.sort_unstable_by(f64::total_cmp);
        values.dedup();
        values
    };
    let words = |done: &Reproduction, column: usize| -> Vec<String> {
        let mut found: Vec<String> = done.written[0].product.tables[0]
            .rows
            .iter()
            .filter_map(
                |row| if let Cell::Text(text) = &row[column] { Some(text.clone()) } else { None },
            )
            .collect();
        found.dedup();
        found
    };
    let done = own("2.4", &["friction.reference_velocity=0.3", "dither.amplitude=[0, 0.6, 1.2]"])
        .expect("drawn");
    assert_eq!(
        numbers(&done, "amplitude_ratio_over_reference").len(),
        3,
        "three amplitudes over v_m = 0.3"
    );
    let written = &done.written[0];
    let caption = written.product.plain_caption();
    assert!(
        caption.starts_with(
            "Own numbers, friction.reference_velocity = 0.3; dither.amplitude = 0, 0.6, 1.2:"
        ),
        "{caption}"
    );
    assert!(
        caption.contains("but no figure of that dissertation") && caption.contains("v_m = 0.3"),
        "{caption}"
    );
    assert!(!caption.contains("Figure 2.4"), "{caption}");
    assert!(written.own && written.files[0].ends_with("own-figure-2.4.svg"), "{:?}", written.files);
    // Waveforms, also those that need keys of their own, and damping ratios.
    let done = own(
        "3.3",
        &["dither.waveform=[sine, burst]", "dither.carrier=sine", "dither.on=4", "dither.off=1"],
    )
    .expect("drawn");
    assert_eq!(words(&done, 0), ["sine", "burst"]);
    let done =
        own("3.5", &["dither.waveform=square", "belt.damping_ratio=[0.1, 0.02]"]).expect("drawn");
    assert_eq!(words(&done, 0), ["square"]);
    assert_eq!(numbers(&done, "damping_ratio"), [0.02, 0.1]);
    let done = own("2.6", &["belt.damping_ratio=[0.1, 0.02]"]).expect("drawn");
    assert_eq!(numbers(&done, "damping_ratio"), [0.02, 0.1]);
    let done =
        own("2.8", &["belt.belt_velocity=[0.04, 0.06, 0.08]", "friction.static_coefficient=0.5"])
            .expect("drawn");
    assert_eq!(numbers(&done, "belt_velocity"), [0.04, 0.06, 0.08]);
    let done = own("2.3", &["dither.amplitude=[0.2, 0.6]"]).expect("drawn");
    assert_eq!(done.written[0].product.figure.as_ref().expect("a picture").panels.len(), 6);
    let done =
        own("2.2", &["friction.law=[stribeck]", "friction.reference_velocity=0.1"]).expect("drawn");
    assert_eq!(done.written[0].product.tables[0].columns.len(), 2);
    let done = own(
        "5.9",
        &["disc.load.friction=[0.1, 0.4]", "disc.load.speed=[0.3, 0.5]", "disc.modal_damping=1e-4"],
    )
    .expect("drawn");
    assert!(done.written[0].product.plain_caption().contains("ξ = 0.0001"));
}

/// Every figure whose numbers can be changed accepts a change of one, and none of its sentences is about the print then.
#[test]
fn every_figure_takes_a_change() {
    for entry in ENTRIES.iter().filter(|entry| !["claims", "5.6"].contains(&entry.name)) {
        // Those that take long are of the same functions as others.
        if [
            "2.9", "3.10", "3.11", "4.10", "5.5", "4.6", "5.8", "5.10", "5.11", "5.13", "5.14",
            "5.15", "2.11", "3.12", "3.13",
        ]
        .contains(&entry.name)
        {
            continue;
        }
        let change = if entry.source().text.contains("[disc]") {
            "disc.poisson_ratio=0.29"
        } else {
            "belt.normal_load=1.2"
        };
        let done =
            own(entry.name, &[change]).unwrap_or_else(|why| panic!("{}: {why:?}", entry.name));
        let caption = done.written[0].product.plain_caption();
        assert!(caption.starts_with("Own numbers, "), "{}: {caption}", entry.name);
        assert!(
            !caption.contains("as printed") || entry.name.starts_with("5."),
            "{}: {caption}",
            entry.name
        );
        assert!(!caption.contains("The dissertation"), "{}: {caption}", entry.name);
    }
}

#[test]
fn changes_that_suit_no_figure_are_refused() {
    let wrong = |name: &str, change: &str| {
        let Err(Failure::Wrong(complaints)) = own(name, &[change]) else {
            panic!("{name} {change}")
        };
        complaints[0].to_string()
    };
    assert!(
        wrong("2.4", "belt.belt_velocity=[0.1, 0.2]")
            .contains("takes lists of values of dither.amplitude")
    );
    assert!(wrong("2.4", "friction.reference_velocty=0.1").contains("friction.reference_velocity"));
    assert!(wrong("claims", "belt.belt_velocity=0.1").contains("unlike claims"));
    let folder = tempfile::tempdir().expect("a folder");
    let changes = vec![Change::parse("belt.normal_load=2", "--set").expect("a change")];
    let options = ReproductionOptions { changes, ..Default::default() };
    let all = find(&[]).expect("all");
    let failure =
        run(&all, folder.path(), &options, |_| panic!("nothing is made")).expect_err("refused");
    assert!(format!("{failure:?}").contains("the name of a figure"), "{failure:?}");
}
