"""Parts and spectra as tasks: the same bits whoever computes them, and nothing lost but what dies."""

import functools
import os
import signal
import subprocess
import sys
import textwrap
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from towers import halfway, tower
from trundle.dynamics import (
    intervals_below,
    modes_by_shifts,
    modes_within,
    part_as_arrays,
    together,
)
from trundle.results.kept import read_kept, write_kept
from trundle.run import parts as run_parts
from trundle.run.dask_cluster import local_cluster
from trundle.run.kept_parts import kept_part
from trundle.run.mode_cache import modes_of
from trundle.run.parts import modes_by_parts, with_kept_parts
from trundle.structure.superelements import Cuts, Parting, reduction

F_MAX = 12.0
CUT = Parting(cuts=Cuts(z=halfway(3)), f_parts=30.0, f_seams=60.0)


@functools.cache
def building():
    return tower(storeys=3, bays_x=2, bays_y=1, mesh_size=1.0)


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("TRUNDLE_CACHE", str(tmp_path / "modes"))
    return tmp_path / "modes"


@pytest.fixture
def reduced(monkeypatch):
    """Count what is reduced."""
    done = []
    original = reduction.Part.reduced

    def counting(part, f_max, **kwargs):
        done.append(part.content_hash)
        return original(part, f_max, **kwargs)

    monkeypatch.setattr(reduction.Part, "reduced", counting)
    return done


def bits(structure):
    """Return the bytes of all reduced parts."""
    return [
        {name: values.tobytes() for name, values in part_as_arrays(part).items()}
        for part in structure.joined.parts
    ]


def test_parts_have_the_same_bits_whoever_reduces_them(monkeypatch, folder):
    """One thread, two, and parts that were kept: tasks depend on what they are given alone."""
    found = []
    for threads in ("1", "2", "2"):  # the last finds them kept
        monkeypatch.setenv("TRUNDLE_THREADS", threads)
        parted = with_kept_parts(CUT.of(building()))
        modes = modes_by_parts(parted, F_MAX)
        found.append((bits(parted), modes.omega.tobytes(), modes.shapes.tobytes()))
        if len(found) == 1:
            for file in (folder / "parts").iterdir():
                file.unlink()
    assert found[0] == found[1] == found[2]


@pytest.mark.slow
@pytest.mark.parametrize("workers", [pytest.param(1, marks=pytest.mark.longest), 2])
def test_parts_have_the_same_bits_by_workers(workers, folder, monkeypatch):
    """A cluster's processes reduce parts and search the spectrum, as this process does."""
    monkeypatch.setattr(run_parts, "dense_is_better", lambda *_: False)
    monkeypatch.setattr(run_parts, "_TOGETHER", 4)
    here = with_kept_parts(CUT.of(building()))
    expected = modes_by_parts(here, F_MAX)
    for file in (folder / "parts").iterdir():
        file.unlink()
    with local_cluster(workers) as cluster:
        there = with_kept_parts(CUT.of(building()), cluster)
        found = modes_by_parts(there, F_MAX, executor=cluster)
    assert bits(there) == bits(here)
    assert found.shapes.tobytes() == expected.shapes.tobytes()


def test_equal_parts_of_another_building_are_not_reduced_again(reduced):
    """Of a fourth storey's building the lower parts are those of three; the top one stands higher,

    and may differ by round-off of its places: only what is equal to the last bit is taken.
    """
    modes_of(with_kept_parts(CUT.of(building())), f_max=F_MAX)
    first = len(reduced)
    assert first == len(set(reduced)) == 3  # ground, middle, top
    taller = tower(storeys=4, bays_x=2, bays_y=1, mesh_size=1.0)
    cuts = replace(CUT, cuts=Cuts(z=halfway(4)))
    assert with_kept_parts(cuts.of(taller)).joined.n_dofs == taller.n_dofs
    assert len(reduced) <= first + 1


