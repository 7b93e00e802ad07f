"""Files of exports: which format, which names, whole or not at all; decks that names cannot bend."""

import os

import numpy as np
import pytest
from scipy import sparse

from models import small_floor
from trundle.errors import InputError
from trundle.exports import Subject, export, format_of
from trundle.imports import read_model
from trundle.structure import (
    BeamGroup,
    BeamSection,
    Floor,
    Material,
    MatrixModel,
    PointMasses,
    RigidLinks,
    ShellGroup,
    ShellSection,
    SpringGroup,
)
from trundle.structure.elements import GROUND, FaceGroup, NodeInertia

STUFF = Material(elastic_modulus=3e10, poisson_ratio=0.2, density=2500.0)


def table(*, slab="slab", spring=(0.0, 0.0, 5e6, 0.0, 0.0, 0.0)):
    """A plate on springs, with a beam below it and a mass on it."""
    nodes = np.array([[0.0, 0, 0], [3, 0, 0], [3, 2, 0], [0, 2, 0]])
    return Floor(
        nodes=nodes,
        fixed=np.array([[True, True, False, False, False, True]] + [[False] * 6] * 3),
        shells=(
            ShellGroup(
                elements=np.array([[0, 1, 2, 3]]), name=slab,
                section=ShellSection(thickness=0.2, material=STUFF, superimposed_mass=123.0),
            ),
        ),
        beams=(
            BeamGroup(
                elements=np.array([[0, 1]]), offset=np.array([0.0, 0.0, -0.35]),
                section=BeamSection.rectangle(0.3, 0.5, STUFF),
            ),
        ),
        springs=(
            SpringGroup(elements=np.array([[i, GROUND] for i in range(4)]),
                        stiffness=np.array(spring)),
        ),
        masses=(PointMasses(nodes=np.array([2, 2]), mass=np.array([50.0, 70.0])),),
    )  # fmt: skip


def test_the_ending_tells_the_format_and_a_kind_that_is_said_wins(tmp_path):
    """``.BDF`` is a deck as ``.bdf`` is; a kind names the format whatever the ending."""
    assert format_of(tmp_path / "A.BDF").kind == "nastran"
    assert format_of(tmp_path / "a.txt", "nastran").kind == "nastran"
    assert format_of(tmp_path / "a.vtu", "gltf").kind == "gltf"
    with pytest.raises(InputError, match=r"^stl: of no format that is written; .*vtu \(\.vtu\)"):
        format_of(tmp_path / "a.vtu", "stl")
    (file,) = export(Subject(structure=table()), tmp_path / "deck.txt", "nastran")
    assert file == tmp_path / "deck.txt"
    assert file.read_text().startswith("SOL 103")


def test_what_cannot_be_written_leaves_what_was_there(tmp_path):
    """A structure without cards: the old file stays as it was, and nothing lies beside it."""
    path = tmp_path / "a.bdf"
    path.write_text("the old one")
    nodes = np.array([[0.0, 0, 0], [1, 0, 0]])
    face = FaceGroup(connectivity=np.array([[0, 1]]))
    one = sparse.csc_array(np.eye(2))
    index = np.full((2, 6), -1)
    index[:, 2] = [0, 1]
    known = MatrixModel(
        nodes=nodes, dof_index=index, mass=one, stiffness=one, faces=(face,), decks=(), name="<k>"
    )
    with pytest.raises(InputError, match="<k> is no finite-element model: it has no cards"):
        export(Subject(structure=known), path)
    assert path.read_text() == "the old one"
    assert os.listdir(tmp_path) == ["a.bdf"]


def test_a_later_export_takes_the_place_of_an_earlier_one(tmp_path):
    """Written twice, the second is there alone, and the folder holds no other file."""
    path = tmp_path / "a.bdf"
    export(Subject(structure=small_floor(mesh_size=3.0)), path)
    export(Subject(structure=table()), path)
    assert len(read_model(path).structure.nodes) == 4
    assert os.listdir(tmp_path) == ["a.bdf"]


@pytest.mark.parametrize("name", ["slab\nSPC1,1,123456,3", "Decke\r\nENDDATA", "a" * 200, "é\0"])
def test_a_name_of_a_group_puts_no_card_into_a_deck(tmp_path, name):
    """Line ends in names would begin cards: the deck read back is that of a plain name."""
    plain, odd = tmp_path / "plain.bdf", tmp_path / "odd.bdf"
    export(Subject(structure=table()), plain)
    export(Subject(structure=table(slab=name)), odd)
    assert len(odd.read_text().splitlines()) == len(plain.read_text().splitlines())
    first, second = (read_model(path).structure for path in (plain, odd))
    assert first.content_hash == second.content_hash
    assert max(map(len, odd.read_text().splitlines())) <= 72


