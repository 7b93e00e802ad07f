"""Wrong study files: exit code 2, place, value, rule and remedy, no traceback, nothing written."""

import os
from pathlib import Path

import pytest

from studies import GOOD, run_main
from trundle.errors import StudyError
from trundle.study_file.build import load_study

# (what, text to replace, replacement, words that the message must hold)
MISTAKES = [
    ("unknown key", 'seed = 1', 'seed = 1\ncolour = "red"', ["colour", "unknown key", "known keys"]),
    ("misspelt key", "mesh_size", "meshsize", ["floor.meshsize", "did you mean 'mesh_size'"]),
    ("unknown nested key", "density =", "densty =", ["floor.material.densty", "unknown key"]),
    ("unknown table", "[criteria]", "[criterion]", ["criterion", "did you mean 'criteria'"]),
    ("wrong unit", '"15 km/h"', '"15 kg"', ["route[1].speed", "'15 kg'", "not one of speed"]),
    ("missing unit", '"15 km/h"', '"15"', ["route[1].speed", "unit is missing", "15 km/h"]),
    ("number for a quantity", '"15 km/h"', "15", ["route[1].speed", "text with its unit"]),
    ("unknown unit", '"15 km/h"', '"15 knotz"', ["route[1].speed", "knotz", "unknown"]),
    ("code for a quantity", '"15 km/h"', '"__import__(1)"', ["route[1].speed", "number and a unit"]),
    ("not a number", '"15 km/h"', '"nan km/h"', ["route[1].speed", "number and a unit"]),
    ("infinite", '"15 km/h"', '"1e999 km/h"', ["route[1].speed", "finite"]),
    ("negative thickness", '"0.2 m"', '"-0.2 m"', ["floor.slab_thickness", "-0.2 m", "greater than 0"]),
    ("zero speed", '"15 km/h"', '"0 km/h"', ["route[1].speed", "greater than 0"]),
    ("negative mass", '"300 kg/m2"', '"-300 kg/m2"', ["superimposed_mass", "0 or more"]),
    ("class Z", 'class = "B"', 'class = "Z"', ["road[1].class", "'Z'", "choose one of A, B"]),
    ("bad level", 'class = "B"', 'class = "B"\nlevel = "uper"', ["road[1].level", "did you mean 'upper'"]),
    ("bad waviness", 'class = "B"', 'class = "B"\nwaviness = 20', ["road[1].waviness", "20"]),
    ("route off the floor", '["12 m", "3 m"]', '["99 m", "3 m"]', ["route[1].path[2]", "(99, 3) m", "stay on the floor"]),
    ("route of no length", '["12 m", "3 m"]', '["0 m", "3 m"]', ["route[1].path", "same point twice"]),
    ("route of one point", ', ["12 m", "3 m"]', "", ["route[1].path"]),
    ("point off the floor", '["3 m", "3 m"]', '["3 m", "7 m"]', ["point[1].at", "(3, 7) m", "move it onto the floor"]),
    ("a method named as a coordinate", 'name = "coupled"', 'name = "road"', ["method[1].name", "results have for themselves"]),
    ("a route named as a coordinate", 'name = "main"', 'name = "contact"', ["route[1].name", "results have for themselves"]),
    ("dt too long for the bands", '"5 ms"', '"10 ms"', ["criteria.method", "80 Hz", "at most 5 ms"]),
    ("dt longer than the record", '"4 s"', '"20 ms"', ["method[1].dt", "10 steps"]),
    ("no f_max", 'f_max = "30 Hz"\n', "", ["method[1].f_max", "modes are kept"]),
    ("f_max with newmark", 'f_max =', 'integration = "newmark"\nf_max =', ["method[1].f_max", "no modes"]),
    ("single precision with newmark", 'f_max = "30 Hz"', 'integration = "newmark"\nprecision = "single"', ["method[1].precision", "double precision"]),
    ("no event", 'curves = ["VC-A"]', 'curves = ["VC-A"]\nevents = 0', ["criteria.events"]),
    ("ratio with newmark", 'f_max = "30 Hz"', 'integration = "newmark"', ["method[1].damping", "rayleigh_alpha"]),
    ("two dampings", 'ratio = "3 %"', 'ratio = "3 %", rayleigh_alpha = "1 1/s"', ["method[1].damping", "damping is a ratio"]),
    ("no damping", 'ratio = "3 %"', "", ["method[1].damping", "nothing"]),
    ("damping in per cent without sign", '"3 %"', "3.0", ["method[1].damping.ratio", "below 1"]),
    ("unknown interaction", '"coupled"\nf_max', '"copled"\nf_max', ["method[1].interaction", "did you mean 'coupled'"]),
    ("unknown vehicle kind", '"container_truck_40ft"', '"tank"', ["vehicle.truck.kind", "'tank'", "container_truck_40ft"]),
    ("misspelt vehicle kind", '"container_truck_40ft"', '"city_bus_2_axel"', ["vehicle.truck.kind", "must be one of container_truck_40ft", "planar", "did you mean 'city_bus_2_axle'"]),
    ("a vehicle of old", '"container_truck_40ft"', '"articulated_truck_5_axle"', ["vehicle.truck.kind", "no longer offered", "use 'tractor_3axle_semitrailer_6_axle_worn'"]),
    ("vehicle without a kind", 'kind = "container_truck_40ft"', "", ["vehicle.truck.kind", "nothing", "must be one of container_truck_40ft"]),
    ("unknown entry", 'f_max =', 'entry = "abrubt"\nf_max =', ["method[1].entry", "did you mean 'abrupt'"]),
    ("abrupt over a length", 'f_max =', 'entry = "abrupt"\nentry_length = "2 m"\nf_max =', ["method[1].entry_length", "2 m", "has no length"]),
    ("unknown floor kind", 'kind = "plan"', 'kind = "flat"', ["floor.kind", "'flat'", "reference_unit"]),
    ("unknown vehicle", 'vehicle = "truck"', 'vehicle = "van"', ["route[1].vehicle", "'van'", "truck"]),
    ("unknown criterion", '["VC-A"]', '["VC-Z"]', ["criteria.curves[1]", "VC-Z", "trundle criteria"]),
    ("unknown method", 'method = "coupled"', 'method = "other"', ["criteria.method", "'other'", "coupled"]),
    ("percentile", '["VC-A"]', '["VC-A"]\npercentile = 101', ["criteria.percentile", "101"]),
    ("duplicate point", "[criteria]", '[[point]]\nname = "tool"\nat = ["1 m", "1 m"]\n[criteria]', ["point", "'tool' 2 times", "names must differ"]),
    ("duplicate road", "[criteria]", '[[road]]\nclass = "B"\n[criteria]', ["road", "'B' 2 times"]),
    ("traffic of one", "[criteria]", '[[traffic]]\nname = "all"\nroutes = ["main"]\n[criteria]', ["traffic[1].routes"]),
    ("traffic of an unknown route", "[criteria]", '[[traffic]]\nname = "all"\nroutes = ["main", "side"]\n[criteria]', ["traffic[1].routes[2]", "'side'", "main"]),
    ("printed value of nothing", "[criteria]", '[[printed]]\ncase = "x"\nroad = "B"\nmethod = "coupled"\npeak_acceleration = "1 gal"\nrms_velocity = "1 um/s"\n[criteria]', ["printed[1].case", "'x'"]),
    ("no runs", "runs = 2", "runs = 0", ["runs", "0", "1 or more"]),
    ("negative seed", "seed = 1", "seed = -1", ["seed", "-1"]),
    ("runs beyond reason", "runs = 2", "runs = 90000000", ["runs", "90000000", "1000000 or less"]),
    ("endless record", '"4 s"', '"9 d"', ["duration", "steps"]),
    ("no title", 'title = "Small"', "", ["title", "required"]),
    ("empty title", 'title = "Small"', 'title = ""', ["title"]),
    ("mesh too fine", '"1.5 m"', '"1 mm"', ["floor.mesh_size", "nodes", "or more"]),
    ("mesh too coarse", '"1.5 m"', '"40 m"', ["floor.mesh_size", "quarter"]),
    ("column lines fall", '"6 m", "12 m"]', '"6 m", "3 m"]', ["floor", "rise without repeats"]),
    ("band falls", "[criteria]", '[roughness]\nn_min = "3 1/m"\nn_max = "1 1/m"\n[criteria]', ["roughness.n_max", "above n_min"]),
    ("band in radians", "[criteria]", '[roughness]\nn_min = "1 rad/m"\n[criteria]', ["roughness.n_min", "cycles, not radians"]),
    ("waves too short for dt", "[criteria]", '[roughness]\nn_max = "90 1/m"\nn_max_follows_dt = false\n[criteria]', ["roughness.n_max", "can follow waves"]),
    ("entry longer than the route", 'f_max =', 'entry_length = "9 m"\nf_max =', ["entry_length", "must both fit"]),
    ("vehicle longer than the route", 'f_max =', 'entry = "static"\nf_max =', ["entry", "12.5 m"]),
    ("vehicle that does not stand", 'kind = "container_truck_40ft"', 'kind = "planar"\nbodies = [{ mass = "1 t", pitch_inertia = "1 kg m2" }]\naxles = [{ setback = "0 m", stiffness = "1 kN/m" }]', ["vehicle.truck", "does not stand"]),
    ("table for a list", "[[road]]", "[road]", ["road", "list of tables", "[[road]]"]),
    ("list for a table", "[floor]", "[[floor]]", ["floor", "must be a table"]),
    ("vehicle without a name", "[vehicle.truck]", "[vehicle]", ["vehicle.kind"]),
    ("name with a slash", 'name = "tool"', 'name = "../tool"', ["point[1].name", "without '/'"]),
    ("nothing fixed", 'column = { width = "0.4 m", depth = "0.4 m" }\nstorey_below = "4 m"', "", ["floor", "nothing holds"]),
    ("one hinge", 'column = { width = "0.4 m", depth = "0.4 m" }\nstorey_below = "4 m"', 'edges = { x_min = "simple", y_min = "symmetry" }', ["floor.edges", "tip over"]),
    ("columns without a storey", 'storey_below = "4 m"', "", ["floor.column", "columns need storey_below"]),
    ("yes for true", "[criteria]", '[roughness]\nn_max_follows_dt = "yes"\n[criteria]', ["roughness.n_max_follows_dt", "true or false"]),
    ("text for a count", "runs = 2", 'runs = "2"', ["runs", "whole number"]),
    ("radians", '"30 Hz"', '"600 rad/s"', ["method[1].f_max", "counts cycles"]),
    ("a length of the wrong size", '"0.2 m"', '"200 km"', ["slab_thickness", "up to 10000 m"]),
    ("a hidden name", 'name = "tool"', 'name = "."', ["point[1].name", "not beginning with"]),
    ("a control character", 'title = "Small"', 'title = "Sm\\u001b[31mall"', ["title", "control characters"]),
    ("a curve twice", '["VC-A"]', '["VC-A", "VC-A"]', ["criteria.curves", "2 times"]),
    ("an axle that lifts off", 'kind = "container_truck_40ft"', 'kind = "planar"\nbodies = [{ mass = "1 t", pitch_inertia = "900 kg m2", centre = "9 m" }]\naxles = [{ setback = "0 m", stiffness = "1 kN/m" }, { setback = "3 m", stiffness = "1 kN/m" }]', ["vehicle.truck", "lift off at rest"]),
    ("a key called as the kind", "[floor]", "[floor]\nplan = 3", ["floor.plan", "unknown key"]),
    ("not TOML", "[floor]", "[floor", ["TOML 1.0", "line"]),
]  # fmt: skip


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_file_that_the_mistakes_are_made_in_is_good(here):
    path = here / "study.toml"
    path.write_text(GOOD)
    assert load_study(path).runs == 2


