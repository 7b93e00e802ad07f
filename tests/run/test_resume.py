"""A run that is killed goes on, and ends with the bytes of one that was not."""

import errno
import hashlib
import io
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from studies import GOOD, spoilt
from trundle.cli.app import main
from trundle.errors import ComputationError, InputError, UnstableStepError
from trundle.results.codec import pack
from trundle.results.modes import FirstModes
from trundle.run.checkpoint import InMemory, unfinished_folder, unfinished_of
from trundle.run.fingerprint import digest_of
from trundle.run.jobs import plan_jobs
from trundle.run.tasks import RunsTask, tasks_of
from trundle.run.whole_study import run_study
from trundle.study_file.build import load_study

# Two routes and three methods, of which one steps all dofs: nine pieces and more.
STUDY = (
    GOOD.replace("runs = 2", "runs = 40").replace('"4 s"', '"6 s"')
    + """
[[road]]
class = "C"

[[route]]
name = "other"
vehicle = "truck"
path = [["12 m", "4 m"], ["0 m", "4 m"]]
speed = "20 km/h"

[[method]]
name = "decoupled"
interaction = "decoupled"
f_max = "60 Hz"
dt = "2.5 ms"
damping = { ratio = "3 %" }

[[method]]
name = "direct"
interaction = "coupled"
integration = "newmark"
dt = "5 ms"
damping = { rayleigh_alpha = "0.8 1/s", rayleigh_beta = "0.001 s" }

[map]
spacing = "3 m"
"""
)


