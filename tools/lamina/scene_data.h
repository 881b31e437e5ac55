// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "choice/choose.h"
#include "choice/field.h"
#include "lamina/scene.h"
#include "render_stats.h"
#include "scene/scene_mesh.h"
#include "volume/volume_data.h"

namespace lamina {

// The data that a scene draws: one of the two.
struct SceneData {
    std::shared_ptr<const VolumeData> volume;
    std::shared_ptr<const SceneMesh> mesh;

    // As choices and warnings see it; the data must outlive it.
    std::unique_ptr<Field> field() const;
};

// Loads what the scene draws, and makes the scene what it is then: with transfer function and
// camera chosen, where they are automatic, and changed as wished.
SceneData load_data(Scene& scene, const Wishes& wishes, RenderStats& stats);

// Chooses what the scene leaves open from its volume, whatever it draws.
void choose_for_volume(Scene& scene);

// The scene as a document that load_scene() reads: all of it that is not about drawing, and what
// `document` says about that.
nlohmann::ordered_json document_of(const Scene& scene, const nlohmann::json& document);

}  // namespace lamina
