"""Studies that nobody means: found in `check`, doubted in the result, never a traceback."""

import warnings

import numpy as np
import pytest

from models import small_floor
from studies import GOOD, LIBRARY, problems, run_main
from trundle.dynamics import ModalRatio
from trundle.errors import InputError
from trundle.road import RoadClass
from trundle.route import Route
from trundle.run.whole_study import run_study
from trundle.simulate import Coupled, Crossing, Modal, lay_out
from trundle.study.doubts import study_doubts
from trundle.study_file.build import load_study
from trundle.vehicle import library_vehicle

AT = 'at = ["3 m", "3 m"]'
WAY = '[["0 m", "3 m"], ["12 m", "3 m"]]'
STOREY = 'storey_below = "4 m"'
DURATION = 'duration = "4 s"\n'


def planar(mass, stiffness, damping, inertia="5000 kg m2", wheel=""):
    axle = f'stiffness = "{stiffness}", damping = "{damping}"{wheel}'
    return (
        f'kind = "planar"\nbodies = [{{ mass = "{mass}", pitch_inertia = "{inertia}", '
        f'centre = "1.5 m" }}]\naxles = [{{ setback = "0 m", {axle} }}, '
        f'{{ setback = "3 m", {axle} }}]'
    )


def loaded(tmp_path, *changes):
    text = GOOD.replace(DURATION, "")
    for old, new in changes:
        assert text.count(old) == 1
        text = text.replace(old, new)
    path = tmp_path / "study.toml"
    path.write_text(text)
    return load_study(path)


@pytest.mark.parametrize("kind", ["simple", "pinned", "clamped"])
def test_a_route_along_a_held_edge_is_refused(tmp_path, kind):
    (problem,) = problems(
        tmp_path,
        (STOREY, f'{STOREY}\nedges = {{ y_max = "{kind}" }}'),
        (WAY, '[["0 m", "6 m"], ["12 m", "6 m"]]'),
    )
    assert problem.place == "route[1].path"
    assert f"along y_max, which is {kind}" in problem.value


def test_a_route_across_held_edges_is_fine(tmp_path):
    loaded(tmp_path, (STOREY, f'{STOREY}\nedges = {{ x_min = "pinned", y_max = "clamped" }}'))


@pytest.mark.parametrize(("length", "speed"), [("1 mm", "15 km/h"), ("0.5 m", "500 km/h")])
def test_a_route_of_less_than_two_steps_is_refused(tmp_path, length, speed):
    (problem,) = problems(
        tmp_path,
        (WAY, f'[["0 m", "3 m"], ["{length}", "3 m"]]'),
        ('"15 km/h"', f'"{speed}"'),
        ('dt = "5 ms"', 'dt = "5 ms"\nentry = "abrupt"'),
    )
    assert "looks every 5 ms" in problem.rule


def test_from_python_a_route_that_loads_nothing_is_refused():
    floor = small_floor(mesh_size=2.0, edges={"y_min": "clamped"})
    (x0, y0), x1 = floor.nodes[:, :2].min(axis=0), floor.nodes[:, 0].max()
    route = Route.straight((x0, y0), (x1, y0), speed=4.0, name="edge")
    crossing = Crossing(library_vehicle("car_bmw_320i"), route, RoadClass("B"))
    method = Coupled(integration=Modal(f_max=60.0, dt=0.005), damping=ModalRatio(ratio=0.03))
    with pytest.raises(InputError, match="no wheel loads the floor"):
        lay_out(floor, crossing, method=method, points={"a": (1.0, 1.0)})


@pytest.mark.parametrize(
    "vehicle",
    [
        planar("5 t", "1e11 N/m", "1 kN s/m"),
        planar("5 t", "1e6 N/m", "10 kN s/m",
               wheel=', axle_mass = "300 kg", tyre_stiffness = "1e11 N/m"'),
    ],
)  # fmt: skip
def test_what_steps_cannot_show_is_found_in_check(tmp_path, vehicle):
    (problem,) = problems(tmp_path, (LIBRARY, vehicle))
    assert "on its own springs, which steps of 5 ms cannot show" in problem.rule


