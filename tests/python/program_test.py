# SPDX-License-Identifier: Apache-2.0
"""The shipped scenes, bit for bit as `lamina render` draws them."""
import json
import os
import pathlib
import subprocess

import numpy as np
import pytest

import lamina

SCENES = sorted((pathlib.Path(os.environ["LAMINA_SOURCE"]) / "data" / "scenes").glob("*.json"))
SIZE = (80, 60)


def data_of(scene):
    name = json.loads(scene.read_text()).get("volume") or json.loads(scene.read_text()).get("mesh")
    if not isinstance(name, str):
        return None
    return pathlib.Path(name.replace("${LAMINA_DATA}", os.environ.get("LAMINA_DATA", "/nowhere")))


@pytest.mark.parametrize("scene", SCENES, ids=[scene.stem for scene in SCENES])
def test_shipped_scenes(scene, program, tmp_path):
    if data_of(scene) is not None and not data_of(scene).exists():
        pytest.skip(f"no {data_of(scene).name} in LAMINA_DATA")
    picture = lamina.render(scene, size=SIZE, context="cpu")
    subprocess.run([program, "render", scene, "-o", tmp_path / "a.exr", "--context", "cpu", "--quiet", "--size", "80x60"],
                   check=True)
    found = lamina.compare(picture, tmp_path / "a.exr")
    assert found.linf == 0
    saved = tmp_path / "b.exr"
    picture.save(saved)
    assert lamina.compare(saved, tmp_path / "a.exr").linf == 0


def test_there_are_scenes():
    assert len(SCENES) > 10
