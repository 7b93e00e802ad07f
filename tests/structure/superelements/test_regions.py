"""Parts that are given by their outlines."""

import numpy as np
import pytest
from scipy import sparse

from towers import HEIGHT, SPAN, halfway, tower
from trundle.errors import InputError
from trundle.structure.superelements import Cuts, Parting, Region
from trundle.structure.superelements.cuts import shares_of
from trundle.structure.superelements.regions import shares_by_region

LIKE = {"f_parts": 40.0, "f_seams": 100.0}


def box(name, x, y, **heights):
    (a, b), (c, d) = x, y
    return Region(
        name=name, outline=np.array([[a, c], [b, c], [b, d], [a, d]], dtype=float), **heights
    )


def sums_of(shares, count):
    """Return by which share each element of a group lies in each piece."""
    found = []
    for share in shares:
        table = np.zeros((share.element.max(initial=-1) + 1, count))
        np.add.at(table, (share.element, share.piece), share.weight)
        found.append(table)
    return found


def test_outlines_where_planes_could_be_cut_the_same():
    """Two by two bays on two storeys, given as eight boxes and cut by planes: the same shares of
    every element, beams between units by halves and columns at the corner of four by quarters."""
    floor = tower(storeys=2, bays_x=2, bays_y=2, mesh_size=1.5)
    middle = float(halfway(2)[0])
    planes = Cuts(x=np.array([SPAN]), y=np.array([SPAN]), z=np.array([middle]))
    edges = ((-1.0, SPAN), (SPAN, 2 * SPAN + 1.0))
    regions = tuple(
        box(f"{i}{j}{k}", x, y, low=low, high=high)
        for i, x in enumerate(edges)
        for j, y in enumerate(edges)
        for k, (low, high) in enumerate(((-np.inf, middle), (middle, np.inf)))
    )
    given = shares_of(floor.elements, floor.nodes, Cuts(regions=regions))
    cut = shares_of(floor.elements, floor.nodes, planes)
    weights = np.concatenate([share.weight for share in given])
    assert {0.25, 0.5, 1.0} == set(weights)
    for mine, theirs in zip(sums_of(given, 8), sums_of(cut, 8), strict=True):
        np.testing.assert_array_equal(mine, theirs)


L_SHAPE = np.array([[-1, -1], [13, -1], [13, 6], [6, 6], [6, 13], [-1, 13]], dtype=float)


def test_an_l_shaped_part_and_what_is_left():
    """Three bays by one outline, the fourth by planes through all: sound as the whole is.

    Rayleigh and Ritz: no frequency is too low; at twice the band, within 1 %. Pieces add up to the
    whole's matrices."""
    floor = tower(storeys=2, bays_x=2, bays_y=2, mesh_size=1.0)
    region = Region(name="three bays", outline=L_SHAPE)
    cuts = Cuts(z=halfway(2), regions=(region,))
    parted = Parting(cuts=cuts, **LIKE).of(floor)
    assert len(parted.pieces.placed) == 3  # the rest on two storeys, and the given one across both
    total = sparse.csc_array((floor.n_dofs, floor.n_dofs))
    for own in parted.pieces.placed:
        k = parted.pieces.distinct[own.kind].stiffness.tocoo()
        values = k.data * own.sign[k.row] * own.sign[k.col]
        total += sparse.coo_array((values, (own.dofs[k.row], own.dofs[k.col])), shape=total.shape)
    assert abs(total - floor.stiffness).max() < 1e-9 * abs(floor.stiffness).max()
    found, expected = parted.modes(20.0).omega, floor.modes(20.0).omega
    n = len(found)
    assert n > 10
    assert np.all(found >= expected[:n] * (1.0 - 1e-9))
    np.testing.assert_allclose(found, expected[:n], rtol=1e-2)


def test_a_slanting_outline_shares_what_lies_along_it():
    """A beam along the diagonal belongs to both sides by half; one across it to one of them, whole."""
    nodes = np.array([[0, 0, 0], [4, 4, 0], [2, 0, 0], [2, 4, 0], [0, 4, 0]], dtype=float)
    ends = np.array([[0, 1], [2, 3], [0, 4]])
    region = Region(name="lower", outline=np.array([[0, 0], [4, 0], [4, 4]], dtype=float))
    np.testing.assert_array_equal(
        shares_by_region(nodes, ends, [region]), [[0.5, 0.5], [1.0, 0.0], [0.0, 1.0]]
    )


def test_copies_of_a_part_are_reduced_once():
    """Four equal bays in a row, given one by one: ends are mirrored, and so are those between."""
    floor = tower(storeys=1, bays_x=4, bays_y=1, mesh_size=1.5)
    bays = tuple(box("bay", (SPAN * i, SPAN * (i + 1)), (-1.0, SPAN + 1.0)) for i in range(4))
    pieces = Parting(cuts=Cuts(regions=bays), **LIKE).of(floor).pieces
    assert len(pieces.placed) == 4
    assert len(pieces.distinct) == 2


def test_what_is_given_decides_what_is_kept():
    """Equal cuts have one hash, another outline or height another one."""
    floor = tower(storeys=2, mesh_size=2.0)
    one = box("a", (-1.0, SPAN), (-1.0, 7.0))
    hashes = {
        Parting(cuts=Cuts(regions=(region,)), **LIKE).of(floor).content_hash
        for region in (
            one,
            box("b", (-1.0, SPAN), (-1.0, 7.0)),
            box("a", (-1.0, SPAN), (-1.0, 8.0)),
            box("a", (-1.0, SPAN), (-1.0, 7.0), high=HEIGHT),
        )
    }
    assert len(hashes) == 3  # a name decides nothing


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Region(name="a", outline=np.zeros((3, 2))), "outline of three corners"),
        (lambda: Region(name="a", outline=L_SHAPE[:2]), "outline of three corners"),
        (lambda: Region(name="a", outline=L_SHAPE[[0, 2, 1, 4]]), "cross"),
        (lambda: box("a", (0, 1), (0, 1), low=2.0, high=2.0), "end above where it begins"),
        (
            lambda: Cuts(regions=(box("a", (0, 2), (0, 1)), box("b", (1, 3), (0, 1)))),
            "'a' and 'b' overlap",
        ),
    ],
)
def test_no_part_is_made_of_nothing(make, words):
    with pytest.raises(InputError, match=words):
        make()


def test_parts_that_touch_or_lie_over_each_other_do_not_overlap():
    """Nor do strips of a millimetre, as a rounded place leaves."""
    left, right = box("a", (0, 2), (0, 1)), box("b", (2 - 5e-4, 3), (0, 1))
    over = box("c", (0, 3), (0, 1), low=4.0)
    assert not left.overlaps(right)
    assert not box("a", (0, 2), (0, 1), high=4.0).overlaps(over)
    assert left.overlaps(over)


def test_a_part_in_which_nothing_lies_is_refused():
    floor = tower(storeys=1, mesh_size=2.0)
    far = box("annex", (100.0, 110.0), (0.0, 5.0))
    with pytest.raises(InputError, match="'annex' nothing"):
        shares_of(floor.elements, floor.nodes, Cuts(regions=(far,)))
