"""Run a study on a Slurm cluster, with workers in jobs of their own.

    python slurm.py study.toml --jobs 10 --cpus 8 --memory 16GB --partition compute

Run it where jobs can be submitted, in an environment that all nodes see, with trundle's extra
"cluster" and dask-jobqueue. Options that it does not know are passed on to ``trundle run``.
``--show`` prints what would be submitted, and submits nothing.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path


def main() -> int:
    """Start workers, run the study on them, and stop them."""
    parser = argparse.ArgumentParser(description="Run a study on a Slurm cluster.")
    parser.add_argument("study", help="study file")
    parser.add_argument("--jobs", type=int, default=10, help="jobs, a worker each")
    parser.add_argument("--cpus", type=int, default=8, help="processors of each")
    parser.add_argument("--memory", default="16GB", help="memory of each")
    parser.add_argument("--walltime", default="02:00:00", help="longest time of each")
    parser.add_argument("--partition", help="partition, if not the default one")
    parser.add_argument("--account", help="account, if not the default one")
    parser.add_argument("--interface", help="network that nodes share, such as ib0")
    parser.add_argument("--show", action="store_true", help="print the job script, and end")
    given, options = parser.parse_known_args()

    from dask_jobqueue import SLURMCluster  # noqa: PLC0415 - --help needs it not
    from distributed import Client  # noqa: PLC0415

    threads = ["TRUNDLE_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"]
    cluster = SLURMCluster(
        queue=given.partition,
        account=given.account,
        interface=given.interface,
        cores=1,  # tasks at once in a worker: each uses all processors of its job
        processes=1,
        job_cpu=given.cpus,
        memory=given.memory,
        walltime=given.walltime,
        python=sys.executable,
        scheduler_options={"dashboard": False},
        worker_extra_args=["--no-dashboard"],
        job_script_prologue=[f"export {name}={given.cpus}" for name in threads],
    )
    with cluster:
        if given.show:
            print(cluster.job_script())
            return 0
        cluster.scale(jobs=given.jobs)
        with Client(cluster) as client:
            client.wait_for_workers(1)  # the others join as the queue lets them
        trundle = Path(sys.executable).with_name("trundle")
        address = cluster.scheduler_address
        command = [trundle, "run", given.study, "--scheduler", address, *options]
        return subprocess.run(command, check=False).returncode  # noqa: S603 - its user's own words


if __name__ == "__main__":
    sys.exit(main())
