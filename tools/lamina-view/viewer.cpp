// SPDX-License-Identifier: Apache-2.0
#include "viewer.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <glm/common.hpp>
#include <utility>

#include "panels/help_window.h"
#include "panels/theme.h"

namespace lamina::view {
namespace {
// Sizes of the panels and of the status line, in heights of the font.
constexpr float side_width = 25, bottom_height = 19, status_height = 1.8f;
// If a drag pauses for so many seconds, the picture is drawn in full.
constexpr double still_seconds = .3;
constexpr int key_f1 = 290;

constexpr ImGuiWindowFlags fixed_window = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                          ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                          ImGuiWindowFlags_NoSavedSettings |
                                          ImGuiWindowFlags_NoBringToFrontOnFocus;

bool is_comparison_key(int key) {
    return key == 'B' || key == 'M' || key == 'N' || key == 'V';
}

void begin_fixed(const char* name, float x, float y, float width, float height) {
    ImGui::SetNextWindowPos({x, y});
    ImGui::SetNextWindowSize({width, height});
    ImGui::Begin(name, nullptr, fixed_window);
}

}  // namespace

Viewer::Viewer(const GladGLContext& gl, const SessionOptions& options, std::function<void()> wake,
               std::filesystem::path settings_file)
    : settings_file_(std::move(settings_file)),
      worker_(options, wake),
      saving_(wake),
      texture_(gl),
      comparison_view_(gl),
      panels_(make_panels()),
      shown_(worker_.shown()) {
    try {
        settings_ = ViewerSettings::load(settings_file_);
    } catch (const std::exception& error) {
        message_ = error.what();
        bad_ = true;
    }
}

// Saves the viewer's settings. Errors are ignored: the window is gone.
Viewer::~Viewer() {
    if (settings_file_.empty()) return;
    try {
        settings_.save(settings_file_);
    } catch (const std::exception&) {
    }
}

void Viewer::open(const std::filesystem::path& file) {
    try {
        Scene scene = load_scene(file);
        const bool is_scene = file.extension() == ".json";
        if (shown_->loaded == document_.revisions().data) before_ = document_;
        document_.open(std::move(scene));
        document_.size_follows_window = !is_scene;
        wants_size_ = is_scene;
        message_.clear();
    } catch (const std::exception& error) {
        message_ = error.what();
        bad_ = true;
    }
}

std::string Viewer::save(const std::filesystem::path& file) {
    if (!can_save(file))
        return fmt::format("{}: found the suffix \"{}\", expected .json, .exr, .png or .npy",
                           file.string(), file.extension().string());
    waiting_.push_back(file);
    return {};
}

void Viewer::set_trace(bool trace) {
    settings_.trace = trace;
}

void Viewer::set_coarse(bool coarse) {
    settings_.coarse = coarse;
}

void Viewer::show_panels(bool panels) {
    settings_.panels = panels;
}

void Viewer::fix_size(int width, int height) {
    document_.size_follows_window = false;
    document_.set_size(width, height);
    wants_size_ = true;
}

std::optional<glm::ivec2> Viewer::take_wanted_size() {
    if (!std::exchange(wants_size_, false)) return {};
    const Scene& scene = document_.scene();
    const glm::vec2 picture(static_cast<float>(scene.width), static_cast<float>(scene.height));
    return glm::ivec2(glm::ceil(picture / pixels_ + beside_));
}

CameraControl::Around Viewer::around() const {
    return {area_, shown_->bounds, shown_->probe ? &*shown_->probe : nullptr};
}

void Viewer::handle(const InputEvent& event) {
    using Kind = InputEvent::Kind;
    const ImGuiIO& io = ImGui::GetIO();
    if (event.kind == Kind::drop && !event.files.empty()) return open(event.files.front());
    if (event.kind == Kind::pointer) pointer_ = event.place;
    const bool pointer_is_taken = event.kind == Kind::press || event.kind == Kind::wheel;
    if (pointer_is_taken && io.WantCaptureMouse) return;
    if (event.kind == Kind::key) {
        if (io.WantTextInput || prompt_.open()) return;
        if (event.key == key_f1 || event.control || event.key == key::tab || event.key == 'T' ||
            event.key == 'C' || is_comparison_key(event.key))
            return take_key(event);
        if (io.WantCaptureKeyboard && event.key < '0') return;
    }
    if (shown_->loaded != document_.revisions().data) return;
    if (!control_.handle(event, around(), document_)) return;
    changed_at_ = event.seconds;
    if (!input_at_) input_at_ = DrawRequest::Clock::now();
}

void Viewer::take_key(const InputEvent& event) {
    if (event.key == key_f1) help_ = !help_;
    if (event.key == key::tab) settings_.panels = !settings_.panels;
    if (!event.control) {
        if (event.key == 'T') settings_.trace = !settings_.trace;
        if (event.key == 'C') settings_.coarse = !settings_.coarse;
        take_comparison_key(event.key);
        return;
    }
    switch (event.key) {
        case 'O':
            return ask_open();
        case 'S':
            return ask_save(".json");
        case 'E':
            return ask_save(".exr");
        case 'Q':
            closing_ = true;
            return;
        case 'Y':
            return document_.redo();
        case 'Z':
            return event.shift ? document_.redo() : document_.undo();
        default:
            return;
    }
}

void Viewer::take_comparison_key(int key) {
    if (key == 'B') precision_.comparison.flip();
    if (key == 'M') precision_.comparison.next_mode();
    if (key == 'N') precision_.pin(document_, *shown_);
    if (key == 'V') precision_.comparison.next_with();
}

std::string Viewer::title() const {
    if (!document_.is_open()) return "lamina";
    return fmt::format("{}{} - lamina", document_.scene().file.filename().string(),
                       document_.dirty() ? " *" : "");
}

void Viewer::follow_worker() {
    shown_ = worker_.shown();
    go_back_if_failed();
    if (shown_->loaded == document_.revisions().data && opened_ != shown_->loaded) {
        opened_ = shown_->loaded;
        settings_.add_recent(document_.scene().file);
    }
    if (shown_->chosen && shown_->chosen_of == document_.revisions())
        document_.take_chosen(*shown_->chosen);
    if (shown_->screen && shown_->screen != uploaded_) {
        texture_.show(*shown_->screen);
        uploaded_ = shown_->screen;
    }
    precision_.follow(document_, *shown_);
    for (const Saving::Result& result : saving_.take_results()) {
        bad_ = !result.failure.empty();
        message_ = bad_ ? result.failure : fmt::format("wrote {}", result.file.string());
        if (!bad_ && result.file.extension() == ".json") document_.mark_saved();
    }
}

// If a file could not be read, goes back to the document that was open before.
void Viewer::go_back_if_failed() {
    if (shown_->failure.empty() || shown_->failed_request != requested_.number) return;
    if (shown_->loaded == document_.revisions().data) return;
    // If another file has been opened since then, its result is awaited.
    if (document_.revisions() != requested_.revisions) return;
    message_ = shown_->failure;
    bad_ = true;
    document_ = shown_->loaded == before_.revisions().data ? before_ : Document();
    requested_.revisions = {};
}

bool Viewer::is_full() const {
    return document_.is_open() && shown_->full && shown_->kind != PictureKind::moving &&
           shown_->full_revisions == document_.revisions() &&
           requested_.revisions == document_.revisions() && !requested_.moving;
}

bool Viewer::is_truth() const {
    return is_full() && shown_->truth != nullptr;
}

bool Viewer::is_failed() const {
    return bad_ || (!shown_->failure.empty() && shown_->failed_request == requested_.number);
}

std::string Viewer::failure() const {
    return bad_ ? message_ : shown_->failure;
}

void Viewer::request_picture(double seconds) {
    if (!document_.is_open()) return;
    const bool changed = document_.revisions() != requested_.revisions;
    const bool dragged =
        control_.moving(seconds) || (ImGui::IsAnyItemActive() && ImGui::IsAnyMouseDown());
    const bool rests = requested_.moving && (!dragged || seconds > changed_at_ + still_seconds);
    const bool switched =
        settings_.coarse != requested_.coarse || settings_.trace != requested_.trace;
    if (!changed && !rests && !switched) return;
    if (changed) changed_at_ = seconds;
    requested_.revisions = document_.revisions();
    requested_.words = document_.words();
    requested_.moving = changed && dragged;
    requested_.coarse = settings_.coarse;
    requested_.trace = settings_.trace;
    requested_.number = ++requests_;
    requested_.asked_at = input_at_.value_or(DrawRequest::Clock::now());
    input_at_.reset();
    DrawRequest request = requested_;
    request.scene = document_.scene();
    request.pinned = precision_.comparison.pinned();
    worker_.request(std::move(request));
    if (changed) message_.clear(), bad_ = false;
}

void Viewer::save_what_waits() {
    if (waiting_.empty() || !is_full()) return;
    for (const std::filesystem::path& file : std::exchange(waiting_, {}))
        saving_.save(file, shown_);
}

std::optional<double> Viewer::next_frame() const {
    if (!requested_.moving) return {};
    const double still = changed_at_ + still_seconds;
    return std::min(still, control_.rest_at().value_or(still));
}

void Viewer::frame(float width, float height, float pixels, double seconds) {
    follow_worker();
    draw_menu();
    const float menu = ImGui::GetFrameHeight();
    const bool panels = settings_.panels;
    const float side = panels ? em(side_width) : 0, bottom = panels ? em(bottom_height) : 0;
    const float status = em(status_height);
    pixels_ = pixels;
    beside_ = {side, menu + bottom + status};
    const float picture_width = std::max(width - beside_.x, 1.f);
    const float picture_height = std::max(height - beside_.y, 1.f);
    if (document_.is_open() && document_.size_follows_window)
        document_.set_size(static_cast<int>(picture_width * pixels),
                           static_cast<int>(picture_height * pixels));
    draw_picture(0, menu, picture_width, picture_height, pixels);
    find_value();
    if (panels) {
        begin_fixed("side", picture_width, menu, side, height - menu - status);
        draw_side_panels();
        ImGui::End();
        begin_fixed("bottom", 0, menu + picture_height, picture_width, bottom);
        draw_bottom_panels();
        ImGui::End();
    }
    draw_status(width, height);
    prompt_.draw();
    help_window(help_);
    // Changes of one gesture are undone together: a step ends when no key or button is down.
    const bool* const keys = ImGui::GetIO().KeysDown;
    if (!ImGui::IsAnyItemActive() && !ImGui::IsAnyMouseDown() &&
        std::none_of(keys, keys + IM_ARRAYSIZE(ImGui::GetIO().KeysDown), std::identity()))
        document_.end_step();
    request_picture(seconds);
    save_what_waits();
}

void Viewer::draw_picture(float left, float top, float width, float height, float pixels) {
    if (!uploaded_) return;
    // Pixels of the picture are pixels of the screen unless it is coarse or does not fit.
    const Scene& scene = document_.scene();
    const bool coarse = shown_->kind == PictureKind::moving || shown_->kind == PictureKind::none;
    const auto across = static_cast<float>(coarse ? scene.width : texture_.width());
    const auto down = static_cast<float>(coarse ? scene.height : texture_.height());
    const float scale = std::min({1 / pixels, width / across, height / down});
    const auto on_pixels = [&](float place) { return std::floor(place * pixels) / pixels; };
    const float x = on_pixels(left + (width - scale * across) / 2);
    const float y = on_pixels(top + (height - scale * down) / 2);
    area_ = {{x, y}, {scale * across, scale * down}, texture_.width()};
    ImGui::GetBackgroundDrawList()->AddImage(
        reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture_.name())), {x, y},
        {x + scale * across, y + scale * down});
    draw_comparison();
}

