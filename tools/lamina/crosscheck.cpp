// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/client.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/output_file.h"
#include "base/process.h"
#include "git_commit.h"
#include "image/exr.h"
#include "output_files.h"
#include "program.h"
#include "render/draw_context.h"
#include "render/pipeline.h"
#include "shared_options.h"
#include "study/crosscheck.h"
#include "study/report_files.h"
#include "study/study_frames.h"
#include "verbs.h"

namespace lamina {
namespace {

constexpr const char* crosscheck_name = "crosscheck";
const std::vector<std::string> file_names{"traced_volume.exr", "traced_mesh.exr", "sliced.exr",
                                          "projected.exr",     "budget.json",     "report.html"};
constexpr const char* kept_name = "crosscheck-kept";  // finished steps, kept until all are done

struct CrosscheckOptions {
    SceneOptions scene;
    std::string output, context = "auto";
    study::CrosscheckSettings settings;
    bool resume = false, force = false, quiet = false;
};

void check_ladder(const study::CrosscheckSettings& settings) {
    for (const double each : settings.tolerances) {
        if (!(each > 0 && each <= 1))
            throw UsageError(fmt::format(
                "--tolerances {:g}: expected numbers above 0 and up to 1 (of the range of values)",
                each));
    }
    for (const int each : settings.samples) {
        if (each < 1 || each > 65536)
            throw UsageError(fmt::format("--samples {}: expected numbers from 1 to 65536", each));
    }
}

void write_picture(const std::filesystem::path& path, const Image& image, ImageColorSpace space) {
    AtomicFile file(path);
    write_exr(file, image, {}, space);
    file.commit();
}

void write_all(const std::filesystem::path& folder, const study::Crosscheck& made,
               const study::CrosscheckSubject& subject) {
    const study::ErrorBudget budget = study::error_budget(made.pictures);
    OwnFiles(folder, crosscheck_name).add(file_names);
    const ImageColorSpace space = made.pictures.space;
    write_picture(folder / "traced_volume.exr", made.pictures.traced_volume, space);
    write_picture(folder / "traced_mesh.exr", made.pictures.traced_mesh, space);
    write_picture(folder / "sliced.exr", made.pictures.sliced, space);
    write_picture(folder / "projected.exr", made.pictures.projected, space);
    study::write_text(folder / "budget.json",
                      json_text(study::budget_json(made, budget, subject), 1) + "\n");
    study::write_text(folder / "report.html",
                      study::report_page(study::crosscheck_report(made, budget, subject)));
    for (const std::string& finding : study::crosscheck_findings(made, budget, subject))
        print_result("{}\n", printable(finding));
}

// Warns if --tolerances is given for a scene whose mesh has no tolerance.
void say_of_one_mesh(const CrosscheckOptions& options, const Scene& scene) {
    if (options.quiet || options.settings.ends_by_itself || study::makes_meshes(scene)) return;
    print_message(
        "lamina: --tolerances: not used: {}\n",
        scene.mesh_file() == nullptr
            ? "the scene's mesh is Kuhn's, which has no tolerance"
            : "the scene's mesh is a file, " + printable(scene.mesh_file()->path.string()));
}

void say(const CrosscheckOptions& options, const std::string& text) {
    if (!options.quiet) print_message("lamina: {}\n", printable(text));
}

// Kept steps are named by a hash of their input, so those of other scenes are never taken.
study::CrosscheckSettings settings_of(const CrosscheckOptions& options,
                                      const std::filesystem::path& kept) {
    if (std::filesystem::exists(kept) && !options.resume) {
        fail(
            "{}: holds finished steps of a cross-check that was stopped: --resume goes on with "
            "them, or remove the folder",
            kept.string());
    }
    study::CrosscheckSettings settings = options.settings;
    settings.kept = kept;
    settings.begin = [kept] {
        OwnFiles(kept.parent_path(), crosscheck_name).add({kept_name});
        make_folder(kept);
    };
    settings.say = [&options](const std::string& text) { say(options, text); };
    return settings;
}

// Removes the files that study::crosscheck() keeps, and the folder if it is then empty.
void remove_kept(const std::filesystem::path& kept) {
    std::error_code ignored;
    for (const auto& file : std::filesystem::directory_iterator(kept, ignored)) {
        const std::filesystem::path name = file.path().filename();
        const bool hash =
            name.stem().string().size() == 16 &&
            name.stem().string().find_first_not_of("0123456789abcdef") == std::string::npos;
        const bool kind =
            name.extension() == ".vtu" || name.extension() == ".npy" || name.extension() == ".json";
        if (hash && kind) std::filesystem::remove(file.path(), ignored);
    }
    std::filesystem::remove(kept, ignored);  // fails if other files are left
}

study::Crosscheck kept_crosscheck(const Scene& scene, const study::CrosscheckSettings& settings,
                                  const Capabilities& capabilities) {
    try {
        return study::crosscheck(scene, settings, capabilities);
    } catch (const Interrupted&) {
        std::error_code ignored;
        if (!std::filesystem::exists(settings.kept, ignored)) throw;
        throw Interrupted(
            fmt::format("interrupted: finished steps are kept in {}; --resume goes on",
                        settings.kept.string()));
    }
}

void run(const CrosscheckOptions& options) {
    check_ladder(options.settings);
    nlohmann::json ignored;
    Scene scene = load_scene(options.scene, {}, ignored);
    // Both methods need the volume; this is checked before anything is made.
    if (!scene.has_volume())
        fail("{}: volume: is missing, expected the volume that both methods show",
             scene.file.string());
    const std::filesystem::path folder = options.output;
    std::vector<std::string> names = file_names;
    names.emplace_back(kept_name);
    expect_own_folder(folder, crosscheck_name, names, files_of(scene), options.force);
    const study::CrosscheckSettings settings = settings_of(options, folder / kept_name);
    say_of_one_mesh(options, scene);
    Choices choices = chosen_by_volume(scene);
    scene = std::move(choices.scene);
    for (const std::string& chosen : choices.reasons) say(options, chosen);
    const Auto<ContextChoice> choice = context_choice(options.context);
    restrict_instructions_as_asked();
    make_folder(folder);
    const DrawContext context(choice);
    const auto current = context.make_current();
    study::CrosscheckSubject subject{std::filesystem::path(options.scene.file).stem().string(),
                                     scene.max_error, study::describe_machine()};
    subject.environment["drivers"] = renderer_and_threads(context.capabilities());
    subject.environment["version"] = LAMINA_VERSION;
    subject.environment["commit"] = git_commit;
    subject.environment["command"] = command_line();
    write_all(folder, kept_crosscheck(scene, settings, context.capabilities()), subject);
    remove_kept(settings.kept);
    say(options,
        fmt::format("wrote four pictures, budget.json and report.html into {}", options.output));
}

}  // namespace

void add_crosscheck(CLI::App& app, int&) {
    const auto options = std::make_shared<CrosscheckOptions>();
    CLI::App* const verb = app.add_subcommand(
        crosscheck_name, "Slice a volume and project its mesh, and say where they differ, and why");
    verb->add_option("SCENE", options->scene.file,
                     "Scene file (JSON) with a volume, or a volume; - reads a scene from stdin")
        ->required();
    verb->add_option("-o,--output", options->output, "Folder to write (made if need be)")
        ->type_name("FOLDER")
        ->required();
    verb->add_option("--set", options->scene.settings,
                     "Set a key of the scene, as in render.max_error=0.5")
        ->option_text("KEY=VALUE")
        ->allow_extra_args(false);
    add_raw_options(*verb, options->scene.raw);
    const CLI::Option* const tolerances =
        verb->add_option(
                "--tolerances", options->settings.tolerances,
                "Of the meshes to compare, beside the scene's own, with commas between: all of "
                "them are drawn; by default .1,.05,.02,.01,.005,.002,.001, until both methods "
                "agree within render.max_error, or a mesh has 250,000 tets. Not used if the scene "
                "has a mesh file, or a mesh with \"kuhn\"")
            ->option_text("T,T,...")
            ->delimiter(',')
            ->allow_extra_args(false);
    verb->add_option("--samples", options->settings.samples,
                     "Slabs to compare, beside the scene's own, with commas between; by default "
                     "64,128,256,512,1024")
        ->option_text("N,N,...")
        ->delimiter(',')
        ->allow_extra_args(false);
    verb->add_option("--context", options->context,
                     "What draws: auto (a GPU, else cpu), osmesa, egl, cpu")
        ->option_text("auto|osmesa|egl|cpu");
    verb->add_flag("--resume", options->resume, "Go on with a cross-check that was stopped");
    verb->add_flag("--force", options->force, force_help);
    verb->add_flag("--quiet", options->quiet, "No messages and no progress on stderr");
    verb->callback([options, tolerances] {
        Progress::set_quiet(options->quiet);
        options->settings.ends_by_itself = tolerances->count() == 0;
        run(*options);
    });
}

}  // namespace lamina