@pytest.mark.parametrize("command", ["run"])
@pytest.mark.parametrize(("what", "old", "new", "words"), MISTAKES, ids=[m[0] for m in MISTAKES])
def test_a_mistake_is_named(here, monkeypatch, capsys, command, what, old, new, words):
    assert old in GOOD
    path = here / "study.toml"
    path.write_text(GOOD.replace(old, new, 1))
    code, output = run_main(monkeypatch, capsys, command, path)
    assert code == 2, output
    for word in words:
        assert word in output.err
    assert "Traceback" not in output.err
    if what != "not TOML":
        assert "rule:" in output.err
        assert "remedy:" in output.err
    assert [p.name for p in here.iterdir()] == ["study.toml"]


def test_all_mistakes_come_at_once_and_none_twice(here):
    text = GOOD
    for what, old, new, _ in MISTAKES:
        if what in {"wrong unit", "class Z", "point off the floor", "no damping", "no title"}:
            text = text.replace(old, new, 1)
    path = here / "study.toml"
    path.write_text(text)
    with pytest.raises(StudyError) as caught:
        load_study(path)
    places = [problem.place for problem in caught.value.problems]
    assert sorted(places) == [
        "method[1].damping", "point[1].at", "road[1].class", "route[1].speed", "title",
    ]  # fmt: skip


