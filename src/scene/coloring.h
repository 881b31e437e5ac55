// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/enum_words.h"
#include "lamina/project_settings.h"

namespace lamina {

// Tells whether colours are means, of points of a tet or of the ends of a segment. Means mix
// colours whatever their extinction, and only the vertices of a fan carry interpolated values.
inline bool mixes_colors(Coloring coloring) {
    switch (coloring) {
        case Coloring::preintegrated:
        case Coloring::analytic:
            return false;
        case Coloring::attenuation:
        case Coloring::vertex:
            return true;
    }
    unreachable_enum();
}

}  // namespace lamina
