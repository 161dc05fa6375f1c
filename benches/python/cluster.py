"""The cost of a Dask cluster: overhead of a chunk, and efficiency with one and with two workers.

    python benches/python/cluster.py

All times are CPU times (separately for worker processes and for scheduler with client), so that they are meaningful on a loaded
machine too. A worker's efficiency is the CPU time of the computation alone over all CPU time of the worker while the map runs.
"""

from __future__ import annotations

import os
import tempfile
import time
from pathlib import Path
from typing import Any

import distributed

import quell

BELT = quell.Belt(
    damping_ratio=0.005,
    normal_load=1.0,
    belt_velocity=0.05,
    friction=quell.Stribeck(static_coefficient=0.4, minimum_coefficient=0.2857, reference_velocity=0.2),
    dither=quell.Dither("tangential", "sine", amplitude=0.4, frequency_ratio=10.0),
)
CHEAP = ("growth", BELT.sweeping([quell.Axis("dither.amplitude", 0.05, 1.0, 700), quell.Axis("belt.belt_velocity", 0.02, 0.4, 700)]))
DEAR = (
    "residual-vibration",
    BELT.set({"solver.settle": 1200.0}).sweeping(
        [quell.Axis("dither.amplitude", 0.05, 1.0, 36), quell.Axis("belt.belt_velocity", 0.02, 0.4, 36)]
    ),
)


def cpu(client: Any) -> tuple[float, float]:
    """CPU time of the workers, and of this process with the scheduler."""
    return sum(client.run(time.process_time).values()), time.process_time()


def alone(quantity: str, study: quell.Study, folder: Path) -> tuple[float, int]:
    """CPU time of the same map on one thread without a cluster, and the number of its chunks."""
    begun = time.process_time()
    store = folder / "alone.zarr"
    study.map(quantity, store=store, threads=1)
    used = time.process_time() - begun
    return used, len(list((store / ".quell" / "done").iterdir()))


def measure(name: str, quantity: str, study: quell.Study, workers: int) -> None:
    """One map on the given number of workers with one thread each."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        base, chunks = alone(quantity, study, folder)
        with (
            distributed.LocalCluster(
                n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None, local_directory=place
            ) as cluster,
            distributed.Client(cluster) as client,
        ):
            client.run(lambda: __import__("quell"))
            # Heartbeats cost CPU time even when idle.
            before, begun = cpu(client), time.perf_counter()
            time.sleep(5.0)
            idle = [(b - a) / (time.perf_counter() - begun) for a, b in zip(before, cpu(client), strict=True)]
            before, begun = cpu(client), time.perf_counter()
            study.map(quantity, store=folder / "there.zarr", client=client)
            wall, after = time.perf_counter() - begun, cpu(client)
            begun = time.process_time()
            study.map(quantity, store=folder / "there.zarr", client=client, resume=True)
            read = time.process_time() - begun
    worker, here = (b - a - rest * wall for a, b, rest in zip(before, after, idle, strict=True))
    print(
        f"  {name}, {workers} worker(s): {chunks} chunks of {1e3 * base / chunks:.0f} ms; alone {base:.2f} s; "
        f"workers {worker:.2f} s: efficiency {base / worker:.3f}, {1e3 * (worker - base) / chunks:.1f} ms a chunk; "
        f"scheduler and client {here - read:.2f} s, {1e3 * (here - read) / chunks:.1f} ms a chunk; "
        f"reading it all {read:.2f} s; wall {wall:.1f} s"
    )


def main() -> None:
    """Runs all measurements."""
    print(f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}; seconds are CPU time")
    for workers in (1, 2):
        measure("cheap points", *CHEAP, workers)
        measure("dear points", *DEAR, workers)


if __name__ == "__main__":
    main()
