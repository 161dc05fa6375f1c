"""A map on the nodes of a Slurm cluster, handed out by Dask: python docs/dask-jobqueue.py

Needs dask-jobqueue (pip install dask-jobqueue) beside quell[cluster]. The store must lie on a file system that all
nodes see. Killed and started again, it goes on where it was.
"""

from dask_jobqueue import SLURMCluster
from distributed import Client

import quell

STORE = "/scratch/shared/how-much-dither.zarr"


def main() -> None:
    """A hundred jobs of one process with sixteen threads each; Quell works outside of Python's lock."""
    study = quell.Study.from_toml("studies/how-much-dither.toml")
    with SLURMCluster(cores=16, processes=1, memory="16GB", walltime="02:00:00") as cluster:
        cluster.scale(jobs=100)
        with Client(cluster) as client:
            done = quell.sweep(study, "efficiency", store=STORE, client=client, resume=True)
            done.save("how-much-dither.svg")


if __name__ == "__main__":
    main()
