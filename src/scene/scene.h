// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "optics/transfer_function.h"
#include "scene/camera.h"
#include "volume/generate.h"

namespace lamina {

enum class Method { slice, trace };
enum class Target { float32, float16, fixed16, fixed8 };
enum class Classification { post, preintegrated };
enum class Order { back_to_front, front_to_back };
enum class Filter { exact, hardware };
enum class NanPolicy { error, transparent };

struct SliceSettings {
    std::optional<int> samples;  // slabs N; none: two per voxel along the view ("auto")
    Classification classification = Classification::post;
    Order order = Order::back_to_front;
    Filter filter = Filter::exact;
};

// A scene file as read (DESIGN section 4): what to draw and how, nothing measured yet.
struct Scene {
    std::filesystem::path file;
    std::filesystem::path volume_file;               // or
    std::optional<GeneratorRequest> volume_request;  // {"generate": ...}
    NanPolicy nan = NanPolicy::error;
    TransferFunction transfer_function = TransferFunction::linear({TransferKnot{}});
    Camera camera;
    int width = 0;
    int height = 0;
    glm::dvec3 background{0};  // linear
    Method method = Method::slice;
    Target target = Target::float32;
    SliceSettings slice;
    double trace_tolerance = 1e-5;  // of full scale
    std::vector<std::string> warnings;
};

const char* name_of(Method method);
const char* name_of(Target target);
const char* name_of(Classification classification);
const char* name_of(Order order);
const char* name_of(Filter filter);

// The volume that the scene names: read from its file, or generated.
Volume load_volume(const Scene& scene);

}  // namespace lamina
