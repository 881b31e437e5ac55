// SPDX-License-Identifier: Apache-2.0
#include "scene/project_settings.h"

#include "base/unreachable.h"

namespace lamina {

const char* name_of(Coloring coloring) {
    switch (coloring) {
        case Coloring::preintegrated:
            return "preintegrated";
        case Coloring::attenuation:
            return "attenuation";
        case Coloring::vertex:
            return "vertex";
        case Coloring::analytic:
            return "analytic";
    }
    unreachable_enum();
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
        case ProjectGeometry::triangles:
            return "triangles";
    }
    unreachable_enum();
}

const char* name_of(ProjectDither dither) {
    switch (dither) {
        case ProjectDither::none:
            return "none";
        case ProjectDither::alpha:
            return "alpha";
        case ProjectDither::after_blend:
            return "after_blend";
    }
    unreachable_enum();
}

const char* name_of(LengthMapping mapping) {
    switch (mapping) {
        case LengthMapping::octave:
            return "octave";
        case LengthMapping::log2:
            return "log2";
        case LengthMapping::linear:
            return "linear";
    }
    unreachable_enum();
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
        case TableFormat::float32:
            return "float32";
    }
    unreachable_enum();
}

}  // namespace lamina
