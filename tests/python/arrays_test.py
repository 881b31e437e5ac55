# SPDX-License-Identifier: Apache-2.0
"""Arrays of all kinds against numpy's own conversions."""
import gc
import json
import random
import subprocess
import warnings
import weakref

import numpy as np
import pytest

import lamina

SHARED = [np.uint8, np.int16, np.uint16, np.float32]


def ramp(shape, dtype):
    return np.arange(np.prod(shape)).reshape(shape).astype(dtype)


@pytest.mark.parametrize("dtype", SHARED)
def test_contiguous_arrays_are_shared(dtype):
    values = ramp((3, 4, 5), dtype)
    volume = lamina.Volume(values)
    assert np.shares_memory(volume.array, values)
    assert volume.dtype == dtype and volume.shape == (3, 4, 5) and not volume.conversion
    fortran = np.asfortranarray(values)
    assert np.shares_memory(lamina.Volume(fortran, axes="xyz").array, fortran)
    assert np.array_equal(lamina.Volume(fortran, axes="xyz").array, fortran.transpose())


def test_samples_outlive_their_array(tmp_path):
    file = tmp_path / "a.npy"
    np.save(file, ramp((4, 4, 4), np.uint16))
    mapped = np.load(file, mmap_mode="r")
    volume = lamina.Volume(mapped)
    assert np.shares_memory(volume.array, mapped)
    expected = np.array(mapped)
    del mapped
    gc.collect()
    assert np.array_equal(volume.array, expected)
    array = volume.array
    del volume
    gc.collect()
    assert np.array_equal(array, expected)


def test_an_array_is_let_go(function):
    class Kept(np.ndarray):
        pass
    values = ramp((4, 4, 4), np.float32).view(Kept)
    gone = weakref.ref(values)
    picture = lamina.render(lamina.Volume(np.asarray(values)), function, size=(8, 6))
    assert picture.array.shape == (6, 8, 4)
    del values, picture
    gc.collect()
    assert gone() is None


def test_the_samples_cannot_be_written():
    with pytest.raises(ValueError):
        lamina.Volume(ramp((2, 2, 2), np.uint8)).array[0, 0, 0] = 1


def converter_of_numpy_2(values, dtype=None, copy=True):
    """numpy.array as of numpy 2, where copy=False means never."""
    result = np.asarray(values, dtype=dtype)
    if copy is False and not np.shares_memory(result, values):
        raise ValueError("Unable to avoid copy while creating an array as requested.")
    return result.copy() if copy else result


@pytest.mark.parametrize("is_picture", [False, True])
def test_numpy_may_ask_for_a_copy_or_for_none(is_picture, blob, function, monkeypatch):
    data = lamina.render(blob, function, size=(8, 6), context="cpu") if is_picture else blob
    monkeypatch.setattr(np, "array", converter_of_numpy_2)
    for copy in (None, False):
        assert np.shares_memory(data.__array__(copy=copy), data.array)
    assert not np.shares_memory(data.__array__(copy=True), data.array)
    for copy in (None, True):
        values = data.__array__(np.float64, copy=copy)
        assert values.dtype == np.float64 and np.array_equal(values, data.array)
    with pytest.raises(ValueError):
        data.__array__(np.float64, copy=False)
    assert np.asarray(data, dtype=float).dtype == np.float64


def lossless_type(array):
    """Which type has to hold the values, by this page's own rule."""
    if array.dtype.kind == "b":
        return np.dtype(np.uint8)
    if array.dtype.newbyteorder("=") in [np.dtype(kind) for kind in SHARED]:
        return array.dtype.newbyteorder("=")
    if array.dtype.kind == "f":
        return np.dtype(np.float32)
    if array.dtype == np.int8:
        return np.dtype(np.int16)
    for kind in SHARED[:3]:
        if np.iinfo(kind).min <= array.min() and array.max() <= np.iinfo(kind).max:
            return np.dtype(kind)
    return np.dtype(np.float32)


