// SPDX-License-Identifier: Apache-2.0
#include "model/attempt.h"

#include <fmt/ranges.h>

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

}  // namespace lamina::view
