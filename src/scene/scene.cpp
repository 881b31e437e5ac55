// SPDX-License-Identifier: Apache-2.0
#include "lamina/scene.h"

#include "base/client.h"
#include "base/error.h"
#include "scene/scene_volume.h"
#include "volume/generate.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

const VolumeFile& file_of_volume(const Scene& scene) {
    if (const VolumeFile* const file = scene.volume_file()) return *file;
    fail("no volume was given, and the scene names none");
}

}  // namespace

// The words of every enum below are listed by enum_words() (base/enum_words.h), too.
const char* name_of(Method method) {
    switch (method) {
        case Method::slice:
            return "slice";
        case Method::project:
            return "project";
        case Method::trace:
            return "trace";
    }
    return nullptr;
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
    return nullptr;
}

const char* name_of(TraceOf of) {
    switch (of) {
        case TraceOf::volume:
            return "volume";
        case TraceOf::mesh:
            return "mesh";
    }
    return nullptr;
}

const char* name_of(NanPolicy policy) {
    switch (policy) {
        case NanPolicy::error:
            return "error";
        case NanPolicy::transparent:
            return "transparent";
    }
    return nullptr;
}

const char* name_of(Classification classification) {
    switch (classification) {
        case Classification::post:
            return "post";
        case Classification::preintegrated:
            return "preintegrated";
        case Classification::exact:
            return "exact";
    }
    return nullptr;
}

const char* name_of(Order order) {
    switch (order) {
        case Order::back_to_front:
            return "back_to_front";
        case Order::front_to_back:
            return "front_to_back";
    }
    return nullptr;
}

const char* name_of(Filter filter) {
    switch (filter) {
        case Filter::exact:
            return "exact";
        case Filter::hardware:
            return "hardware";
    }
    return nullptr;
}

const char* name_of(NodeArithmetic nodes) {
    switch (nodes) {
        case NodeArithmetic::shader:
            return "shader";
        case NodeArithmetic::fixed:
            return "fixed";
    }
    return nullptr;
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
    return nullptr;
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
    return nullptr;
}

const char* name_of(OverRounding rounding) {
    switch (rounding) {
        case OverRounding::separate:
            return "separate";
        case OverRounding::fused:
            return "fused";
    }
    return nullptr;
}

Volume load_volume(const Scene& scene, const std::filesystem::path& only_below) {
    const OnlyBelowScope scope(only_below);
    if (const auto* request = std::get_if<GeneratorRequest>(&scene.volume))
        return generate(*request);
    const VolumeFile& file = file_of_volume(scene);
    return read_volume(file.path, file.selection);
}

Volume open_volume(const Scene& scene) {
    if (const auto* request = std::get_if<GeneratorRequest>(&scene.volume))
        return generate(*request);
    const VolumeFile& file = file_of_volume(scene);
    return open_volume(
        file.path, file.selection,
        {.residence = VolumeUse::Residence::as_fits, .lit = scene.lighting.has_value()});
}

}  // namespace lamina
