// SPDX-License-Identifier: Apache-2.0
#include "panels/setting_controls.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>

#include "lamina/color.h"
#include "panels/theme.h"
#include "panels/typed_input.h"

namespace lamina::view {
namespace {

using Json = nlohmann::ordered_json;
using Answer = std::optional<Json>;

std::string word_of(const Json& value) {
    return value.is_string() ? value.get<std::string>() : value.dump();
}

double number_of(const Json& value) {
    return value.is_number() ? value.get<double>() : 0;
}

Answer flag_control(const Json& value) {
    bool flag = value.is_boolean() && value.get<bool>();
    if (ImGui::Checkbox("##flag", &flag)) return Json(flag);
    return {};
}

Answer choice_control(const SettingNode& node, const Json& value) {
    Answer answer;
    if (!ImGui::BeginCombo("##choice", word_of(value).c_str())) return answer;
    for (const Json& word : node.words)
        if (ImGui::Selectable(word_of(word).c_str(), word == value)) answer = word;
    ImGui::EndCombo();
    return answer;
}

// Numbers of few magnitudes have a slider; others are drawn by their own size, or typed.
Answer number_control(const SettingNode& node, const Json& value) {
    double number = number_of(value);
    const bool slides = node.least >= 0 && std::isfinite(node.most) && node.most <= 1000;
    bool changed = false;
    if (slides) {
        // Ends that are no values themselves are left out by little.
        const double least = node.least_excluded ? 1e-4 * node.most : node.least;
        const double most = node.most_excluded ? node.most - least : node.most;
        const bool by_ratio = (least > 0 && most / least > 50) || most > 100;
        changed =
            ImGui::SliderScalar("##number", ImGuiDataType_Double, &number, &least, &most, "%.6g",
                                by_ratio && !node.most_excluded ? ImGuiSliderFlags_Logarithmic : 0);
    } else {
        const float speed = static_cast<float>(std::max(1e-30, .005 * std::abs(number)));
        changed = ImGui::DragScalar("##number", ImGuiDataType_Double, &number, speed, nullptr,
                                    nullptr, "%.9g");
    }
    if (changed) return Json(number);
    return {};
}

Answer whole_control(const SettingNode& node, const Json& value) {
    auto number = static_cast<std::int64_t>(number_of(value));
    const double least_number = std::max(node.least, -9e15),
                 most_number = std::min(node.most, 9e15);
    const auto least = static_cast<std::int64_t>(least_number);
    const auto most = static_cast<std::int64_t>(most_number);
    const float speed = std::max(.05f, .01f * static_cast<float>(number));
    if (ImGui::DragScalar("##whole", ImGuiDataType_S64, &number, speed, &least, &most, "%lld",
                          ImGuiSliderFlags_AlwaysClamp))
        return Json(number);
    return {};
}

Answer text_control(const Json& value) {
    std::string text = value.is_string() ? value.get<std::string>() : "";
    if (typed_text("##text", "", text)) return Json(text);
    return {};
}

// [32, 32] is written 32x32.
std::string factors_text(const Json& value) {
    if (!value.is_array()) return word_of(value);
    std::string text;
    for (const Json& factor : value) {
        if (!text.empty()) text += 'x';
        text += word_of(factor);
    }
    return text;
}

Answer factors_control(const Json& value) {
    std::string text = factors_text(value);
    if (typed_text("##factors", "32x32, 4^5", text)) return Json(text);
    return {};
}

Answer vector_control(const SettingNode& node, const Json& value) {
    const std::size_t count = node.count;
    const float space = ImGui::GetStyle().ItemInnerSpacing.x;
    const float width = (ImGui::GetContentRegionAvail().x - space * static_cast<float>(count - 1)) /
                        static_cast<float>(count);
    Json numbers =
        value.is_array() && value.size() == count ? value : Json(std::vector<int>(count));
    double largest = 0;
    for (const Json& number : numbers) largest = std::max(largest, std::abs(number_of(number)));
    Answer answer;
    for (std::size_t i = 0; i < count; ++i) {
        if (i > 0) ImGui::SameLine(0, space);
        ImGui::PushID(static_cast<int>(i));
        ImGui::SetNextItemWidth(width);
        double number = number_of(numbers[i]);
        const float speed =
            node.whole ? .25f : static_cast<float>(std::max(1e-30, .004 * std::max(largest, .1)));
        if (ImGui::DragScalar("##part", ImGuiDataType_Double, &number, speed, nullptr, nullptr,
                              node.whole ? "%.0f" : "%.6g")) {
            numbers[i] = node.whole ? Json(std::llround(number)) : Json(number);
            answer = numbers;
        }
        ImGui::PopID();
    }
    return answer;
}

// A picker of display values, and the numbers that the file has.
Answer color_control(const Json& value, ImageColorSpace space) {
    glm::dvec3 color(1);
    if (value.is_array() && value.size() == 3)
        color = {number_of(value[0]), number_of(value[1]), number_of(value[2])};
    glm::vec3 display(display_of_color(color, space));
    Answer answer;
    if (ImGui::ColorEdit3("##picker", &display.r,
                          ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_NoLabel))
        answer = Json{{"srgb", {display.r, display.g, display.b}}};
    ImGui::SameLine();
    SettingNode numbers;
    numbers.kind = SettingKind::vector;
    numbers.count = 3;
    if (const Answer typed = vector_control(numbers, {color.r, color.g, color.b})) answer = typed;
    return answer;
}

}  // namespace

Answer setting_control(const SettingNode& node, const Json& value, ImageColorSpace space) {
    ImGui::SetNextItemWidth(-1);
    switch (node.kind) {
        case SettingKind::fixed:
            ImGui::TextColored(theme::dim, "%s", word_of(node.words.front()).c_str());
            return {};
        case SettingKind::flag:
            return flag_control(value);
        case SettingKind::choice:
            return choice_control(node, value);
        case SettingKind::whole:
            return whole_control(node, value);
        case SettingKind::number:
            return number_control(node, value);
        case SettingKind::text:
            return text_control(value);
        case SettingKind::factors:
            return factors_control(value);
        case SettingKind::vector:
            return vector_control(node, value);
        case SettingKind::color:
            return color_control(value, space);
        case SettingKind::group:
        case SettingKind::list:
        case SettingKind::either:
            return {};  // the panel opens these
    }
    return {};
}

}  // namespace lamina::view
