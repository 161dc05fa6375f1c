//! `quell map --shard K/N`: one part of a map, into a store that other processes share.

use std::fmt::Write as _;
use std::path::Path;

use quell::run::map::{Part, Shared};
use quell::sweep::{Plan, Running, Shard};
use quell::{Complaint, Failure, Fault, Origin};
use serde_json::json;

use crate::answer::Answer;
use crate::interrupt;
use crate::progress::Bar;

/// Reads the option; a picture needs the whole map.
pub(super) fn read(text: &str, plot: bool) -> Result<Shard, Box<Complaint>> {
    let shard = Shard::parse(text, "--shard")?;
    if plot {
        let allowed = "a shard is no whole map: when all are done, the same command with --resume \
                       instead of --shard draws it";
        let origin = Origin::Argument("--plot");
        return Err(Box::new(Complaint::new(Fault::Usage, "--plot", origin, text, allowed)));
    }
    Ok(shard)
}

/// Computes a shard and tells what is left of the map.
pub(super) fn run(
    shard: Shard,
    path: &Path,
    plan: Plan,
    threads: Option<usize>,
    json: bool,
) -> Result<Answer, Failure> {
    let shared = Shared::open(path, plan)?;
    let chunks = shard.chunks(shared.plan().chunks());
    let bar = Bar::new();
    let running = Running { threads, stop: interrupt::flag(), progress: &bar };
    let part = shared.compute(&chunks, running)?;
    let left = shared.unrecorded()?;
    let mut shards: Vec<usize> = left.iter().map(|&chunk| shard.number_of(chunk)).collect();
    shards.sort_unstable();
    shards.dedup();
    let object = || {
        json!({
            "ok": true,
            "shard": { "number": shard.number(), "of": shard.of() },
            "chunks": chunks.len(),
            "computed_chunks": part.computed,
            "there_chunks": part.there,
            "damaged_chunks": part.damaged,
            "computed_points": part.points,
            "map_chunks": shared.plan().chunks().len(),
            "left_chunks": left.len(),
            "left_shards": shards,
            "saved": [path.display().to_string()],
        })
    };
    let answer = Answer::new(json, object, || text(shard, &shared, part, (left.len(), &shards)));
    Ok(answer.warning(warnings(part)))
}

fn text(shard: Shard, shared: &Shared, part: Part, (left, shards): (usize, &[usize])) -> String {
    let path = shared.path().display();
    let all = shared.plan().chunks().len();
    let mut text = format!("Shard {} of {} of {path}\n", shard.number(), shard.of());
    let own = part.computed + part.there;
    let seconds = part.elapsed.as_secs_f64();
    let _ = write!(
        text,
        "  {own} of the map's {all} chunks: {} computed in {seconds:.2} s",
        part.computed
    );
    if part.there > 0 {
        let _ = write!(text, ", {} were there", part.there);
    }
    text.push('\n');
    if left == 0 {
        text += "  the map is whole: the same command with --resume instead of --shard reads it\n";
    } else {
        let numbers: Vec<String> = shards.iter().map(usize::to_string).collect();
        let _ = writeln!(text, "  {left} chunks are left, of the shards {}", numbers.join(","));
    }
    text
}

fn warnings(part: Part) -> Vec<String> {
    let told =
        format!("{} chunks of the store were cut short or changed, and done again", part.damaged);
    if part.damaged > 0 { vec![told] } else { Vec::new() }
}
