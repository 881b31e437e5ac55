// SPDX-License-Identifier: Apache-2.0
#include "model/attempts.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "lamina/scene.h"
#include "model/comparison.h"

namespace lamina::view {
namespace {

std::string tree_text(const TreeSettings* tree) {
    if (tree == nullptr) return {};
    std::string text = fmt::format("{}", fmt::join(tree->factors, "x"));
    if (tree->nodes != NodeArithmetic::shader) text += fmt::format(", {}", name_of(tree->nodes));
    if (tree->code != NodeCode::minimax) text += fmt::format(", {}", name_of(tree->code));
    if (tree->alpha_bits != TreeSettings().alpha_bits)
        text += fmt::format(", {} bits", tree->alpha_bits);
    return text;
}

std::string target_text(const Scene& scene) {
    if (scene.target != Target::emulated) return name_of(scene.target);
    return fmt::format("{} {}", name_of(scene.target), scene.emulate.bits);
}

void tell_slices(const Scene& scene, Attempt& attempt) {
    attempt.classification = name_of(scene.slice.classification);
    attempt.tree = tree_text(given_tree(scene.slice.tree));
    if (scene.slice.samples.is_given()) attempt.samples = fmt::to_string(*scene.slice.samples);
    if (scene.slice.dither) attempt.target += ", dither";
}

void tell_tets(const Scene& scene, Attempt& attempt) {
    const ProjectSettings& project = scene.project;
    attempt.classification = name_of(project.coloring);
    if (project.interpolation != Interpolation::perspective)
        attempt.classification += fmt::format(", {}", name_of(project.interpolation));
    if (project.thickness != Thickness::exact)
        attempt.classification += fmt::format(", {}", name_of(project.thickness));
    attempt.tree = tree_text(given_tree(project.tree));
    if (project.dither != ProjectDither::none) attempt.target += ", dither";
}

std::string text_without_view(Scene scene) {
    scene.camera = Camera{};
    scene.width = scene.height = 1;
    return scene_text(scene);
}

// Returns a cell of CSV. RFC 4180: a cell with a comma, a quote or a line end is put in quotes.
std::string quoted(const std::string& cell) {
    if (cell.find_first_of(",\"\r\n") == std::string::npos) return cell;
    std::string text(1, '"');
    for (const char c : cell) text.append(c == '"' ? 2 : 1, c);
    text.push_back('"');
    return text;
}

// Returns a row of CSV; unknown numbers are empty cells.
std::string csv_row(const Attempt& row) {
    const bool measured = row.share_measured > 0;
    const auto number = [](double value) { return fmt::format("{:.6g}", value); };
    const auto error = [&](double value) { return measured ? number(value) : std::string(); };
    const std::string cells[] = {fmt::to_string(row.view),
                                 row.method,
                                 row.classification,
                                 row.target,
                                 row.tree,
                                 row.samples,
                                 number(row.resolved.max_error),
                                 row.expected ? number(*row.expected) : "",
                                 error(row.error.linf),
                                 error(row.error.mean),
                                 error(row.error.l2),
                                 number(row.share_measured),
                                 number(row.draw_ms),
                                 number(row.frame_ms),
                                 fmt::to_string(row.resolved.width),
                                 fmt::to_string(row.resolved.height),
                                 nlohmann::ordered_json::parse(scene_text(row.resolved)).dump()};
    std::vector<std::string> quoted_cells;
    for (const std::string& cell : cells) quoted_cells.push_back(quoted(cell));
    return fmt::format("{}\r\n", fmt::join(quoted_cells, ","));
}

}  // namespace

Attempt attempt_of(const Scene& scene, const Scene& resolved) {
    Attempt attempt;
    attempt.scene = scene;
    attempt.resolved = resolved;
    attempt.method = name_of(resolved.method);
    switch (resolved.method) {
        case Method::slice:
            attempt.target = target_text(resolved);
            tell_slices(resolved, attempt);
            break;
        case Method::project:
            attempt.target = target_text(resolved);
            tell_tets(resolved, attempt);
            break;
        case Method::trace:
            attempt.classification = name_of(resolved.trace_of);
            break;
    }
    return attempt;
}

double frame_ms_of(const FrameStatistics& statistics) {
    double ms = 0;
    for (const char* stage : {"geometry", "order", "draw"})
        if (statistics.stages_ms.contains(stage)) ms += statistics.stages_ms.at(stage);
    return ms;
}

std::string short_text(const Scene& scene) {
    const Attempt attempt = attempt_of(scene, scene);
    std::string text = attempt.method + ", " + attempt.classification;
    if (!attempt.target.empty()) text += ", " + attempt.target;
    if (!attempt.tree.empty()) text += ", tree " + attempt.tree;
    if (!attempt.samples.empty()) text += fmt::format(", {} slabs", attempt.samples);
    return text;
}

int Attempts::view_of(const Scene& scene) {
    const auto found =
        std::ranges::find_if(views_, [&](const Scene& view) { return same_view(view, scene); });
    const auto index = found - views_.begin();
    if (found == views_.end()) views_.push_back(scene);
    return static_cast<int>(index) + 1;
}

void Attempts::add(const Scene& scene, const Scene& resolved, std::optional<double> expected,
                   const FrameStatistics& statistics) {
    const std::string settings = text_without_view(scene);
    std::size_t row = 0;
    while (row < rows_.size() &&
           !(settings_[row] == settings && same_view(rows_[row].resolved, resolved)))
        ++row;
    const bool known = row < rows_.size();
    const bool goes_along = !known && !rows_.empty() && settings_[newest_] == settings &&
                            rows_[newest_].share_measured < 1;
    if (goes_along) row = newest_;
    Attempt attempt = attempt_of(scene, resolved);
    attempt.view = view_of(resolved);
    attempt.expected = expected;
    attempt.draw_ms = statistics.draw_ms;
    attempt.frame_ms = frame_ms_of(statistics);
    if (known) {
        attempt.share_measured = rows_[row].share_measured;
        attempt.error = rows_[row].error;
    }
    if (row == rows_.size()) {
        rows_.emplace_back();
        settings_.push_back(settings);
    }
    rows_[row] = std::move(attempt);
    newest_ = row;
}

void Attempts::measured(double share, const ErrorNorms& error) {
    if (rows_.empty() || share <= 0 || share < rows_[newest_].share_measured) return;
    rows_[newest_].share_measured = share;
    rows_[newest_].error = error;
}

void Attempts::clear() {
    *this = {};
}

std::string Attempts::csv() const {
    std::string text =
        "view,method,classification,target,tree,samples,max_error,expected_error,linf,l1,l2,"
        "share_measured,draw_ms,frame_ms,width,height,scene\r\n";
    for (const Attempt& row : rows_) text += csv_row(row);
    return text;
}

std::vector<std::size_t> Attempts::alike(void (*without)(Scene&)) const {
    std::vector<std::size_t> found;
    if (rows_.empty()) return found;
    const auto text = [&](const Attempt& row) {
        Scene scene = row.scene;
        without(scene);
        return text_without_view(std::move(scene));
    };
    const std::string wanted = text(rows_[newest_]);
    for (std::size_t row = 0; row < rows_.size(); ++row)
        if (rows_[row].view == rows_[newest_].view && text(rows_[row]) == wanted)
            found.push_back(row);
    return found;
}

}  // namespace lamina::view
