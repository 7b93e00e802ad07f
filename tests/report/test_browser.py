"""Open the reports in a real browser: no error, the verdict to be read, a map to be seen."""

import os
import re
import shutil
import struct
import subprocess
import sys

import pytest

from trundle.records.assess import assess_record
from trundle.report import write_record_report, write_report
from trundle.run.whole_study import run_study
from trundle.signals import Record
from trundle.study_file.build import load_study

sys.path.append(os.path.join(os.path.dirname(__file__), "..", "study"))
from studies import LONG, MAP

BROWSER = next(
    filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), ""
)
pytestmark = pytest.mark.skipif(not BROWSER, reason="no Chromium: apt-get install chromium")


def browse(page, tmp_path, *options):
    """Return what the browser prints on its two outputs."""
    arguments = [
        "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
        "--disable-background-networking", "--disable-component-update", "--disable-sync",
        f"--user-data-dir={tmp_path / 'profile'}", "--enable-logging=stderr", "--v=0",
        "--window-size=1200,2200", "--virtual-time-budget=8000",
    ]  # fmt: skip
    done = subprocess.run(
        [BROWSER, *arguments, *options, page.as_uri()], capture_output=True, text=True, timeout=100,
        check=True,
    )  # fmt: skip
    return done.stdout, done.stderr


def console(errors):
    """Return what the page itself said: CONSOLE lines of the browser's log."""
    return [line for line in errors.splitlines() if "CONSOLE" in line]


def size_of(png):
    return struct.unpack(">II", png.read_bytes()[16:24])


def colours_of(png):
    from matplotlib.image import imread

    pixels = (imread(png)[..., :3] * 15).astype(int).reshape(-1, 3)
    return len({tuple(pixel) for pixel in pixels[::37]})


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    (folder / "study.toml").write_text(LONG + MAP)
    return write_report(run_study(load_study(folder / "study.toml")), folder)


def test_the_report_opens_without_an_error(page, tmp_path):
    text, errors = browse(page, tmp_path, "--dump-dom")
    assert console(errors) == []
    verdict = text[
        text.index('id="verdict"') : text.index("</section>", text.index('id="verdict"'))
    ]
    assert re.search(r"VC-A</td>|VC-A</span>|>VC-A<", verdict)
    assert "✓ pass" in verdict or "✗ fail" in verdict
    assert re.search(r'<canvas id="map-plot"[^>]* width="[1-9]', text)  # the script has drawn
    markup = re.sub(r"<script.*?</script>", "", text, flags=re.DOTALL)
    assert not re.search(r'(src|href)="https?://', markup)  # it opens without any network


def test_a_picture_of_the_report(page, tmp_path):
    shot = tmp_path / "report.png"
    browse(page, tmp_path, f"--screenshot={shot}")
    assert size_of(shot) == (1200, 2200)
    assert colours_of(shot) > 20


def test_the_map_has_the_colours_of_its_classes(page, tmp_path):
    """What the page's data rank at their places is what is seen: each such colour, in its share."""
    import json

    import numpy as np
    from matplotlib.colors import to_rgb
    from matplotlib.image import imread

    shot = tmp_path / "map.png"
    browse(page, tmp_path, f"--screenshot={shot}")
    data = json.loads(
        re.search(r'id="map-data">(.*?)</script>', page.read_text("utf-8"), re.DOTALL).group(1)
    )
    ranks = [r for row in data["views"][-1]["ranks"] for r in row if r is not None]
    pixels = imread(shot)[..., :3].reshape(-1, 3)
    seen = {
        rank: int((np.abs(pixels - to_rgb(data["colours"][rank])).max(axis=1) < 0.01).sum())
        for rank in set(ranks)
    }
    for rank, count in seen.items():
        share = ranks.count(rank) / len(ranks)
        assert abs(count / sum(seen.values()) - share) < 0.25, (rank, seen)
    largest = max(seen, key=seen.get)
    assert seen[largest] > 20_000


def test_the_page_of_a_record_opens_without_an_error(tmp_path):
    import numpy as np

    t = np.arange(0, 30, 0.005)
    v = 1e-4 * np.exp(-(((t - 15) / 3) ** 2)) * np.sin(2 * np.pi * 6 * t)
    record = Record(
        samples=v[None], sampling_frequency=200.0, quantity="velocity", channel_names=("<i>z</i>",)
    )
    from trundle.criteria import VC

    text, errors = browse(
        write_record_report(assess_record(record, VC), tmp_path), tmp_path, "--dump-dom"
    )
    assert console(errors) == []
    assert "&lt;i&gt;z&lt;/i&gt;" in text
    assert "VC-A" in text


def test_a_report_prints_to_pdf(page, tmp_path):
    """The documented way to a PDF: the browser prints the page."""
    pdf = tmp_path / "report.pdf"
    browse(page, tmp_path, f"--print-to-pdf={pdf}", "--no-pdf-header-footer")
    assert pdf.read_bytes().startswith(b"%PDF")
    assert pdf.stat().st_size > 50_000