def random_array(dice):
    """Any type, byte order, strides and order of axes; and the same [z, y, x]."""
    code = dice.choice(["?", "i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f2", "f4", "f8", "g"])
    dtype = np.dtype(code).newbyteorder(dice.choice("<>"))
    shape = tuple(dice.randint(1, 7) for _ in range(3))
    steps = [1, 1, 1] if dice.random() < 0.4 else [dice.choice([1, 2, 3, -1, -2]) for _ in range(3)]
    whole = tuple(n * abs(step) for n, step in zip(shape, steps))
    numbers = np.random.default_rng(dice.randrange(1 << 30))
    if dtype.kind == "f":
        values = numbers.normal(scale=100, size=whole).astype(dtype)
    else:
        reach = dice.choice([100, 30000, 65535, 1 << 24])
        info = np.iinfo(dtype) if dtype.kind != "b" else np.iinfo(np.uint8)
        values = numbers.integers(max(info.min, -reach), min(info.max, reach), size=whole, endpoint=True).astype(dtype)
    array = np.asarray(values, order=dice.choice("CF"))[tuple(slice(None, None, step) for step in steps)]
    if dice.random() < 0.3:
        array.flags.writeable = False
    axes = "".join(dice.sample("xyz", 3))
    return array, axes, array.transpose([axes.index(letter) for letter in "zyx"])


def test_200_random_arrays():
    dice = random.Random(29)
    shared = 0
    for number in range(200):
        array, axes, ordered = random_array(dice)
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            volume = lamina.Volume(array, axes=axes)
        expected = np.ascontiguousarray(ordered, dtype=lossless_type(array))
        assert volume.dtype == expected.dtype, (number, array.dtype, axes)
        assert np.array_equal(volume.array, expected), (number, array.dtype, axes)
        lossy = not np.array_equal(expected.astype(np.longdouble), ordered.astype(np.longdouble))
        assert bool(said) == lossy == bool(volume.conversion), (number, array.dtype)
        is_as_drawn = ordered.flags.c_contiguous and array.dtype in [np.dtype(kind) for kind in SHARED]
        assert np.shares_memory(volume.array, array) == is_as_drawn, (number, array.dtype, axes)
        shared += is_as_drawn
    assert shared >= 3


def test_float32_says_what_it_cannot_hold():
    values = np.full((2, 2, 2), 1.0)
    assert lamina.Volume(values).dtype == np.float32  # exact: nothing is said
    values[0, 0, 0] = 1 + 2.0 ** -30
    with pytest.warns(lamina.PrecisionWarning, match="float64 values are drawn as float32.*1 of 8 differ, by up to 9.31e-10"):
        lamina.Volume(values)
    with pytest.warns(lamina.PrecisionWarning, match="int64 values .*1 of 2 differ, by up to 1"):
        lamina.Volume(np.array([[[0, 2 ** 24 + 1]]]))
    with pytest.warns(lamina.PrecisionWarning, match="uint64 values .*1 of 2 differ, by up to 1$"):
        lamina.Volume(np.array([[[0, 2 ** 63 + 1]]], dtype=np.uint64))
    values[0, 0, 0] = 1e39
    with pytest.raises(ValueError, match="1 values of float64 are beyond float32, expected up to 3.4e38"):
        lamina.Volume(values)
    values[0, 0, 0] = np.nan
    values[0, 0, 1] = -np.inf
    assert np.array_equal(lamina.Volume(values).array, values, equal_nan=True)


@pytest.mark.parametrize("array, error, message", [
    (np.zeros(4), ValueError, r"shape \(4,\), expected three axes \(z, y, x\), or two \(y, x\) of one slice"),
    (np.zeros((2, 3, 4, 5)), ValueError, r"shape \(2, 3, 4, 5\), expected three axes"),
    (np.zeros((0, 3, 4)), ValueError, r"shape \(0, 3, 4\), expected one sample or more"),
    (np.zeros((2, 2, 2), object), TypeError, "type object, expected whole or floating-point numbers"),
    (np.zeros((2, 2, 2), complex), TypeError, "type complex128, expected whole"),
    (np.zeros((2, 2, 2), "U3"), TypeError, "type <U3"),
    (np.zeros((2, 2, 2), "M8[s]"), TypeError, "type datetime64"),
    (np.ma.masked_equal(np.arange(8).reshape(2, 2, 2), 3), TypeError, "masked array"),
    ("a text", TypeError, "found .a text., expected numbers; lamina.read reads files"),
])
def test_other_arrays_are_refused(array, error, message):
    with pytest.raises(error, match=message):
        lamina.Volume(array)