ODD = {
    "stiff, overdamped": (LIBRARY, planar("5 t", "1e11 N/m", "1e10 N s/m")),
    "damper alone": (LIBRARY, planar("5 t", "1e6 N/m", "1e10 N s/m")),
    "a gram": (LIBRARY, planar("1 g", "1e5 N/m", "1 kN s/m", "1e-4 kg m2")),
    "wheels of a gram": (LIBRARY, planar("5 t", "1e6 N/m", "1e5 N s/m",
                         wheel=', axle_mass = "1 g", tyre_stiffness = "1e6 N/m"')),
    "isolator of 2 kHz": (AT, f'{AT}\nisolator = {{ frequency = "2 kHz", damping = "5 %" }}'),
    "isolator undamped": (AT, f'{AT}\nisolator = {{ frequency = "9 Hz", damping = "1e-9 %" }}'),
    "heavy floor": ("300 kg/m2", "1e5 kg/m2"),
    "soft floor": ("30 GPa", "1e5 Pa"),
}  # fmt: skip


@pytest.mark.parametrize("name", ODD)
def test_odd_numbers_end_in_finite_ones_without_a_raw_warning(tmp_path, monkeypatch, name):
    monkeypatch.setenv("TRUNDLE_CACHE", "")
    study = loaded(tmp_path, ODD[name])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        result = run_study(study)
    (cell,) = result.cells.values()
    assert np.isfinite(cell.peak_acceleration).all()
    sizes = [w for w in result.warnings()["coupled"] if w.subject.startswith("size of the motion")]
    assert len(sizes) == (name in {"soft floor", "stiff, overdamped", "damper alone"}), (
        cell.peak_acceleration
    )


def test_where_nothing_moves_nothing_is_assessed(tmp_path, monkeypatch, capsys):
    """A level of 0 is below every limit, and says nothing."""
    monkeypatch.chdir(tmp_path)
    study = loaded(
        tmp_path,
        (STOREY, f'{STOREY}\nedges = {{ y_min = "clamped" }}'),
        (AT, 'at = ["3 m", "0 m"]'),
    )
    assert any("nothing is assessed there" in w.message for w in study_doubts(study))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        code, output = run_main(monkeypatch, capsys, "run", "study.toml")
    assert code == 0
    assert "not assessed: nothing moves there" in output.out
    assert "pass" not in output.out.partition("margin = ")[2].partition("?")[0]


def test_a_first_mode_near_f_max_is_refused_before_the_runs(tmp_path, monkeypatch):
    monkeypatch.setattr("trundle.run.whole_study.carry_out", None)
    study = loaded(tmp_path, ('f_max = "30 Hz"', 'f_max = "5 Hz"'))
    first = study.floor.modes(6.0).frequencies[0]
    with pytest.raises(
        InputError, match=f"f_max = 5 Hz, and the floor's first is at {first:.2f} Hz"
    ):
        run_study(study)


def test_a_floor_without_a_mode_below_f_max_is_refused_before_the_runs(tmp_path, monkeypatch):
    """No mode at all, not merely a late first one: the study and what would help are named."""
    monkeypatch.setattr("trundle.run.whole_study.carry_out", None)
    study = loaded(tmp_path, ('f_max = "30 Hz"', 'f_max = "1 Hz"'))
    assert study.floor.modes(1.0).n_modes == 0
    with pytest.raises(InputError, match=r"study\.toml: the floor has no mode below 1 Hz.*raise"):
        run_study(study)


def test_warnings_of_the_result_are_on_the_screen(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    loaded(tmp_path, ODD["soft floor"])
    code, output = run_main(monkeypatch, capsys, "run", "study.toml")
    assert code == 0
    assert "warning: coupled: size of the motion" in output.out
    assert output.out.count("is unusual: the modulus of a floor's material") == 1
