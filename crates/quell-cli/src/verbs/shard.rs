//! `quell map --shard K/N`: one part of a map, into a store that other processes share.
use crate::answer::Answer;
use crate::interrupt;
use crate::progress::Bar;
use quell::map::{Sharded, Shared};
use quell::running::Running;
use quell::sweep::{Plan, Shard};
use quell::{Complaint, Failure, Fault, Origin};
use std::fmt::Write as _;
use std::path::Path;

/// Parses the option; `--plot` is rejected because a picture requires the whole map.
pub(super) fn read(text: &str, plot: bool) -> Result<Shard, Box<Complaint>> {
    let shard = Shard::parse(text, "--shard")?;
    if plot {
        let allowed = "a shard is not the whole map: when all shards are done, the same command with --resume \
                       instead of --shard draws it";
        let origin = Origin::Argument("--plot");
        return Err(Box::new(Complaint::new(Fault::Usage, "--plot", origin, text, allowed)));
    }
    Ok(shard)
}

/// Computes a shard and reports which chunks of the map are left.
pub(super) fn run(
    shard: Shard,
    path: &Path,
    plan: Plan,
    threads: Option<usize>,
    json: bool,
) -> Result<Answer, Failure> {
    let shared = Shared::open(path, plan)?;
    let bar = Bar::new();
    bar.keeps(path, "the same command continues");
    let running = Running { threads, stop: interrupt::flag(), progress: &bar };
    let done = shared.compute_shard(shard, running)?;
    Ok(Answer::new(json, &done.json(path), || text(&done, path)))
}

fn text(done: &Sharded, path: &Path) -> String {
    let Sharded { shard, part, .. } = done;
    let (path, all) = (path.display(), done.map_chunks);
    let mut text = format!("Shard {} of {} of {path}\n", shard.number(), shard.of());
    let own = part.computed + part.there;
    let seconds = part.elapsed.as_secs_f64();
    let _ = write!(
        text,
        "  {own} of {all} chunks of the map: {} computed in {seconds:.2} s",
        part.computed
    );
    if part.there > 0 {
        let _ = write!(text, ", {} already in the store", part.there);
    }
    text.push('\n');
    if done.left == 0 {
        text +=
            "  the map is complete: the same command with --resume instead of --shard reads it\n";
    } else {
        let numbers: Vec<String> = done.left_shards.iter().map(usize::to_string).collect();
        let chunks = if done.left == 1 { "chunk is" } else { "chunks are" };
        let shards = if numbers.len() == 1 { "shard" } else { "shards" };
        let (left, numbers) = (done.left, numbers.join(","));
        let _ = writeln!(text, "  {left} {chunks} left, of {shards} {numbers}");
    }
    text
}
