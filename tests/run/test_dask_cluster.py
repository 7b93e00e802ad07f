"""What is sent to workers: every part with the layout of its own job."""

from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import pytest

from studies import GOOD
from trundle._progress import silent
from trundle.errors import ComputationError, InputError
from trundle.run import dask_cluster
from trundle.run.dask_cluster import Cluster, cluster_at, local_cluster
from trundle.run.jobs import PreparedJob, plan_jobs
from trundle.run.tasks import tasks_of
from trundle.study_file.build import load_study


@dataclass(eq=False)
class Answered:
    """A future whose result is there: which layout the part was sent with."""

    value: Any
    status: str = "finished"

    def done(self):
        return True

    def result(self):
        return self.value

    def release(self):
        pass


@dataclass
class Client:
    """Keeps what is scattered, as workers do, and answers with it."""

    scattered: list = field(default_factory=list)
    status: str = "running"

    def scatter(self, carrier, *, hash):
        assert not hash
        self.scattered.append(carrier.layout)
        return Answered(carrier.layout)

    def submit(self, _work, _task, carrier, _source, **_options):
        return Answered(carrier.value)


def test_a_layout_is_never_taken_for_one_that_was_let_go_of(tmp_path, monkeypatch):
    """Layouts come and go at the same place in memory; 50 jobs each get their own."""
    lost = SimpleNamespace(CancelledError=KeyError, KilledWorker=OSError)
    monkeypatch.setattr(dask_cluster, "_distributed", lambda: lost)
    (tmp_path / "study.toml").write_text(GOOD)
    tasks = tasks_of(plan_jobs(load_study(tmp_path / "study.toml"))[0])[:2]
    client, found = Client(), []
    cluster = Cluster(client)
    for i in range(50):
        laid_out = PreparedJob(layout=i, places=None)
        for task in tasks:
            cluster.submit(task, laid_out, silent)
        found += [layout for _name, layout in cluster.finished(wait=False)]
    assert found == [i for i in range(50) for _ in range(2)]
    assert client.scattered == list(range(50))
    assert not cluster._sent  # nothing is held that no part waits for


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
def test_the_ports_of_workers_open_with_this_runs_keys_alone():
    """All listen on loopback, none is the dashboard's, and none takes a client without keys."""
    psutil, distributed = pytest.importorskip("psutil"), pytest.importorskip("distributed")
    with local_cluster(2) as cluster:
        here = psutil.Process()
        listening = [
            link.laddr
            for process in [here, *here.children(recursive=True)]
            for link in process.net_connections()
            if link.status == psutil.CONN_LISTEN
        ]
        assert len(listening) >= 3
        assert {place.ip for place in listening} == {"127.0.0.1"}
        assert 8787 not in {place.port for place in listening}
        address = cluster._client.scheduler.address
        assert address.startswith("tls://")
        for scheme in ("tcp", "tls"):
            with pytest.raises((OSError, TypeError)):
                distributed.Client(address.replace("tls", scheme), timeout=2)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
def test_workers_with_another_source_are_refused(monkeypatch):
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=1, host="127.0.0.1", dashboard_address=None, silence_logs=50
    ) as there:
        with cluster_at(there.scheduler_address):
            pass  # the same source
        own = dask_cluster.source_hash
        monkeypatch.setattr(dask_cluster, "_own_source", lambda: own() + "edited")
        with (
            pytest.raises(InputError, match="another trundle"),
            cluster_at(there.scheduler_address),
        ):
            pass


def test_a_lost_scheduler_is_named(monkeypatch, tmp_path):
    """The client has closed by itself: nothing would ever be done."""
    lost = SimpleNamespace(
        CancelledError=KeyError, KilledWorker=OSError, wait=lambda *_, **__: None
    )
    monkeypatch.setattr(dask_cluster, "_distributed", lambda: lost)
    (tmp_path / "study.toml").write_text(GOOD)
    first, second = tasks_of(plan_jobs(load_study(tmp_path / "study.toml"))[0])[:2]
    client = Client()
    cluster = Cluster(client)
    del second
    cluster.submit(first, PreparedJob(layout=1, places=None), silent)
    client.status = "closed"
    with pytest.raises(ComputationError, match="what was finished is kept"):
        list(cluster.finished(wait=True))


def test_parts_lost_while_they_are_waited_for_are_sent_again(monkeypatch, tmp_path):
    """A worker dies with a part: the wait itself is cancelled, and then the part is done again."""
    told = []

    def wait(*_, **__):
        told.append(1)
        if len(told) == 1:
            raise KeyError

    lost = SimpleNamespace(CancelledError=KeyError, KilledWorker=OSError, wait=wait)
    monkeypatch.setattr(dask_cluster, "_distributed", lambda: lost)
    (tmp_path / "study.toml").write_text(GOOD)
    first, second = tasks_of(plan_jobs(load_study(tmp_path / "study.toml"))[0])[:2]
    cluster, laid_out = Cluster(Client()), PreparedJob(layout=7, places=None)
    for task in (first, second):
        cluster.submit(task, laid_out, silent)
    assert [layout for _name, layout in cluster.finished(wait=True)] == [7, 7]


def test_every_part_asks_its_worker_for_its_source():
    """A worker may join when the work is under way; nothing of another's is stored."""
    with pytest.raises(ComputationError, match="has another trundle"):
        dask_cluster._compute(None, None, dask_cluster.source_hash() + "edited")
