"""What reduced parts show of themselves, against masses by hand and spoilt reductions."""

import functools
from dataclasses import replace

import numpy as np

from towers import HEIGHT, SPAN, halfway, tower
from trundle.structure.superelements import Cuts, Parting
from trundle.structure.superelements.evidence import evidence_of


@functools.cache
def parted():
    floor = tower(storeys=3, bays_x=2, bays_y=1, mesh_size=1.5, beams=False)
    return Parting(cuts=Cuts(z=halfway(3)), f_parts=60.0, f_seams=60.0).of(floor)


def test_a_storey_weighs_its_slab_and_columns_in_all_directions():
    """Middle storey, by hand: 12 m x 6 m of slab with its load, six columns one storey high."""
    (middle,) = [e for e in parted().evidence() if not e.grounded and e.n_boundary > 40]
    density = parted().whole.shells[0].section.material.density
    slab = SPAN * 2 * SPAN * (0.2 * density + 200.0)
    posts = 6 * 0.4 * 0.4 * HEIGHT * density
    np.testing.assert_allclose(middle.mass[:3], slab + posts, rtol=1e-6)


def test_a_free_part_follows_a_rigid_motion_without_strain_and_loses_no_mass():
    """Storeys above the ground: strain and error of mass are round-off; the lowest one is held."""
    found = parted().evidence()
    free = [e for e in found if not e.grounded]
    assert len(free) == len(found) - 1
    for one in free:
        assert np.abs(one.mass_error).max() < 1e-8
        assert np.abs(one.strain).max() < 1e-9
    (ground,) = [e for e in found if e.grounded]
    assert set(ground.grounded) >= {"x", "y", "z"}


def test_modes_carry_more_of_what_is_inside_the_more_are_kept():
    """Effective mass rises towards 1 with the band, and never beyond (Bessel's inequality)."""
    floor = parted().whole
    shares = []
    for band in (30.0, 120.0, 1000.0):
        cut = Parting(cuts=Cuts(z=halfway(3)), f_parts=band, f_seams=band).of(floor)
        shares.append(min(e.effective[2] for e in cut.evidence()))
        assert max(e.effective.max() for e in cut.evidence()) <= 1.0 + 1e-9
    assert shares[0] <= shares[1] <= shares[2]
    assert shares[2] > 0.9


def test_spoilt_mass_and_a_hidden_spring_are_seen():
    """A hundredth more mass, and a spring to the ground at one dof of the boundary."""
    number = next(i for i, e in enumerate(parted().evidence()) if not e.grounded)
    piece, part = parted().pieces.distinct[number], parted().joined.parts[number]
    heavy = evidence_of(piece, replace(part, mass=1.01 * part.mass))
    np.testing.assert_allclose(heavy.mass_error, 0.01, rtol=1e-6)
    spring = part.stiffness.copy()
    row = int(np.flatnonzero(piece.kinds[part.boundary] == 2)[0])
    spring[row, row] += spring[row, row]
    assert "z" in evidence_of(piece, replace(part, stiffness=spring)).grounded
