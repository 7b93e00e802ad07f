"""Nodes that follow others: exact rigid motion, closed forms, flat slabs that settle."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve

from models import small_floor, small_plan
from studies import GOOD
from trundle.dynamics import natural_modes
from trundle.errors import InputError
from trundle.route import contact_rows
from trundle.structure import (
    CONCRETE,
    BeamGroup,
    BeamSection,
    Floor,
    Hermite,
    Rectangle,
    RigidLinks,
    build_floor,
    node_motion,
    reference_plan,
)
from trundle.study.doubts import study_doubts
from trundle.study_file import study_from_text

ALONG_X = np.array([[1.0, 0.0]])


def linked(**changes):
    """A small flat slab on two columns of half a metre, joined over their cross-section."""
    settings = {
        "beams_x": None, "beams_y": None, "column": Rectangle(width=0.5, depth=0.7),
        "column_heads": "rigid", "x_lines": np.array([2.0, 7.0]), "y_lines": np.array([3.0]),
    }  # fmt: skip
    return build_floor(small_plan(**{**settings, **changes}), mesh_size=0.7)


def test_what_follows_moves_as_a_rigid_body():
    """Every node that follows: ``u = u_0 + theta_0 x r`` and the same rotation, for any motion."""
    floor = linked()
    (links,) = floor.links
    assert len(links.follows) > 8
    q = np.random.default_rng(1).standard_normal(floor.n_dofs)
    motion = np.stack([node_motion(floor, dof) @ q for dof in range(6)], axis=1)
    arm = floor.nodes[links.follows] - floor.nodes[links.leads]
    lead = motion[links.leads]
    expected = lead[:, :3] + np.cross(lead[:, 3:], arm)
    np.testing.assert_allclose(motion[links.follows, :3], expected, atol=1e-12)
    np.testing.assert_allclose(motion[links.follows, 3:], lead[:, 3:], atol=1e-12)


def test_links_take_no_energy_and_no_mass():
    """A free slab with rigid zones: six motions without energy, the mass of the slab without."""
    plan = {"storey_below": 0.0, "storey_above": 0.0, "column": None}
    loose = small_floor(mesh_size=1.0, beams_x=None, beams_y=None, **plan)
    inner = [loose.nearest_node(x, y) for x, y in ((4.0, 3.0), (5.0, 3.0), (4.0, 4.0))]
    links = RigidLinks(leads=np.array([inner[0]] * 2), follows=np.array(inner[1:]))
    floor = Floor(nodes=loose.nodes, fixed=loose.fixed, shells=loose.shells, links=(links,))
    assert floor.n_dofs == loose.n_dofs - 12
    values = np.linalg.eigvalsh(floor.stiffness.toarray())
    assert np.count_nonzero(values < 1e-9 * values[-1]) == 6
    assert floor.moving_mass() == pytest.approx(loose.moving_mass(), rel=1e-12)


def test_a_rigid_end_is_a_longer_lever():
    """Cantilever of L with a rigid arm a: ``P (L^3 / 3 + L^2 a + L a^2) / E I`` at its end."""
    length, arm, inertia = 3.0, 0.8, 1e-4
    section = BeamSection(
        area=1.0, inertia_y=inertia, inertia_z=inertia, torsion_constant=inertia,
        shear_area_y=np.inf, shear_area_z=np.inf, material=CONCRETE,
    )  # fmt: skip
    nodes = np.array([[0.0, 0, 0], [length, 0, 0], [length + arm, 0.3, 0]])
    fixed = np.zeros((3, 6), dtype=bool)
    fixed[0] = True
    floor = Floor(
        nodes=nodes, fixed=fixed, beams=(BeamGroup(elements=np.array([[0, 1]]), section=section),),
        links=(RigidLinks(leads=np.array([1]), follows=np.array([2])),),
    )  # fmt: skip
    load = node_motion(floor, 2)[2].toarray().ravel() * 1e3
    sunk = float((node_motion(floor, 2) @ spsolve(floor.stiffness, load))[2])
    rigidity = CONCRETE.elastic_modulus * inertia
    bent = 1e3 * (length**3 / 3 + length**2 * arm + length * arm**2) / rigidity
    twisted = 1e3 * 0.3**2 * length / (CONCRETE.shear_modulus * inertia)
    assert sunk == pytest.approx(bent + twisted, rel=1e-9)


def test_a_wheel_over_a_column_stands_on_a_plane():
    """Within the column: deflection and slope are those of the head's rigid motion."""
    floor = linked()
    head = floor.nearest_node(7.0, 3.0)
    q = np.random.default_rng(4).standard_normal(floor.n_dofs)
    w, rx, ry = (q[floor.dof_index[head, dof]] for dof in (2, 3, 4))
    places = np.array([7.0, 3.0]) + np.array([[0.1, 0.05], [-0.3, 0.2], [0.34, -0.24]])
    rows = contact_rows(floor, places, np.repeat(ALONG_X, 3, axis=0), shape=Hermite())
    arm = places - [7.0, 3.0]
    expected = w + rx * arm[:, 1] - ry * arm[:, 0]
    np.testing.assert_allclose(rows.matrix(rows.value) @ q, expected, atol=1e-10)
    np.testing.assert_allclose(rows.matrix(rows.slope) @ q, -ry, atol=1e-10)


