// SPDX-License-Identifier: Apache-2.0
// The viewer's menus, prompts and status line.
#include <fmt/format.h>
#include <imgui.h>

#include <filesystem>

#include "panels/theme.h"
#include "viewer.h"

namespace lamina::view {
namespace {

namespace fs = std::filesystem;

// Formats an error of the picture, which is in 1/255.
std::string in_255ths(double error) {
    return fmt::format("{:.3g}/255", error);
}

std::string expected_text(const PlanSummary& plan) {
    return ", error " + text_of(plan.error);
}

}  // namespace

void Viewer::ask_open() {
    prompt_.ask("Open a scene or a data file", document_.scene().file.parent_path() / "",
                [this](const std::string& name) -> std::string {
                    std::error_code unknown;
                    if (!fs::exists(name, unknown)) return fmt::format("{}: no such file", name);
                    open(name);
                    return bad_ ? message_ : std::string();
                });
}

void Viewer::ask_save(const char* suffix) {
    if (!document_.is_open()) return;
    fs::path file = document_.scene().file;
    file.replace_filename(file.stem().string() + "-view" + suffix);
    prompt_.ask("Save the scene (.json) or the picture (.exr, .png, .npy)", file,
                [this](const std::string& name) { return save(name); });
}

void Viewer::draw_menu() {
    if (!ImGui::BeginMainMenuBar()) return;
    if (ImGui::BeginMenu("File")) {
        draw_file_menu();
        ImGui::EndMenu();
    }
    if (ImGui::BeginMenu("Edit")) {
        const std::string undo = "Undo " + document_.undo_name(),
                          redo = "Redo " + document_.redo_name();
        if (ImGui::MenuItem(undo.c_str(), "Ctrl+Z", false, document_.can_undo())) document_.undo();
        if (ImGui::MenuItem(redo.c_str(), "Ctrl+Y", false, document_.can_redo())) document_.redo();
        ImGui::EndMenu();
    }
    if (ImGui::BeginMenu("View")) {
        draw_view_menu();
        ImGui::EndMenu();
    }
    if (ImGui::BeginMenu("Look")) {
        draw_look_menu();
        ImGui::EndMenu();
    }
    if (ImGui::BeginMenu("Help")) {
        ImGui::MenuItem("Keys and pointer", "F1", &help_);
        ImGui::EndMenu();
    }
    ImGui::EndMainMenuBar();
}

void Viewer::draw_file_menu() {
    if (ImGui::MenuItem("Open...", "Ctrl+O")) ask_open();
    if (ImGui::BeginMenu("Recent", !settings_.recent.empty())) {
        fs::path wanted;
        for (const fs::path& file : settings_.recent)
            if (ImGui::MenuItem(file.string().c_str())) wanted = file;
        if (!wanted.empty()) open(wanted);
        ImGui::EndMenu();
    }
    const bool there = document_.is_open();
    if (ImGui::MenuItem("Save scene...", "Ctrl+S", false, there)) ask_save(".json");
    if (ImGui::MenuItem("Save picture...", "Ctrl+E", false, there)) ask_save(".exr");
    ImGui::Separator();
    if (ImGui::MenuItem("Quit", "Ctrl+Q")) closing_ = true;
}

void Viewer::draw_view_menu() {
    const bool there = document_.is_open() && document_.scene().camera.is_given();
    const bool flat = there && document_.scene().camera->projection == Projection::orthographic;
    if (ImGui::MenuItem("Fit", "F", false, there)) control_.fit(around(), document_);
    if (ImGui::MenuItem("Automatic camera", "Home", false, there)) document_.choose_camera();
    if (ImGui::MenuItem("Orthographic", "P", flat, there))
        control_.set_projection(document_,
                                flat ? Projection::perspective : Projection::orthographic);
    constexpr const char* ends[] = {"From +x", "From -x", "From +y",
                                    "From -y", "From +z", "From -z"};
    constexpr const char* keys[] = {"1, X",       "2, Shift+X", "3, Y",
                                    "4, Shift+Y", "5, Z",       "6, Shift+Z"};
    for (int i = 0; i < 6; ++i)
        if (ImGui::MenuItem(ends[i], keys[i], false, there))
            control_.see_axis(i / 2, i % 2 == 0 ? 1 : -1, around(), document_);
    ImGui::Separator();
    ImGui::MenuItem("Coarse while moving", "C", &settings_.coarse);
    ImGui::MenuItem("Trace at rest", "T", &settings_.trace);
    ImGui::MenuItem("Size follows the window", nullptr, &document_.size_follows_window, there);
    ImGui::MenuItem("Panels", "Tab", &settings_.panels);
}

// The words of the command line (docs/first-picture.md): those that are one of a list, and clips.
void Viewer::draw_look_menu() {
    const bool there = document_.is_open() && document_.scene().camera.is_given();
    const auto draw_words = [&](const char* title, const char* member, std::string Words::*word) {
        if (!ImGui::BeginMenu(title, there)) return;
        for (const std::string& known : known_words(member)) {
            if (!ImGui::MenuItem(known.c_str())) continue;
            Words words;
            words.*word = known;
            document_.adjust(std::move(words), std::string(member) + " " + known);
        }
        ImGui::EndMenu();
    };
    draw_words("See from", "view", &Words::view);
    draw_words("Up", "up", &Words::up);
    draw_words("Light", "light", &Words::light);
    if (ImGui::MenuItem("No light", nullptr, false, there))
        document_.edit([](Scene& scene) { scene.lighting.reset(); }, "no light");
    draw_words("Opacity", "opacity", &Words::opacity);
    draw_words("Preset", "preset", &Words::preset);
    if (ImGui::BeginMenu("Clip", there)) {
        clip_menus_.draw_clip(document_, shown_->bounds);
        ImGui::EndMenu();
    }
    if (ImGui::BeginMenu("Crop", there)) {
        clip_menus_.draw_crop(document_, shown_->bounds);
        ImGui::EndMenu();
    }
}

std::string Viewer::status() const {
    const Shown& shown = *shown_;
    if (!document_.is_open()) return "Drop a scene or a data file here, or Ctrl+O";
    std::string text;
    const auto add = [&](const std::string& part) {
        text += (text.empty() ? "" : "   |   ") + part;
    };
    if (shown.kind == PictureKind::moving)
        add(fmt::format("{} x {} while moving, {:.0f} ms; automatic keys keep their values",
                        shown.screen->width, shown.screen->height, shown.moving_ms));
    if (!shown.activity.empty() && shown.activity != "tracing")
        add(fmt::format("{} {:.0f} %", shown.activity, 100 * shown.share_done));
    if (shown.kind == PictureKind::full)
        add(fmt::format("{:.0f} ms{}", shown.statistics.draw_ms, expected_text(shown.plan)));
    const bool asks_truth = shown.resolved && shown.resolved->method == Method::trace;
    if (shown.kind == PictureKind::traced && asks_truth)
        add(fmt::format("the truth, traced {:.0f} %", 100 * shown.share_traced));
    if (shown.kind == PictureKind::traced && !asks_truth)
        add(fmt::format(
            "{}: Linf {}, L2 {}{}",
            shown.truth ? "the truth" : fmt::format("traced {:.0f} %", 100 * shown.share_traced),
            in_255ths(shown.error.linf), in_255ths(shown.error.l2), expected_text(shown.plan)));
    if (shown.kind != PictureKind::moving && !shown.chosen_again.empty())
        add(fmt::format("chosen again: {}{}", shown.chosen_again.front(),
                        shown.chosen_again.size() > 1
                            ? fmt::format(" and {} more", shown.chosen_again.size() - 1)
                            : ""));
    if (!waiting_.empty() || saving_.busy()) add("saving");
    if (seen_)
        add(fmt::format("value {:.6g} at ({:.4g}, {:.4g}, {:.4g})", seen_->value, seen_->position.x,
                        seen_->position.y, seen_->position.z));
    return text;
}

void Viewer::draw_status(float width, float height) {
    const float line = em(1.8f);
    ImGui::SetNextWindowPos({0, height - line});
    ImGui::SetNextWindowSize({width, line});
    ImGui::Begin("status", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus);
    const bool failed = !shown_->failure.empty() && shown_->failed_request == requested_.number;
    if (bad_ || failed) {
        ImGui::TextColored(theme::bad, "%s", failure().c_str());
    } else {
        const std::string text = message_.empty() ? status() : message_ + "   |   " + status();
        ImGui::TextUnformatted(text.c_str());
    }
    ImGui::End();
}

}  // namespace lamina::view
