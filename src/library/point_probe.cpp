// SPDX-License-Identifier: Apache-2.0
#include "lamina/point_probe.h"

#include <utility>

#include "library/point_probe_parts.h"
#include "reference/seen_point.h"

namespace lamina {

PointProbe::PointProbe(std::shared_ptr<Parts> parts) : parts_(std::move(parts)) {}

std::optional<SeenPoint> PointProbe::seen(double column, double row) const {
    if (parts_->volume) return seen_point(parts_->scene, parts_->volume->volume, column, row);
    const SceneMesh& mesh = *parts_->mesh;
    std::call_once(parts_->first,
                   [&] { parts_->open_faces.emplace(mesh.mesh, mesh.mesh.open_faces()); });
    return seen_point(parts_->scene, mesh, *parts_->open_faces, column, row);
}

}  // namespace lamina
