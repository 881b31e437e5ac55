# SPDX-License-Identifier: Apache-2.0
"""Every example of a docstring and of docs/python.md is run."""
import doctest
import inspect
import os

import numpy as np
import pytest

import lamina


def documented():
    """The module, what it offers, and the members of classes, by name."""
    found = {"lamina": lamina}
    for name in lamina.__all__:
        thing = getattr(lamina, name)
        found[name] = thing
        if inspect.isclass(thing):
            own = {key: value for key, value in vars(thing).items() if not key.startswith("_")}
            found.update({f"{name}.{key}": getattr(value, "__func__", value) for key, value in own.items()})
    return {name: thing for name, thing in found.items() if name != "colormaps"}


DOCUMENTED = documented()


def examples_run(text, name, folder):
    before = os.getcwd()
    os.chdir(folder)
    try:
        test = doctest.DocTestParser().get_doctest(text, {"lamina": lamina, "np": np}, name, name, 0)
        runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE | doctest.IGNORE_EXCEPTION_DETAIL)
        said = []
        runner.run(test, out=said.append)
        assert runner.failures == 0, "".join(said)
        return runner.tries
    finally:
        os.chdir(before)


@pytest.mark.filterwarnings("ignore::lamina.PictureWarning")
@pytest.mark.parametrize("name", [name for name, thing in DOCUMENTED.items() if ">>>" in (inspect.getdoc(thing) or "")])
def test_examples_of_docstrings(name, tmp_path):
    assert examples_run(inspect.getdoc(DOCUMENTED[name]), name, tmp_path) > 0


def test_the_page_of_vtk():
    pytest.importorskip("vtkmodules", reason="python3-vtk9 is not installed")
    import lamina.vtk
    assert {"scene", "hold", "Held"} == set(lamina.vtk.__all__)
    for thing in (lamina.vtk, lamina.vtk.scene, lamina.vtk.hold, lamina.vtk.Held):
        assert len(inspect.getdoc(thing)) > 100


def test_everything_is_documented():
    for name, thing in DOCUMENTED.items():
        is_field = name.split(".")[0] in ("Camera", "Light", "Lighting", "Norms", "Omission", "Plan") and not callable(thing)
        assert is_field or (inspect.getdoc(thing) or "").strip(), name


@pytest.mark.filterwarnings("ignore::lamina.PictureWarning")
def test_examples_of_the_page(source, tmp_path):
    page = (source / "docs" / "python.md").read_text()
    blocks = [block.split("```")[0] for block in page.split("```python\n")[1:]]
    assert len(blocks) > 3
    text = "\n".join(block for block in blocks if ">>>" in block)
    assert examples_run(text, "docs/python.md", tmp_path) > 10
