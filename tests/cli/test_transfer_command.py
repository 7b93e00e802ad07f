"""The command that says what a force here does there: its table, its picture, its mistakes."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from matplotlib import rc_context
from matplotlib.figure import Figure
from matplotlib.image import imread

from studies import BUILDING, GOOD, run_main
from trundle.report.canvas import STYLE
from trundle.report.figures.transfer import transfer_figure
from trundle.simulate import TransferFunctions, transfer
from trundle.structure import Spot
from trundle.study_file.build import study_from_text
from trundle.views.transfer import curves, largest_peaks


@pytest.fixture
def shaken(tmp_path, monkeypatch, capsys):
    """Return what runs the command on a study in a folder of its own; its code, and what it said."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments, text=GOOD):
        (tmp_path / "study.toml").write_text(text)
        return run_main(monkeypatch, capsys, "transfer", "study.toml", *arguments)

    return run


def table(path):
    with open(path, newline="", encoding="utf-8") as opened:
        heading, *rows = csv.reader(opened)
    return heading, [row[:2] for row in rows], np.array([row[2:] for row in rows], dtype=float)


@pytest.mark.parametrize(
    ("quantity", "unit", "scale"),
    [("receptance", "nm/N", 1e9), ("mobility", "(um/s)/N", 1e6), ("accelerance", "(mm/s2)/N", 1e3)],
)
def test_the_table_is_what_python_gives(shaken, quantity, unit, scale):
    """Two forces on one point: in the file's unit, with magnitude and phase of the same numbers."""
    code, said = shaken(
        "--from", "9 m, 250 cm", "--from", "tool", "--to", "tool", "--quantity", quantity,
        "--f-min", "2 Hz", "--f-max", "24 Hz", "--lines", "60", "--out", "t.csv", "--quiet",
    )  # fmt: skip
    assert (code, said.out) == (0, "")
    assert all(line.startswith("warning: ") for line in said.err.splitlines())
    heading, names, rows = table("t.csv")
    assert heading == [
        "from", "to", "frequency [Hz]", f"real [{unit}]", f"imaginary [{unit}]",
        f"magnitude [{unit}]", "phase [deg]",
    ]  # fmt: skip
    assert names == [["9 m, 250 cm", "tool"]] * 60 + [["tool", "tool"]] * 60
    study = study_from_text(GOOD)
    lines, method = np.geomspace(2.0, 24.0, 60), study.methods[0].interaction
    found = transfer(
        study.floor, {"a": (9.0, 2.5), "b": (3.0, 3.0)}, {"tool": (3.0, 3.0)}, lines,
        integration=method.integration, damping=method.damping,
    )  # fmt: skip
    values = scale * getattr(found, quantity)[:, 0].ravel()
    np.testing.assert_allclose(rows[:, 0], np.tile(lines, 2), rtol=1e-12)
    np.testing.assert_allclose(rows[:, 1] + 1j * rows[:, 2], values, rtol=1e-9)
    np.testing.assert_allclose(rows[:, 3], np.abs(values), rtol=1e-9)
    np.testing.assert_allclose(rows[:, 3] * np.exp(1j * np.radians(rows[:, 4])), values, rtol=1e-9)


def test_peaks_on_the_screen_are_those_of_the_table(shaken):
    """All points of the study unless said; three significant digits of the largest magnitude."""
    code, said = shaken("--from", "tool", "--out", "t.csv", "--figure", "t.png")
    assert code == 0
    _, _, rows = table("t.csv")
    highest = rows[rows[:, 3].argmax()]
    assert f"{highest[0]:.4g}" in said.out
    assert f"{highest[3]:.3g}" in said.out
    assert "written: t.csv" in said.out
    assert "written: t.png" in said.out
    assert "warning: modal truncation: lines above 15 Hz" in said.out
    # as far as the method shows: f_max / 1.25
    assert rows[-1, 0] == pytest.approx(24.0)
    picture = imread("t.png")
    assert picture.shape[0] > 600
    assert np.unique(picture.reshape(-1, picture.shape[2]), axis=0).shape[0] > 20


def test_json_for_programs(shaken):
    code, said = shaken("--from", "tool", "--json", "--figure", "t.svg")
    assert code == 0
    found = json.loads(said.out)
    (pair,) = found["pairs"]
    assert (found["quantity"], found["unit"], found["method"]) == (
        "mobility",
        "(um/s)/N",
        "coupled",
    )
    assert (pair["from"], pair["to"]) == ("tool", "tool")
    sizes = [peak["magnitude"] for peak in pair["peaks"]]
    assert sizes == sorted(sizes, reverse=True)
    assert found["table"] is None
    assert found["figure"] == "t.svg"


