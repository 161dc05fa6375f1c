"""Maps on a cluster of processes: one of them is killed, and the result has the same bits as a local run."""

from __future__ import annotations

import os
import signal
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import BELT, DITHER

import quell

distributed = pytest.importorskip("distributed")

AXES = [quell.Axis("dither.amplitude", 0.05, 1.0, 30), quell.Axis("belt.belt_velocity", 0.02, 0.4, 30)]
STUDY = quell.Belt(**BELT, dither=DITHER, solver=quell.Solver(settle=400.0, record_periods=20), axes=AXES)


@pytest.fixture(scope="module")
def client(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """A cluster of three processes, each with one thread."""
    import dask

    folder = str(tmp_path_factory.mktemp("workers"))
    with (
        dask.config.set({"distributed.scheduler.allowed-failures": 5}),
        distributed.LocalCluster(
            n_workers=3, threads_per_worker=1, processes=True, dashboard_address=None, local_directory=folder
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        yield client


def bytes_of(store: Path) -> dict[str, bytes]:
    """Every array of a store."""
    return {str(it.relative_to(store)): it.read_bytes() for it in sorted(store.rglob("*")) if it.is_file() and "/c/" in str(it)}


def test_a_killed_worker_s_chunk_is_redone(client: Any, tmp_path: Path) -> None:
    processes = list(client.run(os.getpid).values())
    assert len(set(processes)) == 3 and os.getpid() not in processes
    killed = threading.Event()

    def progress(there: int, every: int) -> None:
        if there >= every // 4 and not killed.is_set():
            killed.set()
            os.kill(processes[0], signal.SIGKILL)

    there = quell.sweep(STUDY, ["residual-vibration", "stick-fraction"], store=tmp_path / "there.zarr", client=client, progress=progress)
    assert killed.is_set()
    here = STUDY.map(["residual-vibration", "stick-fraction"], store=tmp_path / "here.zarr")
    assert here.dataset.drop_attrs().identical(there.dataset.drop_attrs())
    assert there.shape == [30, 30] and np.isfinite(there["residual_vibration"].values).any()
    one, other = bytes_of(tmp_path / "here.zarr"), bytes_of(tmp_path / "there.zarr")
    assert len(one) > 20 and one == other


def test_a_store_goes_on_where_it_stopped(client: Any, tmp_path: Path) -> None:
    store = tmp_path / "m.zarr"
    part = STUDY.map("growth", AXES, store=store, shard="2/3")
    assert part.left_chunks == 0 or 2 not in part.left_shards
    with pytest.raises(quell.StudyError, match="resume=True"):
        quell.sweep(STUDY, "growth", store=store, client=client)
    done = quell.sweep(STUDY, "growth", store=store, client=client, resume=True)
    assert done.dataset["growth"].values.tobytes() == STUDY.map("growth").dataset["growth"].values.tobytes()


def test_what_is_wrong_is_said_before_anything_runs(client: Any, tmp_path: Path) -> None:
    with pytest.raises(quell.StudyError, match="store"):
        quell.sweep(STUDY, "residual-vibration", client=client)
    with pytest.raises(quell.StudyError, match="residual-vibration"):
        quell.sweep(STUDY, "efficency", store=tmp_path / "m.zarr", client=client)
    with pytest.raises(quell.StudyError, match="client"):
        quell.sweep(STUDY, "residual-vibration", store=tmp_path / "m.zarr", client=3)
    with pytest.raises(quell.StudyError, match="shard"):
        STUDY.map("residual-vibration", store=tmp_path / "m.zarr", shard="4/3")
    assert not list(tmp_path.iterdir())


def test_shards_of_several_processes_make_the_map(tmp_path: Path) -> None:
    store = tmp_path / "m.zarr"
    parts = [STUDY.map("growth", store=store, shard=f"{k}/2") for k in (2, 1)]
    assert parts[-1].left_chunks == 0 and sum(it.computed_chunks for it in parts) == parts[0].facts["map_chunks"]
    with pytest.raises(quell.StudyError, match="a shard has no table: read the map with resume=True"):
        parts[-1].save(tmp_path / "m.csv")
    whole = STUDY.map("growth", store=store, resume=True)
    assert whole.resumed_points == 900