def test_a_deck_says_each_part_by_hand(tmp_path):
    """Fields of 16 columns: places, 1.23E+02 kg/m2 on the plate, 5 MN/m, both masses, supports."""
    path = tmp_path / "a.bdf"
    export(Subject(structure=table()), path)
    cards = {}
    for line in path.read_text().splitlines():
        if line.startswith(("*", "$")) or "," in line or "*" not in line[:8]:
            continue
        cards.setdefault(line[:8].rstrip(" *"), []).append(
            [line[8 + 16 * i : 24 + 16 * i].strip() for i in range(4)]
        )
    assert [float(x) for x in cards["GRID"][1][2:]] == [3.0, 0.0]
    assert [c[:2] + c[3:] for c in cards["CONM2"]] == [
        [c[0], "3", mass] for c, mass in zip(cards["CONM2"], ("5.000000000E+01", "7.000000000E+01"),
                                             strict=True)
    ]  # fmt: skip
    assert [(float(c[1]), c[2], c[3]) for c in cards["CELAS2"]] == [
        (5e6, str(i), "3") for i in (1, 2, 3, 4)
    ]
    assert [c[:3] for c in cards["SPC1"]] == [["1", "126", "1"]]
    assert [float(c) for c in cards["MAT1"][0][1:]] == [3e10, 3e10 / 2.4, 0.2]


def test_six_springs_come_back_in_their_dofs(tmp_path):
    """1 to 6 MN/m and MN m: the matrices read back hold each in its own row."""
    spring = tuple(1e6 * k for k in range(1, 7))
    path = tmp_path / "a.bdf"
    export(Subject(structure=table(spring=spring)), path)
    again = read_model(path).structure
    bare, ours = table(spring=(1e-30,) * 6), table(spring=spring)
    assert again.n_dofs == ours.n_dofs
    added = (again.stiffness - bare.stiffness).toarray()
    for node in range(4):
        for dof in range(6):
            row = ours.dof_index[node, dof]
            if row >= 0:
                largest = ours.stiffness.diagonal().max()
                assert added[row, row] == pytest.approx(spring[dof], abs=1e-8 * largest)


def test_elements_without_a_card_are_refused_by_their_names(tmp_path):
    """What cannot be written is not left out in silence: the deck would be another model."""
    base = table()
    face = FaceGroup(connectivity=np.array([[0, 1, 2]]), name="Ölwanne")
    odd = Floor(nodes=base.nodes, fixed=base.fixed, shells=base.shells, others=(face,))
    with pytest.raises(InputError, match="Ölwanne: FaceGroup has no card"):
        export(Subject(structure=odd), tmp_path / "a.bdf")
    assert os.listdir(tmp_path) == []


TURN = 0.3
ASLANT = np.array([0.1, 0.05, -0.35])


def turned(**changes):
    """A post and a beam whose common node is held along axes that are turned by 0.3 rad."""
    fixed = np.zeros((3, 6), dtype=bool)
    fixed[0] = True
    fixed[1, 0] = True
    angles = np.zeros((3, 2))
    angles[1] = TURN
    section = BeamSection.rectangle(0.3, 0.5, STUFF)
    values = {
        "nodes": np.array([[0.0, 0, 0], [0, 0, 3], [4, 1, 3]]), "fixed": fixed, "angles": angles,
        "beams": (
            BeamGroup(elements=np.array([[1, 0]]), section=section, up=np.array([1.0, 0, 0])),
            BeamGroup(elements=np.array([[2, 1]]), section=section, offset=ASLANT),
        ),
        "name": "turned",
    }  # fmt: skip
    return Floor(**{**values, **changes})


def cards_in(path):
    """Return the fields of every card by the columns of the format alone, by name."""
    found = {}
    for line in path.read_text().splitlines():
        values = [line[8 + 16 * i : 24 + 16 * i].strip() for i in range(4)]
        if line.startswith("*"):
            last.extend(values)
        elif "*" in line[:8]:
            last = values
            found.setdefault(line[:8].rstrip(" *"), []).append(last)
    return found


