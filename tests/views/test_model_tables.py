"""What a model comes to, as text: units, what is not known, and names as they are."""

import json
from dataclasses import replace

import numpy as np
import pytest

from trundle.imports.summary import GroupSummary, ModelSummary, SurfaceSummary
from trundle.views.model import summary_data, summary_tables

FOUND = ModelSummary(
    name="Halle, <b>.bdf", units="", n_nodes=12, n_dofs=60, low=np.array([-1.0, 0.0, 2.0]),
    high=np.array([11.0, 6.0, 6.5]),
    groups=(
        GroupSummary(name="Decke, Süd", kind="quadrilaterals", count=8, size=72.0, mass=43200.0),
        GroupSummary(name="Kran", kind="points", count=1, size=0.0, mass=700.0),
    ),
    surfaces=(
        SurfaceSummary(name="eben", lowest=3.0, highest=3.004, area=72.0, low=(0.0, 1.0), high=(12.0, 6.0)),
        SurfaceSummary(name="Rampe", lowest=3.0, highest=4.5, area=20.0, low=(0.0, 0.0), high=(5.0, 4.0)),
    ),
    mass=np.array([44000.0, 43950.0, 43900.0, 1e5, 2e5, 3e5]), centre=np.array([6.0, 3.0, 3.25]),
    rigid=np.array([0.0, 0.0, 1e-12, 0.0, 0.0, 1e-10]), frequencies=np.array([4.56789, 7.0]),
    unmoved="", told=("EIGRL, passed over", "N and m are assumed"),
)  # fmt: skip


def tables(found):
    return {table.title: table for table in summary_tables(found)}


def whole(found):
    """Return the rows of the first table; the first of each name."""
    first = next(summary_tables(found))
    assert first.title == found.name
    return dict(reversed(first.rows))


def test_masses_are_in_tonnes_and_of_their_own_motion():
    """44000 kg along x are 44 t, 43.9 t of them move along z; inertias in t m2, by their axes."""
    found = tables(FOUND)
    assert [(r[0], r[4]) for r in found["Groups of elements"].rows] == [
        ("Decke, Süd", "43.2"),
        ("Kran", "0.7"),
    ]
    rigid = found["Moved as a rigid body, without supports"]
    assert [r[:2] for r in rigid.rows] == [
        ("along x", "44"), ("along y", "43.95"), ("along z", "43.9"),
        ("about x", "100"), ("about y", "200"), ("about z", "300"),
    ]  # fmt: skip
    assert rigid.rows[2][2] == "1.0e-12"
    assert whole(FOUND)["mass along z [t]"] == "43.9"


def test_the_box_is_said_axis_by_axis():
    """From -1 to 11 m, 0 to 6 m and 2 to 6.5 m; a file that says no units has a dash."""
    said = whole(FOUND)
    assert (said["x [m]"], said["y [m]"], said["z [m]"]) == ("-1 to 11", "0 to 6", "2 to 6.5")
    assert said["centre of mass [m]"] == "6, 3, 3.25"
    assert (said["nodes"], said["degrees of freedom"], said["units of the file"]) == (
        "12",
        "60",
        "-",
    )
    assert whole(replace(FOUND, units="kN, mm"))["units of the file"] == "kN, mm"


def test_a_height_that_hardly_varies_is_one_height():
    """4 mm off is level, 1.5 m is a ramp from 3 to 4.5 m; the range of x before that of y."""
    level, ramp = tables(FOUND)["What wheels and points can stand on"].rows
    assert level == ("eben", "3", "72", "0 to 12", "1 to 6")
    assert ramp == ("Rampe", "3 to 4.5", "20", "0 to 5", "0 to 4")


def test_frequencies_are_numbered_from_one():
    """Four decimals of each, the first mode first."""
    found = tables(FOUND)["First natural frequencies, as it is held"]
    assert found.rows == (("1", "4.5679"), ("2", "7.0000"))


def test_rigid_motions_that_raise_forces_are_told():
    """1e-10 of the largest stiffness is round-off, 1e-6 is a spring or an unsound element."""
    assert "grounded" not in whole(FOUND)
    held = replace(FOUND, rigid=np.array([0.0, 0.0, 1e-6, 0.0, 0.0, 0.0]))
    assert whole(held)["grounded"].startswith("rigid motions raise forces")


def test_what_is_not_known_is_said_and_is_no_zero():
    """Modes alone: no mass, no rigid motions, no frequencies, and the reason why."""
    bare = replace(
        FOUND,
        mass=None,
        centre=None,
        rigid=None,
        frequencies=np.zeros(0),
        unmoved="no mass anywhere",
    )
    assert set(tables(bare)) == {
        FOUND.name,
        "Groups of elements",
        "What wheels and points can stand on",
    }
    said = whole(bare)
    assert (said["mass"], said["no modes"]) == ("not known", "no mass anywhere")
    assert "mass along z [t]" not in said
    data = summary_data(bare)
    assert [data[k] for k in ("mass_kg_and_kg_m2", "centre_of_mass_m", "rigid_motions")] == [
        None
    ] * 3
    assert (data["frequencies_hz"], data["no_modes"]) == ([], "no mass anywhere")


def test_all_that_was_told_stands_there():
    """Each on a row of its own, with its commas."""
    first = next(summary_tables(FOUND))
    assert [row[1] for row in first.rows if row[0] == "told"] == list(FOUND.told)


def test_programs_are_given_si():
    """Kilograms and metres as they are, through JSON and back."""
    data = json.loads(json.dumps(summary_data(FOUND)))
    assert data["mass_kg_and_kg_m2"] == pytest.approx(list(FOUND.mass))
    assert data["groups"][0] == {
        "name": "Decke, Süd", "elements": "quadrilaterals", "count": 8, "size": 72.0, "mass_kg": 43200.0,
    }  # fmt: skip
    assert data["surfaces"][1]["heights_m"] == [3.0, 4.5]
    assert (data["surfaces"][0]["low_m"], data["surfaces"][0]["high_m"]) == (
        [0.0, 1.0],
        [12.0, 6.0],
    )
    assert (data["low_m"], data["high_m"]) == ([-1.0, 0.0, 2.0], [11.0, 6.0, 6.5])
    assert data["told"] == list(FOUND.told)
