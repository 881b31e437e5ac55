// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/enum_words.h"
#include "lamina/project_settings.h"

namespace lamina {

// Tells whether means of points of a tet, or of the ends of a segment, are shown: colours mix
// whatever their extinction, and only the vertices of a fan carry what is interpolated.
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
