// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/client.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/output_file.h"
#include "base/process.h"
#include "git_commit.h"
#include "output_files.h"
#include "papers/kraus.h"
#include "papers/lamar.h"
#include "papers/paper_item.h"
#include "program.h"
#include "render/draw_context.h"
#include "study/report_files.h"
#include "study/study_frames.h"
#include "verbs.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

struct ReproduceOptions {
    std::string paper, item, output;
    std::string context = "auto";
    bool force = false, quiet = false;
};

template <typename Stage>
std::string names_of(const std::vector<papers::PaperItem<Stage>>& items) {
    std::vector<std::string> names;
    for (const papers::PaperItem<Stage>& item : items) names.push_back(item.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

template <typename Stage>
std::vector<papers::PaperItem<Stage>> chosen_items(
    const std::vector<papers::PaperItem<Stage>>& items, const ReproduceOptions& options) {
    if (options.item.empty()) return items;
    for (const papers::PaperItem<Stage>& item : items) {
        if (item.name == options.item) return {item};
    }
    throw UsageError(fmt::format("reproduce {} {}: unknown item, expected one of {}", options.paper,
                                 options.item, names_of(items)));
}

// Returns the names of all files that may be written: those of the items, the report and its page.
template <typename Stage>
std::vector<std::string> files_of(const std::vector<papers::PaperItem<Stage>>& items,
                                  const std::string& paper) {
    std::vector<std::string> files{paper + ".json", paper + ".html"};
    for (const papers::PaperItem<Stage>& item : items)
        files.insert(files.end(), item.files.begin(), item.files.end());
    return files;
}

std::vector<std::filesystem::path> data_files() {
    const std::filesystem::path data = papers::KrausStage::data_folder();
    if (data.empty()) return {};
    std::vector<std::filesystem::path> files = files_of_volume(data / "bonsai.nrrd");
    for (const char* const mesh : {"bluntfin.vtu", "combustor.vtu", "torso.vtu"})
        files.push_back(data / mesh);
    return files;
}

// Makes the context and the Stage when an item first draws, and keeps them.
template <typename Stage>
class Stagehand {
  public:
    using MakeContext = std::function<DrawContext()>;
    explicit Stagehand(MakeContext make_context) : make_context_(std::move(make_context)) {}

    nlohmann::ordered_json make(const papers::PaperItem<Stage>& item,
                                const std::filesystem::path& folder) {
        if (item.draw == nullptr) return item.reproduce(folder);
        if (!context_) {
            context_.emplace(make_context_());
            current_ = context_->make_current();
            stage_.emplace(context_->capabilities());
        }
        return item.draw(folder, *stage_);
    }

  private:
    MakeContext make_context_;
    std::optional<DrawContext> context_;
    std::unique_ptr<gl::CurrentContext> current_;
    std::optional<Stage> stage_;
};

nlohmann::ordered_json empty_page(const ReproduceOptions& options) {
    const bool lamar = options.paper == "lamar";
    nlohmann::ordered_json environment = study::describe_machine();
    environment["version"] = LAMINA_VERSION;
    environment["commit"] = git_commit;
    environment["command"] = command_line();
    return {{"title", lamar ? "LaMar 2004, reproduced" : "Kraus, Qiao and Ebert 2004, reproduced"},
            {"kind", "reproduction"},
            {"findings", nlohmann::ordered_json::array()},
            {"environment", environment},
            {"comparisons", nlohmann::ordered_json::array()}};
}

template <typename Stage>
void reproduce(const std::vector<papers::PaperItem<Stage>>& all, const ReproduceOptions& options,
               typename Stagehand<Stage>::MakeContext make_context) {
    Stagehand<Stage> stagehand(std::move(make_context));
    const std::vector<papers::PaperItem<Stage>> items = chosen_items(all, options);
    const std::filesystem::path folder = options.output;
    const std::string report_name = options.paper + ".json", page_name = options.paper + ".html";
    const std::string verb = "reproduce " + options.paper;
    expect_own_folder(folder, verb, files_of(items, options.paper), data_files(), options.force);
    const OwnFiles own(folder, verb);
    make_folder(folder);
    AtomicFile file(folder / report_name), page_file(folder / page_name);
    nlohmann::ordered_json report, page = empty_page(options);
    for (const papers::PaperItem<Stage>& item : items) {
        nlohmann::ordered_json result;
        own.add(item.files);
        try {
            result = stagehand.make(item, folder);
        } catch (const Interrupted&) {
            throw Interrupted(fmt::format("interrupted in {}: files of {} of {} items are in {}",
                                          item.name, report.size(), items.size(), folder.string()));
        }
        print_result("{:<14} {}\n", item.name, result["note"].get<std::string>());
        flush_results();  // at once: an item may take minutes
        const nlohmann::ordered_json panels = papers::take_panels(result);
        page["findings"].push_back({{"anchor", item.name}, {"text", result["in_short"]}});
        page["comparisons"].push_back(papers::page_section(item.name, result, panels, folder));
        report[item.name] = result;
    }
    page["summary"] = papers::count_verdicts(report);
    own.add({report_name, page_name});
    file.write(json_text(report, 1) + "\n");
    page_file.write(study::report_page(page));
    file.commit();
    page_file.commit();
}

// Returns the OpenGL context of a word. Throws UsageError if it names none.
gl::ContextKind opengl_kind(const std::string& word) {
    const Auto<ContextChoice> choice = context_choice(word);
    if (choice.is_automatic()) return gl::ContextKind::any;
    if (*choice == ContextChoice::cpu) {
        throw UsageError(
            fmt::format("--context {}: this needs OpenGL, expected auto, osmesa or egl", word));
    }
    return *choice == ContextChoice::egl ? gl::ContextKind::egl : gl::ContextKind::osmesa;
}

void run(const ReproduceOptions& options) {
    Progress::set_quiet(options.quiet);
    if (options.paper == "lamar") {
        // Some items examine blending units and textures, so they need OpenGL.
        const gl::ContextKind kind = opengl_kind(options.context);
        reproduce(papers::lamar_items(), options, [kind] { return DrawContext(kind); });
    } else if (options.paper == "kraus") {
        const Auto<ContextChoice> choice = context_choice(options.context);
        reproduce(papers::kraus_items(), options, [choice] { return DrawContext(choice); });
    } else {
        throw UsageError(
            fmt::format("reproduce {}: unknown paper, expected lamar or kraus", options.paper));
    }
}

}  // namespace

void add_reproduce(CLI::App& app, int& exit_code) {
    (void)exit_code;
    auto* const verb = app.add_subcommand(
        "reproduce", "Make the tables and figures of a paper again, and compare");
    const auto options = std::make_shared<ReproduceOptions>();
    verb->add_option("PAPER", options->paper, "lamar or kraus")->required();
    verb->add_option("ITEM", options->item,
                     fmt::format("All of them when left out; of lamar: {}; of kraus: {}",
                                 names_of(papers::lamar_items()), names_of(papers::kraus_items())));
    verb->add_option("-o,--output", options->output, "Folder to write (made if need be)")
        ->type_name("FOLDER")
        ->required();
    verb->add_option("--context", options->context,
                     "What draws: auto, osmesa, egl, or, of kraus, cpu (lamina's own engine, "
                     "without OpenGL)")
        ->option_text("auto|osmesa|egl|cpu");
    verb->add_flag("--force", options->force, force_help);
    verb->add_flag("--quiet", options->quiet, "No progress");
    verb->callback([options] { run(*options); });
}

}  // namespace lamina