def test_modes_by_parts_are_kept(reduced):
    """The second study finds both modes and parts, and says the same of every dof."""
    first = modes_of(with_kept_parts(CUT.of(building())), f_max=F_MAX)
    count = len(reduced)
    again = modes_of(with_kept_parts(CUT.of(building())), f_max=F_MAX)
    assert len(reduced) == count
    assert first.shapes.tobytes() == again.shapes.tobytes()
    some = np.arange(0, building().n_dofs, 97)
    np.testing.assert_array_equal(first.at(some), again.at(some))


@pytest.mark.parametrize(
    "name",
    [
        "one mode less",
        "f_max",
        "mass",
        *(
            pytest.param(name, marks=pytest.mark.longest)
            for name in ("omega", "shapes", "coupling", "stiffness")
        ),
    ],
)
def test_a_spoilt_part_is_reduced_again(name, folder, reduced):
    """Numbers that a stranger forged with a sound checksum do not satisfy what defines a part."""
    parted = with_kept_parts(CUT.of(building()))
    part = parted.pieces.part(0)
    whole = parted.joined.parts[0]
    file = next(f for f in (folder / "parts").iterdir() if part.content_hash in f.name)
    arrays, _ = read_kept(file, file.stem)
    if name == "one mode less":
        arrays["omega"] = arrays["omega"][:-1]
        arrays["shapes"], arrays["coupling"] = arrays["shapes"][:, :-1], arrays["coupling"][:-1]
    elif name == "f_max":
        arrays["f_max"] = np.array(29.0)
    else:
        flat = arrays[name].reshape(-1).copy()
        flat[len(flat) // 2] += 1e-3 * np.abs(flat).max()
        arrays[name] = flat.reshape(arrays[name].shape)
    write_kept(file, arrays, file.stem)
    assert kept_part(part, CUT.f_parts) is None
    count = len(reduced)
    again = with_kept_parts(CUT.of(building())).joined.parts[0]
    assert len(reduced) == count + 1
    assert again.shapes.tobytes() == whole.shapes.tobytes()


def test_parts_that_landed_survive_a_kill(folder, reduced):
    """kill -9 while the third part is reduced: the first is there, whole, and believed."""
    script = textwrap.dedent(
        """
        import os, signal
        from trundle.run.parts import with_kept_parts
        from trundle.structure.superelements import reduction
        from run.test_part_tasks import CUT, building
        original, done = reduction.Part.reduced, []
        def dying(part, f_max, **kwargs):
            if len(done) == 2:
                os.kill(os.getpid(), signal.SIGKILL)
            done.append(part)
            return original(part, f_max, **kwargs)
        reduction.Part.reduced = dying
        with_kept_parts(CUT.of(building())).joined
        """
    )
    paths = os.pathsep.join([str(Path(__file__).parents[1]), os.environ.get("PYTHONPATH", "")])
    process = subprocess.run(
        [sys.executable, "-c", script], check=False,
        env=dict(os.environ, PYTHONPATH=paths, TRUNDLE_THREADS="1"), capture_output=True,
    )  # fmt: skip
    assert process.returncode == -signal.SIGKILL, process.stderr.decode()
    landed = len(list((folder / "parts").glob("part-*.npz")))
    assert landed >= 1
    assert with_kept_parts(CUT.of(building())).joined.n_dofs == building().n_dofs
    assert len(reduced) == 3 - landed


def test_parts_of_a_spectrum_are_together_the_whole():
    """Intervals begin where the last ends, and hold all modes that a search of the whole finds."""
    pencil = CUT.of(building()).joined.pencil
    whole = modes_by_shifts(pencil, f_max=F_MAX)
    parts = intervals_below(pencil, F_MAX, most=4)
    assert len(parts) > 2
    assert [part.first for part in parts[1:]] == [part.end for part in parts[:-1]]
    found = together(
        [modes_within(pencil, part) for part in parts],
        n_coordinates=pencil.n_coordinates,
        f_max=F_MAX,
    )
    np.testing.assert_allclose(found.omega, whole.omega, rtol=1e-9)
    carried = pencil.mass @ found.shapes
    np.testing.assert_allclose(found.shapes.T @ carried, np.eye(found.n_modes), atol=1e-7)
