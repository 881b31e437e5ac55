# SPDX-License-Identifier: Apache-2.0
import gc
import io
import struct
import zlib

import numpy as np
import pytest

import lamina

SIZE = (40, 30)


@pytest.fixture
def picture(blob, function):
    return lamina.render(blob, function, size=SIZE, context="cpu")


def test_the_array_is_the_picture_itself(picture):
    assert picture.array.shape == (30, 40, 4) and picture.array.dtype == np.float32
    assert picture.array is picture.array and picture.array.flags.c_contiguous
    assert np.shares_memory(np.asarray(picture), picture.array)
    assert np.asarray(picture, dtype=np.float64).dtype == np.float64
    assert np.shares_memory(np.from_dlpack(picture), picture.array)
    assert picture.__dlpack_device__() == (1, 0)


def test_a_buffer_is_used_again_only_when_nobody_holds_it(blob, function):
    session = lamina.Session(blob, function, size=SIZE, context="cpu")
    first = session.draw()
    address, expected = first.array.ctypes.data, first.array.copy()
    session.camera = session.camera.turned(30)
    second = session.draw()
    assert second.array.ctypes.data != address and np.array_equal(first.array, expected)
    assert not np.array_equal(second.array, expected)
    held = second.array[::2, :, 0]  # a view holds it, too
    address, expected = second.array.ctypes.data, held.copy()
    del first, second
    gc.collect()
    third = session.draw()
    assert third.array.ctypes.data != address and np.array_equal(held, expected)
    address = third.array.ctypes.data
    del third
    gc.collect()
    assert session.draw().array.ctypes.data == address


def test_pictures_outlive_their_session(blob, function):
    session = lamina.Session(blob, function, size=SIZE, context="cpu")
    array = session.draw().array
    expected = array.copy()
    del session
    gc.collect()
    assert np.array_equal(array, expected)


def test_rays_along_a_ramp_have_a_bound_of_their_own(blob, picture):
    assert picture.error_along_ramps is None and lamina.trace(picture.scene).error_along_ramps is None
    steep = lamina.TransferFunction([(0.6, "white", 0), (0.601, "white", 3e4)])
    drawn = lamina.render(blob, steep, size=SIZE, context="cpu")
    assert drawn.error_kind == "derived" and drawn.error < 1 < drawn.error_along_ramps <= 255 + drawn.error


def test_what_is_known_of_it(picture):
    assert 0 < picture.error <= 1
    assert picture.plan.method == "slice" and picture.plan.target == "float32" and picture.plan.slabs >= 1
    assert "classification exact" in " ".join(picture.plan.text.split())
    assert all(name and reason for name, reason in picture.omitted)
    assert picture.stats["draw_ms"] > 0 and picture.stats["drawn_by"].startswith("cpu")
    assert picture.warnings == []


def test_nothing_to_see_is_said(blob):
    with pytest.warns(lamina.PictureWarning, match="transfer function") as said:
        picture = lamina.render(blob, lamina.TransferFunction([(5, "white", 0), (6, "white", 1)]), size=SIZE)
    assert len(picture.warnings) == 1 and said[0].filename == __file__


def test_files(picture, tmp_path):
    for suffix in ("exr", "npy", "png"):
        picture.save(tmp_path / f"a.{suffix}")
    assert np.array_equal(np.load(tmp_path / "a.npy"), picture.array)
    for suffix in ("exr", "npy"):
        assert picture.compare(tmp_path / f"a.{suffix}").linf == 0
    assert lamina.compare(tmp_path / "a.png", tmp_path / "a.png").linf == 0
    assert b"chosen" in (tmp_path / "a.exr").read_bytes() or b"uses" in (tmp_path / "a.exr").read_bytes()
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")
    with pytest.raises(lamina.Error, match="suffix \".jpg\": JPEG would add errors .*, expected .png, .exr or .npy"):
        picture.save(tmp_path / "a.jpg")
    with pytest.raises(lamina.Error):
        picture.save(tmp_path / "nowhere" / "a.png")


def test_transparent_files_have_straight_alpha(blob, function, tmp_path):
    image = pytest.importorskip("PIL.Image")
    picture = lamina.render(blob, function, size=SIZE, background="white", transparent=True)
    picture.save(tmp_path / "a.png")
    codes = np.asarray(image.open(tmp_path / "a.png"))
    rgba = picture.array.astype(np.float64)
    assert codes.shape == rgba.shape and 0 < codes[:, :, 3].max() and codes[:, :, 3].min() < 255
    assert np.abs(codes[:, :, 3] - 255 * rgba[:, :, 3]).max() <= 0.501
    with np.errstate(invalid="ignore"):
        linear = np.where(rgba[:, :, 3:] > 0, rgba[:, :, :3] / rgba[:, :, 3:], 0)
    srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    assert np.abs(codes[:, :, :3] - 255 * srgb).max() <= 0.501
    assert np.array_equal(np.asarray(image.open(io.BytesIO(picture._repr_png_()))), codes)
    picture.save(tmp_path / "b.png", transparent=False)
    assert image.open(tmp_path / "b.png").mode == "RGB"
    # Pictures agree within the rounding of codes: half a code, times the curve's largest slope, and of the opacity.
    assert picture.compare(tmp_path / "a.png").linf <= 0.5 * (1 + 2.4 / 1.055)


