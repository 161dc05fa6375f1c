//! The atlas as files.
//!
//! ```sh
//! cargo run --release -p quell-design --example atlas > atlas.csv            # thresholds at round numbers of the groups
//! cargo run --release -p quell-design --example atlas -- tables > atlas.txt  # the tables, computed again; minutes
//! ```

use std::num::NonZeroUsize;
use std::thread;

use quell_design::atlas::{
    Atlas, AtlasAnswer, AtlasChange, AtlasErrors, AtlasLaw, AtlasPoint, AtlasTable, ERROR_BANDS,
    WAVEFORMS,
};
use quell_model::Waveform;

/// Values of R.
const FREQUENCY_RATIOS: [f64; 5] = [5.0, 10.0, 20.0, 50.0, 200.0];
/// Values of ζ_f/R.
const DAMPINGS_PER_CYCLE: [f64; 5] = [0.001, 0.01, 0.05, 0.1, 0.2];
/// Values of κ.
const RELATIVE_DAMPINGS: [f64; 7] = [0.0, 0.02, 0.05, 0.1, 0.2, 0.5, 0.8];
/// Values of v₀/v_m over the largest of the law.
const VELOCITY_SHARES: [f64; 11] = [0.02, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0];

/// Number of random points per table and band at which the errors are measured, and their seed.
const ERROR_POINTS: (usize, u64) = (200, 2005);

fn main() {
    if std::env::args().any(|word| word == "tables") {
        print!("{}", computed().text());
        return;
    }
    println!(
        "law,waveform,frequency_ratio,friction_damping_per_cycle,relative_damping,relative_velocity,\
         grazing_amplitude,quench_amplitude,lost_amplitude,relative_error"
    );
    for law in AtlasLaw::ALL {
        for waveform in WAVEFORMS {
            print_round_numbers(law, &waveform);
        }
    }
}

/// A row for each combination of round numbers; amplitudes are over v_m. The base response is quiet from `quench_amplitude` on, and below
/// `lost_amplitude` where that has a value.
fn print_round_numbers(law: AtlasLaw, waveform: &Waveform) {
    for frequency_ratio in FREQUENCY_RATIOS {
        for per_cycle in DAMPINGS_PER_CYCLE {
            for relative_damping in RELATIVE_DAMPINGS {
                for share in VELOCITY_SHARES {
                    let point = AtlasPoint {
                        law,
                        waveform: waveform.clone(),
                        relative_damping,
                        relative_velocity: share * law.largest_velocity(),
                        frequency_ratio,
                        friction_damping: per_cycle * frequency_ratio,
                    };
                    if let Some(answer) = Atlas::shipped().answer(&point) {
                        println!("{}", row(&answer));
                    }
                }
            }
        }
    }
}

fn row(answer: &AtlasAnswer) -> String {
    let point = &answer.point;
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
    let errors = answer.changes.iter().map(AtlasChange::relative_error);
    let errors = errors.collect::<Option<Vec<f64>>>();
    [
        point.law.name().to_owned(),
        point.waveform.name().to_owned(),
        point.frequency_ratio.to_string(),
        point.damping_per_cycle().to_string(),
        point.relative_damping.to_string(),
        point.relative_velocity.to_string(),
        answer.grazing.0.to_string(),
        answer.last().map_or(0.0, |change| change.amplitude).to_string(),
        number(answer.lost().map(|change| change.amplitude)),
        number(errors.map(|errors| errors.into_iter().fold(0.0, f64::max))),
    ]
    .join(",")
}

/// The tables and their errors, computed again. A node without an exact value keeps that of the shipped table.
fn computed() -> Atlas {
    let shipped = Atlas::shipped();
    let mut atlas = Atlas::default();
    for table in &shipped.tables {
        let values = exact(table, &AtlasTable::nodes(table.law, table.surface));
        let kept = values.into_iter().zip(&table.values);
        let values = kept.map(|(new, old)| new.unwrap_or(*old)).collect();
        atlas.tables.push(AtlasTable { values, ..table.clone() });
    }
    for table in &shipped.tables {
        for band in ERROR_BANDS {
            let of = (table.law, &table.waveform, table.surface);
            let exact = |places: &[Vec<f64>]| exact(table, places);
            atlas.errors.extend(AtlasErrors::measured(&atlas, of, band, ERROR_POINTS, exact));
        }
    }
    atlas
}

/// The exact values of a table at some places, on all cores.
fn exact(table: &AtlasTable, places: &[Vec<f64>]) -> Vec<Option<f64>> {
    let value = |place: &Vec<f64>| {
        AtlasTable::compute(table.law, &table.waveform, table.surface, place).ok()
    };
    let cores = thread::available_parallelism().map_or(1, NonZeroUsize::get);
    thread::scope(|scope| {
        let parts = places.chunks(places.len().div_ceil(cores).max(1));
        let works = parts.map(|part| scope.spawn(move || part.iter().map(value).collect()));
        let works: Vec<thread::ScopedJoinHandle<'_, Vec<Option<f64>>>> = works.collect();
        works.into_iter().flat_map(|work| work.join().expect("no panic")).collect()
    })
}
