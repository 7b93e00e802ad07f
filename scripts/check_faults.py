"""Put known faults into a copy of the code, one at a time, and see that the tests catch each.

Usage: python scripts/check_faults.py [--list] [--only NAME] [--json FILE] [--again FILE]

The faults stand in faults.toml beside this script. Exit code 0 if every fault is caught, 1 if
one survives, 2 if a fault is out of date or a run says nothing about it.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from queue import Queue

ROOT = Path(__file__).resolve().parent.parent
FAULTS = Path(__file__).with_name("faults.toml")
COPIED = ("src", "tests", "scripts", "pyproject.toml")
TIME_LIMIT = 600  # s for the tests of one fault, which may keep a loop from ending
ALL_LIMIT = 3600  # s for those of all faults on the unchanged code
PASSED, FAILED = 0, 1  # of pytest's exit codes, the two that say something about the code

PYTEST = ("-m", "pytest", "-q", "--tb=no", "--maxfail=1", "-p", "no:cacheprovider")
_FIRST_FAILURE = re.compile(r"^(?:FAILED|ERROR) (.+?)(?: - .*)?$", re.MULTILINE)


@dataclass(frozen=True, kw_only=True)
class Fault:
    """Hold one replacement in one file, and the tests that must see it.

    Attributes
    ----------
    name : str
        What is wrong, as a reader of the documentation is told.
    file : str
        Path below the project's root.
    old, new : str
        Text that occurs exactly once in the file, and what it is replaced by.
    tests : tuple of str
        Arguments for pytest: test ids, files, or a folder with ``-k`` and an expression.
    """

    name: str
    file: str
    old: str
    new: str
    tests: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """Hold what became of a fault.

    Attributes
    ----------
    name : str
        The fault's name.
    caught : bool
        Whether a test failed.
    by : str
        Id of the first test that failed; empty where none did.
    seconds : float
        Time that the tests took [s].
    problem : str
        Why the run says nothing about the fault; empty where it does.
    """

    name: str
    caught: bool
    by: str
    seconds: float
    problem: str = ""


class Copy:
    """A copy of code and tests in a folder of its own, where faults do no harm."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        folder.mkdir()
        source = folder / "src"
        # Bytecode is found by a file's size and time in whole seconds: a fault of the same
        # length could run the code of the last one.
        self._environment = os.environ | {
            "PYTHONPATH": str(source),
            "PYTHONDONTWRITEBYTECODE": "1",
            "OMP_NUM_THREADS": os.environ.get("OMP_NUM_THREADS", "1"),
        }
        for name in COPIED:
            place = ROOT / name
            if place.is_dir():
                shutil.copytree(place, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
            else:
                shutil.copy(place, folder / name)
        imported = self.run("-c", "import trundle; print(trundle.__file__)").stdout.strip()
        print(f"testing {imported or 'nothing: trundle cannot be imported'}", flush=True)
        if not Path(imported).is_relative_to(source):
            raise SystemExit(f"tests would not run on the copy in {source}")

    def run(self, *arguments: str, limit: float = TIME_LIMIT) -> subprocess.CompletedProcess[str]:
        """Run Python on the copy."""
        return subprocess.run(
            [sys.executable, *arguments],
            cwd=self.folder,
            env=self._environment,
            capture_output=True,
            text=True,
            check=False,
            timeout=limit,
        )

    def try_fault(self, fault: Fault) -> Outcome:
        """Put a fault in, run its tests, take it out again."""
        file = self.folder / fault.file
        sound = file.read_text("utf-8")
        file.write_text(sound.replace(fault.old, fault.new), "utf-8")
        start = time.monotonic()
        try:
            code, output = self._outcome_of(fault.tests)
        finally:
            file.write_text(sound, "utf-8")
        failure = _FIRST_FAILURE.search(output)
        caught = code == FAILED
        return Outcome(
            name=fault.name,
            caught=caught,
            by=failure[1] if caught and failure else "",
            seconds=round(time.monotonic() - start, 1),
            problem="" if code in {PASSED, FAILED} else f"pytest's exit code is {code}: {output}",
        )

    def _outcome_of(self, tests: tuple[str, ...]) -> tuple[int, str]:
        try:
            done = self.run(*PYTEST, *tests)
        except subprocess.TimeoutExpired:
            return -1, f"not done after {TIME_LIMIT} s"
        return done.returncode, done.stdout + done.stderr


def read_faults() -> tuple[Fault, ...]:
    """Read the list of faults."""
    entries = tomllib.loads(FAULTS.read_text("utf-8"))["fault"]
    return tuple(Fault(**{**entry, "tests": tuple(entry["tests"])}) for entry in entries)


def check_list(faults: tuple[Fault, ...], folder: Path) -> None:
    """Stop if a fault no longer fits the code, or if two have one name."""
    times = {fault: _times(fault, folder) for fault in faults}
    wrong = [
        f"{fault.name}: its text occurs {n} times in {fault.file}, and must occur once"
        for fault, n in times.items()
        if n != 1
    ]
    wrong += [f"{fault.name}: it changes nothing" for fault in faults if fault.old == fault.new]
    names = [fault.name for fault in faults]
    wrong += [f"{name}: named twice" for name in sorted({n for n in names if names.count(n) > 1})]
    if wrong:
        print("the list of faults is out of date:", *wrong, sep="\n  ", file=sys.stderr)
        raise SystemExit(2)


def _times(fault: Fault, folder: Path) -> int:
    file = folder / fault.file
    return file.read_text("utf-8").count(fault.old) if file.is_file() else 0


def selections(faults: Iterable[Fault]) -> list[tuple[str, ...]]:
    """Return what to run for the tests of all faults: all ids at once, then each ``-k``."""
    ids: dict[str, None] = {}
    chosen: dict[tuple[str, ...], None] = {}
    for fault in faults:
        if any(argument.startswith("-") for argument in fault.tests):
            chosen[fault.tests] = None
        else:
            ids.update(dict.fromkeys(fault.tests))
    return [tuple(ids)] * bool(ids) + list(chosen)


def check_sound(copy: Copy, faults: tuple[Fault, ...]) -> None:
    """Stop unless every test passes while there is no fault."""
    start = time.monotonic()
    for tests in selections(faults):
        done = copy.run(*PYTEST, "-n", str(os.cpu_count() or 1), *tests, limit=ALL_LIMIT)
        if done.returncode != PASSED:
            print(done.stdout, done.stderr, file=sys.stderr)
            print("the tests must pass on the unchanged code first", file=sys.stderr)
            raise SystemExit(2)
    print(f"without a fault all tests pass ({time.monotonic() - start:.0f} s)", flush=True)


def try_all(faults: tuple[Fault, ...]) -> list[Outcome]:
    """Try every fault, one to a copy at a time, a line of progress for each."""
    outcomes = []
    with tempfile.TemporaryDirectory(prefix="trundle-faults-") as folder:
        copies = [Copy(Path(folder).resolve() / str(i)) for i in range(os.cpu_count() or 1)]
        check_list(faults, copies[0].folder)
        check_sound(copies[0], faults)
        idle: Queue[Copy] = Queue()
        for copy in copies:
            idle.put(copy)
        with ThreadPoolExecutor(len(copies)) as pool:
            trials = pool.map(partial(try_on_idle, idle), faults)
            for number, outcome in enumerate(trials, start=1):
                outcomes.append(outcome)
                print(f"{number:3}/{len(faults)} {line_of(outcome)}", flush=True)
    return outcomes


def try_on_idle(idle: Queue[Copy], fault: Fault) -> Outcome:
    """Try a fault on a copy that no other fault is in."""
    copy = idle.get()
    try:
        return copy.try_fault(fault)
    finally:
        idle.put(copy)


def line_of(outcome: Outcome) -> str:
    """Say in a line what became of a fault."""
    end = f"({outcome.seconds:.1f} s)"
    if outcome.problem:
        return f"ERROR     {outcome.name} {end}\n{outcome.problem}"
    if outcome.caught:
        return f"caught    {outcome.name}: {outcome.by} {end}"
    return f"SURVIVED  {outcome.name} {end}"


def summarise(outcomes: list[Outcome]) -> int:
    """Print how many faults were caught; return the exit code."""
    broken = [outcome for outcome in outcomes if outcome.problem]
    survived = [outcome for outcome in outcomes if not outcome.caught and not outcome.problem]
    caught = len(outcomes) - len(broken) - len(survived)
    seconds = sum(outcome.seconds for outcome in outcomes)
    print(f"{caught} of {len(outcomes)} faults caught in {seconds:.0f} s")
    for outcome in survived:
        print(f"survived: {outcome.name}")
    for outcome in broken:
        print(f"no result: {outcome.name}")
    return 1 if survived else 2 if broken else 0


def write_json(outcomes: list[Outcome], file: Path) -> None:
    """Write name, caught, by and seconds of every fault, for the documentation."""
    keys = ("name", "caught", "by", "seconds")
    rows = [{key: getattr(outcome, key) for key in keys} for outcome in outcomes]
    file.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


def caught_before(file: Path, faults: tuple[Fault, ...]) -> list[Outcome]:
    """Return the outcomes of faults that an earlier run has seen caught."""
    names = {fault.name for fault in faults}
    rows = [Outcome(**row) for row in json.loads(file.read_text("utf-8"))]
    return [row for row in rows if row.caught and row.name in names]


def main() -> int:
    """Read the command line, try the faults asked for."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--list", action="store_true", help="name the faults and stop")
    parser.add_argument("--only", metavar="NAME", help="faults whose name holds this text")
    parser.add_argument("--json", metavar="FILE", type=Path, help="write the outcomes there")
    parser.add_argument(
        "--again",
        metavar="FILE",
        type=Path,
        help="try those alone that FILE does not say are caught",
    )
    asked = parser.parse_args()
    faults = read_faults()
    if asked.only:
        faults = tuple(fault for fault in faults if asked.only.lower() in fault.name.lower())
        if not faults:
            parser.error(f"no fault's name holds {asked.only!r}; see --list")
    if asked.list:
        print(*(f"{fault.name}  ({fault.file})" for fault in faults), sep="\n")
        return 0
    before = caught_before(asked.again, faults) if asked.again else []
    known = {outcome.name for outcome in before}
    outcomes = before + try_all(tuple(fault for fault in faults if fault.name not in known))
    if asked.json:
        write_json(outcomes, asked.json)
    return summarise(outcomes)


if __name__ == "__main__":
    sys.exit(main())