def test_a_wheel_beside_a_column_meets_no_step():
    """Across the column's face deflection and slope are continuous, as elsewhere on rectangles."""
    floor = linked()
    q = np.random.default_rng(5).standard_normal(floor.n_dofs)
    at = np.array([[7.35 - 1e-9, 3.1], [7.35 + 1e-9, 3.1]])
    rows = contact_rows(floor, at, np.repeat(ALONG_X, 2, axis=0), shape=Hermite())
    for weights in (rows.value, rows.slope):
        before, behind = rows.matrix(weights) @ q
        assert before == pytest.approx(behind, abs=1e-6)


def test_a_flat_slab_settles_as_its_mesh_is_refined():
    """First frequency: 5 % from 0.75 to 0.375 m, 2 % to 0.19 m; at one node it keeps falling."""
    found = {}
    for heads in ("point", "rigid"):
        plan = small_plan(
            beams_x=None, beams_y=None, x_lines=np.array([1.5, 9.5]), y_lines=np.array([1.5, 9.5]),
            x_extent=(0.0, 11.0), y_extent=(0.0, 11.0), column_heads=heads,
            column=Rectangle(width=0.5, depth=0.5),
        )  # fmt: skip
        floors = [build_floor(plan, mesh_size=h) for h in (0.75, 0.375, 0.1875)]
        found[heads] = [
            natural_modes(f.mass, f.stiffness, f_max=9.0).frequencies[0] for f in floors
        ]
    change = {heads: 1.0 - np.array(f[1:]) / f[:-1] for heads, f in found.items()}
    assert 0.0 < change["rigid"][0] < 0.05
    assert 0.0 < change["rigid"][1] < 0.02
    assert change["rigid"][0] > 2.0 * change["rigid"][1]
    assert change["point"][1] > 0.05


def test_columns_on_planes_of_symmetry_are_joined_too():
    """The reference unit: half columns on its mirror planes lead what they have of a section."""
    plan = replace(reference_plan(), column_heads="rigid")
    floor = build_floor(plan, mesh_size=3.5)
    needles = replace(floor, links=())  # the same mesh, each column at one node
    assert len(floor.links[0].follows) >= 3 * 25
    firsts = [
        natural_modes(f.mass, f.stiffness, f_max=6.0).frequencies[0] for f in (needles, floor)
    ]
    assert firsts[0] < firsts[1] < 1.1 * firsts[0]
    assert floor.moving_mass() == pytest.approx(needles.moving_mass(), rel=1e-3)


@pytest.mark.parametrize(
    ("leads", "follow", "said"),
    [
        ([0, 1], [2, 2], "follows two others"),
        ([0, 2], [2, 3], "leads others and follows one itself"),
        ([0], [99], "node numbers must be 0 to"),
    ],
)
def test_links_that_cannot_be_are_refused(leads, follow, said):
    floor = small_floor(mesh_size=3.0)
    with pytest.raises(InputError, match=said):
        Floor(
            nodes=floor.nodes, fixed=floor.fixed, shells=floor.shells, beams=floor.beams,
            links=(RigidLinks(leads=np.array(leads), follows=np.array(follow)),),
        )  # fmt: skip


def test_a_held_node_that_should_follow_is_refused():
    floor = small_floor(mesh_size=3.0)
    fixed = floor.fixed.copy()
    fixed[1, 2] = True
    held = Floor(
        nodes=floor.nodes, fixed=fixed, shells=floor.shells, beams=floor.beams,
        links=(RigidLinks(leads=np.array([0]), follows=np.array([1])),),
    )  # fmt: skip
    with pytest.raises(InputError, match="node 1 is held, and follows a node that moves"):
        _ = held.stiffness


def test_studies_can_ask_for_it():
    """``column_heads = "rigid"``: links are there, and the doubt about needles is gone."""
    flat = GOOD.replace("beams_x = { width", "# beams_x = { width")
    assert any("as a needle" in str(d) for d in study_doubts(study_from_text(flat)))
    rigid = flat.replace("[vehicle.truck]", 'column_heads = "rigid"\n\n[vehicle.truck]')
    study = study_from_text(rigid)
    assert study.floor.links
    assert not any("as a needle" in str(d) for d in study_doubts(study))
