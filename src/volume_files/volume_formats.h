// SPDX-License-Identifier: Apache-2.0
// The readers of volumes: two or three functions for each format. is_NAME() tells by its content if
// a file or folder is of the format, and never throws. open_NAME() throws Error: one line that
// names the file. files_of_NAME() returns the file and those that belong to it, and throws Error.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "base/value_type.h"
#include "lamina/volume.h"
#include "volume_files/volume_opening.h"

namespace lamina {

// NRRD (http://teem.sourceforge.net/nrrd/format.html): three orthogonal axes of any scalar type in
// the file's own coordinates (`space origin` and `space directions`, or axis mins and `spacings`).
// Further axes have one sample, or are channel and time by their kinds and directions. Encodings
// are raw, gzip, bzip2 and ascii; the header is attached or names its data files.
bool is_nrrd(const std::filesystem::path& path);
Volume open_nrrd(const std::filesystem::path& path, const VolumeRequest& request = {},
                 const VolumeUse& use = {});
std::vector<std::filesystem::path> files_of_nrrd(const std::filesystem::path& path);

// A folder or ZIP archive with an array of Zarr version 2 or 3, or an OME-Zarr image, of which one
// level is read. Axes of a plain array have the meaning of their names, or are (time, channel,) z,
// y, x; arrays of coordinates place its samples, else they are 1 apart. In a group, `request.array`
// names an array or image, unless there is only one.
bool is_zarr(const std::filesystem::path& path);
Volume open_zarr(const std::filesystem::path& path, const VolumeRequest& request,
                 const VolumeUse& use);
std::vector<std::filesystem::path> files_of_zarr(const std::filesystem::path& path);

// An HDF5 or NetCDF-4 file, or an array in it, "FILE.h5:/PATH", which `request.array` may name,
// too. Axes, places and missing samples are those that attributes and dimension scales say
// (hdf5_layout.h, array_axes.h, packed_values.h); unnamed axes are z, y, x, with time and channel
// before them. Scaled samples do not stay in the file. is_hdf5() is there without libhdf5, too.
bool is_hdf5(const std::filesystem::path& path);
Volume open_hdf5(const std::filesystem::path& path, const VolumeRequest& request,
                 const VolumeUse& use);
std::vector<std::filesystem::path> files_of_hdf5(const std::filesystem::path& path);

// Classic NetCDF (CDF-1, CDF-2 and CDF-5), with axes and missing samples as in NetCDF-4.
bool is_netcdf_classic(const std::filesystem::path& path);
Volume open_netcdf_classic(const std::filesystem::path& path, const VolumeRequest& request,
                           const VolumeUse& use);
std::vector<std::filesystem::path> files_of_netcdf_classic(const std::filesystem::path& path);

// A DICOM file of several frames, or one series of a folder of DICOM files: the one whose UID or
// description request.array names, else the largest. If a series has several images at each place,
// request.time chooses. A folder is DICOM if one of its first 64 files is, or, if it has none but a
// DICOMDIR, of those in the folders inside it.
bool is_dicom(const std::filesystem::path& path);
Volume open_dicom(const std::filesystem::path& path, const VolumeRequest& request,
                  const VolumeUse& use);
std::vector<std::filesystem::path> files_of_dicom(const std::filesystem::path& path);

// MetaImage files (.mha, .mhd; https://itk.org/Wiki/ITK/MetaIO/Documentation): an image of three
// dimensions, or of four, the last of which is time, with channels; binary, compressed or as text;
// in the file itself, in another, in a list or in a numbered series. The rows of `TransformMatrix`
// are the axes. If `AnatomicalOrientation` names directions, the world's axes are LPS.
bool is_metaimage(const std::filesystem::path& path);
Volume open_metaimage(const std::filesystem::path& path, const VolumeRequest& request,
                      const VolumeUse& use);
std::vector<std::filesystem::path> files_of_metaimage(const std::filesystem::path& path);

// NIfTI-1 and NIfTI-2, with gzip or without, a single file or a pair (either name stands for both),
// of any real type, or of RGB and RGBA, whose colours are channels. The fourth axis is time; the
// fifth, the components of vectors, are channels. scl_slope and scl_inter are applied.
bool is_nifti(const std::filesystem::path& path);
Volume open_nifti(const std::filesystem::path& path, const VolumeRequest& request,
                  const VolumeUse& use);
std::vector<std::filesystem::path> files_of_nifti(const std::filesystem::path& path);

// VTK image data and rectilinear grids with even steps: XML files, their parallel forms, legacy
// files, and a .pvd of them, whose steps are times. The request's array, else the one that the file
// calls its scalars, else the first; arrays of points come before those of cells. Samples of points
// are nodes; those of cells lie in the cells' middles. Components are channels. Pieces are put
// together. is_vti() also knows VTK's kinds that are neither volume nor mesh: open_vti() says so.
bool is_vti(const std::filesystem::path& path);
Volume open_vti(const std::filesystem::path& path, const VolumeRequest& request,
                const VolumeUse& use);
std::vector<std::filesystem::path> files_of_vti(const std::filesystem::path& path);

// TIFF or BigTIFF with every compression that libtiff knows: slices are the pages of a file, or of
// a folder's files by the numbers in their names; all have one size and type. Samples of a pixel
// are channels; descriptions by ImageJ, OME or tifffile give channels, times and distances. An OME
// data set may have several files and images, of which `request.array` names one. Slices one behind
// the other that are not compressed can stay in their file.
bool is_tiff(const std::filesystem::path& path);
Volume open_tiff(const std::filesystem::path& path, const VolumeRequest& request,
                 const VolumeUse& use);
std::vector<std::filesystem::path> files_of_tiff(const std::filesystem::path& path);

// NumPy's format (NEP 1): an array [z, y, x] of any real type, byte order and memory order, with up
// to two axes more for channels and times; or an archive of arrays (.npz), of which `request.array`
// names one. Samples lie 1 apart from 0 on, as nodes.
bool is_npy(const std::filesystem::path& path);
Volume open_npy(const std::filesystem::path& path, const VolumeRequest& request,
                const VolumeUse& use);

// A PNG or JPEG file, a slice, or a folder of such files of one size and type, slices by the
// numbers in their names. Their colours are channels. Most of the folder's files must be pictures.
bool is_pictures(const std::filesystem::path& path);
Volume open_pictures(const std::filesystem::path& path, const VolumeRequest& request,
                     const VolumeUse& use);
std::vector<std::filesystem::path> files_of_pictures(const std::filesystem::path& path);

// Returns the type of NumPy's type word without byte order, such as "f8". "b1" (truth) is a byte.
std::optional<ValueType> numpy_type(std::string_view word);
// Returns what such a word that numpy_type() does not know means, and what to do, to end a message.
std::string numpy_advice(std::string_view word);

}  // namespace lamina
