// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "parallel/leader.h"
#include "render_job.h"

namespace lamina {

// Draws the frames of a volume with all ranks. Throws Error where they cannot share the scene.
std::unique_ptr<RenderJob> make_shared_slice_job(const RenderRequest& request, Leader& leader);

}  // namespace lamina
