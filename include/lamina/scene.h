// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lamina/camera.h"
#include "lamina/clip.h"
#include "lamina/emulation.h"
#include "lamina/export.h"
#include "lamina/generator_request.h"
#include "lamina/image_color_space.h"
#include "lamina/lighting.h"
#include "lamina/mesh_settings.h"
#include "lamina/project_settings.h"
#include "lamina/slice_settings.h"
#include "lamina/transfer_function.h"
#include "lamina/volume_request.h"

namespace lamina {

enum class Method { slice, project, trace };
enum class Target { float32, float16, fixed16, fixed8, emulated };
// The data that the method "trace" draws.
enum class TraceOf { volume, mesh };
enum class NanPolicy { error, transparent };

struct GivenTransfer;  // internal (scene/given_transfer.h)

// A scene file as read (docs/scene.md): what to draw and how, nothing measured yet.
struct Scene {
    std::filesystem::path file;
    std::filesystem::path volume_file;               // or
    VolumeRequest volume_selection;                  // what of that file
    std::optional<GeneratorRequest> volume_request;  // {"generate": ...}
    std::filesystem::path mesh_file;                 // or
    std::int64_t mesh_time = 0;                      // its step, from 0 (.pvd)
    std::optional<MeshSettings> mesh_request;        // made from the volume
    std::string scalar;  // of the mesh file; empty: its first point array
    NanPolicy nan = NanPolicy::error;
    TransferFunction transfer_function = TransferFunction::linear({TransferKnot{}});
    Camera camera;
    Clip clip;
    // Where these are set, what stands above is replaced by what the data suggest, once they are
    // known (docs/first-picture.md).
    bool automatic_transfer_function = false, automatic_camera = false;
    // The transfer function as a scene file gives it; null if it gives none. A colour map without a
    // range is stretched over the data as long as automatic_transfer_function is set: callers who
    // set a function of their own end that.
    std::shared_ptr<const GivenTransfer> given_transfer;
    std::optional<Lighting> lighting;  // none: colours are shown as they are
    int width = 800;
    int height = 600;
    // Colours and background are given, and pictures composited, in its numbers.
    ImageColorSpace color_space = ImageColorSpace::linear;
    glm::dvec3 background{0};
    Method method = Method::slice;
    Target target = Target::float32;
    bool automatic_target = false;  // "target": "auto": the plan chooses
    Emulation emulate;              // for Target::emulated
    // In 1/255. Choices that the scene leaves open ("auto") keep the picture's error below this
    // bound.
    double max_error = 1;
    SliceSettings slice;
    ProjectSettings project;
    TraceOf trace_of = TraceOf::volume;
    double trace_tolerance = 1e-5;  // largest error of a traced picture, as a share of full scale

    bool has_volume() const { return !volume_file.empty() || volume_request; }
    bool has_mesh() const { return !mesh_file.empty() || mesh_request; }
    // Whether the mesh is drawn. The volume is then needed at most to make it.
    bool draws_mesh() const {
        return method == Method::project || (method == Method::trace && trace_of == TraceOf::mesh);
    }
};

LAMINA_API const char* name_of(Method method);
LAMINA_API const char* name_of(Target target);
inline bool is_fixed_point(Target target) {
    return target == Target::fixed8 || target == Target::fixed16 || target == Target::emulated;
}
LAMINA_API const char* name_of(TraceOf of);
LAMINA_API const char* name_of(NanPolicy policy);
LAMINA_API const char* name_of(Classification classification);
LAMINA_API const char* name_of(Order order);
LAMINA_API const char* name_of(Filter filter);
LAMINA_API const char* name_of(NodeArithmetic nodes);
LAMINA_API const char* name_of(NodeCode code);
LAMINA_API const char* name_of(AlphaRounding rounding);
LAMINA_API const char* name_of(OverRounding rounding);

// Loads the volume that the scene names: it is read from its file, or generated. `only_below`: as
// for files (lamina/data_files.h).
LAMINA_API Volume load_volume(const Scene& scene, const std::filesystem::path& only_below = {});

// Reads a scene file (docs/scene.md), or makes a scene that draws a data file, with all else
// automatic. Writes one with every key written out. Both throw Error. `only_below`: as
// for load_volume().
LAMINA_API Scene load_scene(const std::filesystem::path& file,
                            const std::filesystem::path& only_below = {});
LAMINA_API void save_scene(const Scene& scene, const std::filesystem::path& file);

}  // namespace lamina
