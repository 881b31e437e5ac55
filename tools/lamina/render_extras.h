// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <nlohmann/json_fwd.hpp>

#include "render/pipeline.h"

namespace lamina {

// Additions of a program to the verb `render`; all of them may be empty.
struct RenderExtras {
    // Throws if the program cannot draw the scene with that --context.
    std::function<void(const Scene& scene, const Auto<ContextChoice>& context)> check;
    FramesMaker make_frames;
    // Adds to what --stats writes, after the last frame.
    std::function<void(nlohmann::ordered_json&)> add_statistics;
};

CLI::App& add_render_with(CLI::App& app, const RenderExtras& extras);

}  // namespace lamina
