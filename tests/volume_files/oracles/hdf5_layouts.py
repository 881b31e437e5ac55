# SPDX-License-Identifier: Apache-2.0
"""HDF5 files in the layouts of programs: Chimera, DREAM.3D, Velox, Octave, Imaris, BigDataViewer, VTK and ITK, by h5py."""
import numpy as np

from .cases import diagonal, ramp, rotation


def geometries(h5py, cases, write, add, bad):
    """Steps and places that programs write along x, y and z beside an array [z, y, x]."""
    array = ramp()
    with h5py.File(cases.path("map.cmap"), "w") as file:
        file["Chimera/image1/data_zyx"] = array
        file["Chimera/image1"].attrs.update({"step": [.9, .7, 2.5], "origin": [1., 2., 3.]})
    add("map.cmap", array, diagonal(.9, .7, 2.5), (1, 2, 3))
    with h5py.File(cases.path("turned.cmap"), "w") as file:
        file["Chimera/image1/data_zyx"] = array
        file["Chimera/image1"].attrs.update({"step": [.9, .7, 2.5], "origin": [1., 2., 3.],
                                             "rotation_axis": [0., 0., 1.], "rotation_angle": 45.})
    add("turned.cmap", array, diagonal(.9, .7, 2.5), (1, 2, 3), warnings=["rotation_angle and cell_angles are not used"])
    with h5py.File(cases.path("grains.dream3d"), "w") as file:
        group = file.create_group("DataContainers/Grains")
        group["_SIMPL_GEOMETRY/SPACING"] = np.array([.9, .7, 2.5], "f4")
        group["_SIMPL_GEOMETRY/ORIGIN"] = np.array([1, 2, 3], "f4")
        group["CellData/Ids"] = array[..., None]
    add("grains.dream3d", array, diagonal(.9, .7, 2.5), (1.45, 2.35, 4.25))
    with h5py.File(cases.path("velox.emd"), "w") as file:
        group = file.create_group("Data/Image/0123abcd")
        group["Data"], group["Metadata"] = array, np.zeros((300, array.shape[2]), "u1")
    add("velox.emd", array[None, :, :, 0], warnings=["time 0 of", "Velox keeps the sizes of pixels"])
    add("velox.emd", array[None, :, :, 3], time=3)
    with h5py.File(cases.path("octave.h5"), "w") as file:
        file["v/value"] = array
        file["v"].attrs["OCTAVE_NEW_FORMAT"] = np.uint8(1)
    add("octave.h5", array, warnings=["Octave has written it: its first axis (rows) is taken for x"])