@pytest.mark.parametrize("keywords, error, message", [
    ({"axes": "zyy"}, ValueError, "axes: found 'zyy', expected the letters x, y and z"),
    ({"axes": "zy"}, ValueError, "axes: found 'zy'"),
    ({"axes": 3}, TypeError, "axes: found 3, expected a text"),
    ({"spacing": 0}, ValueError, "spacing: found 0"),
    ({"spacing": (1, 2)}, ValueError, r"spacing: found \(1, 2\), expected three finite numbers"),
    ({"spacing": (1, -1, 1)}, ValueError, "spacing: found"),
    ({"spacing": (1, 1, np.nan)}, ValueError, "spacing: found"),
    ({"origin": (1, 2, "x")}, ValueError, "could not convert|origin"),
    ({"origin": 3}, TypeError, "origin: found 3, expected three numbers"),
    ({"origin": (0, 0, 1e101)}, ValueError, "coordinates up to 1e100"),
    ({"directions": [[1, 0, 0], [1, 1, 0], [0, 0, 1]]}, ValueError, "perpendicular vectors of length 1"),
    ({"directions": [1, 0, 0]}, ValueError, "directions: found"),
    ({"centers": "corner"}, ValueError, "centers: found 'corner', expected \"node\" or \"cell\""),
])
def test_other_grids_are_refused(keywords, error, message):
    with pytest.raises(error, match=message):
        lamina.Volume(np.zeros((2, 3, 4), np.uint8), **keywords)


def test_where_samples_lie():
    volume = lamina.Volume(np.zeros((2, 3, 4), np.uint8), spacing=(1, 2, 3), origin=(10, 20, 30),
                           directions=[(0, 1, 0), (-1, 0, 0), (0, 0, 1)], centers=("cell", "node", "node"))
    assert volume.spacing == (1, 2, 3) and volume.origin == (10, 20, 30)
    assert volume.centers == ("cell", "node", "node")
    # x steps along +y, half a voxel more at each end; y along -x.
    assert volume.bounds == ((6, 19.5, 30), (10, 23.5, 33))
    assert np.array_equal(volume.directions, [(0, 1, 0), (-1, 0, 0), (0, 0, 1)])
    flat = lamina.Volume(np.zeros((1, 3, 4), np.uint8))
    assert flat.centers == ("node", "node", "cell")  # one sample: a voxel
    assert flat.bounds == ((0, 0, -0.5), (3, 2, 0.5))


def test_axes_change_nothing_but_the_view(blob, function):
    picture = lamina.render(blob, function, size=(32, 24), context="cpu")
    for axes in ("xyz", "yzx"):
        turned = blob.array.transpose(["zyx".index(letter) for letter in axes])
        same = lamina.Volume(turned, spacing=blob.spacing, axes=axes)
        assert np.array_equal(lamina.render(same, function, size=(32, 24), context="cpu").array, picture.array)


def test_nan_is_as_the_scene_says(blob, function):
    values = np.array(blob.array)
    values[3, 4, 5] = np.nan
    volume = lamina.Volume(values, spacing=blob.spacing)
    with pytest.raises(lamina.Error, match="nan"):
        lamina.render(volume, function, size=(16, 12))
    picture = lamina.render(volume, function, size=(16, 12), nan="transparent")
    assert np.isfinite(picture.array).all() and picture.array.max() > 0


def test_volumes_come_back_from_files(blob, tmp_path):
    file = tmp_path / "blob.nrrd"
    blob.save(file)
    again = lamina.read(file)
    assert np.array_equal(again.array, blob.array) and again.spacing == blob.spacing and again.file == file
    assert again.bounds == blob.bounds and again.centers == blob.centers
    with pytest.raises(lamina.Error, match="suffix"):
        blob.save(tmp_path / "blob.vti")
    with pytest.raises(lamina.Error, match="nothing.nrrd: no such file"):
        lamina.read(tmp_path / "nothing.nrrd")


def test_units_of_files_are_kept(tmp_path):
    header = "NRRD0004\ntype: uint8\ndimension: 3\nspace: 3D-right-handed\nspace units: \"um\" \"um\" \"um\"\n"
    header += "sizes: 2 2 2\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nencoding: raw\n\n"
    (tmp_path / "a.nrrd").write_bytes(header.encode() + bytes(8))
    volume = lamina.read(tmp_path / "a.nrrd").copy()
    assert volume.unit == "um" and lamina.Volume(volume.array).unit == ""
    volume.save(tmp_path / "b.nrrd")
    assert lamina.read(tmp_path / "b.nrrd").unit == "um"


