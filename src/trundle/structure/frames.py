"""Build local element frames and turn element matrices into global axes."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from trundle._typing import Array
from trundle.errors import InputError

__all__ = ["beam_frames", "plate_areas", "rotate_blocks", "shell_frames", "triangle_frames"]

_NEEDLE = 1e-9  # sine of an angle below which a triangle is a line
_FLATNESS = 1e-3  # warp over size; a flat element cannot carry more and stay consistent


def plate_areas(corners: Float[Array, "elements corners 3"]) -> Float[Array, " elements"]:
    """Return the areas of triangles, or of quadrilaterals by their diagonals [m2]."""
    first, last = (3, 1) if corners.shape[1] == 4 else (1, 0)
    across = np.cross(corners[:, 2] - corners[:, 0], corners[:, first] - corners[:, last])
    return 0.5 * np.linalg.norm(across, axis=1)


def shell_frames(
    corners: Float[Array, "elements 4 3"],
) -> tuple[Float[Array, "elements 4 2"], Float[Array, "elements 3 3"]]:
    """Return in-plane corner coordinates and frames (rows x, y, z) of flat quadrilaterals.

    Raises
    ------
    InputError
        An element without area, or warped by more than 0.1 % of its size.
    """
    diagonal_1 = corners[:, 2] - corners[:, 0]
    diagonal_2 = corners[:, 3] - corners[:, 1]
    normal = np.cross(diagonal_1, diagonal_2)
    length = np.linalg.norm(normal, axis=1)
    if np.any(length <= 0.0):
        raise InputError(f"shell element {int(np.argmin(length))} has no area")
    z_axis = normal / length[:, None]
    edge = corners[:, 1] + corners[:, 2] - corners[:, 0] - corners[:, 3]
    x_axis = edge - np.sum(edge * z_axis, axis=1, keepdims=True) * z_axis
    x_axis /= np.linalg.norm(x_axis, axis=1, keepdims=True)
    frames = np.stack([x_axis, np.cross(z_axis, x_axis), z_axis], axis=1)
    local = np.einsum("eij,eaj->eai", frames, corners - corners.mean(axis=1, keepdims=True))
    warp = np.abs(local[:, :, 2]).max(axis=1) / np.sqrt(length)
    if np.any(warp > _FLATNESS):
        bad = int(np.argmax(warp))
        raise InputError(
            f"shell element {bad} is warped by {100 * warp[bad]:.2g} % of its size; "
            "a flat shell allows 0.1 %: split it or refine the mesh there"
        )
    return local[:, :, :2], frames


def triangle_frames(
    corners: Float[Array, "elements 3 3"],
) -> tuple[Float[Array, "elements 3 2"], Float[Array, "elements 3 3"]]:
    """Return in-plane corner coordinates and frames (rows x, y, z) of triangles.

    Raises
    ------
    InputError
        An element without area.
    """
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    normal = np.cross(first, second)
    length = np.linalg.norm(normal, axis=1)
    size = np.linalg.norm(first, axis=1) * np.linalg.norm(second, axis=1)
    thin = length <= _NEEDLE * size
    if np.any(thin):
        raise InputError(f"shell element {int(np.argmax(thin))} has no area")
    z_axis = normal / length[:, None]
    x_axis = first / np.linalg.norm(first, axis=1, keepdims=True)
    frames = np.stack([x_axis, np.cross(z_axis, x_axis), z_axis], axis=1)
    local = np.einsum("eij,eaj->eai", frames, corners - corners.mean(axis=1, keepdims=True))
    return local[:, :, :2], frames


def beam_frames(
    ends: Float[Array, "elements 2 3"], up: Float[Array, " 3"]
) -> tuple[Float[Array, " elements"], Float[Array, "elements 3 3"]]:
    """Return lengths and frames (rows x, y, z) of straight members.

    Local x runs from the first end to the second; local z is the part of `up` normal to x,
    or of global x where the member is parallel to `up`, or of global z where it is along x too.

    Raises
    ------
    InputError
        A member without length, or an `up` without direction.
    """
    along = ends[:, 1] - ends[:, 0]
    lengths = np.linalg.norm(along, axis=1)
    if np.any(lengths <= 0.0):
        raise InputError(f"beam element {int(np.argmin(lengths))} has no length")
    x_axis = along / lengths[:, None]
    reference = np.broadcast_to(up, x_axis.shape).copy()
    size = float(np.linalg.norm(up))
    if not size > 0.0:
        raise InputError("up must be a direction; got 0, 0, 0")
    parallel = np.linalg.norm(np.cross(x_axis, reference), axis=1) < 1e-6 * size
    reference[parallel] = np.array([1.0, 0.0, 0.0])
    along_x = np.linalg.norm(x_axis[:, 1:], axis=1) < 1e-6
    reference[parallel & along_x] = np.array([0.0, 0.0, 1.0])
    z_axis = reference - np.sum(reference * x_axis, axis=1, keepdims=True) * x_axis
    z_axis /= np.linalg.norm(z_axis, axis=1, keepdims=True)
    return lengths, np.stack([x_axis, np.cross(z_axis, x_axis), z_axis], axis=1)


def rotate_blocks(
    matrices: Float[Array, "elements n n"], frames: Float[Array, "elements 3 3"]
) -> Float[Array, "elements n n"]:
    """Turn element matrices from local axes to global ones, three dofs at a time."""
    n_elements, size, _ = matrices.shape
    blocks = matrices.reshape(n_elements, size // 3, 3, size // 3, 3)
    # T^T K T with T = diag(R, R, ...), R mapping global vectors to local ones
    turned = np.einsum("eki,eakbl,elj->eaibj", frames, blocks, frames, optimize=True)
    return turned.reshape(n_elements, size, size)