@pytest.mark.parametrize(
    ("quantity", "asked", "unit", "size"),
    [
        ("mobility", 'velocity = "in/s"', "(in/s)/N", 25400.0),
        ("accelerance", 'acceleration = "gal"', "gal/N", 10.0),
        ("receptance", 'displacement = "mil"', "mil/N", 25400.0),
        ("receptance", 'velocity = "in/s"', "nm/N", 1.0),
    ],
)
def test_people_read_the_unit_that_the_study_asks_for(
    shaken, monkeypatch, quantity, asked, unit, size
):
    """By hand: an inch is 25400 um, a gal 10 mm/s2, a mil 25400 nm. Programs read what they did."""
    drawn = []
    monkeypatch.setattr(
        "trundle.report.figures.transfer.transfer_figure",
        lambda *told: drawn.append(told) or Figure(),
    )
    said = {}
    for name, text in (("usual", GOOD), ("asked", f"{GOOD}\n[report]\n{asked}\n")):
        arguments = ("--from", "tool", "--quantity", quantity, "--f-min", "2 Hz", "--lines", "60")
        files = ("--out", f"{name}.csv", "--figure", "t.png")
        assert shaken(*arguments, *files, text=text)[0] == 0
        said[name] = shaken(*arguments, text=text)[1].out
        found = json.loads(shaken(*arguments, "--json", text=text)[1].out)
        said[f"{name} json"] = found["unit"], found["pairs"]
    (usual, _, _), (read, _, _) = drawn
    assert read[0].unit == unit
    np.testing.assert_allclose(size * read[0].values, usual[0].values, rtol=1e-12)
    assert f"magnitude [{unit}]" in said["asked"]
    assert f"{read[0].magnitude.max():.3g}" in said["asked"]
    assert said["asked json"] == said["usual json"]
    assert Path("asked.csv").read_bytes() == Path("usual.csv").read_bytes()


def test_places_on_storeys_level_points_and_newmark(shaken):
    """A machine on the deck below, the tool upstairs along two axes; by a method without modes."""
    text = BUILDING.replace('on = "lab"\nat', 'on = "lab"\naxes = ["z", "x"]\nat')
    text = text.replace(
        'integration = "modal"\nf_max = "60 Hz"\ndt = "5 ms"\ndamping = { ratio = "3 %" }',
        'integration = "newmark"\ndt = "5 ms"\n'
        'damping = { rayleigh_alpha = "0.86 1/s", rayleigh_beta = "1 ms" }',
    )
    code, said = shaken(
        "--from", "6 m, 3 m @ deck", "--to", "tool", "--to", "tool x", "--lines", "300",
        "--out", "t.csv", text=text,
    )  # fmt: skip
    assert code == 0, said.err
    _, names, rows = table("t.csv")
    assert {tuple(pair) for pair in names} == {
        ("6 m, 3 m @ deck", "tool"), ("6 m, 3 m @ deck", "tool x"),
    }  # fmt: skip
    # Newmark's steps show 0.075 of the sampling frequency
    assert rows[-1, 0] == pytest.approx(0.075 * 200.0)
    study = study_from_text(text)
    found = transfer(
        study.floor, {"machine": Spot(6.0, 3.0, "deck")}, {"tool": Spot(4.0, 3.0, "lab")}, rows[:300, 0],
        damping=study.methods[0].interaction.damping,
    )  # fmt: skip
    np.testing.assert_allclose(rows[:300, 3], 1e6 * np.abs(found.mobility[0, 0]), rtol=1e-6)


def test_modes_are_those_that_a_run_keeps(shaken, tmp_path, monkeypatch):
    """Found once, to the same frequency: the second command finds none."""
    monkeypatch.setenv("TRUNDLE_CACHE", str(tmp_path / "cache"))
    assert shaken("--from", "tool", "--out", "one.csv")[0] == 0
    (kept,) = (tmp_path / "cache").glob("*.npz")
    assert "-30-" in kept.name

    def found_again(*arguments, **settings):
        raise AssertionError

    monkeypatch.setattr("trundle.structure.floor.Floor.modes", found_again)
    assert shaken("--from", "tool", "--out", "two.csv")[0] == 0
    assert (tmp_path / "one.csv").read_bytes() == (tmp_path / "two.csv").read_bytes()


