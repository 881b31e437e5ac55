# SPDX-License-Identifier: Apache-2.0
import json
import subprocess

import numpy as np
import pytest

import lamina


def test_norms_are_those_of_their_definition():
    dice = np.random.default_rng(1)
    a, b = dice.random((7, 5, 4)), dice.random((7, 5, 4)).astype(np.float32)
    found = lamina.compare(a, b)
    e = 255 * (a - b.astype(np.float64))
    # Sums of 140 numbers of up to 255 in double precision.
    assert np.allclose((found.linf, found.mean, found.l2), (np.abs(e).max(), e.mean(), np.sqrt((e * e).mean())), atol=1e-11)
    assert found.l1 == found.mean and found.channels["R"].l1 == found.channels["R"].mean
    for index, name in enumerate("RGBA"):
        assert np.isclose(found.channels[name].linf, np.abs(e[:, :, index]).max())
    row, column, channel = np.unravel_index(np.abs(e).argmax(), e.shape)
    assert found.worst == (column, row, "RGBA"[channel])
    assert np.allclose(found.array, e)


def test_files_compare_as_the_command_line_does(program, tmp_path):
    dice = np.random.default_rng(2)
    for name in "ab":
        np.save(tmp_path / f"{name}.npy", dice.random((6, 9, 4)).astype(np.float32))
    found = lamina.compare(tmp_path / "a.npy", str(tmp_path / "b.npy"))
    said = json.loads(subprocess.run([program, "compare", tmp_path / "a.npy", tmp_path / "b.npy", "--json"], check=True,
                                     capture_output=True).stdout)
    assert [found.linf, found.l1, found.l2] == [said["all"][name] for name in ("linf", "l1", "l2")]
    assert list(found.channels["G"]) == [said["channels"]["G"][name] for name in ("linf", "l1", "l2")]
    found.save(tmp_path / "difference.png")
    subprocess.run([program, "compare", tmp_path / "a.npy", tmp_path / "b.npy", "--diff", tmp_path / "theirs.png"],
                   check=True, capture_output=True)
    assert lamina.compare(tmp_path / "difference.png", tmp_path / "theirs.png").linf == 0
    assert found._repr_png_().startswith(b"\x89PNG")


@pytest.mark.parametrize("value", [0, -1, float("nan"), float("inf")])
def test_a_difference_is_drawn_up_to_a_finite_number_above_0(value, tmp_path):
    found = lamina.compare(np.zeros((2, 2, 4)), np.full((2, 2, 4), 1 / 255))
    with pytest.raises(lamina.Error, match="range: found .*, expected a finite number above 0"):
        found.save(tmp_path / "difference.png", range=value)
    assert not list(tmp_path.iterdir())


def test_equal_pictures_have_a_difference_to_draw(tmp_path):
    lamina.compare(np.zeros((2, 2, 4)), np.zeros((2, 2, 4))).save(tmp_path / "difference.png")
    assert (tmp_path / "difference.png").stat().st_size


@pytest.mark.parametrize("a, b, error, message", [
    (np.zeros((2, 2, 4)), np.zeros((2, 3, 4)), lamina.Error, "2 x 2.*3 x 2"),
    (np.zeros((2, 2, 3)), np.zeros((2, 2, 3)), ValueError, r"a: found the shape \(2, 2, 3\), expected \(height, width, 4\)"),
    (np.zeros((2, 2, 4)), np.zeros((2, 2)), ValueError, "b: found the shape"),
    (np.zeros((2, 2, 4)), np.full((2, 2, 4), np.nan), lamina.Error, "finite"),
    (np.zeros((2, 2, 4)), "nowhere.exr", lamina.Error, "nowhere.exr"),
    (np.zeros((2, 2, 4)), "nowhere.jpg", lamina.Error, "suffix"),
    (np.zeros((2, 2, 4), "U1"), np.zeros((2, 2, 4)), TypeError, "a: found the type"),
])
def test_what_cannot_be_compared(a, b, error, message):
    with pytest.raises(error, match=message):
        lamina.compare(a, b)


def test_linear_light_is_not_compared_with_display_values(blob, function, tmp_path):
    linear = lamina.render(blob, function, size=(8, 6))
    display = lamina.render(blob, function, size=(8, 6), color_space="display")
    with pytest.raises(lamina.Error, match="linear.*display"):
        linear.compare(display)
    display.save(tmp_path / "a.exr")
    with pytest.raises(lamina.Error, match="linear.*display"):
        linear.compare(tmp_path / "a.exr")
