//! Tables 5.1 and 5.2: speeds at which waves meet, with properties of the meetings that the dissertation does not give.

use quell_disc::resonance::{Resonance, Waves};

use super::super::failure::failed;
use super::super::product::{DataTable, Product};
use super::super::source::EntrySource;
use super::study;
use quell::cite::Task;
use quell::complaint::Failure;

/// Speeds of table 5.1.
pub(crate) const PRINTED_UNDITHERED: [&str; 5] = ["0.036", "0.064", "0.114", "0.192", "1"];

/// Speeds of table 5.2.
pub(crate) const PRINTED_INDUCED: [&str; 8] =
    ["0.325", "0.369", "0.458", "0.536", "0.675", "0.836", "0.879", "0.964"];

/// Table 5.1.
pub(crate) fn undithered(source: &EntrySource) -> Result<Product, Failure> {
    table(source, |waves| waves.undithered(0.0..=1.0), "Ω", &PRINTED_UNDITHERED, "5.1")
}

/// Table 5.2.
pub(crate) fn induced(source: &EntrySource) -> Result<Product, Failure> {
    table(source, |waves| waves.dithered(0.0..=1.0), "Ω*", &PRINTED_INDUCED, "5.2")
}

fn table(
    source: &EntrySource,
    found: impl Fn(&Waves) -> Vec<Resonance>,
    symbol: &str,
    printed: &[&str],
    number: &str,
) -> Result<Product, Failure> {
    let study = study(source, &[])?;
    let waves = Waves::new(study.disc()).map_err(|why| failed(source.name, &why))?;
    let columns = [
        ("name", "1"),
        ("printed", "ω_ref"),
        ("speed", "ω_ref"),
        ("waves", "1"),
        ("pair_can_be_unstable", "1"),
        ("threshold_over_damper", "1"),
    ];
    let mut table = DataTable::new("", &columns);
    // Speeds of one's own are not those of the print.
    let printed = if source.is_own() { &[] } else { printed };
    let mut names = printed.iter().enumerate();
    let damper = study.disc().loads().first().map_or(1.0, |load| load.damping);
    for resonance in found(&waves) {
        // The dissertation omits Ω = 0.
        let (name, value) = match names.next().filter(|_| resonance.speed > 1e-9) {
            Some((index, printed)) => (format!("{symbol}_{}", index + 1), printed.parse().ok()),
            None if source.is_own() => (symbol.to_owned(), None),
            None => ("not printed".to_owned(), None),
        };
        if resonance.speed <= 1e-9 {
            names = printed.iter().enumerate();
        }
        table.row([
            name.as_str().into(),
            value.into(),
            resonance.speed.into(),
            resonance.label().as_str().into(),
            if resonance.pair_can_be_unstable() { "yes" } else { "no" }.into(),
            resonance.threshold.map(|threshold| threshold / damper).into(),
        ]);
    }
    let caption = if source.is_own() {
        format!(
            "Own numbers, {}: speeds Ω at which two waves of the disc meet in the frame of the load, as in table {number} of Michaux \
             (2005), but no table of that dissertation; the pair of waves, whether it can be unstable at first order, and the friction \
             $f$/$c$ at the tip of its tongue.",
            source.own_words().join("; ")
        )
    } else {
        format!(
            "Table {number}. Speeds Ω at which two waves of the disc meet in the frame of the load, $N_r$ = 1, $N_θ$ = 2{}: every \
             printed digit is reproduced with $b$/$a$ = 0.5, printed as 0.05. Added: the pair of waves, whether it can be unstable at \
             first order, and the friction $f$/$c$ at the tip of its tongue.",
            if number == "5.2" { ", $R$ = 2.7" } else { "" }
        )
    };
    Ok(Product::disc_table(caption, &study).by(&[Task::Resonances]).table(table))
}
