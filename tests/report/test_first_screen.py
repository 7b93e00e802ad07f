"""The first screen of a report in a real browser: the verdict stands above the fold, nothing is cut off."""

import os
import re
import sys
from dataclasses import replace

import numpy as np
import pytest
from hand_made import class_map_of, result_of, study_of

from trundle.report.pages.study import _render
from trundle.results.maps import MapKey, StudyMap
from trundle.results.modes import FirstModes

sys.path.append(os.path.dirname(__file__))
from test_browser import BROWSER, browse, console

pytestmark = pytest.mark.skipif(not BROWSER, reason="no Chromium: apt-get install chromium")

MAP = '\n[map]\nspacing = "3 m"\ncriterion = "VC-A"\n'
CURVES = (
    'curves = ["VC-A"]',
    'curves = ["workshop", "office", "operating-theatre", "VC-A", "VC-B", "VC-C", "VC-D", "VC-E", '
    '"stepper-B"]',
)
ASK = """<script>
var told = {};
["conclusion", "sentences", "grid", "map-plot"].forEach(function (name) {
  var one = document.querySelector("#" + name + ", ." + name);
  if (one && name === "conclusion") { one = document.querySelector("p.conclusion"); }
  if (one) { told[name] = Math.round(one.getBoundingClientRect().bottom); }
});
document.querySelectorAll("#conclusion .scroll").forEach(function (box) {
  told.cut = box.scrollWidth - box.clientWidth;
});
told.wide = document.documentElement.scrollWidth - document.documentElement.clientWidth;
document.body.dataset.told = JSON.stringify(told);
</script></body>"""


def told(page, tmp_path, width, height):
    import html
    import json

    file = tmp_path / "asked.html"
    file.write_text(page.replace("</body>", ASK), "utf-8")
    text, errors = browse(file, tmp_path, "--dump-dom", f"--window-size={width},{height}")
    assert console(errors) == []
    return json.loads(html.unescape(re.search(r'data-told="([^"]*)"', text).group(1)))


def page_of_points(n):
    """Two routes, two roads and so many points, each louder than the last, with a map."""
    text = '\n[[point]]\nname = "tool number {}"\nat = ["{:.2f} m", "4 m"]\n'
    points = "".join(text.format(i, 0.5 + 0.5 * i) for i in range(2, n + 1))
    study = study_of('\n[[road]]\nclass = "C"\n' + points + MAP, CURVES)
    result = result_of(study, lambda key: np.geomspace(1e-6, 1e-4, n))
    places = study.map.n_places
    margin = np.geomspace(0.1, 10.0, places)
    one = StudyMap(
        classes=class_map_of(study.map.grids, {"VC-A": margin, "VC-B": 0.5 * margin}),
        numbers={
            name: np.full(places, np.nan)
            for name in ("rms_velocity", "peak_acceleration", "response_factor", "vdv")
        },
        band_levels=np.zeros((places, 20)),
    )
    keys = [MapKey(case.name, road) for case in study.cases for road in study.roads]
    return _render(replace(result, maps=dict.fromkeys(keys, one)), [])


@pytest.mark.parametrize("n", [1, 3, 20])
def test_the_verdict_stands_above_the_fold(n, tmp_path):
    """On a laptop's window, 1280 by 720, and on a telephone's, 390 by 844 (500: no window is narrower)."""
    page = page_of_points(n)
    wide = told(page, tmp_path, 1280, 720)
    assert wide["conclusion"] < 250
    assert wide["grid"] < 720 or n == 20
    assert wide["map-plot"] < 900
    assert wide["cut"] == 0  # every criterion is seen without scrolling aside
    narrow = told(page, tmp_path, 500, 844)
    assert narrow["conclusion"] < 844
    assert max(wide["wide"], narrow["wide"]) <= 0


def test_the_model_opens_in_space(tmp_path):
    """The button's frame holds a page that draws; modes that results kept are told there."""
    study = study_of("", CURVES)
    n = len(study.floor.nodes)
    motion = np.zeros((n, 6, 2))
    motion[:, 2, :] = 1.0
    modes = FirstModes(frequencies=np.array([4.5, 6.25, 8.0]), vertical=motion[:, 2], motion=motion)
    page = _render(replace(result_of(study, 1e-5), modes=modes), [])
    click = """<script>
    document.getElementById("space-open").click();
    setTimeout(function () {
      var inside = document.querySelector("#space-frame iframe").contentDocument;
      document.body.dataset.told = inside.getElementById("what").textContent;
    }, 3000);
    </script></body>"""
    file = tmp_path / "opened.html"
    file.write_text(page.replace("</body>", click), "utf-8")
    text, _ = browse(
        file, tmp_path, "--dump-dom", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"
    )
    said = re.search(r'data-told="([^"]*)"', text)
    assert said is not None
    assert "4.5" in said.group(1)
    assert "6.25" in said.group(1)


def test_a_model_too_large_for_a_page_has_no_view(tmp_path):
    study = study_of("", CURVES)
    vertical = np.zeros((len(study.floor.nodes), 1))
    modes = FirstModes(frequencies=np.array([4.5]), vertical=vertical)
    assert 'id="space"' not in _render(replace(result_of(study, 1e-5), modes=modes), [])