def imaris(h5py, cases, write, add, bad):
    """The last chunks are padded; sizes and extents are texts of one letter each."""
    def letters(text):
        return np.array([letter.encode() for letter in text], "S1")
    arrays = {}
    with h5py.File(cases.path("im.ims"), "w") as file:
        file.attrs["ImarisDataSet"] = letters("ImarisDataSet")
        for level, size in enumerate(((8, 10, 12), (4, 5, 6))):
            for time in range(2):
                for channel in range(2):
                    group = file.create_group(f"DataSet/ResolutionLevel {level}/TimePoint {time}/Channel {channel}")
                    padded = np.full((16, 16, 16), 999, "<u2")
                    array = ramp("<u2", size) + 2000 * channel + 4000 * time
                    padded[:size[0], :size[1], :size[2]] = array
                    group.create_dataset("Data", data=padded, chunks=(8, 8, 8), compression="gzip")
                    for axis, count in zip("ZYX", size):
                        group.attrs[f"ImageSize{axis}"] = letters(str(count))
                    arrays[level, time, channel] = array
        image = file.create_group("DataSetInfo/Image")
        for axis, (low, high) in enumerate(((1, 11.8), (0, 7), (-5, 15))):
            image.attrs[f"ExtMin{axis}"] = letters(str(low))
            image.attrs[f"ExtMax{axis}"] = letters(str(high))
        image.attrs["Unit"] = letters("um")
        for channel, name in enumerate(("DAPI", "GFP")):
            file.create_group(f"DataSetInfo/Channel {channel}").attrs["Name"] = letters(name)
        times = file.create_group("DataSetInfo/TimeInfo")
        times.attrs["TimePoint1"], times.attrs["TimePoint2"] = letters("2020-01-01"), letters("2020-01-02")
        file["Thumbnail/Data"] = np.zeros((4, 4, 4), "u1")
    contents = {"channels": ["DAPI", "GFP"], "times": ["2020-01-01", "2020-01-02"], "levels": [[12, 10, 8], [6, 5, 4]]}
    for (level, time, channel), array in arrays.items():
        steps, half = np.array([.9, .7, 2.5]) * 2 ** level, 2 ** level / 2
        where = np.array([1, 0, -5]) + np.array([.9, .7, 2.5]) * half
        add("im.ims", array, np.diag(steps), where, "um", contents, cell=True, level=level, time=time, channel=channel)
    add("im.ims", arrays[0, 0, 0], diagonal(.9, .7, 2.5), (1.45, .35, -3.75), "um", cell=True,
        warnings=["level 0 of 2 is taken", "channel 0 of 2 is taken", "time 0 of 2 is taken"])
    for start in ("/", "", "//"):
        bad("im.ims", "level, time and channel choose it",
            array=f"{start}DataSet/ResolutionLevel 0/TimePoint 0/Channel 0/Data")
    bad("im.ims", "channel: found 2, expected a whole number from 0 to 1", channel=2)
    first, place = "DataSet/ResolutionLevel 0/TimePoint 0/Channel 0", "DataSetInfo/Image"
    for name, group, key, text, expected in (
            ("far", place, "ExtMax0", "far", "expected a number"), ("comma", place, "ExtMax1", "10,8", "expected a number"),
            ("end", place, "ExtMin2", "1.5 um", "expected a number"), ("none", place, "ExtMin2", " ", "expected a number"),
            ("half", first, "ImageSizeX", "11.5", "expected a whole number"), ("padded", place, "ExtMax0", "11.8  ", "")):
        with h5py.File(cases.path("im.ims"), "r") as old, h5py.File(cases.path(f"im_{name}.ims"), "w") as file:
            for part in old:
                old.copy(part, file)
            file[group].attrs[key] = letters(text)
        if expected:
            bad(f"im_{name}.ims", f"/{group}: {key}: found", text, expected, level=0, channel=0, time=0)
        else:
            add(f"im_{name}.ims", arrays[0, 0, 0], diagonal(.9, .7, 2.5), (1.45, .35, -3.75), "um", cell=True, level=0,
                channel=0, time=0)


def big_data_viewer(h5py, cases, write, add, bad):
    fine, coarse = ramp("<i2", (4, 6, 8)), ramp("<i2", (4, 3, 4))
    fine[0, 0, 0] = -1  # 65535: BigDataViewer's shorts have no sign
    with h5py.File(cases.path("bdv.h5"), "w") as file:
        for time in range(2):
            for setup in range(2):
                file[f"t{time:05}/s{setup:02}/0/cells"] = fine + time * 10 + setup
                file[f"t{time:05}/s{setup:02}/1/cells"] = coarse + time * 10 + setup
        for setup in range(2):
            file[f"s{setup:02}/resolutions"] = np.array([[1, 1, 1], [2, 2, 1]], "f8")
            file[f"s{setup:02}/subdivisions"] = np.array([[4, 4, 4], [4, 4, 4]], "i4")
    add("bdv.h5", fine.view("u2"), warnings=["the sizes of voxels in its .xml"])
    for request in ({"level": 1, "time": 1, "channel": 1}, {"array": "/t00001/s01/1/cells"},
                    {"array": "t00001//s01/1/cells", "time": 1}):
        add("bdv.h5", (coarse + 11).view("u2"), diagonal(2, 2, 1), (.5, .5, 0), **request,
            contents={"channels": ["", ""], "times": ["", ""]}, warnings=["the sizes of voxels in its .xml"])
    bad("bdv.h5", "time: found 0, expected 1 or none", "/t00001/s01/1/cells", array="/t00001/s01/1/cells", time=0)
    bad("bdv.h5", "level: found 2, expected a whole number from 0 to 1", array="/t00001/s01/2/cells")