def start(folder: Path, *options: str) -> subprocess.Popen:
    # modes are found anew in every process: what must agree does not come from a shared cache
    environment = os.environ | {"TRUNDLE_CACHE": ""}
    return subprocess.Popen(
        [sys.executable, "-m", "trundle", "run", "study.toml", "--out", "out", *options],
        cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip


def folder_of(tmp_path: Path, name: str) -> Path:
    folder = tmp_path / name
    folder.mkdir()
    (folder / "study.toml").write_text(STUDY)
    return folder


def arrays(folder: Path) -> dict[str, bytes]:
    """Return every file of the store, by its name."""
    store = folder / "out" / "results.zarr"
    return {str(f.relative_to(store)): f.read_bytes() for f in store.rglob("*") if f.is_file()}


def pieces(folder: Path) -> list[str]:
    store = unfinished_folder(folder / "out") / "pieces"
    return [e.name for e in store.glob("*.piece")] if store.is_dir() else []


def wait_for_pieces(folder: Path, process: subprocess.Popen, count: int) -> None:
    while len(pieces(folder)) < count:
        assert process.poll() is None, process.communicate()
        time.sleep(0.002)


@pytest.fixture(scope="module")
def whole(tmp_path_factory) -> dict[str, bytes]:
    folder = folder_of(tmp_path_factory.mktemp("whole"), "run")
    process = start(folder)
    _, error = process.communicate(timeout=300)
    assert process.returncode == 0, error
    assert not unfinished_folder(folder / "out").exists()
    return arrays(folder)


@pytest.mark.slow
@pytest.mark.parametrize("count", [1, pytest.param(5, marks=pytest.mark.longest)])
def test_a_killed_run_ends_with_the_same_bytes(tmp_path, whole, count):
    """kill -9 in the middle: nothing half-written; the same command finishes what is missing."""
    folder = folder_of(tmp_path, "killed")
    process = start(folder)
    wait_for_pieces(folder, process, count)
    process.kill()
    process.communicate()
    assert not (folder / "out").exists()
    left = pieces(folder)
    assert count <= len(left) < 10
    again = start(folder)
    _, error = again.communicate(timeout=300)
    assert again.returncode == 0, error
    assert f"going on from {len(left)} finished pieces" in error
    assert arrays(folder) == whole
    assert sorted(e.name for e in folder.iterdir()) == ["out", "study.toml"]


@pytest.mark.longest
def test_workers_and_a_killed_worker_give_the_same_bytes(tmp_path, whole):
    """Two dask workers, one of them killed with a part in its hands: the part is done again."""
    psutil = pytest.importorskip("psutil")
    pytest.importorskip("distributed")
    folder = folder_of(tmp_path, "cluster")
    process = start(folder, "--workers", "2")
    wait_for_pieces(folder, process, 1)
    children = psutil.Process(process.pid).children(recursive=True)
    workers = [c for c in children if "spawn_main" in " ".join(c.cmdline())]
    assert len(workers) >= 2
    workers[-1].send_signal(signal.SIGKILL)
    _, error = process.communicate(timeout=300)
    assert process.returncode == 0, error
    assert arrays(folder) == whole


def test_another_study_begins_anew(tmp_path):
    """Pieces belong to a study text; a changed seed throws them away, and so does --fresh."""
    path = tmp_path / "study.toml"
    path.write_text(GOOD)
    out = tmp_path / "out"

    def stop_after_one(study) -> None:
        job = plan_jobs(study)[0]
        with pytest.raises(KeyboardInterrupt), unfinished_of(study, out) as store:
            assert store.n_found == 0
            run_study(study, store=_Stopping(store, tasks_of(job)[0].name))

    study = load_study(path)
    stop_after_one(study)
    with pytest.raises(KeyboardInterrupt), unfinished_of(study, out) as store:
        assert store.n_found == 1
        raise KeyboardInterrupt
    path.write_text(GOOD.replace("seed = 1", "seed = 2"))
    stop_after_one(load_study(path))
    with unfinished_of(load_study(path), out, fresh=True) as store:
        assert store.n_found == 0
    assert not unfinished_folder(out).exists()


class _Stopping:
    """A store whose owner is interrupted after a piece."""

    def __init__(self, store, name: str) -> None:
        self.store, self.name = store, name

    def has(self, name: str) -> bool:
        return self.store.has(name)

    def save(self, name: str, piece) -> None:
        self.store.save(name, piece)
        if name == self.name:
            raise KeyboardInterrupt

    def load(self, name: str):
        return self.store.load(name)


def test_a_piece_comes_back_as_it_was(tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(GOOD)
    study = load_study(path)
    memory = InMemory()
    run_study(study, store=memory)
    with unfinished_of(study, tmp_path / "out") as disk:
        for job in plan_jobs(study):
            for name in [task.name for task in tasks_of(job)]:
                piece = memory.load(name)
                disk.save(name, piece)
                again = disk.load(name)
                assert digest_of(again) == digest_of(piece)  # types, names, and every bit
                assert pack(again)[1] == pack(piece)[1]


def spoil(file, how):
    data = bytearray(file.read_bytes())
    if how == "flipped":
        data[len(data) // 2] ^= 1
    if how == "cut":
        data = data[: len(data) // 2]
    if how == "other numbers":  # an archive of its own, whole but for the checksum
        packed = io.BytesIO()
        with np.load(io.BytesIO(bytes(data[32:]))) as kept:
            other = {n: kept[n] + 1 if kept[n].dtype.kind == "f" else kept[n] for n in kept.files}
            np.savez(packed, **other)
        data = data[:32] + packed.getvalue()
    file.write_bytes(b"" if how == "empty" else bytes(data))


@pytest.mark.parametrize("how", ["flipped", "cut", "empty", "other numbers"])
def test_a_piece_that_was_altered_is_not_believed(tmp_path, how):
    """One of two pieces is spoiled between stop and resumption: it is not found, the other is."""
    path, out = tmp_path / "study.toml", tmp_path / "out"
    path.write_text(GOOD)
    study, memory = load_study(path), InMemory()
    run_study(study, store=memory)
    first, second, *_ = [
        name for job in plan_jobs(study) for name in [t.name for t in tasks_of(job)]
    ]
    with pytest.raises(KeyboardInterrupt), unfinished_of(study, out) as disk:
        for name in (first, second):
            disk.save(name, memory.load(name))
        raise KeyboardInterrupt
    spoil(unfinished_folder(out) / "pieces" / f"{first}.piece", how)
    with unfinished_of(study, out) as disk:
        assert (disk.n_found, disk.has(first), disk.has(second)) == (1, False, True)


def test_no_bit_and_no_end_of_a_piece_may_change(tmp_path):
    """Every part of the file: sum, headers, numbers, notes, the archive's list."""
    path, out = tmp_path / "study.toml", tmp_path / "out"
    path.write_text(GOOD)
    with unfinished_of(load_study(path), out) as disk:
        disk.save("a", FirstModes(frequencies=np.arange(9.0), vertical=np.zeros((1, 1))))
        file = unfinished_folder(out) / "pieces" / "a.piece"
        data = file.read_bytes()
        for spoiled in spoilt(data):
            file.write_bytes(spoiled)
            with pytest.raises(ComputationError, match="was altered"):
                disk.load("a")
        file.write_bytes(data)
        np.testing.assert_array_equal(disk.load("a").frequencies, np.arange(9.0))


def test_a_piece_is_neither_another_s_nor_another_study_s(tmp_path):
    path, out = tmp_path / "study.toml", tmp_path / "out"
    path.write_text(GOOD)
    kept = unfinished_folder(out) / "pieces"
    with pytest.raises(KeyboardInterrupt), unfinished_of(load_study(path), out) as disk:
        disk.save("a", FirstModes(frequencies=np.arange(3.0), vertical=np.zeros((1, 1))))
        (kept / "b.piece").write_bytes((kept / "a.piece").read_bytes())
        raise KeyboardInterrupt
    with unfinished_of(load_study(path), out) as disk:
        assert (disk.has("a"), disk.has("b")) == (True, False)
        foreign = (kept / "a.piece").read_bytes()
    path.write_text(GOOD.replace("seed = 1", "seed = 2"))
    with pytest.raises(KeyboardInterrupt), unfinished_of(load_study(path), out) as disk:
        disk.save("c", FirstModes(frequencies=np.arange(3.0), vertical=np.zeros((1, 1))))
        (kept / "a.piece").write_bytes(foreign)
        raise KeyboardInterrupt
    with unfinished_of(load_study(path), out) as disk:
        assert (disk.has("a"), disk.has("c")) == (False, True)


class Payload:
    """What leaves a trace when it is unpickled."""

    def __init__(self, trace):
        self.trace = str(trace)

    def __reduce__(self):
        return os.mkdir, (self.trace,)


def test_a_stranger_s_piece_is_not_unpickled(tmp_path):
    """Its checksum is right, for whoever can write a file can sum it up."""
    path, out, trace = tmp_path / "study.toml", tmp_path / "out", tmp_path / "trace"
    path.write_text(GOOD)
    study = load_study(path)
    with pytest.raises(KeyboardInterrupt), unfinished_of(study, out) as disk:
        disk.save("a", FirstModes(frequencies=np.ones(1), vertical=np.zeros((1, 1))))
        label = disk._label("a").encode() + b"\0"
        raise KeyboardInterrupt
    (file,) = (unfinished_folder(out) / "pieces").iterdir()
    own = file.read_bytes()[32:]
    assert file.read_bytes()[:32] == hashlib.sha256(label + own).digest()  # as it is summed up
    with np.load(io.BytesIO(own)) as arrays:
        forged = dict(arrays)
    forged["value.frequencies"] = np.array([Payload(trace)], dtype=object)
    written = io.BytesIO()
    np.savez(written, **forged)
    data = written.getvalue()
    file.write_bytes(hashlib.sha256(label + data).digest() + data)
    with unfinished_of(study, out) as disk:
        assert disk.n_found == 0
    assert not trace.exists()
    with np.load(io.BytesIO(data), allow_pickle=True) as arrays:
        arrays["value.frequencies"]
    assert trace.exists()  # it would have left one


def test_what_a_study_only_names_is_in_its_fingerprint(tmp_path):
    """A criteria file edited between stop and resumption: everything is computed anew."""
    path, out, own = tmp_path / "study.toml", tmp_path / "out", tmp_path / "own.csv"
    text = GOOD.replace('curves = ["VC-A"]', 'curves = ["VC-A", "own"]\nfiles = ["own.csv"]')
    path.write_text(text)
    for limit, found in (("60", 0), ("60", 1), ("50", 0)):
        own.write_text(
            f"# quantity = band_rms_velocity\nfrequency [Hz], limit [um/s]\n1,{limit}\n80,{limit}\n"
        )
        study = load_study(path)
        with pytest.raises(KeyboardInterrupt), unfinished_of(study, out) as disk:
            assert disk.n_found == found
            disk.save("a", FirstModes(frequencies=np.arange(3.0), vertical=np.zeros((1, 1))))
            raise KeyboardInterrupt


@pytest.mark.parametrize("where", ["lock", "trundle-unfinished.json", "pieces"])
def test_links_in_an_unfinished_folder_are_not_followed(tmp_path, where):
    path, victim = tmp_path / "study.toml", tmp_path / "thesis.tex"
    path.write_text(GOOD)
    victim.write_text("mine")
    folder = unfinished_folder(tmp_path / "out")
    folder.mkdir()
    (folder / "trundle-unfinished.json").write_text("{}")
    (folder / where).unlink(missing_ok=True)
    (folder / where).symlink_to(victim)
    with (
        pytest.raises(InputError, match="is a link"),
        unfinished_of(load_study(path), tmp_path / "out"),
    ):
        pass
    assert victim.read_text() == "mine"


@pytest.mark.parametrize("where", ["lock", "trundle-unfinished.json", "pieces", "pieces/a.piece"])
def test_pipes_in_an_unfinished_folder_are_not_waited_for(tmp_path, where):
    path = tmp_path / "study.toml"
    path.write_text(GOOD)
    folder = unfinished_folder(tmp_path / "out")
    (folder / "pieces").mkdir(parents=True)
    (folder / "trundle-unfinished.json").write_text("{}")
    if where == "pieces":
        (folder / "pieces").rmdir()
    (folder / where).unlink(missing_ok=True)
    os.mkfifo(folder / where)
    with (
        pytest.raises(InputError, match="a pipe"),
        unfinished_of(load_study(path), tmp_path / "out"),
    ):
        pass


@pytest.mark.parametrize("where", ["lock", "trundle-unfinished.json"])
def test_a_file_of_two_names_keeps_its_content(tmp_path, where):
    """An archive can name a file twice; what the other name shows is somebody else's."""
    path, victim = tmp_path / "study.toml", tmp_path / "thesis.tex"
    path.write_text(GOOD)
    victim.write_bytes(b"mine \xff")
    folder = unfinished_folder(tmp_path / "out")
    folder.mkdir()
    (folder / "trundle-unfinished.json").write_text("{}")
    (folder / where).unlink(missing_ok=True)
    os.link(victim, folder / where)
    with unfinished_of(load_study(path), tmp_path / "out") as disk:
        disk.save("a", FirstModes(frequencies=np.arange(3.0), vertical=np.zeros((1, 1))))
    assert victim.read_bytes() == b"mine \xff"
    assert not folder.exists()


@pytest.mark.parametrize("fresh", [True, False])
def test_what_a_user_puts_beside_the_pieces_is_kept(tmp_path, fresh):
    path, out = tmp_path / "study.toml", tmp_path / "out"
    path.write_text(GOOD)
    study, folder = load_study(path), unfinished_folder(out)
    with pytest.raises(KeyboardInterrupt), unfinished_of(study, out) as disk:
        disk.save("a", FirstModes(frequencies=np.arange(3.0), vertical=np.zeros((1, 1))))
        raise KeyboardInterrupt
    for name in ("notes.txt", "pieces/mine.txt"):
        (folder / name).write_text("mine")
    with unfinished_of(study, out, fresh=fresh) as disk:
        assert disk.n_found == (0 if fresh else 1)
    left = sorted(str(f.relative_to(folder)) for f in folder.rglob("*") if f.is_file())
    assert left == ["notes.txt", "pieces/mine.txt"]


def test_a_file_in_the_place_of_the_pieces_is_named(tmp_path):
    path, folder = tmp_path / "study.toml", unfinished_folder(tmp_path / "out")
    path.write_text(GOOD)
    folder.mkdir()
    for name in ("trundle-unfinished.json", "pieces"):
        (folder / name).write_text("mine")
    with (
        pytest.raises(InputError, match="pieces is no folder"),
        unfinished_of(load_study(path), tmp_path / "out"),
    ):
        pass
    assert (folder / "pieces").read_text() == "mine"


def test_a_full_disk_is_named_and_keeps_what_was_finished(tmp_path, monkeypatch):
    path, out = tmp_path / "study.toml", tmp_path / "out"
    path.write_text(GOOD)
    study, piece = (
        load_study(path),
        FirstModes(frequencies=np.arange(3.0), vertical=np.zeros((1, 1))),
    )

    def full(number):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with (
        pytest.raises(InputError, match=r"b\.piece cannot be written \(No space left.*are kept"),
        unfinished_of(study, out) as disk,
    ):
        disk.save("a", piece)
        monkeypatch.setattr("trundle.results.kept.os.fsync", full)
        disk.save("b", piece)
    monkeypatch.undo()
    assert pieces(tmp_path) == ["a.piece"]
    assert not list(unfinished_folder(out).rglob(".writing-*"))
    with unfinished_of(study, out) as disk:
        assert (disk.n_found, disk.has("a")) == (1, True)


def test_two_runs_into_one_folder_do_not_meet(tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(GOOD)
    study = load_study(path)
    with (
        unfinished_of(study, tmp_path / "out"),
        pytest.raises(InputError, match="another trundle is working"),
        unfinished_of(study, tmp_path / "out"),
    ):
        pass


def test_a_foreign_folder_is_left_alone(tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(GOOD)
    foreign = tmp_path / "out.unfinished"
    foreign.mkdir()
    (foreign / "thesis.tex").write_text("mine")
    with (
        pytest.raises(InputError, match="trundle did not write it"),
        unfinished_of(load_study(path), tmp_path / "out"),
    ):
        pass
    assert (foreign / "thesis.tex").read_text() == "mine"


def test_an_error_in_one_part_stops_the_others(tmp_path, monkeypatch):
    """The error arrives with its attributes, and pieces that were finished stay."""
    path = tmp_path / "study.toml"
    path.write_text(STUDY)
    study = load_study(path)

    whole = RunsTask.compute

    def failing(task, laid_out, progress=None):
        if task.job.method.name == "direct":
            raise UnstableStepError("no longer finite", step=3, time=0.1)
        return whole(task, laid_out, progress)

    monkeypatch.setattr(RunsTask, "compute", failing)
    memory = InMemory()
    with pytest.raises(UnstableStepError) as caught:
        run_study(study, store=memory)
    assert caught.value.step == 3
    assert memory.has(tasks_of(plan_jobs(study)[0])[0].name)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--workers", "2", "--scheduler", "tcp://127.0.0.1:1"], "give one of them"),
        (["--scheduler", "nonsense"], "no dask scheduler answers"),
    ],
)
def test_a_wrong_cluster_is_refused(tmp_path, monkeypatch, capsys, options, words):
    pytest.importorskip("distributed")
    path = tmp_path / "study.toml"
    path.write_text(GOOD)
    monkeypatch.setattr(sys, "argv", ["trundle", "run", str(path), *options])
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit) as stop:
        main()
    assert stop.value.code == 2
    assert words in capsys.readouterr().err
    assert [e.name for e in tmp_path.iterdir()] == ["study.toml"]
