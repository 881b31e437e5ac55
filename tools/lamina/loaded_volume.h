// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render_job.h"
#include "scene/facts.h"
#include "volume/volume.h"

namespace lamina {

// The volume of a scene that is rendered, measured; what is noteworthy is said and counted.
struct LoadedVolume {
    LoadedVolume(const RenderRequest& request, RenderStats& stats);

    Volume volume;
    Facts facts;
};

}  // namespace lamina
