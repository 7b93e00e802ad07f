"""Switch on the run-time check of array shapes, and keep numerics on one thread a worker."""

import os

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")

from jaxtyping import install_import_hook  # noqa: E402  (threads are set before numpy loads)

NUMERIC = (
    "dynamics", "signals", "road", "vehicle", "structure", "route", "simulate", "response",
    "criteria",
)  # fmt: skip
install_import_hook([f"trundle.{name}" for name in NUMERIC], "shape_checker.check")
