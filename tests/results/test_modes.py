"""What is kept of natural modes: every frequency, and the first shapes as nodes move upwards."""

import numpy as np

from models import small_floor
from trundle.results.modes import first_modes


def test_all_frequencies_and_eight_shapes_are_kept():
    """Each shape is the vertical entry of the mode at every node, and nothing where it is held."""
    floor = small_floor(mesh_size=1.5)
    modes = floor.modes(90.0)
    found = first_modes(modes, floor)
    assert modes.n_modes > 8
    assert found.n_modes == modes.n_modes
    np.testing.assert_array_equal(found.frequencies, modes.frequencies)
    assert found.vertical.shape == (len(floor.nodes), 8)
    dofs = floor.dof_index[:, 2]
    moving = dofs >= 0
    np.testing.assert_allclose(found.vertical[moving], modes.shapes[dofs[moving], :8])
    assert (~moving).any()
    assert (found.vertical[~moving] == 0.0).all()
