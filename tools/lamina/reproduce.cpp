// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/progress.h"
#include "context_kind.h"
#include "gl/context.h"
#include "study/lamar.h"
#include "study/lamar_stage.h"
#include "verbs.h"

namespace lamina {
namespace {

struct ReproduceOptions {
    std::string paper, item, output;
    std::string context = "auto";
    bool quiet = false;
};

std::vector<std::string> item_names() {
    std::vector<std::string> names;
    for (const LamarItem& item : lamar_items()) names.push_back(item.name);
    return names;
}

std::vector<LamarItem> chosen_items(const ReproduceOptions& options) {
    if (options.paper != "lamar") {
        throw UsageError(fmt::format("reproduce {}: unknown paper, expected lamar", options.paper));
    }
    if (options.item.empty()) return lamar_items();
    for (const LamarItem& item : lamar_items()) {
        if (item.name == options.item) return {item};
    }
    throw UsageError(fmt::format("reproduce lamar {}: unknown item, expected one of {}",
                                 options.item, fmt::join(item_names(), ", ")));
}

void make_folder(const std::string& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) fail("{}: cannot make this folder: {}", folder, error.message());
}

// Makes the context when an item first draws, and keeps it.
class Stagehand {
  public:
    explicit Stagehand(gl::ContextKind kind) : kind_(kind) {}

    nlohmann::ordered_json make(const LamarItem& item, const std::filesystem::path& folder) {
        if (item.draw == nullptr) return item.reproduce(folder);
        if (!context_) {
            context_ = gl::Context::create(kind_);
            stage_.emplace(context_->capabilities());
        }
        return item.draw(folder, *stage_);
    }

  private:
    gl::ContextKind kind_;
    std::unique_ptr<gl::Context> context_;
    std::optional<LamarStage> stage_;
};

void run(const ReproduceOptions& options) {
    Progress::set_quiet(options.quiet);
    Stagehand stagehand(context_kind(options.context));
    const std::vector<LamarItem> items = chosen_items(options);
    make_folder(options.output);
    const std::filesystem::path folder = options.output;
    AtomicFile file(folder / "lamar.json");
    nlohmann::ordered_json report;
    for (const LamarItem& item : items) {
        report[item.name] = stagehand.make(item, folder);
        fmt::print("{:<12} {}\n", item.name, report[item.name]["note"].get<std::string>());
    }
    file.write(report.dump(1) + "\n");
    file.commit();
}

}  // namespace

void add_reproduce(CLI::App& app, int& exit_code) {
    (void)exit_code;
    auto* const verb = app.add_subcommand(
        "reproduce", "Make the tables and figures of a paper again, and compare");
    const auto options = std::make_shared<ReproduceOptions>();
    verb->add_option("PAPER", options->paper, "lamar")->required();
    verb->add_option("ITEM", options->item,
                     fmt::format("{}; all of them when left out", fmt::join(item_names(), ", ")));
    verb->add_option("-o,--output", options->output, "folder to write (made if need be)")
        ->required();
    verb->add_option("--context", options->context, "OpenGL context: auto, osmesa or egl");
    verb->add_flag("--quiet", options->quiet, "no progress");
    verb->callback([options] { run(*options); });
}

}  // namespace lamina
