// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/client.h"
#include "base/error.h"
#include "base/output_file.h"
#include "base/process.h"
#include "lamina/scene.h"
#include "mesh_files/mesh_file.h"
#include "meshing/volume_mesh.h"
#include "output_files.h"
#include "render/pipeline.h"
#include "scene_files/scene_reader.h"
#include "shared_options.h"
#include "verbs.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

constexpr std::int64_t fewest_tets = 6;  // of a box of one cell
constexpr std::int64_t most_tets = (std::int64_t{1} << 29) - 1;

struct MeshOptions {
    std::string input, output;
    std::optional<double> tolerance;
    std::optional<std::int64_t> max_tets;
    bool kuhn = false, quiet = false;
    RawOptions raw;
};

struct MeshTask {
    Volume volume;
    MeshSettings settings;
    std::optional<TransferFunction> transfer_function;
};

// The output: one .vtu file, or a .node file with its .ele.
class MeshOutput {
  public:
    explicit MeshOutput(const std::filesystem::path& path) : paths_{path} {
        const std::string extension = path.extension();
        if (extension != ".vtu" && extension != ".node") {
            throw UsageError(
                fmt::format("-o {}: expected a name that ends in .vtu or .node", path.string()));
        }
        file_ = std::make_unique<AtomicFile>(path);
        if (extension != ".node") return;
        paths_.push_back(std::filesystem::path(path).replace_extension(".ele"));
        elements_ = std::make_unique<AtomicFile>(paths_.back());
    }
    const std::vector<std::filesystem::path>& paths() const { return paths_; }
    void write(const MeshData& mesh) {
        if (!elements_) {
            write_vtu(*file_, mesh);
        } else {
            write_node(*file_, mesh);
            write_ele(*elements_, mesh);
            file_->complete();  // both files are written before either is renamed
            elements_->complete();
            // The old .node is removed first: if the process is killed between the two renames, an
            // old .node beside a new .ele would be read as one mesh.
            std::filesystem::remove(file_->path());
            elements_->commit();
        }
        file_->commit();
    }

  private:
    std::vector<std::filesystem::path> paths_;
    std::unique_ptr<AtomicFile> file_, elements_;
};

void check(const MeshOptions& options) {
    if (options.tolerance && !(*options.tolerance > 0 && *options.tolerance <= 1)) {
        throw UsageError(fmt::format(
            "--tolerance {}: expected a number above 0 and up to 1 (of the range of values)",
            *options.tolerance));
    }
    if (options.max_tets && (*options.max_tets < fewest_tets || *options.max_tets > most_tets)) {
        throw UsageError(fmt::format("--max-tets {}: expected a number from {} to {}",
                                     *options.max_tets, fewest_tets, most_tets));
    }
}

// Reads a volume as a field. Tets interpolate between labels, too, which is said.
Volume read_field(const std::string& file, VolumeRequest request) {
    std::vector<std::string> said;
    Client quiet = ClientScope::current();
    quiet.warnings = nullptr;
    std::optional<Volume> volume;
    {
        const ClientScope scope(quiet);
        volume = keep_warnings(said, [&] { return read_volume(file, request); });
    }
    if (volume->grid().lookup == VolumeLookup::linear) {
        for (const std::string& text : said) warn(text);
        return *volume;
    }
    volume.reset();
    request.lookup = VolumeLookup::linear;
    say("{}: its samples are labels, and the mesh interpolates between their numbers, "
        "so that it has values that are none",
        file);
    return read_volume(file, request);
}

MeshTask load(const MeshOptions& options, const MeshOutput& output) {
    const VolumeRequest request = request_of(options.raw);
    const FileKind kind = request.raw ? FileKind::volume : kind_of_file(options.input);
    if (kind == FileKind::mesh)
        fail("{}: is a mesh already, expected a volume or a scene (JSON)", options.input);
    if (kind == FileKind::volume) {
        expect_different_files(files_of_volume(options.input, request), output.paths());
        return {read_field(options.input, request), {}, {}};
    }
    Scene scene = load_scene(options.input);
    expect_different_files(files_of(scene), output.paths());
    if (!scene.has_volume()) {
        fail("{}: has no \"volume\", which a mesh could be made from", options.input);
    }
    Choices choices = chosen_by_volume(scene);
    scene = std::move(choices.scene);
    if (!options.quiet) {
        for (const std::string& chosen : choices.reasons) print_message("lamina: {}\n", chosen);
    }
    return {load_volume(scene), mesh_settings(scene), *scene.transfer_function};
}

void report_made(const MeshReport& report, const MeshSettings& settings) {
    print_result("points: {}\n", report.points);
    print_result("tets: {} ({:.3g} of the {} of the Kuhn split)\n", report.tets,
                 static_cast<double>(report.tets) / static_cast<double>(report.kuhn_tets),
                 report.kuhn_tets);
    print_result("error: at most {:.4g} of the range of values ({:.6g} of {:.6g})\n",
                 report.relative_error(), report.error, report.range);
    if (report.within_tolerance) return;
    const std::string what = fmt::format("{:.4g} of the range of values, wanted {:.4g}",
                                         report.relative_error(), settings.tolerance);
    if (report.stopped_by_max_tets) {
        print_message(
            "lamina: stopped at {} tets (--max-tets {}): the mesh differs from the volume "
            "by up to {}\n",
            report.tets, settings.max_tets, what);
    } else if (!settings.kuhn) {
        print_message(
            "lamina: points cannot lie closer together: the mesh differs from the volume "
            "by up to {}\n",
            what);
    }
}

void run(const MeshOptions& options) {
    Progress::set_quiet(options.quiet);
    check(options);
    MeshOutput output(options.output);
    MeshTask task = load(options, output);
    if (options.tolerance) task.settings.tolerance = *options.tolerance;
    if (options.max_tets) task.settings.max_tets = *options.max_tets;
    if (options.kuhn) task.settings.kuhn = true;
    MeshReport report;
    const TransferFunction* const transfer_function =
        task.transfer_function ? &*task.transfer_function : nullptr;
    MeshData mesh;
    try {
        mesh = make_volume_mesh(task.volume, task.settings, transfer_function, report);
    } catch (const Error& error) {
        fail("{}: {}", options.input, error.what());
    }
    output.write(mesh);
    report_made(report, task.settings);
}

}  // namespace

void add_mesh(CLI::App& app, int& exit_code) {
    (void)exit_code;
    auto* const verb = app.add_subcommand("mesh", "Make tetrahedra from a volume");
    const auto options = std::make_shared<MeshOptions>();
    const MeshSettings defaults;
    verb->add_option("INPUT", options->input,
                     "Volume (as for render), or scene (JSON): its volume and mesh settings, and "
                     "coarse where its transfer function shows nothing")
        ->required();
    verb->add_option("-o,--output", options->output, "Mesh to write (.vtu, or .node with its .ele)")
        ->type_name("FILE")
        ->required();
    add_raw_options(*verb, options->raw);
    verb->add_option("--tolerance", options->tolerance,
                     fmt::format("Largest difference between mesh and volume, as a fraction of "
                                 "the range of values ({})",
                                 defaults.tolerance))
        ->type_name("SHARE");
    verb->add_option("--max-tets", options->max_tets,
                     fmt::format("Stop at this number of tets ({})", defaults.max_tets))
        ->type_name("N");
    verb->add_flag("--kuhn", options->kuhn,
                   "Every sample and six tets a cell instead; needs no TetGen");
    add_only_below_option(*verb);
    verb->add_flag("--quiet", options->quiet, "No progress");
    verb->callback([options] { run(*options); });
}

}  // namespace lamina
