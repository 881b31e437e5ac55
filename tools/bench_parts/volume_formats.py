# SPDX-License-Identifier: Apache-2.0
"""One volume of int16 in many file formats, written by the formats' own libraries (numpy, nibabel, tifffile, zarr,
h5py, pydicom, VTK), not compressed unless a name says so."""
import gzip
import importlib

import numpy

LIBRARIES = ["h5py", "nibabel", "pydicom", "tifffile", "vtk", "zarr"]


def ensure_libraries():
    for name in LIBRARIES:
        try:
            importlib.import_module(name)
        except ImportError as error:
            raise SystemExit(f"measured: {error}; install Debian's python3-{'vtk9' if name == 'vtk' else name}")


def samples(size):
    """A noisy volume, in the order z, y, x: one slice of noise, moved on from slice to slice."""
    noise = numpy.random.default_rng(1).integers(-1000, 1000, size[1:], dtype=numpy.int16)
    return numpy.stack([numpy.roll(noise, 7 * z, axis=1) + numpy.int16(z) for z in range(size[0])])


def nrrd(array, path, encoding):
    header = (f"NRRD0004\ntype: int16\ndimension: 3\nsizes: {' '.join(map(str, array.shape[::-1]))}\n"
              f"spacings: 1 1 1\nendian: little\nencoding: {encoding}\n\n").encode()
    data = array.tobytes()
    path.write_bytes(header + (gzip.compress(data, 1) if encoding == "gzip" else data))
    return path


def metaimage(array, path):
    sizes = " ".join(map(str, array.shape[::-1]))
    path.write_bytes(f"ObjectType = Image\nNDims = 3\nDimSize = {sizes}\nElementSpacing = 1 1 1\n"
                     "ElementByteOrderMSB = False\nElementType = MET_SHORT\nElementDataFile = LOCAL\n".encode()
                     + array.tobytes())
    return path


def npy(array, path):
    numpy.save(path, array)
    return path


def nifti(array, path):
    import nibabel
    nibabel.save(nibabel.Nifti1Image(array.transpose(2, 1, 0), numpy.eye(4)), path)
    return path


def tiff(array, path):
    import tifffile
    tifffile.imwrite(path, array, photometric="minisblack")
    return path


def zarr_folder(array, path):
    import zarr
    edge = min(64, *array.shape)
    stored = zarr.open(str(path), mode="w", shape=array.shape, dtype=array.dtype, chunks=(edge,) * 3, compressor=None)
    stored[...] = array
    return path


def hdf5(array, path):
    import h5py
    with h5py.File(path, "w") as file:
        file.create_dataset("density", data=array)
    return path


def vti(array, path, base64):
    import vtk
    from vtk.util import numpy_support
    image, writer = vtk.vtkImageData(), vtk.vtkXMLImageDataWriter()
    image.SetDimensions(array.shape[::-1])
    scalars = numpy_support.numpy_to_vtk(array.ravel(), deep=True, array_type=vtk.VTK_SHORT)
    scalars.SetName("density")
    image.GetPointData().SetScalars(scalars)
    writer.SetInputData(image)
    writer.SetFileName(str(path))
    writer.SetCompressorTypeToNone()
    writer.SetDataModeToAppended()
    writer.SetEncodeAppendedData(base64)
    writer.Write()
    return path


def dicom(array, path):
    """A folder of slices."""
    from pydicom.dataset import Dataset, FileMetaDataset
    from pydicom.uid import ExplicitVRLittleEndian, generate_uid
    path.mkdir()
    series = generate_uid()
    for z, pixels in enumerate(array):
        data = Dataset()
        data.file_meta = FileMetaDataset()
        data.file_meta.TransferSyntaxUID = ExplicitVRLittleEndian
        data.file_meta.MediaStorageSOPClassUID = data.SOPClassUID = "1.2.840.10008.5.1.4.1.1.2"
        data.file_meta.MediaStorageSOPInstanceUID = data.SOPInstanceUID = generate_uid()
        data.is_little_endian, data.is_implicit_VR = True, False
        data.Modality, data.SeriesInstanceUID, data.InstanceNumber = "CT", series, z + 1
        data.Rows, data.Columns = pixels.shape
        data.ImagePositionPatient, data.ImageOrientationPatient = [0, 0, z], [1, 0, 0, 0, 1, 0]
        data.PixelSpacing, data.SliceThickness = [1, 1], 1
        data.SamplesPerPixel, data.PhotometricInterpretation = 1, "MONOCHROME2"
        data.BitsAllocated, data.BitsStored, data.HighBit, data.PixelRepresentation = 16, 16, 15, 1
        data.PixelData = pixels.tobytes()
        data["PixelData"].VR = "OW"
        data.save_as(path / f"{z:04d}.dcm", write_like_original=False)
    return path


def write_all(folder, size):
    """Arguments that make lamina read each format, by the format's name; the first is a raw NRRD, which others are held
    against."""
    array = samples(size)
    return {"NRRD, raw": nrrd(array, folder / "raw.nrrd", "raw"),
            "NRRD, gzip": nrrd(array, folder / "gzip.nrrd", "gzip"),
            "MetaImage": metaimage(array, folder / "v.mha"), "NIfTI": nifti(array, folder / "v.nii"),
            "`.npy`": npy(array, folder / "v.npy"), "`.vti`, appended, raw": vti(array, folder / "raw.vti", False),
            "`.vti`, appended, base64": vti(array, folder / "base64.vti", True),
            "Zarr, chunks of 64^3": zarr_folder(array, folder / "v.zarr"),
            "HDF5": f"{hdf5(array, folder / 'v.h5')}:/density",
            "TIFF, a page a slice": tiff(array, folder / "v.tif"),
            "DICOM, a file a slice": dicom(array, folder / "dcm")}
