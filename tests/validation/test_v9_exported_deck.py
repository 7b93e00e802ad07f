"""V9: a deck that trundle wrote, solved by another program: OpenSees, by a script that knows cards.

The script below reads the deck's fields by itself: it shares nothing with trundle's own reader, and
takes no matrix or section from trundle. Shells are OpenSees's ``ShellMITC4`` (lumped masses), bars
its ``ElasticTimoshenkoBeam``; without offsets, for those differ (see `docs/models.md`).
"""

from collections import defaultdict

import numpy as np
import opensees_model
import pytest

from models import small_floor
from trundle.exports import Subject, export
from trundle.imports.summary import summary_of

pytestmark = pytest.mark.slow

CASE = "V9 exported deck"
SOURCE = "OpenSeesPy, ShellMITC4 and ElasticTimoshenkoBeam, from the deck's cards"


def cards(text):
    """Return cards of large fields by name: lists of texts."""
    found, name = defaultdict(list), ""
    for line in text.splitlines()[text.splitlines().index("BEGIN BULK") + 1 :]:
        if line.startswith("$") or "*" not in line[:8]:
            continue
        head, values = line[:8].strip(), [line[8 + 16 * i : 24 + 16 * i].strip() for i in range(4)]
        if head != "*":
            name = head.rstrip("*")
            found[name].append([])
        found[name][-1] += values
    return found


def number(text, default=0.0):
    return float(text) if text else default


def solve(text, n_modes):
    """Return total vertical mass and first frequencies of a deck, by OpenSees."""
    ops = opensees_model.load_opensees()
    deck = cards(text)
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    places = {}
    for fields in deck["GRID"]:
        places[int(fields[0])] = np.array([number(f) for f in fields[2:5]])
        ops.node(int(fields[0]), *places[int(fields[0])].tolist())
    materials = {int(f[0]): [number(v) for v in f[1:5]] for f in deck["MAT1"]}
    mass = 0.0
    for fields in deck["PSHELL"]:
        tag, thick, more = int(fields[0]), float(fields[2]), number(fields[7])
        e, _, nu, rho = materials[int(fields[1])]
        # mass per area over the thickness: OpenSees's section has a density alone
        ops.section("ElasticMembranePlateSection", tag, e, nu, thick, rho + more / thick)
    for tag, *fields in deck["CQUAD4"]:
        property_, *corners = (int(f) for f in fields[:5])
        ops.element("ShellMITC4", int(tag), *corners, property_)
        a, b, c, d = (places[n] for n in corners)
        plate = next(f for f in deck["PSHELL"] if int(f[0]) == property_)
        surface = materials[int(plate[1])][3] * float(plate[2]) + number(plate[7])
        mass += 0.5 * np.linalg.norm(np.cross(c - a, d - b)) * surface
    bars = {int(f[0]): f for f in deck["PBAR"]}
    for tag, *fields in deck["CBAR"]:
        assert not any(fields[8:14]), "offsets are not written here"
        make = bars[int(fields[0])]
        e, g, _, rho = materials[int(make[1])]
        area, plane_1, plane_2, j = (float(v) for v in make[2:6])
        k1, k2 = (number(v) for v in make[16:18])
        ends = [int(f) for f in fields[1:3]]
        # local y of OpenSees lies in the plane of vecxz's normal: vecxz spans x-z, and z is across
        ops.geomTransf("Linear", int(tag), *[float(v) for v in fields[3:6]])
        length = float(np.linalg.norm(places[ends[1]] - places[ends[0]]))
        # vecxz is the orientation: bending in plane 1 is about local y
        ops.element(
            "ElasticTimoshenkoBeam", int(tag), *ends, e, g, area, j, plane_1, plane_2,
            k2 * area, k1 * area, int(tag), "-mass", rho * area, "-cMass",
        )  # fmt: skip
        mass += rho * area * length
    for fields in deck["SPC1"]:
        held = [int(str(i) in fields[1]) for i in range(1, 7)]
        for node in fields[2:]:
            if node:
                ops.fix(int(node), *held)
    opensees_model._use_direct_solver(ops)
    omega2 = np.array(ops.eigen("-genBandArpack", n_modes))
    ops.wipe()
    return mass, np.sqrt(omega2) / (2.0 * np.pi)


def test_a_deck_of_ours_is_solved_by_opensees(tmp_path, record):
    """Mass to the fields' digits; eight frequencies within 1 %, for OpenSees lumps its shells."""
    try:
        opensees_model.load_opensees()
    except ImportError as error:
        pytest.skip(f'OpenSeesPy cannot be used ({error}): pip install "trundle[crosscheck]"')
    floor = small_floor(mesh_size=0.5, eccentric_beams=False)
    (deck,) = export(Subject(structure=floor), tmp_path / "floor.bdf")
    mass, theirs = solve(deck.read_text(), 8)
    ours = summary_of(floor)
    assert ours.mass[2] == pytest.approx(mass, rel=1e-8)
    frequencies = floor.modes(120.0).frequencies[:8]
    record.row("exported deck, mass", mass / 1e3, ours.mass[2] / 1e3, unit="t", rtol=1e-8)
    for i, (f, g) in enumerate(zip(frequencies, theirs, strict=True), start=1):
        record.row(f"exported deck, frequency {i}", g, f, unit="Hz", rtol=0.01)
