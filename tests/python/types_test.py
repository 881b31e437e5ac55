# SPDX-License-Identifier: Apache-2.0
"""The types that the package promises, checked by mypy; the stub of its compiled part, made from the module."""
import pathlib
import shutil
import subprocess
import sys

import pytest

import lamina

PACKAGE = pathlib.Path(lamina.__file__).parent

CLIENT = """
import numpy as np
import lamina

volume = lamina.Volume(np.zeros((2, 2, 2)), spacing=0.5)
function = lamina.TransferFunction([(0, "red", 0.0), (1, (1, 1, 1), 2)])
picture = lamina.render(volume, function, camera=lamina.Camera.orbit(volume), size=(8, 6), max_error=1)
array: np.ndarray = picture.array
view: lamina.keywords.CameraKeys = {"eye": np.array([2, 1, 3]), "center": (0, 0, 0)}
lamina.Session(volume, camera=view, size=array.shape[:2]).set(lighting={"lights": [lamina.Light()]}, transfer_function="auto")
worst: float = picture.compare(array).linf
reveal_type(lamina.Session(volume).turntable(3)[0])
reveal_type(lamina.read("a.nrrd"))
lamina.Camera(eye="here", center=(0, 0, 0))  # wrong
lamina.render(volume, max_eror=1)  # wrong
lamina.render(volume, slice={"sample": 3})  # wrong
picture.size  # wrong
"""


def needed(program):
    if not shutil.which(program, path="/usr/bin:/usr/local/bin"):
        pytest.skip(f"{program} is not there (Debian's package mypy)")
    return program


def run(*command, **keywords):
    return subprocess.run([str(part) for part in command], capture_output=True, text=True, **keywords)


def test_the_package_and_a_client_pass_mypy(source, tmp_path):
    needed("mypy")
    settings = tmp_path / "mypy.ini"
    settings.write_text("[mypy]\nstrict = True\nwarn_unused_ignores = False\nenable_incomplete_feature = Unpack\ndisallow_any_generics = False\n"
                        f"cache_dir = {tmp_path / 'cache'}\n[mypy-vtkmodules.*]\nignore_missing_imports = True\n"
                        "follow_imports = skip\n")
    (tmp_path / "client.py").write_text(CLIENT)
    found = run(sys.executable, "-m", "mypy", "--config-file", settings, "-p", "lamina", cwd=PACKAGE.parent)
    assert found.returncode == 0, found.stdout + found.stderr
    found = run(sys.executable, "-m", "mypy", "--config-file", settings, tmp_path / "client.py")
    lines = [line.split("client.py:")[1] for line in found.stdout.splitlines() if "client.py:" in line]
    assert [line.split(":")[0] for line in lines] == ["12", "13", "14", "15", "16", "17"], found.stdout
    assert "Picture" in lines[0] and "Union[" in lines[1] and "incompatible type" in lines[2]
    assert "did you mean \"max_error\"" in lines[3] and "SliceKeys" in lines[4]
    assert '"Picture" has no attribute "size"' in lines[5]
    assert (PACKAGE / "py.typed").exists()


def test_the_stub_is_that_of_the_module(source):
    needed("stubgen")
    made = run(sys.executable, "-B", source / "tools" / "python_stub")
    assert made.returncode == 0, made.stderr
    assert made.stdout == (source / "python" / "lamina" / "_lamina.pyi").read_text()
