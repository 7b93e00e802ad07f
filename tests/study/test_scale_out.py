"""What is sent to workers: every part with the layout of its own job."""

from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

from test_bad_input import GOOD

from trundle.study import load_study, scale_out
from trundle.study.jobs import LaidOut, plan_jobs
from trundle.study.scale_out import Cluster


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

    def scatter(self, carrier, *, hash):
        assert not hash
        self.scattered.append(carrier.layout)
        return Answered(carrier.layout)

    def submit(self, _work, _job, carrier, _part, **_options):
        return Answered(carrier.value)


def test_a_layout_is_never_taken_for_one_that_was_let_go_of(tmp_path, monkeypatch):
    """Layouts come and go at the same place in memory; 50 jobs each get their own."""
    lost = SimpleNamespace(CancelledError=KeyError, KilledWorker=OSError)
    monkeypatch.setattr(scale_out, "_distributed", lambda: lost)
    (tmp_path / "study.toml").write_text(GOOD)
    job = plan_jobs(load_study(tmp_path / "study.toml"))[0]
    client, found = Client(), []
    cluster = Cluster(client)
    for i in range(50):
        cluster.submit(job, range(2), LaidOut(layout=i, places=None))
        cluster.collect(lambda _name, layout: found.append(layout), wait=False)
    assert found == [i for i in range(50) for _ in range(2)]
    assert client.scattered == list(range(50))
    assert not cluster._sent  # nothing is held that no part waits for