void Viewer::draw_comparison() {
    Comparison& comparison = precision_.comparison;
    if (!comparison.active()) return;
    const bool truth = comparison.with == CompareWith::truth;
    const std::string a = truth ? "the truth" : short_text(comparison.pinned()->resolved);
    comparison_view_.draw(comparison, area_, "A: " + a, "B: " + short_text(*shown_->resolved));
}

// Finds the value under the pointer, unless the picture moves: it would then be the value of
// another place when it is read.
void Viewer::find_value() {
    seen_.reset();
    const bool at_rest = shown_->kind == PictureKind::full || shown_->kind == PictureKind::traced;
    if (!at_rest || !shown_->probe || !area_.contains(pointer_) || ImGui::GetIO().WantCaptureMouse)
        return;
    const glm::dvec2 pixel = area_.pixel(pointer_);
    seen_ = shown_->probe->seen(pixel.x, pixel.y);
}

PanelContext Viewer::panel_context() {
    return {document_, *shown_, seen_ ? std::optional(seen_->value) : std::nullopt, &precision_};
}

void Viewer::draw_side_panels() {
    PanelContext context = panel_context();
    for (const auto& panel : panels_)
        if (panel->place() == PanelPlace::side &&
            ImGui::CollapsingHeader(panel->title(), ImGuiTreeNodeFlags_DefaultOpen))
            panel->draw(context);
}

void Viewer::draw_bottom_panels() {
    PanelContext context = panel_context();
    if (!ImGui::BeginTabBar("bottom panels")) return;
    for (const auto& panel : panels_) {
        if (panel->place() != PanelPlace::bottom || !ImGui::BeginTabItem(panel->title())) continue;
        panel->draw(context);
        ImGui::EndTabItem();
    }
    ImGui::EndTabBar();
}

}  // namespace lamina::view
