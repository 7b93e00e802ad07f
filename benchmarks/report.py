"""How large a study's report is, how long it takes to draw, and how fast a browser opens it.

The quick study of two bays is run (or a results folder is named), its report drawn again in this
process, and the page opened in a headless Chromium, whose own clock tells when it has loaded. The
limit it is held against is an empty page in the same browser.
"""

from __future__ import annotations

import argparse
import json
import re
import shutil
import subprocess
import tempfile
import time
from pathlib import Path

import trundle as tr

TELL = """<script>addEventListener("load", function () { setTimeout(function () {
var t = performance.getEntriesByType("navigation")[0];
document.body.dataset.opened = JSON.stringify([t.loadEventEnd, t.domInteractive]);
}, 0); });</script></body>"""


def opened(browser: str, page: Path, folder: Path) -> list[float]:
    """Return when a page has loaded and could be used, after its opening [ms]; the best of three."""
    file = folder / "opened.html"
    file.write_text(page.read_text("utf-8").replace("</body>", TELL), "utf-8")
    found = []
    for _ in range(3):
        command = [
            browser, "--headless", "--no-sandbox", "--disable-gpu", "--dump-dom",
            f"--user-data-dir={folder / 'profile'}", "--timeout=10000", file.as_uri(),
        ]  # fmt: skip
        text = subprocess.run(command, capture_output=True, text=True, check=True).stdout
        said = re.search(r'data-opened="\[([\d.]+),([\d.]+)\]"', text)
        if said is not None:
            found.append([float(said.group(1)), float(said.group(2))])
    return min(found) if found else []


def main() -> None:
    parser = argparse.ArgumentParser(description="Size and times of a report.")
    parser.add_argument("results", nargs="?", type=Path, help="results folder of a run")
    given = parser.parse_args()
    browser = next(filter(None, map(shutil.which, ("chromium", "google-chrome"))), "")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if given.results is None:
            study = tr.load_study("examples/from_python/study.toml")
            result = tr.run_study(study)
        else:
            result = tr.read_results(given.results)
        start, cpu = time.perf_counter(), time.process_time()
        page = tr.write_report(result, folder)
        drawn = time.perf_counter() - start
        empty = folder / "empty.html"
        empty.write_text("<!doctype html><html><body></body></html>", "utf-8")
        text = page.read_text("utf-8")
        found = {
            "figures": text.count("<figure id="),
            "MB of the page": round(page.stat().st_size / 1e6, 2),
            "s to draw": round(drawn, 1),
            "CPU s to draw": round(time.process_time() - cpu, 1),
        }
        if browser:
            found |= {
                "ms to open (loaded, usable)": opened(browser, page, folder),
                "of an empty page": opened(browser, empty, folder),
            }
    print(json.dumps(found))


if __name__ == "__main__":
    main()