def test_info_is_that_of_the_command_line(program, tmp_path):
    np.save(tmp_path / "four.npy", np.arange(2 * 3 * 4 * 5, dtype=np.int16).reshape(2, 3, 4, 5))
    labels = "NRRD0005\ntype: uint8\ndimension: 3\nsizes: 2 1 1\nencoding: raw\nSegment0_ID:=s\n"
    labels += "Segment0_LabelValue:=2\nSegment0_Name:=liver\n\n"
    (tmp_path / "labels.seg.nrrd").write_bytes(labels.encode() + bytes([1, 2]))
    (tmp_path / "a.bin").write_bytes(bytes(range(8)))
    mesh = lamina.Mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2, 3)], [0, 1, 2, 3])
    mesh.save(tmp_path / "a.vtu")
    (tmp_path / "two.pvd").write_text('<VTKFile type="Collection" version="0.1"><Collection>'
                                      '<DataSet timestep="0.5" file="a.vtu"/><DataSet timestep="2" file="a.vtu"/>'
                                      '</Collection></VTKFile>')

    def said(file, *options):
        return json.loads(subprocess.run([program, "info", "--json", tmp_path / file, *options], capture_output=True,
                                         check=True).stdout)
    with pytest.warns(lamina.PictureWarning, match="is taken for channels"):
        assert lamina.info(tmp_path / "four.npy") == said("four.npy")
    second = lamina.info(tmp_path / "four.npy", channel=1)
    assert second == said("four.npy", "--set", "volume.channel=1") and second["channels"] == ["", ""]
    with pytest.warns(lamina.PictureWarning, match="labels"):
        named = lamina.info(str(tmp_path / "labels.seg.nrrd"))
    assert named == said("labels.seg.nrrd") and named["labels"][1]["name"] == "liver"
    assert lamina.info(tmp_path / "a.bin", size=(2, 2, 2), type="uint8") == said("a.bin", "--raw", "2,2,2,uint8")
    steps = lamina.info(tmp_path / "two.pvd", time=1)
    with pytest.raises(lamina.Error, match="found scalar, expected time"):
        lamina.info(tmp_path / "two.pvd", scalar="T")
    assert steps == said("two.pvd", "--set", "mesh.time=1") and steps["times"] == ["0.5", "2"]
    (tmp_path / "s.json").write_text("{}")
    with pytest.raises(lamina.Error, match="s.json: holds a scene, expected a volume or a mesh"):
        lamina.info(tmp_path / "s.json")
    (tmp_path / "below").mkdir()
    with pytest.raises(lamina.Error, match="not below"):
        lamina.info(tmp_path / "four.npy", only_below=tmp_path / "below")


def test_what_a_file_does_not_say_is_told(function, tmp_path):
    stored = np.arange(2 * 3 * 4, dtype=">u2").reshape(2, 3, 4)
    (tmp_path / "a.bin").write_bytes(b"head" + stored.tobytes())
    volume = lamina.read(tmp_path / "a.bin", size=(4, 3, 2), type="uint16", offset=4, endian="big", spacing=(1, 2, 3))
    assert np.array_equal(volume.array, stored) and volume.spacing == (1, 2, 3)
    scene = lamina.render(volume, function, size=(8, 6)).scene
    assert scene["volume"]["path"] == str(tmp_path / "a.bin") and scene["volume"]["endian"] == "big"
    scene.save(tmp_path / "a.json")
    assert lamina.Scene.load(tmp_path / "a.json")["volume"] == scene["volume"]
    with pytest.raises(lamina.Error, match="a.bin: channel: expected no such key: raw files hold only one"):
        lamina.read(tmp_path / "a.bin", size=(4, 3, 2), type="uint16", channel=1)
    with pytest.raises(lamina.Error, match="chanel.*channel"):
        lamina.read(tmp_path / "a.bin", chanel=1)


def test_bare_arrays_are_volumes(blob, function):
    picture = lamina.render(blob.array, function, size=(16, 12))
    assert picture.array.max() > 0
    with pytest.raises(TypeError, match="found int, expected a Volume, a Mesh, an array"):
        lamina.render(3)


