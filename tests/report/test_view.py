"""The page on which a model is looked at: what it holds, and that a real browser draws it."""

import base64
import json
import os
import sys

import numpy as np
import pytest

from models import small_floor
from studies import BUILDING, GOOD, run_main
from trundle import load_study, run_study, study_from_text
from trundle.report.pages.view import view_page, write_view
from trundle.results.store import write_results
from trundle.run.playback import playback_of
from trundle.views.scene import scene_of
from trundle.views.solids import moved, solids_of

sys.path.append(os.path.dirname(__file__))
from test_browser import BROWSER, colours_of, console

needs_browser = pytest.mark.skipif(not BROWSER, reason="no Chromium: apt-get install chromium")


def volume(solid, nodes, motion=None):
    """Return the volume that triangles enclose: a sixth of the triple products, summed."""
    at = moved(solid, np.zeros((len(nodes), 6)) if motion is None else motion, nodes)
    a, b, c = (at[solid.triangles[:, i]] for i in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6.0


def test_bodies_have_the_volumes_of_their_parts():
    """A slab of 12 x 6 x 0.2 m; beams of 0.3 x 0.6 m, columns of 0.4 x 0.4 m, closed and outwards."""
    floor = small_floor(mesh_size=2.0)
    found = {solid.name: volume(solid, floor.nodes) for solid in solids_of(floor)}
    expected = {}
    for group in floor.shells:
        xyz = floor.nodes[group.elements]
        across = np.cross(xyz[:, 2] - xyz[:, 0], xyz[:, 3] - xyz[:, 1])
        size = 0.5 * np.linalg.norm(across, axis=1).sum() * group.section.thickness
        expected[group.name] = expected.get(group.name, 0.0) + size
    for group in floor.beams:
        length = np.linalg.norm(np.diff(floor.nodes[group.elements], axis=1)[:, 0], axis=1).sum()
        expected[group.name] = expected.get(group.name, 0.0) + length * group.section.area
    assert found.keys() == expected.keys()
    for name, value in expected.items():
        assert found[name] == pytest.approx(value, rel=1e-6)


def test_triangles_and_quadrilaterals_of_a_slab_are_one_body():
    """Without walls between them: each slab of the building, with its opening, is closed."""
    floor = study_from_text(BUILDING).floor
    solids = {solid.name: solid for solid in solids_of(floor)}
    slab = solids["slab deck"]
    assert volume(slab, floor.nodes) == pytest.approx(0.25 * (2 * 96.0 - 4.0), rel=1e-9)
    edges = np.sort(np.concatenate([slab.triangles[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
    _, times = np.unique(edges, axis=0, return_counts=True)
    assert (times == 2).all()


def test_bodies_turn_with_their_nodes():
    """A rigid turn by a small angle moves vertices as it moves nodes: volume is kept."""
    floor = small_floor(mesh_size=3.0)
    motion = np.zeros((len(floor.nodes), 6))
    turn = 1e-4
    motion[:, 5] = turn
    motion[:, 0], motion[:, 1] = -turn * floor.nodes[:, 1], turn * floor.nodes[:, 0]
    for solid in solids_of(floor):
        assert volume(solid, floor.nodes, motion) == pytest.approx(
            volume(solid, floor.nodes), rel=1e-6
        )
        at = floor.nodes[solid.node] + solid.arm
        by = np.column_stack([-turn * at[:, 1], turn * at[:, 0], 0.0 * at[:, 2]])
        np.testing.assert_allclose(moved(solid, motion), by, atol=1e-12)


def test_a_scene_holds_storeys_modes_and_a_crossing():
    study = study_from_text(BUILDING)
    modes = study.floor.modes(30.0)
    play = playback_of(study, n_frames=20)
    scene = scene_of(study.floor, title="a", modes=modes, study=study, playback=play)
    json.dumps(scene, allow_nan=False)
    assert scene["storeys"] == ["deck", "lab"]
    assert {part["storey"] for part in scene["solids"]} == {0, 1}
    assert [mode["frequency"] for mode in scene["modes"]] == modes.frequencies[:24].tolist()
    crossing = scene["crossing"]
    raw = np.frombuffer(base64.b64decode(crossing["motion"]), dtype="<i2")
    motion = raw.reshape(20, -1) * crossing["largest"] / 32767
    np.testing.assert_allclose(motion, play.motion, atol=crossing["largest"] / 32767)
    assert [route["name"] for route in scene["routes"]] == ["aisle"]
    assert scene["points"] == [{"name": "tool", "place": [4.0, 3.0, 6.5]}]


def test_nothing_of_a_name_becomes_a_script(tmp_path):
    scene = scene_of(small_floor(mesh_size=3.0), title="</script><script>alert(1)</script><!--")
    page = view_page(scene)
    assert "<script>alert(1)" not in page
    assert page.count("</script>") == 5
    assert 'http-equiv="Content-Security-Policy" content="default-src \'none\'' in page
    assert 'src="' not in page
    write_view(scene, tmp_path / "v.html")
    assert [one.name for one in tmp_path.iterdir()] == ["v.html"]


def shown(page, tmp_path, anchor):
    """Return the page's state, what it complains of, and its picture."""
    import subprocess

    picture = tmp_path / "page.png"
    arguments = [
        BROWSER, "--headless", "--no-sandbox", "--use-angle=swiftshader",
        "--enable-unsafe-swiftshader", "--disable-background-networking", "--no-first-run",
        "--host-resolver-rules=MAP * ~NOTFOUND", "--disable-component-update", "--disable-sync",
        f"--user-data-dir={tmp_path / 'profile'}", "--enable-logging=stderr", "--v=0",
        "--window-size=1200,800", "--virtual-time-budget=8000",
    ]  # fmt: skip
    address = f"{page.as_uri()}#{anchor}"
    dom = subprocess.run(
        [*arguments, "--dump-dom", address], capture_output=True, text=True, timeout=120, check=True
    )
    subprocess.run(
        [*arguments, f"--screenshot={picture}", address],
        capture_output=True,
        timeout=120,
        check=True,
    )
    said = [line for line in console(dom.stderr) if "GL Driver Message" not in line]
    return dom.stdout, said, picture


@needs_browser
@pytest.mark.slow
def test_a_browser_draws_it_offline(tmp_path, monkeypatch, capsys):
    """Ready, without a complaint, in colours; at another time and in a mode it looks otherwise."""
    (tmp_path / "s.toml").write_text(BUILDING)
    page = tmp_path / "s-view.html"
    code, said = run_main(
        monkeypatch, capsys, "view", tmp_path / "s.toml", "-o", page, "--frames", "30"
    )
    assert (code, str(page) in said.out) == (0, True)
    assert page.stat().st_size < 3e6
    pictures = []
    for anchor in ("time=1.5", "mode=2"):
        dom, complaints, picture = shown(page, tmp_path, anchor)
        assert complaints == []
        assert 'data-state="ready"' in dom
        assert colours_of(picture) > 20
        pictures.append(picture.read_bytes())
    assert len(set(pictures)) == 2
    assert "mode 2 of 24 shown" in dom


@pytest.mark.longest
def test_models_and_results_are_looked_at_too(tmp_path, monkeypatch, capsys):
    (tmp_path / "s.toml").write_text(GOOD)
    (tmp_path / "r").mkdir()
    write_results(run_study(load_study(tmp_path / "s.toml")), tmp_path / "r")
    run_main(monkeypatch, capsys, "export", tmp_path / "s.toml", tmp_path / "m.bdf")
    for source, more in ((tmp_path / "r", ()), (tmp_path / "m.bdf", ("--f-max", "20 Hz"))):
        page = tmp_path / f"{source.stem}.html"
        code, _ = run_main(monkeypatch, capsys, "view", source, "-o", page, *more)
        assert code == 0
        assert ('"crossing":null' in page.read_text()) == (source.suffix == ".bdf")
