"""Maps on a ``dask.distributed`` cluster: workers compute chunks into one store that all of them reach.

The scheduler distributes only the numbers of chunks. A worker derives the plan of the map from the study, computes
the chunk with the same bits as any other machine, and writes it to the store, completely or not at all. A task returns
only a receipt. Dask gives the task of a lost worker to another one; a chunk that was finished already is found in the
store and not computed again. At the end everything is read back from the store and verified.
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
"""Number of rounds in which missing chunks are distributed."""

TASKS_A_THREAD = (4, 16)
"""Smallest and largest number of tasks for each thread of the cluster, if there are enough chunks: fewer leave threads idle at
the end, more keep the scheduler busy."""

MANY_TASKS = 2000
"""This many tasks occupy the scheduler for some seconds; beyond it each thread gets fewer."""


@lru_cache(maxsize=4)
def shared(parts: str, quantities: tuple[str, ...], store: str) -> NativeShared:
    """The plan of a map and its store, created once per process."""
    import pickle

    from ._quell import NativeShared, NativeStudy

    study = NativeStudy.parse(pickle.loads(bytes.fromhex(parts)))
    return NativeShared.open(study, list(quantities), store)


def compute_chunks(parts: str, quantities: tuple[str, ...], store: str, chunks: list[int]) -> tuple[int, float]:
    """Computes the chunks that the store lacks on a worker: (computed points, seconds)."""
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
    return results.Shard._left(study, {**facts, "seconds": seconds})


def split(chunks: list[int], threads: int) -> list[list[int]]:
    """Chunks in tasks of nearly the same length; neighbours, which take about the same time, are in different tasks."""
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
    # The functions of distributed have no types.
    untyped: Any = distributed
    anyone: Any = client
    place = os.path.abspath(store)
    if not resume and os.path.isdir(os.path.join(place, ".quell")):
        allowed = "a new path; resume=True continues the existing store"
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
                return results.Map._of(study, here.read())
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
            # After Ctrl-C or a failed task, no other task is started.
            anyone.cancel(futures, force=True)
    left = here.missing()
    if not left:
        return results.Map._of(study, here.read())
    raise RunError(store, f"{len(left)} of {len(sizes)} chunks are still missing: do all workers reach this path?")
