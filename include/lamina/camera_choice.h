// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/camera.h"
#include "lamina/export.h"
#include "lamina/mesh_data.h"
#include "lamina/scene.h"
#include "lamina/volume.h"

namespace lamina {

// Returns the automatic camera (docs/first-picture.md), which fits what the scene shows of the
// data, turned around that by degrees to the right (azimuth) and up (elevation). It depends on the
// scene's transfer function, which may be automatic, and on the picture's size. Throws Error if the
// data have no finite value.
LAMINA_API Camera fitted_camera(const Scene& scene, const Volume& volume, double azimuth = 0,
                                double elevation = 0);
LAMINA_API Camera fitted_camera(const Scene& scene, const MeshData& mesh, double azimuth = 0,
                                double elevation = 0);

// Returns the transfer function that a picture of the volume has: the scene's, or one chosen from
// the data if it is automatic. A colour map without a range is stretched over the data. Throws
// Error.
LAMINA_API TransferFunction chosen_transfer_function(const Scene& scene, const Volume& volume);

}  // namespace lamina
