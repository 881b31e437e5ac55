// SPDX-License-Identifier: Apache-2.0
#include "lamina/mesh_making.h"

#include <utility>

#include "base/client.h"
#include "meshing/volume_mesh.h"

namespace lamina {

MadeMesh make_mesh(const Volume& volume, const MeshSettings& settings,
                   const TransferFunction* transfer_function, std::stop_token stop,
                   const ProgressCallback& progress) {
    ProgressListener listener{progress};
    const ClientScope scope({std::move(stop), nullptr, &listener});
    MadeMesh made;
    made.mesh = make_volume_mesh(volume, settings, transfer_function, made.report);
    return made;
}

}  // namespace lamina
