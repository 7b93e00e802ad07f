"""How the work grows: time of the kernel with runs and modes, of modes and direct steps with dofs.

Writes docs/images/scaling.svg, three log-log figures with their fitted slopes.
"""

import json
import time
from pathlib import Path

import numpy as np
from direct_step import DAMPING, NEWMARK, back_substitution
from matplotlib import rc_context
from settings import rear_layout

import trundle as tr
from trundle.dynamics import natural_modes
from trundle.report.canvas import COLOURS, STYLE, make_logarithmic, new_figure
from trundle.simulate import prepare
from trundle.simulate.ensembles import batch_size
from trundle.simulate.wheels.roads import roads_under_wheels

PICTURE = Path(__file__).resolve().parents[1] / "docs" / "images" / "scaling.svg"
RUNS = (10, 30, 100, 300, 1000, 3000, 10000)
MODES = (60, 120, 250, 500, 1000)
MESHES = (4.0, 3.0, 2.0, 1.5, 1.0)


def kernel_seconds(layout, n_runs: int) -> float:
    """Return the time of runs, their roads drawn beforehand, batch by batch."""
    spent, size = 0.0, batch_size(layout)
    for first in range(0, n_runs, size):
        road = roads_under_wheels(
            layout.sources, layout.timeline, range(first, min(first + size, n_runs)), seed=1
        )
        start = time.perf_counter()
        layout.over(road)
        spent += time.perf_counter() - start
    return spent


def over_dofs() -> dict[str, list[float]]:
    found: dict[str, list[float]] = {"dofs": [], "modes": [], "step": []}
    for size in MESHES:
        floor = tr.structure.reference_unit(mesh_size=size)
        start = time.perf_counter()
        natural_modes(floor.mass, floor.stiffness, f_max=20.0)
        found["modes"].append(time.perf_counter() - start)
        found["step"].append(back_substitution(prepare(floor, NEWMARK, DAMPING)))
        found["dofs"].append(floor.n_dofs)
    return found


def slope(x, y) -> float:
    """Return the order of growth over the upper half of the sizes."""
    half = len(x) // 2
    return float(np.polyfit(np.log(x[half:]), np.log(y[half:]), 1)[0])


def draw(panels) -> None:
    with rc_context(STYLE):
        figure, axes = new_figure(9.6, 3.2, columns=3)
        for panel, (label, x, curves) in zip(axes, panels, strict=True):
            for colour, (name, y) in zip(COLOURS, curves.items(), strict=False):
                text = f"{name}, order {slope(x, y):.2f}"
                panel.plot(x, y, marker="o", markersize=4, color=colour, label=text)
            make_logarithmic(panel, "xy")
            panel.set(xlabel=label, ylabel="time [s]")
            panel.legend(loc="upper left")
            panel.set_ylim(
                0.3 * min(map(min, curves.values())), 6.0 * max(map(max, curves.values()))
            )
        figure.savefig(PICTURE, metadata={"Date": None})


def main() -> None:
    layout = rear_layout(f_max=20.0, dt=0.025, duration=25.0)
    runs = [kernel_seconds(layout, n) for n in RUNS]
    modes = [
        kernel_seconds(rear_layout(n_modes=n, dt=0.005, duration=10.0), 512) for n in MODES
    ]  # fmt: skip
    dofs = over_dofs()
    panels = [
        ("runs (166 modes, 1000 steps)", RUNS, {"ensemble kernel": runs}),
        ("modes (512 runs, 2000 steps)", MODES, {"ensemble kernel": modes}),
        (
            "degrees of freedom",
            dofs["dofs"],
            {"modes below 20 Hz": dofs["modes"], "a back-substitution": dofs["step"]},
        ),
    ]
    draw(panels)
    found = {
        label: {name: round(slope(x, y), 2) for name, y in curves.items()}
        for label, x, curves in panels
    }
    print(json.dumps({"order_of_growth": found, "picture": PICTURE.name}))


if __name__ == "__main__":
    main()
