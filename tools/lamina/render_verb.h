// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>

#include "render_job.h"

namespace lamina {

using RenderJobMaker = std::function<std::unique_ptr<RenderJob>(const RenderRequest&)>;

// The verb `render`, whose pictures `make_job` draws.
CLI::App& add_render_with(CLI::App& app, const RenderJobMaker& make_job);

}  // namespace lamina
