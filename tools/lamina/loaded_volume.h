// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render_job.h"
#include "volume/volume_data.h"

namespace lamina {

// Says and counts what is noteworthy of the volume that is rendered, once it is known that it can
// be drawn.
void report_volume(const RenderRequest& request, const VolumeData& data, RenderStats& stats);

}  // namespace lamina
