"""Cost and accuracy of exact statistics against the runs that would be as accurate.

The truck on the rear road of the reference unit, modes below 90 Hz, steps of 5 ms, 25 s: the method
of the paper's study that carries the verdict. Exact statistics with 400 waves against 1600 waves is
the quadrature error; runs scatter about the truth as their sample variance says. Monte Carlo of
equal accuracy would need as many runs as bring that scatter down to the quadrature error.
"""

import json
import time

import numpy as np
from settings import rear_layout

from trundle.response import exact_statistics, reduce_runs
from trundle.simulate import batches, harmonics

WAVES, FINE, RUNS = 400, 1600, 2000


def timed(work):
    start = time.perf_counter()
    found = work()
    return found, time.perf_counter() - start


def levels(statistics) -> np.ndarray:
    """Return RMS velocity and acceleration, and the band levels of the whole event."""
    bands = statistics.band_event()[0]
    rms = [statistics.rms()[0], statistics.rms("acceleration")[0]]
    return np.concatenate([rms, bands[np.isfinite(bands)]])


def sample(layout) -> tuple[np.ndarray, float, float]:
    """Return mean squares of every run, and the seconds of the runs alone and with levels."""
    squares, begun, spent = [], time.perf_counter(), 0.0
    steps = batches(layout, runs=range(RUNS), seed=1)
    while True:
        start = time.perf_counter()
        runs = next(steps, None)
        spent += time.perf_counter() - start
        if runs is None:
            break
        bands = reduce_runs(runs, averaging="event").spectra.values[:, 0]
        rms = [np.mean(x[..., 0] ** 2, axis=1) for x in (runs.velocity, runs.acceleration)]
        kept = bands[:, np.isfinite(bands[0])] ** 2
        squares.append(np.column_stack([*rms, kept]))
    return np.concatenate(squares), spent, time.perf_counter() - begun


def main() -> None:
    layout = rear_layout(f_max=90.0, dt=0.005, duration=25.0)
    few, answers_s = timed(lambda: list(harmonics(layout, n_waves=WAVES)))
    exact, sums_s = timed(lambda: exact_statistics(few, f_max=layout.f_max))
    del few
    fine = exact_statistics(harmonics(layout, n_waves=FINE), f_max=layout.f_max)
    truth = levels(fine)
    error = np.abs(levels(exact) / truth - 1.0)
    squares, runs_s, whole_s = sample(layout)
    # of a root of a mean square: half the relative scatter of that mean
    scatter = 0.5 * squares.std(axis=0, ddof=1) / squares.mean(axis=0) / np.sqrt(RUNS)
    apart = (np.sqrt(squares.mean(axis=0)) / truth - 1.0) / scatter
    equal = RUNS * (scatter / error) ** 2
    thousand = runs_s * 1000 / RUNS
    print(
        json.dumps(
            {
                "waves": WAVES,
                "exact_answers_s": round(answers_s, 2),
                "exact_sums_s": round(sums_s, 2),
                "1000_runs_s": round(thousand, 2),
                "1000_runs_with_levels_s": round(whole_s * 1000 / RUNS, 2),
                "answers_over_1000_runs": round(answers_s / thousand, 3),
                "exact_over_1000_runs_with_levels": round(
                    (answers_s + sums_s) / (whole_s * 1000 / RUNS), 3
                ),
                "stated_quadrature_error": round(exact.quadrature_error, 5),
                "true_quadrature_error_largest": round(float(error.max()), 5),
                "scatter_of_2000_runs_largest": round(float(scatter.max()), 5),
                "2000_runs_from_exact_in_scatters_largest": round(float(np.abs(apart).max()), 2),
                "runs_of_equal_accuracy_median": int(np.median(equal)),
            }
        )
    )


if __name__ == "__main__":
    main()
