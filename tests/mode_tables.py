"""Write nodes, faces, matrices and modes of a floor as tables: read by the tests."""

import numpy as np

from trundle.imports import ModeFiles, units_of

SI = units_of("N, m")
DOFS = ("ux", "uy", "uz", "rx", "ry", "rz")


def write_nodes(path, floor, *, rows, length=1.0):
    heading = ["node", "x", "y", "z", *(DOFS if rows else ())]
    lines = [",".join(heading)]
    for i, place in enumerate(floor.nodes):
        cells = [f"N{i}", *(repr(float(c) / length) for c in place)]
        if rows:
            cells += ["" if r < 0 else str(r + 1) for r in floor.dof_index[i]]
        lines.append(",".join(cells))
    path.write_text("\n".join(lines) + "\n")


def write_elements(path, floor):
    corners = np.concatenate([group.connectivity for group in floor.shells])
    rows = [",".join(f"N{c}" for c in row) for row in corners]
    path.write_text("\n".join(["node 1,node 2,node 3,node 4", *rows]) + "\n")


def of_units(floor, units):
    """Return the matrices of a floor in other units, as another program would have them."""
    turning = np.zeros(floor.n_dofs)
    rows = floor.dof_index[:, 3:]
    turning[rows[rows >= 0]] = 1.0
    scale = units.length ** (-turning)
    mass, stiffness = (m.toarray() * np.outer(scale, scale) for m in floor.matrices())
    return mass / units.mass, stiffness / units.of(1, -1)


def mode_tables(folder, floor, f_max, *, scale=1.0, mass=True, wide=False, units=SI):
    """Write a floor's modes, every shape times a number of its own, as another program would."""
    modes = floor.modes(f_max)
    by = scale * (1.0 + np.arange(modes.n_modes))  # any scale, told by the modal mass
    heading = "Mode, Frequency [Hz]" + (", Modal mass" if mass else "")
    lines = [heading] + [
        f"{i + 1}, {f!r}" + (f", {float(by[i] ** 2 / units.mass)!r}" if mass else "")
        for i, f in enumerate(modes.frequencies.tolist())
    ]
    (folder / "f.csv").write_text("\n".join(lines) + "\n")
    shapes = np.zeros((len(floor.nodes), 6, modes.n_modes))
    shapes[floor.dof_index >= 0] = modes.shapes[floor.dof_index[floor.dof_index >= 0]] * by
    shapes[:, 3:] *= units.length
    if wide:
        names = [f"mode {i + 1}" for i in range(modes.n_modes)]
        rows = [["node", *names]] + [
            [f"N{i}", *map(repr, row)] for i, row in enumerate(shapes[:, 2].tolist())
        ]
    else:
        rows = [["Joint", "StepNum", "U1", "U2", "U3", "R1", "R2", "R3"]] + [
            [f"N{i}", str(k + 1), *map(repr, shapes[i, :, k].tolist())]
            for k in range(modes.n_modes)
            for i in range(len(shapes))
        ]
    (folder / "s.csv").write_text("\n".join(",".join(row) for row in rows) + "\n")
    write_nodes(folder / "n.csv", floor, rows=False, length=units.length)
    write_elements(folder / "e.csv", floor)
    return modes


def files(folder, *, elements=True):
    return ModeFiles(
        frequencies=folder / "f.csv",
        shapes=folder / "s.csv",
        nodes=folder / "n.csv",
        elements=folder / "e.csv" if elements else None,
    )
