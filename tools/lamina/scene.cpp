// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "base/client.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/process.h"
#include "image/film_file.h"
#include "image/picture.h"
#include "output_files.h"
#include "render/pipeline.h"
#include "scene/given_transfer.h"
#include "shared_options.h"
#include "verbs.h"

namespace lamina {
namespace {

struct SceneVerbOptions {
    SceneOptions scene;
    ViewOptions view;
    std::string output;
    bool quiet = false;
};

// Makes the path relative if the data are below the scene's folder. A path relative to the scene
// lets both be moved.
void name_from(const std::filesystem::path& folder, nlohmann::ordered_json& source) {
    if (source.is_object() && source.contains("path")) return name_from(folder, source["path"]);
    if (!source.is_string()) return;
    const auto path = std::filesystem::path(source.get<std::string>()).lexically_relative(folder);
    if (!path.empty() && *path.begin() != ".." && *path.begin() != ".") source = path.string();
}

std::string scene_text(const SceneVerbOptions& options, const Scene& scene,
                       const nlohmann::json& document) {
    nlohmann::ordered_json result = document_of(scene, document);
    if (options.output != standard_stream) {
        const auto folder =
            std::filesystem::weakly_canonical(std::filesystem::absolute(options.output))
                .parent_path();
        for (const char* const source : {"volume", "mesh"})
            if (result.contains(source)) name_from(folder, result[source]);
    }
    return json_text(result, 2) + "\n";
}

// Throws Error if the file's name is not UTF-8: JSON is, so the scene would name another file.
void expect_utf8(const std::filesystem::path& file) {
    const std::string name = file.string();
    if (parse_json(json_text(nlohmann::json(name))) == name) return;
    fail("{}: its name is not UTF-8, which a scene cannot hold: expected another name", name);
}

// Throws UsageError for the names of pictures and films, which people mean for `lamina render`, and
// of data.
void expect_scene_name(const std::string& output) {
    const std::string suffix = lower_suffix(output);
    constexpr std::array pictures{".png", ".exr", ".npy", ".jpg", ".jpeg", ".tif", ".tiff"};
    constexpr std::array data{".nrrd", ".nhdr", ".nii", ".gz",  ".mha", ".mhd",  ".vti",
                              ".vtu",  ".vtk",  ".raw", ".dcm", ".h5",  ".zarr", ".node"};
    if (std::ranges::find(pictures, suffix) != pictures.end() || film_format_of(output) != nullptr)
        throw UsageError(
            fmt::format("-o {}: is a picture's name, and a scene is JSON: expected a name as "
                        "s.json (\"lamina render\" draws pictures)",
                        output));
    if (std::ranges::find(data, suffix) != data.end())
        throw UsageError(fmt::format(
            "-o {}: is a data file's name, and a scene is JSON: expected a name as s.json",
            output));
}

void run(const SceneVerbOptions& options) {
    expect_scene_name(options.output);
    nlohmann::json document;
    const Scene asked = load_scene(options.scene, settings_of(options.view), document);
    if (const VolumeFile* const volume = asked.volume_file()) expect_utf8(volume->path);
    if (const MeshFile* const mesh = asked.mesh_file()) expect_utf8(mesh->path);
    expect_utf8(colormap_file_of(asked));
    expect_different_files(files_of(asked), {options.output});
    const auto output = open_named(options.output);
    PipelineOptions how;
    how.adjustments = adjustments_of(options.view, asked.color_space);
    Pipeline pipeline(asked, {}, how);
    pipeline.load();
    const Scene& scene = pipeline.scene();
    output->write(scene_text(options, scene, document));
    output->commit();
    if (options.quiet) return;
    for (const std::string& chosen : pipeline.reasons()) print_message("lamina: {}\n", chosen);
    if (options.output != standard_stream) print_message("lamina: wrote {}\n", options.output);
}

}  // namespace

void add_scene(CLI::App& app, int&) {
    const auto options = std::make_shared<SceneVerbOptions>();
    CLI::App* const verb = app.add_subcommand(
        "scene", "Write the scene that render would draw of a file, to be edited");
    verb->add_option("FILE", options->scene.file,
                     "Volume (as for render), mesh (.vtu, .pvtu, .pvd, .vtk, .node, .ele), or "
                     "scene (JSON) that leaves "
                     "something open")
        ->required();
    verb->add_option("-o,--output", options->output,
                     "Scene file to write (JSON); - writes to stdout")
        ->option_text("FILE")
        ->required();
    verb->add_option("--method", options->scene.method,
                     "slice, project or trace; as --set render.method=...")
        ->option_text("slice|project|trace");
    verb->add_option("--set", options->scene.settings,
                     "Set a key of the scene, as in render.slice.samples=512")
        ->option_text("KEY=VALUE")
        ->allow_extra_args(false);
    add_raw_options(*verb, options->scene.raw);
    add_view_options(*verb, options->view);
    add_only_below_option(*verb);
    verb->add_flag("--quiet", options->quiet, "No messages and no progress on stderr");
    verb->callback([options] {
        Progress::set_quiet(options->quiet);
        run(*options);
    });
}

}  // namespace lamina
