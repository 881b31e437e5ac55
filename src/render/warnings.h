// SPDX-License-Identifier: Apache-2.0
// Sentences about data, plan and picture that every front end shows to people, word for word.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/client.h"
#include "choice/field.h"
#include "lamina/image.h"
#include "lamina/scene.h"
#include "plan/plan.h"
#include "scene/scene_mesh.h"
#include "visibility/visibility_order.h"
#include "volume/volume_data.h"

namespace lamina {

using Warnings = std::vector<std::string>;

// Samples and cells that are not drawn, or drawn otherwise than the file has them.
Warnings data_warnings(const VolumeData& data);
Warnings data_warnings(const Scene& scene, const SceneMesh& mesh);

// Errors above the scene's max_error, and colours that the target clamps. The scene is one with
// nothing automatic.
Warnings plan_warnings(const Scene& scene, const SlicePlan& plan);
// Colours that the target clamps, and tets of the mesh that overlap others.
Warnings plan_warnings(const Scene& scene, std::int64_t overlapping_tets);

// Tets that were drawn in a wrong order.
Warnings frame_warnings(const OrderReport& order);
// Pixels whose rays meet tets that overlap.
Warnings trace_warnings(std::int64_t overlapping_rays);

// Says each (base/client.h).
void warn_of_all(const Warnings& all);

// Calls work(), and keeps in `said` what it says to the client.
template <typename Work>
auto keep_warnings(Warnings& said, const Work& work) {
    said.clear();
    Client client = ClientScope::current();
    const WarningTaker* const taker = client.warnings;
    const WarningTaker keeper = [&](const std::string& text) {
        said.push_back(text);
        if (taker != nullptr && *taker) (*taker)(text);
    };
    client.warnings = &keeper;
    const ClientScope scope(std::move(client));
    return work();
}

// Warns where a picture of the scene shows nothing, and says why; where more than half of it is
// saturated; and where a colour map's range lies outside that of the data. The scene is one with
// nothing automatic, the field its data.
void warn_of_picture(const Scene& scene, const Field& field, const Image& picture);

// The number of points of the transfer function with a component of the colour above 1, which the
// target clamps.
std::int64_t clamped_colors(const Scene& scene);

}  // namespace lamina
