// SPDX-License-Identifier: Apache-2.0
#include "scene/mesh_facts.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace lamina {

MeshFacts measure(const Scene& scene, const SceneMesh& mesh) {
    MeshFacts facts;
    facts.points = static_cast<std::int64_t>(mesh.mesh.points().size());
    facts.tets = static_cast<std::int64_t>(mesh.mesh.tets().size());
    facts.scalar = mesh.scalar.name;
    facts.findings = mesh.mesh.findings();
    ValueRange range{INFINITY, -INFINITY};
    for (const double value : mesh.scalar.values) {
        if (!std::isfinite(value)) {
            ++facts.non_finite;
            continue;
        }
        range.lo = std::min(range.lo, value);
        range.hi = std::max(range.hi, value);
    }
    facts.range = range;
    const std::string file = scene.mesh_file.string();
    if (facts.range.empty())
        fail("{}: all {} values of \"{}\" are NaN or infinite", file, facts.points, facts.scalar);
    if (facts.non_finite > 0 && scene.nan == NanPolicy::error) {
        fail(
            "{}: found {} NaN or infinite values of \"{}\", expected none; \"nan\": "
            "\"transparent\" "
            "in the scene draws their tets as transparent",
            file, facts.non_finite, facts.scalar);
    }
    return facts;
}

}  // namespace lamina
