// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render_job.h"

namespace lamina {

// Colours above 1 do not fit a fixed-point target: they are clamped there, counted and said.
void count_clamped_colors(const RenderRequest& request, RenderStats& stats);

}  // namespace lamina
