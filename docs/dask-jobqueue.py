"""A map on the nodes of a Slurm cluster, distributed by Dask: python docs/dask-jobqueue.py

Needs dask-jobqueue (pip install dask-jobqueue) in addition to quell[cluster]. The store must be on a file system that
all nodes share. After an interruption, run the program again: it continues where it stopped.
"""

from dask_jobqueue import SLURMCluster
from distributed import Client

import quell

STORE = "/scratch/shared/how-much-dither.zarr"


def main() -> None:
    """A hundred jobs of one process with sixteen threads each; Quell computes without holding Python's global lock."""
    study = quell.Study.from_toml("studies/how-much-dither.toml")
    with SLURMCluster(cores=16, processes=1, memory="16GB", walltime="02:00:00") as cluster:
        cluster.scale(jobs=100)
        with Client(cluster) as client:
            done = quell.sweep(study, "residual-vibration", store=STORE, client=client, resume=True)
            done.save("how-much-dither.svg")


if __name__ == "__main__":
    main()
