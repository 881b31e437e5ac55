// SPDX-License-Identifier: Apache-2.0
// FuzzTarget::run of every target. Comments say what an input is; inputs of several parts are cut
// at part_mark (input_parts.h).
#pragma once

#include <string_view>

namespace lamina::fuzz {

void run_colormap(std::string_view input);  // a ParaView preset
void run_dicom(std::string_view input);     // a slice, another slice
void run_exr(std::string_view input);       // a picture, as `lamina compare` reads it
void run_hdf5(std::string_view input);
void run_integrate(std::string_view input);  // cases of `lamina integrate`
void run_metaimage(std::string_view input);  // the file, its data file
void run_netcdf(std::string_view input);     // classic NetCDF
void run_nifti(std::string_view input);      // the file, the .img of a pair
void run_node_ele(std::string_view input);   // .node, .ele
void run_npy(std::string_view input);
void run_npy_volume(std::string_view input);
void run_nrrd(std::string_view input);      // the file, the data file of a detached header
void run_pictures(std::string_view input);  // a PNG or JPEG file, as a volume
void run_plan(std::string_view input);      // a scene; its volume is replaced by a small one
void run_png(std::string_view input);       // a picture, as in run_exr()
void run_scene(std::string_view input);     // a scene, its colour map
void run_study(std::string_view input);     // a study, its scene
void run_pvd(std::string_view input);  // a .pvd or .pvtu, the .vtu that it may name ("mesh.vtu")
void run_tiff(std::string_view input);
void run_vti(std::string_view input);  // any image of VTK, the piece that it may name ("piece.vti")
void run_vtk(std::string_view input);
void run_vtu(std::string_view input);
// A ZIP archive, or .zarray or an array's zarr.json, then .zattrs or the group's zarr.json (may be
// empty), then a chunk.
void run_zarr(std::string_view input);

}  // namespace lamina::fuzz
