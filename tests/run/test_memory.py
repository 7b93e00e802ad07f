"""What large arrays took is given back."""

import subprocess
import sys

import pytest

LEFT = """
import sys, numpy as np, psutil
from trundle.run.memory import give_back
if sys.argv[1] == "yes":
    assert give_back()
me = psutil.Process()
kept, before = [], me.memory_info().rss
for _ in range(40):  # a large array goes, a small one behind it stays, as layouts and batches do
    large = np.ones(2_500_000)
    kept.append(np.ones(2_000))
    large2 = np.ones(1_500_000)
    del large, large2
print(me.memory_info().rss - before)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="a setting of the C library there")
def test_large_arrays_leave_nothing_behind():
    """Of arrays of 20 and 12 MB that come and go beside small ones less than 8 MB stays."""
    out = subprocess.run(
        [sys.executable, "-c", LEFT, "yes"], capture_output=True, text=True, check=True
    )
    assert int(out.stdout) < 8e6
