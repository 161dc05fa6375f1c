"""Maps on a ``dask.distributed`` cluster: workers compute chunks into one store that all of them reach.

The scheduler hands out numbers of chunks, nothing else: a worker makes the plan of the map from the study, computes
the chunk with the same bits as any other machine, and writes it to the store, whole or not at all. What a task returns
is a receipt. A task of a lost worker is given to another one by Dask; a chunk that it had finished is found in the
store and not done again. In the end everything is read back from the store and proven.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import lru_cache, partial
from typing import TYPE_CHECKING, Any

from . import results
from ._errors import RunError, StudyError, complaint

if TYPE_CHECKING:
    from distributed import Client

    from ._quell import NativeShared
    from ._study import Study

__all__ = ["compute", "compute_chunks", "compute_shard"]

ROUNDS = 3
"""How often chunks that are missing in the end are handed out again."""

TASKS_A_THREAD = (4, 16)
"""Least and most tasks for each thread of the cluster, where there are so many chunks: fewer leave threads idle in the
end, more keep the scheduler busy."""

MANY_TASKS = 2000
"""So many tasks occupy the scheduler for some seconds: beyond them each thread gets fewer."""


@lru_cache(maxsize=4)
def shared(parts: str, quantities: tuple[str, ...], store: str) -> NativeShared:
    """The plan of a map and its store, once a process."""
    import pickle

    from ._quell import NativeShared, NativeStudy

    study = NativeStudy.parse(pickle.loads(bytes.fromhex(parts)))
    return NativeShared.open(study, list(quantities), store)


def compute_chunks(parts: str, quantities: tuple[str, ...], store: str, chunks: list[int]) -> tuple[int, float]:
    """Computes chunks on a worker, those that the store does not have: (points computed, seconds)."""
    _, _, _, points, seconds = shared(parts, quantities, store).compute(chunks, 1, None)
    return points, seconds


def compute_shard(
    study: Study,
    quantities: list[str],
    store: str,
    shard: str,
    *,
    threads: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> results.Shard:
    """Computes one part of a map into a store that other processes share: ``map`` with ``shard``."""
    from ._quell import NativeShared

    NativeShared.check_shard(shard)
    here = NativeShared.open(study._native, quantities, store)
    facts, seconds = here.compute_shard(shard, threads, progress)
    return results.Shard(study, {**facts, "seconds": seconds})


def split(chunks: list[int], threads: int) -> list[list[int]]:
    """Chunks in tasks of nearly the same length, neighbours apart: they take about as long."""
    least, most = (each * max(1, threads) for each in TASKS_A_THREAD)
    count = min(len(chunks), max(least, min(most, MANY_TASKS)))
    return [chunks[first::count] for first in range(count)]


def compute(
    study: Study,
    quantities: list[str],
    store: str,
    client: Client,
    *,
    resume: bool = False,
    progress: Callable[[int, int], object] | None = None,
) -> results.Map:
    """Computes a map on the workers of a client: :meth:`quell.Study.map` with ``client``."""
    import pickle

    import distributed

    if not hasattr(client, "submit"):
        raise StudyError([complaint("client", client, "a dask.distributed client")])
    # Its functions have no types.
    untyped: Any = distributed
    anyone: Any = client
    place = os.path.abspath(store)
    if not resume and os.path.isdir(os.path.join(place, ".quell")):
        allowed = "a new path; or resume=True goes on with the store that is there"
        raise StudyError([complaint("store", store, allowed, "path")])
    from ._quell import NativeShared

    here = NativeShared.open(study._native, quantities, place)
    sizes = here.points()
    parts, names = pickle.dumps(study._native.parts()).hex(), tuple(quantities)
    for _ in range(ROUNDS):
        todo = here.unrecorded()
        there = sum(sizes) - sum(sizes[chunk] for chunk in todo)
        if progress is not None:
            progress(there, sum(sizes))
        if not todo:
            missing = here.missing()
            if not missing:
                return results.Map(study, here.read())
            todo = missing
        tasks = split(todo, sum(anyone.nthreads().values()))
        futures: list[Any] = anyone.map(
            partial(compute_chunks, parts, names, place),
            tasks,
            pure=False,
            retries=2,
            batch_size=1000,
        )
        points = {future.key: sum(sizes[chunk] for chunk in task) for future, task in zip(futures, tasks, strict=True)}
        try:
            for future, _ in untyped.as_completed(futures, with_results=True):
                there += points[future.key]
                if progress is not None:
                    progress(there, sum(sizes))
        finally:
            # After Ctrl-C, or the failure of a task, no other one is begun.
            anyone.cancel(futures, force=True)
    left = here.missing()
    if not left:
        return results.Map(study, here.read())
    raise RunError(store, f"{len(left)} of {len(sizes)} chunks are still missing: do all workers reach this path?")
