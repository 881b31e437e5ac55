// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "render/volume_data.h"
#include "render_job.h"

namespace lamina {

// The volume of a scene that is rendered.
std::shared_ptr<const VolumeData> load_volume_data(const RenderRequest& request,
                                                   RenderStats& stats);

// Says and counts what is noteworthy of it, once it is known that it can be drawn.
void report_volume(const RenderRequest& request, const VolumeData& data, RenderStats& stats);

}  // namespace lamina