def png_codes(data):
    """The codes of an RGB PNG of 8 bits, by its definition."""
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        content = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack_from(">IIBB", content)
            assert (depth, color) == (8, 2)
        packed += content if kind == b"IDAT" else b""
        at += 12 + length
    lines = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + 3 * width)
    codes = np.zeros((height, width, 3), np.int64)
    for row, line in enumerate(lines):
        raw = line[1:].reshape(width, 3).astype(np.int64)
        for column in range(width):
            left = codes[row, column - 1] if column else np.zeros(3, np.int64)
            up = codes[row - 1, column] if row else np.zeros(3, np.int64)
            corner = codes[row - 1, column - 1] if row and column else np.zeros(3, np.int64)
            guess = left + up - corner
            near = np.abs([guess - left, guess - up, guess - corner])
            paeth = np.where((near[0] <= near[1]) & (near[0] <= near[2]), left, np.where(near[1] <= near[2], up, corner))
            predicted = [0, left, up, (left + up) // 2, paeth][line[0]]
            codes[row, column] = (raw[column] + predicted) % 256
    return codes


def test_a_notebook_shows_it_over_the_background(blob, function):
    picture = lamina.render(blob, function, size=(12, 8), background=(0.25, 0.5, 1))
    rgba = picture.array.astype(np.float64)
    linear = np.clip(rgba[:, :, :3] + (1 - rgba[:, :, 3:]) * [0.25, 0.5, 1], 0, 1)
    srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    # Half a code of rounding, and the rest of float32.
    assert np.abs(png_codes(picture._repr_png_()) - 255 * srgb).max() <= 0.501


def test_annotations_are_beside_the_picture(blob, function, tmp_path):
    view = {"size": (120, 90), "camera": lamina.Camera.orbit(blob, azimuth=30), "context": "cpu"}
    plain = lamina.render(blob, function, **view)
    picture = lamina.render(blob, function, annotations={"colorbar": True, "title": "Größe"}, **view)
    assert plain.annotations is None and np.array_equal(plain.array, picture.array)
    layer = picture.annotations
    assert layer.shape == (90, 120, 4) and layer.dtype == np.float32 and not layer.flags.writeable
    changed = (png_codes(picture._repr_png_()) != png_codes(plain._repr_png_())).any(axis=2)
    assert changed.any() and not changed[layer[:, :, 3] == 0].any()
    picture.save(tmp_path / "a.exr")
    assert picture.compare(tmp_path / "a.exr").linf == 0
    picture.save(tmp_path / "a.png")
    plain.save(tmp_path / "b.png")
    assert lamina.compare(tmp_path / "a.png", tmp_path / "b.png").linf > 0
    assert lamina.trace(blob, function, annotations={"axes": True}, size=(16, 12)).annotations is not None
    with pytest.raises(lamina.Error, match="image.annotations.colorbar: found 3"):
        lamina.render(blob, function, annotations={"colorbar": 3}, **view)


def test_traced_pictures_are_double(blob, function, tmp_path):
    truth = lamina.trace(blob, function, size=(16, 12))
    assert truth.array.dtype == np.float64 and 0 <= truth.error < 1e-5 * 255
    assert truth.plan.method == "trace" and truth.plan.target == "float64"
    truth.save(tmp_path / "a.npy")
    assert np.array_equal(np.load(tmp_path / "a.npy"), truth.array)
    again = lamina.trace(truth.scene)
    assert np.array_equal(again.array, truth.array)


def test_the_dictionary_of_its_scene_draws_it_again(picture):
    assert np.array_equal(lamina.render(picture.scene, context="cpu").array, picture.array)
    assert picture.scene["image"]["width"] == 40
    changed = lamina.render(picture.scene, context="cpu", set={"image.width": 20, "image.height": 15})
    assert changed.array.shape == (15, 20, 4)


def test_warnings_are_those_of_the_command_line(blob, function):
    with pytest.warns(lamina.PictureWarning, match="render.max_error: 1e-05 is not kept"):
        picture = lamina.render(blob, function, size=(24, 18), max_error=1e-5, slice={"tree": "auto"}, context="cpu")
    assert any("is not kept" in text for text in picture.warnings)
    hole = blob.array.astype(np.float32)
    hole[3, 3, 3] = np.nan
    with pytest.warns(lamina.PictureWarning, match="1 samples are NaN or infinite"):
        lamina.render(hole, size=(24, 18), nan="transparent", context="cpu")
