// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "lamina/camera.h"
#include "lamina/error.h"
#include "lamina/image.h"
#include "lamina/mesh.h"
#include "lamina/settings.h"
#include "lamina/transfer_function.h"
#include "lamina/volume.h"

namespace lamina {

// How the picture is made. slice: slabs through a volume. project: projected tetrahedra. trace: the
// reference tracer.
enum class Method { slice, project, trace };
// Numbers in which the picture is composited; Scene::emulate describes `emulated`.
enum class Target { float32, float16, fixed16, fixed8, emulated };
// The data that the method "trace" draws.
enum class TraceOf { volume, mesh };
// Treatment of data with NaN or infinite values: an Error, or cells and tets with them are
// transparent.
enum class NanPolicy { error, transparent };

// A volume in a file or a folder, and the part of it that is drawn.
struct VolumeFile {
    std::filesystem::path path;
    VolumeRequest selection = {};

    bool operator==(const VolumeFile&) const = default;
};
// A mesh in a file.
struct MeshFile {
    std::filesystem::path path;
    std::int64_t time = 0;  // step in time of a .pvd, counted from 0
    double join = 0;  // world units: points this near to an earlier one are moved to its place

    bool operator==(const MeshFile&) const = default;
};
// Sources of the data: a file, a formula, or, for a mesh that is made from the scene's volume,
// MeshSettings. The scene of data in memory has std::monostate.
using VolumeSource = std::variant<std::monostate, VolumeFile, GeneratorRequest>;
using MeshSource = std::variant<std::monostate, MeshFile, MeshSettings>;

// Internal type (src/scene/given_transfer.h).
struct GivenTransfer;

// A scene file as read (docs/scene.md): what to draw and how, nothing measured yet.
struct Scene {
    std::filesystem::path file;
    VolumeSource volume;
    MeshSource mesh;
    std::string scalar;  // array of the mesh file; its first point array if empty
    NanPolicy nan = NanPolicy::error;
    // Transfer function and camera are chosen from the data if they are automatic
    // (docs/first-picture.md).
    Auto<TransferFunction> transfer_function = TransferFunction::linear({TransferKnot{}});
    Auto<Camera> camera = Camera{};
    Clip clip;
    // The transfer function as a scene file gives it; null if it gives none. If it is a colour map
    // without a range, an automatic transfer function is that map, stretched over the data.
    std::shared_ptr<const GivenTransfer> given_transfer;
    std::optional<Lighting> lighting;  // without lighting colours are shown as they are
    int width = 800;
    int height = 600;
    // Space in which colours and background are numbers, and in which the picture is composited.
    ImageColorSpace color_space = ImageColorSpace::linear;
    glm::dvec3 background{0};
    bool transparent = false;  // PNG files have straight alpha and no background
    int png_bits = 8;          // of the codes of PNG files: 8 or 16
    Method method = Method::slice;
    Auto<Target> target = Target::float32;
    Emulation emulate;  // for Target::emulated
    // Bound on the picture's error, in 1/255 of full scale. All choices that the scene leaves open
    // ("auto") keep to this bound.
    double max_error = 1;
    SliceSettings slice;
    ProjectSettings project;
    TraceOf trace_of = TraceOf::volume;
    double trace_tolerance = 1e-5;  // largest error of a traced picture, as a share of full scale

    PngLook png_look() const { return {background, transparent, png_bits}; }
    bool has_volume() const { return !std::holds_alternative<std::monostate>(volume); }
    bool has_mesh() const { return !std::holds_alternative<std::monostate>(mesh); }
    // Return the file of the volume or the mesh; null if the data come from elsewhere.
    const VolumeFile* volume_file() const { return std::get_if<VolumeFile>(&volume); }
    VolumeFile* volume_file() { return std::get_if<VolumeFile>(&volume); }
    const MeshFile* mesh_file() const { return std::get_if<MeshFile>(&mesh); }
    MeshFile* mesh_file() { return std::get_if<MeshFile>(&mesh); }
    const MeshSettings* made_mesh() const { return std::get_if<MeshSettings>(&mesh); }
    // Returns true if the mesh is drawn, and the volume is needed at most to make the mesh.
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

// Loads the volume that the scene names: reads its file, or generates it. `only_below`: as in
// load_volume() for files (lamina/volume.h).
LAMINA_API Volume load_volume(const Scene& scene, const std::filesystem::path& only_below = {});

// Kind of the contents of a file.
enum class FileKind { scene, volume, mesh };

// Returns what a file holds, by its content, or by its name if the content does not tell. Throws
// Error if neither does.
LAMINA_API FileKind kind_of_file(const std::filesystem::path& file,
                                 const std::filesystem::path& only_below = {});

// load_scene() reads a scene file (docs/scene.md) or, for a data file, makes a scene that draws it,
// with all else automatic. save_scene() writes a scene file with all keys. Both throw Error.
LAMINA_API Scene load_scene(const std::filesystem::path& file,
                            const std::filesystem::path& only_below = {});
LAMINA_API void save_scene(const Scene& scene, const std::filesystem::path& file);

// Reads a scene (docs/scene.md) from text instead of a file. `name` stands for the file: messages
// name it, and relative paths start at its folder. If data in memory are passed, which a Session
// will draw, the scene need not name any data. `only_below`: as in load_volume() (lamina/volume.h).
// Throws Error.
LAMINA_API Scene parse_scene(const std::string& json, const std::filesystem::path& name,
                             const std::filesystem::path& only_below = {});
LAMINA_API Scene parse_scene(const std::string& json, const std::filesystem::path& name,
                             const Volume& data, const std::filesystem::path& only_below = {});
LAMINA_API Scene parse_scene(const std::string& json, const std::filesystem::path& name,
                             const MeshData& data, const std::filesystem::path& only_below = {});

// Returns the text that save_scene() writes. It does not contain data in memory.
LAMINA_API std::string scene_text(const Scene& scene);

// Returns the automatic camera (docs/first-picture.md), whose picture just holds what the scene
// shows of the data. It is moved around the data by degrees to the right (azimuth) and up
// (elevation). It depends on the scene's transfer function, which may be automatic, and on the size
// of the picture. Throws Error if the data have no finite value.
LAMINA_API Camera fitted_camera(const Scene& scene, const Volume& volume, double azimuth = 0,
                                double elevation = 0);
LAMINA_API Camera fitted_camera(const Scene& scene, const MeshData& mesh, double azimuth = 0,
                                double elevation = 0);

// Returns the transfer function that a picture of the volume has: the scene's, or one chosen from
// the data if it is automatic. A colour map without a range is stretched over the data. Throws
// Error.
LAMINA_API TransferFunction chosen_transfer_function(const Scene& scene, const Volume& volume);

}  // namespace lamina
