# SPDX-License-Identifier: Apache-2.0
import json

import numpy as np
import pytest

import lamina


@pytest.fixture
def scene(blob, function):
    return lamina.render(blob, function, size=(24, 18), context="cpu").scene


def sweep(scene):
    return {"title": "test", "scenes": [scene], "base": {"render.slice.classification": "post", "context": "cpu"},
            "sweep": {"render.slice.samples": [8, 16], "render.target": ["float32", "fixed8"]}, "rounds": 1, "frames": 1}


def test_results_are_arrays(scene, tmp_path):
    found = lamina.study(sweep(scene), tmp_path / "out")
    assert found.runs == 4 and found.failures == [] and found.findings
    assert list(found["render.slice.samples"]) == [8, 8, 16, 16]
    assert list(found["render.target"]) == ["float32", "fixed8"] * 2
    assert found["l2"].dtype == np.float64 and found["pareto"].dtype == bool and found["pareto"].any()
    assert (found["frame_ms_median"] > 0).all() and (tmp_path / "out" / "report.html").exists()
    # The errors are those of the pictures themselves.
    truth = lamina.trace(scene)
    picture = lamina.render(scene, context="cpu", slice={"samples": 8, "classification": "post"})
    assert np.isclose(picture.compare(truth).linf, found["linf"][0], rtol=1e-12)


def test_it_goes_on(scene, tmp_path):
    lamina.study(sweep(scene), tmp_path / "out")
    with pytest.raises(lamina.Error, match="holds this study"):
        lamina.study(sweep(scene), tmp_path / "out")
    again = lamina.study(sweep(scene), tmp_path / "out", resume=True)
    assert again.runs == 4 and again.folder == tmp_path / "out"
    other = sweep(scene)
    other["sweep"] = {"render.slice.samples": [8, 9]}
    with pytest.raises(lamina.Error, match="holds another study"):
        lamina.study(other, tmp_path / "out", resume=True)


def test_a_file_and_named_scenes(scene, tmp_path):
    scene.save(tmp_path / "scene.json")
    study = {"version": 1, "scenes": [{"scene": "scene.json", "name": "mine", "set": {"image.width": 12}}],
             "base": {"render.slice.classification": "post", "context": "cpu"},
             "sweep": {"render.slice.samples": [4]}, "rounds": 1, "frames": 1}
    (tmp_path / "study.json").write_text(json.dumps(study))
    found = lamina.study(tmp_path / "study.json")
    assert list(found["scene"]) == ["mine"] and found.folder is None


@pytest.mark.parametrize("change, error, message", [
    ({"scenes": []}, lamina.Error, "scenes"),
    ({"scenes": [3]}, TypeError, "scenes.0: found 3"),
    ({"sweep": {"render.slcie.samples": [3]}}, lamina.Error, "render.slcie"),
    ({"roudns": 3}, lamina.Error, "roudns.*rounds"),
])
def test_bad_studies(scene, change, error, message):
    with pytest.raises(error, match=message):
        lamina.study({**sweep(scene), **change})


def test_a_missing_file_is_an_error():
    with pytest.raises(lamina.Error, match="nowhere.json"):
        lamina.study("nowhere.json")


def test_folders_with_other_files_are_refused(scene, tmp_path):
    (tmp_path / "report.html").write_text("mine")
    with pytest.raises(lamina.Error, match="report.html"):
        lamina.study(sweep(scene), tmp_path)
    assert (tmp_path / "report.html").read_text() == "mine"
