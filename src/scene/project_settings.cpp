// SPDX-License-Identifier: Apache-2.0
#include "lamina/project_settings.h"

namespace lamina {

// The words of every enum below are listed by enum_words() (base/enum_words.h), too.
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
    return nullptr;
}

const char* name_of(Interpolation interpolation) {
    switch (interpolation) {
        case Interpolation::perspective:
            return "perspective";
        case Interpolation::linear:
            return "linear";
    }
    return nullptr;
}

const char* name_of(Thickness thickness) {
    switch (thickness) {
        case Thickness::exact:
            return "exact";
        case Thickness::dz:
            return "dz";
    }
    return nullptr;
}

const char* name_of(ProjectOrder order) {
    switch (order) {
        case ProjectOrder::mpvo:
            return "mpvo";
        case ProjectOrder::exact:
            return "exact";
        case ProjectOrder::centroid:
            return "centroid";
        case ProjectOrder::none:
            return "none";
    }
    return nullptr;
}

const char* name_of(ProjectGeometry geometry) {
    switch (geometry) {
        case ProjectGeometry::silhouette:
            return "silhouette";
        case ProjectGeometry::triangles:
            return "triangles";
    }
    return nullptr;
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
    return nullptr;
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
    return nullptr;
}

const char* name_of(TableStore store) {
    switch (store) {
        case TableStore::mean_extinction:
            return "mean_extinction";
        case TableStore::opacity:
            return "opacity";
    }
    return nullptr;
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
    return nullptr;
}

const char* name_of(TableConstruction construction) {
    switch (construction) {
        case TableConstruction::exact:
            return "exact";
        case TableConstruction::incremental:
            return "incremental";
    }
    return nullptr;
}

}  // namespace lamina