def test_labels_of_files_have_their_numbers(tmp_path):
    stored = np.zeros((3, 40, 40), np.int64)
    stored[1] = 9
    stored[2] = 5_000_000_000
    np.save(tmp_path / "a.npy", stored)
    volume = lamina.read(tmp_path / "a.npy", lookup="nearest")
    assert volume.lookup == "nearest" and volume.dtype == np.uint8
    assert volume.labels == {0: (0, ""), 1: (9, ""), 2: (5_000_000_000, "")} == volume.copy().labels
    palette = [(0, "black", 0), (9, "red", 100), (5e9, "blue", 100)]
    picture = lamina.render(volume, lamina.TransferFunction(palette, interpolation="nearest"), size=(8, 8))
    red, green, blue = picture.array[4, 4, :3]  # seen from +z
    assert red < 0.01 and green == 0 and blue > 0.99
    assert lamina.Volume(stored.astype(np.uint8)).labels == {}


def test_labels_in_arrays_have_their_numbers_too():
    stored = np.zeros((3, 8, 8), np.int64)
    stored[1], stored[2] = 2**53, 2**53 + 1  # one number as doubles
    with pytest.warns(lamina.PictureWarning, match="array: its 3 labels, from 0 to 9007199254740993, are numbered 0 to 2"):
        volume = lamina.Volume(stored, lookup="nearest", spacing=2)
    assert volume.lookup == "nearest" and volume.dtype == np.uint8 and volume.conversion == ""
    assert volume.spacing == (2, 2, 2)
    assert volume.labels == {0: (0, ""), 1: (2**53, ""), 2: (2**53 + 1, "")}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        small = lamina.Volume(stored.astype(bool).astype(np.float64), lookup="nearest")
        halves = lamina.Volume(np.full((2, 2, 2), .5, np.float32), lookup="nearest")
    assert small.dtype == np.uint8 and small.labels == {}
    assert halves.dtype == np.float32 and halves.lookup == "nearest"


def test_arrays_that_look_like_labels_are_named():
    def said(array, **keywords):
        with warnings.catch_warnings(record=True) as found:
            warnings.simplefilter("always")
            volume = lamina.Volume(array, **keywords)
            for _ in range(2):  # pictures of the volume say nothing more
                lamina.render(volume, size=(8, 8), context="cpu")
        count = sum("look like labels" in str(one.message) for one in found)
        assert count <= 1
        return count == 1

    stored = np.zeros((40, 40, 40), np.uint8)
    stored[10:20, 10:20, 10:20] = 7
    assert said(stored) and said(stored.astype(float)) and said(stored.astype(int) * 10000)
    assert not said(stored, lookup="nearest")
    assert not said(stored, lookup="linear")
    assert not said(stored > 0)  # a mask is a field as well
    assert not said(np.random.default_rng(1).integers(0, 200, (40, 40, 40)))


def test_what_is_taken_for_labels_is_said(tmp_path):
    stored = np.zeros((40, 40, 40), np.int32)
    stored[10:20, 10:20, 10:20] = 70000
    np.save(tmp_path / "a.npy", stored)
    with pytest.warns(lamina.PictureWarning, match="a.npy: its samples are taken for labels, as 98.*six neighbours"):
        volume = lamina.read(tmp_path / "a.npy")
    assert volume.labels == {0: (0, ""), 1: (70000, "")}


def test_saved_labels_are_read_again(tmp_path):
    head = "NRRD0005\ntype: int64\ndimension: 3\nsizes: 2 2 1\nencoding: ascii\nSegment0_ID:=s\n"
    head += "Segment0_LabelValue:=5000000000\nSegment0_Name:=liver\nSegment0_Color:=1 0 .5\n\n0 0 7 5000000000\n"
    (tmp_path / "a.seg.nrrd").write_text(head)
    with pytest.warns(lamina.PictureWarning):
        volume = lamina.read(tmp_path / "a.seg.nrrd")
        assert volume.labels == {0: (0, ""), 1: (7, ""), 2: (5_000_000_000, "liver")}
        volume.save(tmp_path / "b.nrrd")
        assert lamina.read(tmp_path / "b.nrrd").labels == volume.labels
    header, samples = (tmp_path / "b.nrrd").read_bytes().split(b"\n\n", 1)  # as others read it
    assert b"type: uint32" not in header and b"type: int64" in header or b"type: uint64" in header
    assert list(np.frombuffer(samples, np.int64)) == [0, 0, 7, 5_000_000_000]
    assert b"Segment0_LabelValue:=5000000000" in header and b"Segment0_Name:=liver" in header
