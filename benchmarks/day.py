"""Run a day of 400 passages on the reference unit, beside the same passages by themselves.

Two routes under the container truck, coupled, modes below 112 Hz, steps of 5 ms, two points, nine
curves. Timed in turn (processor time, layouts and modes left out of both): the passages as an
ensemble of runs, whose histories are thrown away; and the day, in which they are added up, filtered
into all bands and held against every curve, with the check of the closest meeting. Beside them one
passage at a time, as an ensemble of one run. With `--hour`: a process of its own that runs an hour
of 30 vehicles; its peak of resident memory, above that of the prepared floor too.
"""

import argparse
import json
import resource
import subprocess
import sys
import time

import numpy as np

import trundle as tr
from trundle.criteria import VC, watched
from trundle.run.mode_cache import modes_of
from trundle.simulate import Coupled, Crossing, Modal, batches, coverage_of, lay_out, prepare
from trundle.traffic import Poisson, Schedule, lay_out_meeting, meeting_error, on_one_day

POINTS = {"centre": tr.structure.Spot(32.5, 62.5), "bay": tr.structure.Spot(29.0, 52.0)}
WAYS = {"rear": ((0, 76.5), (52, 76.5)), "front": ((0, 12.5), (52, 12.5))}
LEAST = dict.fromkeys(WAYS, 12.5 / (15 / 3.6) + 2.0)  # s: a truck's length, and two seconds
BAND = tr.road.RoughnessBand(n_max=22.0, contact_patch=0.2)


def resident() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3


def prepared_layouts():
    floor = tr.structure.reference_unit(mesh_size=1.0)
    method = Coupled(integration=Modal(f_max=112.0, dt=0.005))
    modes = modes_of(floor, f_max=112.0)
    prepared = prepare(floor, method.integration, method.damping, modes=modes)
    layouts = {}
    for name, (start, end) in WAYS.items():
        route = tr.route.Route.straight(start, end, speed=15 / 3.6, name=name)
        crossing = Crossing(
            tr.vehicle.container_truck_40ft(), route, tr.road.RoadClass("B"), band=BAND
        )
        length = float(np.ceil(crossing.exit_time + 6.0))
        layouts[name] = lay_out(prepared, crossing, method=method, points=POINTS, duration=length)
    return prepared, layouts


def watched_curves(layouts):
    first = next(iter(layouts.values()))
    coverage = coverage_of(first.sources, float(first.time[-1]))
    return watched(VC, f_max=first.f_max, sampling_frequency=200.0, coverage=coverage)[0]


def a_day(prepared, layouts, departures) -> dict:
    tally = on_one_day(layouts, departures, watched_curves(layouts), seed=1)
    meeting = lay_out_meeting(prepared, layouts, departures, POINTS)
    error = meeting_error(layouts, departures, meeting, seed=1)
    return {"busy_s": tally.busy, "at_once": tally.at_once, "meeting_error": error}


def hour() -> None:
    prepared, layouts = prepared_layouts()
    before = resident()
    schedule = Schedule(
        name="hour",
        streams=(Poisson.through(start=0.0, end=3600.0, rate=30.0, mix={"rear": 1, "front": 1}),),
    )
    start = time.process_time()
    found = a_day(prepared, layouts, schedule.draw(np.random.default_rng(3), LEAST))
    print(
        json.dumps(
            {
                **found,
                "seconds": round(time.process_time() - start, 1),
                "prepared_mb": round(before),
                "resident_mb": round(resident()),
            }
        )
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--passages", type=int, default=400)
    parser.add_argument("--hour", action="store_true", help="an hour alone, in this process")
    options = parser.parse_args()
    if options.hour:
        hour()
        return
    prepared, layouts = prepared_layouts()
    by_hour = np.zeros(24)
    by_hour[6:18] = options.passages / 12.0
    schedule = Schedule(
        name="day", streams=(Poisson.by_hour(by_hour, {"rear": 0.6, "front": 0.4}),)
    )
    departures = schedule.draw(np.random.default_rng(1), LEAST)
    before = resident()
    start = time.process_time()
    for name, n in departures.counts().items():
        for runs in batches(layouts[name], runs=range(n), seed=1, batch=64):
            del runs
    alone = time.process_time() - start
    one, start = 0.0, time.process_time()
    for name, n in departures.counts().items():
        start = time.process_time()
        next(batches(layouts[name], runs=range(1), seed=1))
        one += n * (time.process_time() - start)
    start = time.process_time()
    found = a_day(prepared, layouts, departures)
    day = time.process_time() - start
    print(
        json.dumps(
            {
                "passages": len(departures),
                "alone_s": round(alone, 1),
                "one_by_one_s": round(one, 1),
                "day_s": round(day, 1),
                "day_over_alone": round(day / alone, 2),
                "day_over_one_by_one": round(day / one, 2),
                **found,
                "resident_before_mb": round(before),
                "resident_mb": round(resident()),
            }
        )
    )
    done = subprocess.run([sys.executable, __file__, "--hour"], check=True, stdout=subprocess.PIPE)
    print(done.stdout.decode().strip())


if __name__ == "__main__":
    main()