def test_files_that_are_no_study(here, monkeypatch, capsys):
    """Missing, empty, binary, a folder, 100 MB: refused before they are read."""
    (here / "empty.toml").write_text("  \n")
    (here / "binary.toml").write_bytes(bytes(range(256)))
    (here / "folder.toml").mkdir()
    with (here / "huge.toml").open("wb") as file:
        file.truncate(100_000_000)
    for name, word in (
        ("missing.toml", "no such file"),
        ("empty.toml", "empty file"),
        ("binary.toml", "not UTF-8"),
        ("folder.toml", "a folder"),
        ("huge.toml", "100.0 MB"),
    ):
        code, output = run_main(monkeypatch, capsys, "run", here / name)
        assert code == 2
        assert word in output.err
        assert "remedy:" in output.err
        assert "Traceback" not in output.err


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read and write everywhere")
def test_permissions(here, monkeypatch, capsys):
    path = here / "study.toml"
    path.write_text(GOOD)
    path.chmod(0)
    code, output = run_main(monkeypatch, capsys, "run", path)
    assert code == 2
    assert "permissions" in output.err


def test_results_folders_that_cannot_be(here, monkeypatch, capsys):
    """A file in the way, a foreign folder, a path below a file, a folder of the system."""
    path = here / "study.toml"
    path.write_text(GOOD)
    (here / "file").write_text("mine")
    (here / "foreign").mkdir()
    (here / "foreign" / "letter.txt").write_text("mine")
    for out, word in (
        ("file", "a file has this name"),
        ("foreign", "did not write"),
        ("file/below", "not a folder"),
        ("/proc/trundle", "cannot be written"),
    ):
        code, output = run_main(monkeypatch, capsys, "run", path, "--out", out)
        assert code == 2, output
        assert word in output.err
        assert "--out" in output.err or "choose another" in output.err
    assert (here / "foreign" / "letter.txt").read_text() == "mine"
    assert sorted(p.name for p in here.iterdir()) == ["file", "foreign", "study.toml"]


def test_other_commands_refuse_too(here, monkeypatch, capsys):
    path = here / "study.toml"
    path.write_text(GOOD)
    for arguments, word in (
        (("check", "nowhere.toml"), "no such file"),
        (("new", path), "exists"),
        (("new", "no/folder/x.toml"), "no folder"),
        (("modes", path, "--f-max", "10"), "unit is missing"),
        (("modes", path, "--f-max", "-3 Hz"), "greater than 0"),
        (("run", path, "--colour"), "No such option"),
        (("fly",), "No such command"),
    ):
        code, output = run_main(monkeypatch, capsys, *arguments)
        assert code == 2
        assert word in output.err
    assert Path(path).read_text() == GOOD
