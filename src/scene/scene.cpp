// SPDX-License-Identifier: Apache-2.0
#include "scene/scene.h"

#include "base/unreachable.h"
#include "volume/nrrd.h"

namespace lamina {

const char* name_of(Method method) {
    switch (method) {
        case Method::slice:
            return "slice";
        case Method::project:
            return "project";
        case Method::trace:
            return "trace";
    }
    unreachable_enum();
}

const char* name_of(Target target) {
    switch (target) {
        case Target::float32:
            return "float32";
        case Target::float16:
            return "float16";
        case Target::fixed16:
            return "fixed16";
        case Target::fixed8:
            return "fixed8";
        case Target::emulated:
            return "emulated";
    }
    unreachable_enum();
}

const char* name_of(Classification classification) {
    return classification == Classification::post ? "post" : "preintegrated";
}

const char* name_of(Order order) {
    return order == Order::back_to_front ? "back_to_front" : "front_to_back";
}

const char* name_of(Filter filter) {
    switch (filter) {
        case Filter::exact:
            return "exact";
        case Filter::hardware:
            return "hardware";
        case Filter::automatic:
            return "auto";
    }
    unreachable_enum();
}

const char* name_of(NodeArithmetic nodes) {
    return nodes == NodeArithmetic::shader ? "shader" : "fixed";
}

const char* name_of(NodeCode code) {
    switch (code) {
        case NodeCode::minimax:
            return "minimax";
        case NodeCode::phi:
            return "phi";
        case NodeCode::alpha:
            return "alpha";
    }
    unreachable_enum();
}

const char* name_of(AlphaRounding rounding) {
    switch (rounding) {
        case AlphaRounding::truncate:
            return "truncate";
        case AlphaRounding::nearest:
            return "nearest";
        case AlphaRounding::stochastic:
            return "stochastic";
    }
    unreachable_enum();
}

const char* name_of(OverRounding rounding) {
    return rounding == OverRounding::separate ? "separate" : "fused";
}

Volume load_volume(const Scene& scene) {
    return scene.volume_request ? generate(*scene.volume_request) : read_nrrd(scene.volume_file);
}

}  // namespace lamina
