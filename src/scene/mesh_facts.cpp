// SPDX-License-Identifier: Apache-2.0
#include "scene/mesh_facts.h"

#include "base/error.h"
#include "mesh/scalar_range.h"

namespace lamina {

MeshFacts measure(const Scene& scene, const SceneMesh& mesh) {
    MeshFacts facts;
    facts.points = static_cast<std::int64_t>(mesh.mesh.points().size());
    facts.tets = static_cast<std::int64_t>(mesh.mesh.tets().size());
    facts.scalar = mesh.scalar.name;
    facts.findings = mesh.mesh.findings();
    const ScalarRange found = measure_range(mesh.scalar.values);
    facts.range = found.range;
    facts.non_finite = found.non_finite;
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
