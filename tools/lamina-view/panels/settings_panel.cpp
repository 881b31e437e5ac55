// SPDX-License-Identifier: Apache-2.0
#include "panels/settings_panel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string_view>

#include "lamina/color.h"
#include "lamina/error.h"
#include "model/viewer_settings.h"
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

// Draws a slider for numbers of a limited range; other numbers are dragged in proportion to their
// size, or typed.
Answer number_control(const SettingNode& node, const Json& value) {
    double number = number_of(value);
    const bool slides = node.least >= 0 && std::isfinite(node.most) && node.most <= 1000;
    bool changed = false;
    if (slides) {
        // The slider ends just inside limits that are excluded.
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

// Returns factors as text: [32, 32] becomes 32x32.
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

// Draws a picker of display values, beside the numbers in the file.
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

// Groups shown first: the user changes them while looking at the picture.
constexpr std::array<std::string_view, 6> first_groups{"render", "camera", "lighting",
                                                       "clip",   "image",  "transfer_function"};

constexpr float label_width = 10.5f;  // in heights of the font, for the longest key

bool is_first(const SettingNode& node) {
    return std::ranges::find(first_groups, node.key) != first_groups.end();
}

// Returns true for groups that are open at first: those that say how the picture is drawn.
bool is_used(const SettingNode& node, const Scene& scene) {
    return node.path == "render" || node.path == std::string("render.") + name_of(scene.method);
}

std::string below(const std::string& path, const std::string& key) {
    return path.empty() ? key : path + "." + key;
}

void show_help(const SettingNode& node, const std::string& reason) {
    if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(em(26));
    ImGui::TextUnformatted(node.path.c_str());
    if (!node.description.empty()) ImGui::TextColored(theme::dim, "%s", node.description.c_str());
    if (!node.otherwise.is_null())
        ImGui::TextColored(theme::dim, "Default: %s", node.otherwise.dump().c_str());
    if (!reason.empty()) ImGui::TextColored(theme::warning, "Changes nothing: %s", reason.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

std::optional<Grid::Bounds> data_bounds(const PanelContext& context) {
    if (context.shown.loaded == 0) return {};
    return context.shown.bounds;
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
            return {};  // the panel draws these itself
    }
    return {};
}

void SettingsPanel::draw(PanelContext& context) {
    drawn_.clear();
    if (!context.document.is_open()) return;
    settings_ = settings_of(context.document.scene());
    ImGui::SetNextItemWidth(-1);
    if (ImGui::InputTextWithHint("##filter", "Find a key", filter_.InputBuf,
                                 IM_ARRAYSIZE(filter_.InputBuf)))
        filter_.Build();
    const SettingNode& scene = scene_keys();
    for (const std::string_view key : first_groups)
        for (const SettingNode& part : scene.parts)
            if (part.key == key) draw_node(part, part.key, context);
    if (all_open || filter_.IsActive()) ImGui::SetNextItemOpen(true);
    if (!ImGui::TreeNodeEx("data", ImGuiTreeNodeFlags_SpanAvailWidth)) return;
    for (const SettingNode& part : scene.parts)
        if (!is_first(part)) draw_node(part, part.key, context);
    ImGui::TreePop();
}

// Tells whether the node's path, or one below it, contains the text of the filter.
bool SettingsPanel::passes(const SettingNode& node) const {
    return filter_.PassFilter(node.path.c_str()) ||
           std::ranges::any_of(node.parts, [&](const SettingNode& part) { return passes(part); });
}

SettingsPanel::Json SettingsPanel::value_at(const std::string& path) const {
    return setting_at(settings_, path);
}

SettingsPanel::Json SettingsPanel::start_of(const SettingNode& node, const std::string& path,
                                            PanelContext& context) const {
    return starting_value(node, path, context.document.scene(), context.shown.resolved.get(),
                          data_bounds(context));
}

void SettingsPanel::set(const std::string& path, const Json& value, PanelContext& context) {
    try {
        context.document.set_setting(path, value);
        message_.clear();
    } catch (const Error& error) {
        message_ = error.what();
    }
    message_path_ = path;
}

void SettingsPanel::draw_parts(const SettingNode& node, const std::string& path,
                               PanelContext& context) {
    for (const SettingNode& part : node.parts) draw_node(part, below(path, part.key), context);
}

void SettingsPanel::draw_node(const SettingNode& node, const std::string& path,
                              PanelContext& context) {
    if (!passes(node)) return;
    drawn_.insert(node.path);
    ImGui::PushID(path.c_str());
    switch (node.kind) {
        case SettingKind::group:
            if (node.path == "transfer_function")
                draw_transfer_function(node);
            else
                draw_group(node, path, context);
            break;
        case SettingKind::list:
            draw_list(node, path, context);
            break;
        case SettingKind::either:
            draw_either(node, path, context);
            break;
        default:
            draw_leaf(node, path, context);
    }
    if (path == message_path_ && !message_.empty()) wrapped(theme::bad, message_);
    ImGui::PopID();
}

void SettingsPanel::draw_label(const SettingNode& node, const std::string& reason) {
    ImGui::AlignTextToFramePadding();
    if (reason.empty())
        ImGui::TextUnformatted(node.key.c_str());
    else
        ImGui::TextDisabled("%s", node.key.c_str());
    show_help(node, reason);
    ImGui::SameLine(em(label_width));
}

void SettingsPanel::draw_leaf(const SettingNode& node, const std::string& path,
                              PanelContext& context) {
    const std::string reason = why_without_effect(context.document.scene(), node.path);
    draw_label(node, reason);
    ImGui::BeginDisabled(!reason.empty());
    Json value = value_at(path);
    if (node.automatic) {
        bool automatic = value.is_null() || value == node.automatic_word;
        if (ImGui::Checkbox(node.automatic_word.c_str(), &automatic)) {
            set(path, automatic ? Json(node.automatic_word) : start_of(node, path, context),
                context);
        }
        ImGui::SameLine();
        if (value.is_null() || value == node.automatic_word) {
            ImGui::BeginDisabled();
            setting_control(node, start_of(node, path, context),
                            context.document.scene().color_space);
            ImGui::EndDisabled();
            ImGui::EndDisabled();
            return;
        }
    }
    if (value.is_null()) value = node.otherwise;
    if (const auto answer = setting_control(node, value, context.document.scene().color_space))
        set(path, *answer, context);
    ImGui::EndDisabled();
}

// Draws the combo that switches a group off, on, or to automatic. Returns true if its keys are set.
bool SettingsPanel::draw_switch(const SettingNode& node, const std::string& path,
                                PanelContext& context) {
    const Json value = value_at(path);
    const bool own = value.is_object();
    ImGui::SameLine(em(label_width));
    if (node.path == "camera") {
        if (ImGui::SmallButton("from the data")) context.document.choose_camera();
        return true;
    }
    const bool automatic_without = node.automatic && node.key == "table";
    const bool automatic = value == node.automatic_word || (automatic_without && value.is_null());
    ImGui::SetNextItemWidth(-1);
    const char* const now = own ? "own" : automatic ? node.automatic_word.c_str() : "none";
    if (ImGui::BeginCombo("##switch", now)) {
        if (!automatic_without && ImGui::Selectable("none", !own && !automatic))
            set(path, nullptr, context);
        if (node.automatic && ImGui::Selectable(node.automatic_word.c_str(), automatic))
            set(path, node.automatic_word, context);
        if (ImGui::Selectable("own", own) && !own)
            set(path, start_of(node, path, context), context);
        ImGui::EndCombo();
    }
    return own;
}

void SettingsPanel::draw_group(const SettingNode& node, const std::string& path,
                               PanelContext& context) {
    const std::string reason = why_without_effect(context.document.scene(), node.path);
    const bool switched = may_be_absent(node) || node.path == "camera";
    if (all_open || filter_.IsActive()) ImGui::SetNextItemOpen(true);
    if (!reason.empty())
        ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    if (switched) ImGui::AlignTextToFramePadding();
    const bool open = ImGui::TreeNodeEx(
        node.key.c_str(),
        (switched ? 0 : ImGuiTreeNodeFlags_SpanAvailWidth) |
            (is_used(node, context.document.scene()) ? ImGuiTreeNodeFlags_DefaultOpen : 0));
    if (!reason.empty()) ImGui::PopStyleColor();
    show_help(node, reason);
    ImGui::BeginDisabled(!reason.empty());
    const bool there = !switched || draw_switch(node, path, context);
    ImGui::EndDisabled();
    if (!open) return;
    if (!reason.empty()) wrapped(theme::dim, "Changes nothing: " + reason);
    ImGui::BeginDisabled(!there);
    if (there || all_open)
        draw_parts(node, path, context);
    else
        wrapped(theme::dim, "It has no keys as it is");
    ImGui::EndDisabled();
    ImGui::TreePop();
}

void SettingsPanel::draw_list(const SettingNode& node, const std::string& path,
                              PanelContext& context) {
    const Json value = value_at(path);
    const std::size_t size = value.is_array() ? value.size() : 0;
    const std::string one = node.key.substr(0, node.key.size() - 1);
    const SettingNode& element = node.parts.front();
    draw_label(node, {});
    ImGui::BeginDisabled(node.count > 0 && size >= node.count);
    if (ImGui::SmallButton("add")) {
        Json longer = value.is_array() ? value : Json::array();
        longer.push_back(starting_value(element, below(path, std::to_string(size)),
                                        context.document.scene(), nullptr, data_bounds(context)));
        set(path, longer, context);
    }
    ImGui::EndDisabled();
    ImGui::SameLine();
    ImGui::TextDisabled("%zu", size);
    // If all groups are open, a list without elements shows the keys of an element.
    const std::size_t shown = all_open && size == 0 ? 1 : size;
    for (std::size_t i = 0; i < shown; ++i) {
        const std::string at = below(path, std::to_string(i));
        ImGui::PushID(static_cast<int>(i));
        ImGui::SetNextItemOpen(true, all_open ? ImGuiCond_Always : ImGuiCond_Appearing);
        const bool open = ImGui::TreeNode("##element", "%s %zu", one.c_str(), i + 1);
        ImGui::SameLine(em(label_width));
        ImGui::BeginDisabled(size <= node.least_count);
        if (ImGui::SmallButton("remove")) {
            Json shorter = value;
            shorter.erase(i);
            set(path, shorter, context);
        }
        ImGui::EndDisabled();
        if (open) {
            ImGui::BeginDisabled(i >= size);
            draw_parts(element, at, context);
            ImGui::EndDisabled();
            ImGui::TreePop();
        }
        ImGui::PopID();
    }
}

// Draws the choice between a short form (a file's name, a text, a flag) and an object with keys of
// its own. Typing a text makes the value one.
void SettingsPanel::draw_either(const SettingNode& node, const std::string& path,
                                PanelContext& context) {
    const Json value = value_at(path);
    draw_label(node, {});
    ImGui::SetNextItemWidth(-1);
    const bool annotates = node.path.starts_with("image.annotations.");
    const char* const made = annotates               ? "with settings"
                             : node.path == "volume" ? "generated"
                                                     : "made from the volume";
    const char* const typed = annotates ? "text" : "file";
    const bool is_flag = std::ranges::any_of(
        node.parts, [](const SettingNode& part) { return part.kind == SettingKind::flag; });
    const char* const now = value.is_string()   ? typed
                            : value.is_object() ? made
                            : value == true     ? "shown"
                                                : "none";
    if (ImGui::BeginCombo("##either", now)) {
        if (may_be_absent(node) && ImGui::Selectable("none", value.is_null()))
            set(path, nullptr, context);
        if (is_flag && ImGui::Selectable("shown", value == true)) set(path, true, context);
        if (ImGui::Selectable(made, value.is_object()) && !value.is_object())
            set(path, starting_value(node, path, context.document.scene(), nullptr, {}), context);
        ImGui::EndCombo();
    }
    ImGui::Indent();
    for (const SettingNode& part : node.parts) {
        if (part.kind == SettingKind::text) {
            ImGui::AlignTextToFramePadding();
            ImGui::TextUnformatted(typed);
            ImGui::SameLine(em(label_width));
            if (const auto answer = setting_control(part, value, {})) set(path, *answer, context);
        } else if (part.kind != SettingKind::flag && (value.is_object() || all_open)) {
            ImGui::BeginDisabled(!value.is_object());
            draw_parts(part, path, context);
            ImGui::EndDisabled();
        }
    }
    ImGui::Unindent();
}

// The transfer function's keys have their controls in TransferPanel.
void SettingsPanel::draw_transfer_function(const SettingNode& node) {
    draw_label(node, {});
    ImGui::TextColored(theme::dim, "in its own panel");
    for (const std::string& path : paths_below(node))
        if (!path.ends_with("[]")) drawn_.insert(path);
}

}  // namespace lamina::view
