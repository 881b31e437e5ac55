# SPDX-License-Identifier: Apache-2.0
import os
import pathlib

import numpy as np
import pytest

import lamina

SOURCE = pathlib.Path(os.environ["LAMINA_SOURCE"])


@pytest.fixture(scope="session")
def source():
    return SOURCE


@pytest.fixture(scope="session")
def program():
    return os.environ["LAMINA_PROGRAM"]


@pytest.fixture
def blob():
    """A soft ball in 24 x 20 x 16 samples of float32, and what shows it."""
    z, y, x = np.mgrid[-1:1:16j, -1:1:20j, -1:1:24j]
    return lamina.Volume(np.exp(-3 * (x * x + y * y + z * z)).astype(np.float32), spacing=(0.1, 0.1, 0.2))


@pytest.fixture
def function():
    return lamina.TransferFunction([(0.1, "#204080", 0), (0.6, (0.9, 0.5, 0.1), 2), (1, (1, 1, 1), 9)])
