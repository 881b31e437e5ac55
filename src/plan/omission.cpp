// SPDX-License-Identifier: Apache-2.0
#include "plan/omission.h"

namespace lamina {

std::vector<std::string> omission_names() {
    return {"blending",
            "clip_planes",
            "color",
            "constant_regions",
            "double_precision",
            "drawing",
            "early_termination",
            "empty_space",
            "length_layers",
            "order",
            "perspective",
            "scalars",
            "smooth_points",
            "table",
            "transparent_tets",
            "volume_texture"};
}

}  // namespace lamina
