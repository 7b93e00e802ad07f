"""Time all modes of the reference unit below 100 Hz, against scipy's eigsh for as many.

Processor time counts, of one process; the count is proved by inertia. `--eigsh` runs the peer too,
which takes minutes.
"""

import argparse
import json
import time

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import LinearOperator, eigsh

import trundle as tr
from trundle.dynamics import available_backends, factorise, natural_modes

F_MAX = 100.0


def timed(work):
    start, cpu = time.perf_counter(), time.process_time()
    found = work()
    return found, time.perf_counter() - start, time.process_time() - cpu


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--eigsh", action="store_true", help="time scipy's eigsh beside it")
    options = parser.parse_args()
    floor = tr.structure.reference_unit(mesh_size=1.0)
    report = {"n_dofs": floor.n_dofs}
    modes = None
    for backend in available_backends():
        modes, wall, cpu = timed(
            lambda backend=backend: natural_modes(
                floor.mass, floor.stiffness, f_max=F_MAX, backend=backend
            )
        )
        report |= {
            f"{backend}_wall_s": round(wall, 1),
            f"{backend}_cpu_s": round(cpu, 1),
            f"{backend}_largest_residual": float(modes.residuals.max()),
        }
    report["modes"] = modes.n_modes
    if options.eigsh:
        shifted = sparse.csc_array(floor.stiffness + floor.mass)
        solve = factorise(shifted).solve
        inverse = LinearOperator(shifted.shape, matvec=solve, dtype=float)

        def peer():
            return eigsh(
                floor.stiffness, k=modes.n_modes, M=floor.mass, sigma=-1.0, OPinv=inverse,
                return_eigenvectors=True,
            )  # fmt: skip

        (values, _), wall, cpu = timed(peer)
        found = np.sqrt(np.sort(values)) / (2.0 * np.pi)
        report |= {
            "eigsh_wall_s": round(wall, 1),
            "eigsh_cpu_s": round(cpu, 1),
            "largest_difference": float(np.abs(found / modes.frequencies - 1).max()),
        }
    print(json.dumps(report))


if __name__ == "__main__":
    main()