def test_what_stands_behind_an_isolator_is_not_meant(shaken):
    text = GOOD.replace(
        'at = ["3 m", "3 m"]',
        'at = ["3 m", "3 m"]\nisolator = { frequency = "2 Hz", damping = "10 %" }',
    )
    code, said = shaken("--from", "9 m, 3 m", text=text)
    assert code == 0
    assert "point 'tool': what is given is the floor" in said.out


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--from", "tol"), "--from 'tol': is no point of the study (did you mean 'tool'?)"),
        (("--from", "3 m"), "write a place of the plan with units, '3 m, 4.5 m'"),
        (("--from", "3, 4"), "--from '3, 4': the unit is missing"),
        (("--from", "3 s, 4 m"), "unit 's' is not one of length"),
        (("--from", "tool", "--to", "40 m, 3 m"), "--to '40 m, 3 m': point (40, 3) m is not on the"),
        (("--from", "3 m, 4 m @ attic"), "there is no surface 'attic'"),
        (("--from", "tool", "--method", "coupeld"), "(did you mean 'coupled'?)"),
        (("--from", "tool", "--quantity", "mobilty"), "(did you mean 'mobility'?)"),
        (("--from", "tool", "--f-max", "40 Hz"), "got 40 Hz: ask for 24 Hz at most, or raise f_max to 50"),
        (("--from", "tool", "--f-max", "40"), "--f-max '40': the unit is missing"),
        (("--from", "tool", "--f-min", "0 Hz"), "--f-min '0 Hz': must be 0.001 to 2000 Hz"),
        (("--from", "tool", "--f-min", "24 Hz"), "must be below the highest frequency, 24 Hz, to which"),
        (("--from", "tool", "--lines", "1"), "should be greater than or equal to 2"),
        (("--from", "tool", "--out", "t.txt"), "--out 't.txt': must end with .csv"),
        (("--from", "tool", "--figure", "t.bmp"), "must end with .pdf or .png or .svg"),
        (("--from", "tool", "--out", "there/t.csv"), "make it first"),
        (("--from", "tool", "--json", "--quiet"), "give one of them"),
        ((), "Missing option '--from'"),
    ],
)  # fmt: skip
def test_mistakes_are_told_with_their_remedy_and_leave_nothing(shaken, tmp_path, arguments, words):
    code, said = shaken(*arguments)
    assert code == 2
    plain = " ".join("".join(c for c in said.err if c not in "│╭╮╰╯─").split())
    assert words in plain
    assert [file.name for file in tmp_path.iterdir()] == ["study.toml"]


def test_several_surfaces_must_be_named(shaken):
    code, said = shaken("--from", "3 m, 4 m", text=BUILDING)
    assert code == 2
    assert "--from '3 m, 4 m': say on which surface: 'deck', 'lab'" in said.err


def test_a_picture_that_fails_leaves_no_table_either(shaken, tmp_path, monkeypatch):
    """Both stand aside until both are whole; what stood there before still does."""
    (tmp_path / "t.csv").write_text("earlier")

    def full(*arguments, **settings):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Figure, "savefig", full)
    code, said = shaken("--from", "tool", "--out", "t.csv", "--figure", "t.png")
    assert code == 2
    assert "--figure 't.png': cannot be written (No space left on device)" in said.err
    assert (tmp_path / "t.csv").read_text() == "earlier"
    assert {file.name for file in tmp_path.iterdir()} == {"study.toml", "t.csv"}


def functions(receptance, frequencies):
    return TransferFunctions(
        frequencies=frequencies, receptance=receptance,
        load_names=tuple(f"machine {i}" for i in range(receptance.shape[0])),
        point_names=tuple(f"$tool$ {i}" for i in range(receptance.shape[1])),
    )  # fmt: skip


def test_peaks_are_found_inside_and_at_an_end_that_is_highest():
    """Heights by hand: 5 at 3 Hz, 4 at 7 Hz, and 9 where the range ends; equal neighbours once."""
    f = np.arange(1.0, 11.0)
    values = np.array([1.0, 2, 5, 5, 1, 2, 4, 3, 1, 9]) * 1e-9
    (curve,) = curves(functions(values[None, None].astype(complex), f), "receptance")
    found = largest_peaks(curve)
    assert [(p.frequency, p.at_end) for p in found] == [(10.0, True), (3.0, False), (7.0, False)]
    assert [p.value for p in found] == pytest.approx([9.0, 5.0, 4.0])
    assert len(largest_peaks(curve, n=1)) == 1
    (still,) = curves(functions(0j * values[None, None], f), "mobility")
    assert largest_peaks(still) == []


@pytest.mark.parametrize("f_max", [4.0, 80.0])
@pytest.mark.parametrize("shape", [(1, 1), (3, 4)])
def test_the_picture_says_what_it_shows_and_nothing_overlaps(shape, f_max):
    """Units on both axes, a legend line for every pair, below the axes; a range short or long."""
    f = np.linspace(1.0, f_max, 200)
    resonances = 5.0 + np.arange(np.prod(shape)).reshape(*shape, 1)
    values = 1e-4 / (resonances**2 - f**2 + 0.06j * resonances * f)
    some = curves(functions(values, f), "mobility")
    with rc_context(STYLE):
        figure = transfer_figure(some, "mobility", "A title")
        figure.canvas.draw()
    size, phase = figure.axes
    assert size.get_ylabel() == "mobility [(um/s)/N]"
    assert (phase.get_xlabel(), phase.get_ylabel()) == ("frequency [Hz]", "phase [deg]")
    assert phase.get_xscale() == ("log" if f_max > 6.0 else "linear")
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == [
        f"{c.load} → {c.point}" for c in some
    ]
    looks = {(line.get_color(), line.get_linestyle()) for line in size.get_lines()}
    assert len(looks) == len(some)
    renderer = figure.canvas.get_renderer()
    boxes = [part.get_tightbbox(renderer) for part in (size, phase, legend)]
    assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])
    width, height = figure.canvas.get_width_height()
    assert all(b.x0 >= 0 and b.y0 >= 0 and b.x1 <= width + 1 and b.y1 <= height + 1 for b in boxes)
    ticks = [t for t in size.get_yticks() if size.get_ylim()[0] <= t <= size.get_ylim()[1]]
    assert len(ticks) >= 2
