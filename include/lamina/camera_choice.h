// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/camera.h"
#include "lamina/export.h"
#include "lamina/mesh_data.h"
#include "lamina/scene.h"
#include "lamina/volume.h"

namespace lamina {

// The camera that fits what the scene shows of the data, as where it is "auto"
// (docs/first-picture.md), gone around that by degrees to the right and up. Of the scene its
// transfer function (which may be automatic) and its size count. Throws Error where the data have
// no finite value.
LAMINA_API Camera fitted_camera(const Scene& scene, const Volume& volume, double azimuth = 0,
                                double elevation = 0);
LAMINA_API Camera fitted_camera(const Scene& scene, const MeshData& mesh, double azimuth = 0,
                                double elevation = 0);

// The transfer function that a picture of the volume has: the scene's, chosen from the data if it
// is automatic, with a colour map without a range stretched over them. Throws Error.
LAMINA_API TransferFunction chosen_transfer_function(const Scene& scene, const Volume& volume);

}  // namespace lamina