def vtk_images(h5py, cases, write, add, bad):
    """VTKHDF by its specification: arrays of points and cells, times, components, directions."""
    def image(file, kind="ImageData", turn=None, extent=(2, 7, -1, 3, 4, 7)):
        root = file.create_group("VTKHDF")
        root.attrs["Version"] = [2, 0]
        root.attrs.create("Type", kind.encode("ascii"), dtype=h5py.string_dtype("ascii", len(kind)))
        root.attrs["WholeExtent"] = list(extent)
        root.attrs["Origin"], root.attrs["Spacing"] = [1., 2, 3], [.5, .75, 2]
        if turn is not None:
            root.attrs["Direction"] = turn.ravel()
        return root
    turn = rotation(.3, .2, .1)
    points, cells = ramp(), ramp("<f4", (3, 4, 5))
    colours = ramp("u1", (4, 5, 6, 3))
    with h5py.File(cases.path("image.vtkhdf"), "w") as file:
        root = image(file, turn=turn)
        root.create_group("PointData").attrs["Scalars"] = "a"
        root["PointData/a"], root["PointData/0"], root["CellData/cells"] = points, colours, cells
    spacing = np.array([.5, .75, 2])
    steps = (turn * spacing).T  # the matrix's columns are the axes
    first = np.array([1, 2, 3]) + np.array([2, -1, 4]) @ steps
    arrays = {"arrays": ["/VTKHDF/PointData/0", "/VTKHDF/PointData/a", "/VTKHDF/CellData/cells"]}
    add("image.vtkhdf", points, steps, first)
    add("image.vtkhdf", colours[..., 2], steps, first, array="0", channel=2)
    add("image.vtkhdf", cells, steps, first + np.array([.5, .5, .5]) @ steps, array="/VTKHDF/CellData/cells", cell=True,
        contents=arrays)
    bad("image.vtkhdf", "array: found \"none\"", "/VTKHDF/PointData/a", array="none")
    with h5py.File(cases.path("times.vtkhdf"), "w") as file:
        root = image(file)
        root["PointData/a"] = np.stack([points, points + 1000])
        group = root.create_group("Steps")
        group.attrs["NSteps"] = 3
        group["Values"] = [0., .5, 1.5]
        group["PointDataOffsets/a"] = [1, 0, 1]
    for time, values in ((0, points + 1000), (1, points), (2, points + 1000)):
        add("times.vtkhdf", values, np.diag(spacing), np.array([1, 2, 3]) + np.array([2, -1, 4]) * spacing, time=time,
            contents={"times": ["0", "0.5", "1.5"]})
    bad("times.vtkhdf", "time: found 3", time=3)
    with h5py.File(cases.path("mesh.vtkhdf"), "w") as file:
        image(file, "UnstructuredGrid")
    for name, link in (("away", h5py.ExternalLink("times.vtkhdf", "/VTKHDF/PointData")),
                       ("soft", h5py.SoftLink("/VTKHDF/CellData"))):
        with h5py.File(cases.path(f"{name}.vtkhdf"), "w") as file:
            root = image(file)
            root["CellData/cells"] = cells
            root["PointData"] = link
        for request in ({}, {"array": "a"}):
            bad(f"{name}.vtkhdf", "/VTKHDF/PointData: found no such group in the file itself", **request)
    bad("mesh.vtkhdf", "VTKHDF of type \"UnstructuredGrid\"", ".vtu")
    with h5py.File(cases.path("short.vtkhdf"), "w") as file:
        image(file, extent=(0, 9, 0, 4, 0, 3))["PointData/a"] = points
    bad("short.vtkhdf", "found 6 samples, expected 10")


def itk(h5py, cases, write, add, bad):
    turn = rotation(.3, .2, .1)
    with h5py.File(cases.path("itk.hdf5"), "w") as file:
        group = file.create_group("ITKImage/0")
        group["Dimension"], group["Origin"], group["Spacing"] = [6, 5, 4], [1., 2, 3], [.5, .75, 2]
        group["Directions"], group["VoxelData"] = turn, ramp()
    for array in ("", "/ITKImage/0/VoxelData", "ITKImage/0/VoxelData"):
        add("itk.hdf5", ramp(), turn * np.array([.5, .75, 2])[:, None], (1, 2, 3), lps=True, array=array)
