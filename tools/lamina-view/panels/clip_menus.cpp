// SPDX-License-Identifier: Apache-2.0
#include "panels/clip_menus.h"

#include <fmt/format.h>
#include <imgui.h>

#include <glm/common.hpp>

#include <utility>

#include "panels/theme.h"

namespace lamina::view {
namespace {

constexpr const char* axis_names[] = {"x", "y", "z"};
constexpr float slider_width = 14;  // heights of the font

bool draw_slider(const char* label, double& value, double lo, double hi) {
    ImGui::SetNextItemWidth(em(slider_width));
    return ImGui::SliderScalar(label, ImGuiDataType_Double, &value, &lo, &hi, "%.5g");
}

// Keeps what lies on one side of a plane across an axis. `side`: '>' or '<'.
void clip(Document& document, int axis, char side, double place) {
    Words words;
    words.clip = {fmt::format("{}{}{}", axis_names[axis], side, place)};
    const std::string name = "clip " + words.clip.front();
    glm::dvec3 normal(0);
    normal[axis] = side == '>' ? 1 : -1;
    document.adjust(std::move(words), name, [&](Scene& scene) {
        std::erase_if(scene.clip.planes,
                      [&](const ClipPlane& plane) { return plane.normal == normal; });
    });
}

void crop(Document& document, const Grid::Bounds& box) {
    Words words;
    words.crop = fmt::format("{}:{},{}:{},{}:{}", box.min.x, box.max.x, box.min.y, box.max.y,
                             box.min.z, box.max.z);
    document.adjust(std::move(words), "crop", [](Scene& scene) { scene.clip.box.reset(); });
}

}  // namespace

// Takes the box of the scene, if it has one, and begins in the middle of other data.
void ClipMenus::follow(const Document& document, const Grid::Bounds& bounds) {
    if (bounds.min != bounds_.min || bounds.max != bounds_.max) {
        bounds_ = bounds;
        place_ = bounds.min + 0.5 * (bounds.max - bounds.min);
    }
    if (editing_ || document.words()) return;
    const std::optional<ClipBox>& box = document.scene().clip.box;
    crop_ =
        box ? Grid::Bounds{glm::max(box->min, bounds.min), glm::min(box->max, bounds.max)} : bounds;
}

void ClipMenus::draw_clip(Document& document, const Grid::Bounds& bounds) {
    follow(document, bounds);
    for (int axis = 0; axis < 3; ++axis) {
        ImGui::PushID(axis);
        draw_slider(axis_names[axis], place_[axis], bounds.min[axis], bounds.max[axis]);
        ImGui::SameLine();
        if (ImGui::Button("keep above")) clip(document, axis, '>', place_[axis]);
        ImGui::SameLine();
        if (ImGui::Button("keep below")) clip(document, axis, '<', place_[axis]);
        ImGui::PopID();
    }
    if (ImGui::MenuItem("No planes", nullptr, false, !document.scene().clip.planes.empty())) {
        Clip rest = document.scene().clip;
        rest.planes.clear();
        document.set_clip(rest);
        document.end_step();
    }
}

void ClipMenus::draw_crop(Document& document, const Grid::Bounds& bounds) {
    follow(document, bounds);
    bool moved = false;
    editing_ = false;
    for (int axis = 0; axis < 3; ++axis) {
        ImGui::PushID(axis);
        double &from = crop_.min[axis], &to = crop_.max[axis];
        draw_slider("##from", from, bounds.min[axis], to);
        moved |= ImGui::IsItemDeactivatedAfterEdit();
        editing_ |= ImGui::IsItemActive();
        ImGui::SameLine();
        draw_slider(axis_names[axis], to, from, bounds.max[axis]);
        moved |= ImGui::IsItemDeactivatedAfterEdit();
        editing_ |= ImGui::IsItemActive();
        ImGui::PopID();
    }
    if (moved) crop(document, crop_);
    if (ImGui::MenuItem("No box", nullptr, false, document.scene().clip.box.has_value())) {
        Clip rest = document.scene().clip;
        rest.box.reset();
        document.set_clip(rest);
        document.end_step();
    }
}

}  // namespace lamina::view
