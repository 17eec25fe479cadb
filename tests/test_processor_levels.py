# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture is the same bits however wide the processor's vectors are."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest

SCRIPT = """
import sys
import numpy as np
from engine.settings import Estimate, RenderSettings
from tests.shapes import Picture
from tests.test_determinism import still_life

pictures = [Picture(still_life(), RenderSettings(estimate=estimate)).run(2).pixels() for estimate in Estimate]
np.save(sys.argv[1], np.stack(pictures))
"""


@pytest.mark.parametrize("lacking", ["AVX512", "AVX2"])
def test_the_picture_is_the_same_bits_without(lacking, tmp_path):
    """The C++ checks of the same name show that the variable does what it says."""
    pictures = []
    for name, more in (("as_it_is", {}), ("without", {f"PHOTON_MAPS_WITHOUT_{lacking}": "1"})):
        path = tmp_path / f"{name}.npy"
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), **more}
        command = [sys.executable, "-c", SCRIPT, path]
        subprocess.run(command, env=environment, check=True, timeout=300)
        pictures.append(np.load(path))
    assert pictures[0].mean() > 0.01
    np.testing.assert_array_equal(*pictures)
