// SPDX-License-Identifier: Apache-2.0
#include "fuzz_target.h"

#include "runs.h"

namespace lamina::fuzz {

std::span<const FuzzTarget> fuzz_targets() {
    static constexpr FuzzTarget all[] = {{"colormap", run_colormap},
                                         {"dicom", run_dicom, few_mutations},
                                         {"exr", run_exr},
                                         {"hdf5", run_hdf5, few_mutations},
                                         {"integrate", run_integrate},
                                         {"metaimage", run_metaimage},
                                         {"netcdf", run_netcdf},
                                         {"nifti", run_nifti},
                                         {"npy_volume", run_npy_volume},
                                         {"pictures", run_pictures, few_mutations},
                                         {"tiff", run_tiff, few_mutations},
                                         {"vti", run_vti},
                                         {"node_ele", run_node_ele},
                                         {"npy", run_npy},
                                         {"nrrd", run_nrrd},
                                         {"plan", run_plan},
                                         {"png", run_png},
                                         {"pvd", run_pvd},
                                         {"scene", run_scene},
                                         {"study", run_study},
                                         {"vtk", run_vtk},
                                         {"vtu", run_vtu},
                                         {"zarr", run_zarr}};
    return all;
}

}  // namespace lamina::fuzz