def test_bars_are_written_along_the_axes_in_which_their_grids_move(tmp_path):
    """By hand, from the manual (CBAR): X and W are components in the systems named by CD.

    Grid 2 moves along (cos 0.3, sin 0.3): a vector (1, 0, 0) is (cos 0.3, -sin 0.3, 0) there. Both
    bars are told by what their fields mean in the basic system, without our reader.
    """
    floor, path = turned(), tmp_path / "a.bdf"
    export(Subject(structure=floor), path)
    found = cards_in(path)
    assert [grid[5:6] for grid in found["GRID"]] == [[""], ["1"], [""]]
    (system,) = found["CORD2R"]
    assert [float(x or 0.0) for x in system[2:]][:9] == pytest.approx(
        [0, 0, 0, 0, 0, 1, np.cos(TURN), np.sin(TURN), 0], abs=1e-9
    )
    post, beam = ([float(x or 0.0) for x in one] for one in found["CBAR"])
    assert post[4:7] == pytest.approx([np.cos(TURN), -np.sin(TURN), 0.0], abs=1e-9)
    assert beam[4:7] == pytest.approx([0.0, 0.0, 1.0], abs=1e-9)
    x, y, z = ASLANT
    c, s = np.cos(TURN), np.sin(TURN)
    assert beam[10:13] == pytest.approx(ASLANT.tolist(), abs=1e-9)
    assert beam[13:16] == pytest.approx([c * x + s * y, c * y - s * x, z], abs=1e-9)
    again = read_model(path).structure
    for ours, theirs in zip(floor.matrices(), again.matrices(), strict=True):
        assert abs(ours - theirs).max() <= 2e-9 * abs(ours).max()


@pytest.mark.parametrize(
    ("stiffness", "card"),
    [
        ((1e6, 1e6, 2e6, 3e5, 3e5, 0.0), "CBUSH"),
        ((0.0, 0.0, 2e6, 0.0, 0.0, 5e5), "CELAS2"),
        ((1e6, 4e6, 2e6, 3e5, 3e5, 0.0), "CBUSH"),
        ((0.0, 0.0, 0.0, 0.0, 3e5, 0.0), "CBUSH"),
    ],
)
def test_springs_lie_along_the_basic_axes_where_their_grid_does_not(tmp_path, stiffness, card):
    """A scalar spring is along the grid's own axes, of which z is the basic one.

    Along others a bush has a system of its own (CID 0), whatever its grid has.
    """
    spring = SpringGroup(elements=np.array([[1, GROUND]]), stiffness=np.array(stiffness))
    floor, path = turned(springs=(spring,)), tmp_path / "a.bdf"
    export(Subject(structure=floor), path)
    found = cards_in(path)
    assert [name in found for name in ("CELAS2", "CBUSH")] == [card == "CELAS2", card == "CBUSH"]
    if card == "CBUSH":
        assert [float(k or 0.0) for k in found["PBUSH"][0][2:8]] == list(stiffness)
        assert found["CBUSH"][0][2:8] == ["2", "", "", "", "", "0"]
    ours, theirs = floor.stiffness, read_model(path).structure.stiffness
    assert abs(ours - theirs).max() <= 2e-9 * abs(ours).max()


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        (
            {"springs": (SpringGroup(elements=np.array([[1, 2]]),
                                     stiffness=np.array([1e6, 0, 0, 0, 0, 0])),)},
            "spring: a spring between two places has no card at nodes 2 and 3",
        ),
        (
            {"others": (NodeInertia(nodes=np.array([1]), inertia=np.array([[5, 6, 7, 0, 0, 0.0]])),)},
            "inertia that differs along x and y has no card at node 2",
        ),
        (
            {"links": (RigidLinks(leads=np.array([2]), follows=np.array([1]),
                                  dofs=np.array([1, 0, 0, 0, 0, 0], dtype=bool)),)},
            "a rigid link along x or y alone has no card at node 2",
        ),
    ],
    ids=["spring", "inertia", "link"],
)  # fmt: skip
def test_what_is_along_the_basic_axes_alone_is_refused_where_supports_are_turned(
    tmp_path, changes, said
):
    """A card would mean other axes: none is written rather than a wrong one."""
    with pytest.raises(InputError, match=said):
        export(Subject(structure=turned(**changes)), tmp_path / "a.bdf")
    assert os.listdir(tmp_path) == []


def test_inertia_alike_all_round_is_written_where_supports_are_turned(tmp_path):
    """5 kg along x and y, 7 along z: the same along axes that are turned about z."""
    inertia = NodeInertia(nodes=np.array([1]), inertia=np.array([[5, 5, 7, 2, 2, 3.0]]))
    floor = turned(others=(inertia,))
    export(Subject(structure=floor), tmp_path / "a.bdf")
    again = read_model(tmp_path / "a.bdf").structure
    assert abs(floor.mass - again.mass).max() <= 2e-9 * abs(floor.mass).max()


def test_supports_turned_apart_have_no_card(tmp_path):
    """A grid has one system for its translations and rotations; two angles are not its."""
    base = table()
    angles = np.zeros((4, 2))
    angles[0] = 0.3, 0.5
    odd = Floor(
        nodes=base.nodes, fixed=base.fixed, shells=base.shells, beams=base.beams, angles=angles
    )
    with pytest.raises(InputError, match="turn translations and rotations apart have no card"):
        export(Subject(structure=odd), tmp_path / "a.bdf")
