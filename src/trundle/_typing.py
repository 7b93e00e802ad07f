"""Name the array types that signatures share.

Shapes are checked at run time only in the tests, where jaxtyping's import hook is on.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
from scipy import sparse

Array: TypeAlias = np.ndarray
"""Any numpy array; a signature that knows the axes says so with `jaxtyping`."""

SparseMatrix: TypeAlias = sparse.csc_array | sparse.csr_array
"""A scipy sparse array in column or row form."""

Matrix: TypeAlias = np.ndarray | sparse.csc_array | sparse.csr_array
"""A dense or sparse real matrix."""

ArrayLike: TypeAlias = float | Sequence[Any] | np.ndarray
"""Numbers at the public edge: one, a sequence of them (nested or not), or an array."""
