"""Compute the parts of a study, here or on workers, and take up what was interrupted."""

from trundle.run.dask_cluster import cluster_at, local_cluster
from trundle.run.estimate import Estimate, estimate_of
from trundle.run.executor import Executor
from trundle.run.threads import Threads

__all__ = ["Estimate", "Executor", "Threads", "cluster_at", "estimate_of", "local_cluster"]
