// SPDX-License-Identifier: Apache-2.0
#include "scene/project_settings.h"

namespace lamina {

const char* name_of(Coloring coloring) {
    switch (coloring) {
        case Coloring::preintegrated:
            return "preintegrated";
        case Coloring::attenuation:
            return "attenuation";
        case Coloring::vertex:
            return "vertex";
        default:
            return "analytic";
    }
}

const char* name_of(Interpolation interpolation) {
    return interpolation == Interpolation::perspective ? "perspective" : "linear";
}

const char* name_of(Thickness thickness) {
    return thickness == Thickness::exact ? "exact" : "dz";
}

const char* name_of(ProjectGeometry geometry) {
    switch (geometry) {
        case ProjectGeometry::automatic:
            return "auto";
        case ProjectGeometry::silhouette:
            return "silhouette";
        default:
            return "triangles";
    }
}

const char* name_of(ProjectDither dither) {
    switch (dither) {
        case ProjectDither::none:
            return "none";
        case ProjectDither::alpha:
            return "alpha";
        default:
            return "after_blend";
    }
}

const char* name_of(LengthMapping mapping) {
    switch (mapping) {
        case LengthMapping::octave:
            return "octave";
        case LengthMapping::log2:
            return "log2";
        default:
            return "linear";
    }
}

const char* name_of(TableStore store) {
    return store == TableStore::mean_extinction ? "mean_extinction" : "opacity";
}

const char* name_of(TableFormat format) {
    switch (format) {
        case TableFormat::fixed16:
            return "fixed16";
        case TableFormat::fixed8:
            return "fixed8";
        case TableFormat::float16:
            return "float16";
        default:
            return "float32";
    }
}

}  // namespace lamina
