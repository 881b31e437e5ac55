// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>

#include "lamina/export.h"
#include "lamina/mesh_data.h"
#include "lamina/mesh_settings.h"
#include "lamina/session.h"
#include "lamina/transfer_function.h"
#include "lamina/volume.h"

namespace lamina {

struct MadeMesh {
    MeshData mesh;  // with one scalar at points, "scalar"
    MeshReport report;
};

// Makes tetrahedra that fill the volume's box (docs/meshes.md). They may be coarse for values that
// `transfer_function` does not show (chosen_transfer_function() returns that of a scene); if it is
// null, all values count. Throws Error for samples that are not finite, for a Kuhn split with more
// than settings.max_tets tets, and if lamina-tetrahedralize is neither beside the program or the
// library nor in PATH; Interrupted once a stop is requested.
LAMINA_API MadeMesh make_mesh(const Volume& volume, const MeshSettings& settings = {},
                              const TransferFunction* transfer_function = nullptr,
                              std::stop_token stop = {}, const ProgressCallback& progress = {});

}  // namespace lamina
