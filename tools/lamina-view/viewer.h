// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "comparison_view.h"
#include "model/document.h"
#include "model/frame_history.h"
#include "model/navigator.h"
#include "model/viewer_settings.h"
#include "panels/clip_menus.h"
#include "panels/panel.h"
#include "panels/typed_input.h"
#include "work/draw_worker.h"
#include "work/saving.h"

namespace lamina::view {

// The viewer without its window: input changes the document, the worker draws it, and frame() shows
// the picture.
class Viewer {
  public:
    // `wake`: called from any thread when there is something new to show. `settings_file`: empty if
    // no settings are kept.
    Viewer(const GladGLContext& gl, const SessionOptions& options, std::function<void()> wake,
           std::filesystem::path settings_file);
    ~Viewer();

    // Opens a scene or data file. Errors are shown.
    void open(const std::filesystem::path& file);
    // Saves the full picture once it is drawn. Returns why the name is refused, or an empty text.
    std::string save(const std::filesystem::path& file);
    void set_trace(bool trace);
    void set_coarse(bool coarse);
    void show_panels(bool panels);
    void fix_size(int width, int height);  // of the picture, independent of the window
    // Returns, once, the window size that shows a picture of a new size pixel by pixel.
    std::optional<glm::ivec2> take_wanted_size();

    void handle(const InputEvent& event);
    // Declares the window's contents to ImGui. `width`, `height`: of the window, in ImGui's units;
    // `pixels`: screen pixels per unit; `seconds`: the time.
    void frame(float width, float height, float pixels, double seconds);
    // Returns the time at which a frame is needed even without input; empty if none is.
    std::optional<double> next_frame() const;
    std::string title() const;
    bool is_closing() const { return closing_; }

    const Shown& shown() const { return *shown_; }
    // Tell whether the last request is drawn in full, and traced to its end. A request that cannot
    // be drawn counts as done.
    bool is_full() const;
    bool is_truth() const;
    bool is_saving() const { return !waiting_.empty() || saving_.busy(); }
    bool is_failed() const;
    bool is_busy() const { return worker_.busy() || saving_.busy(); }
    bool awaits_moving_picture() const { return requested_.moving && worker_.busy(); }
    std::string failure() const;  // last error, or empty

  private:
    void follow_worker();
    void go_back_if_failed();
    void request_picture(double seconds);
    void save_what_waits();
    void take_key(const InputEvent& event);
    CameraControl::Around around() const;
    void find_value();
    void ask_open();
    void ask_save(const char* suffix);
    void draw_menu();
    void draw_file_menu();
    void draw_view_menu();
    void draw_look_menu();
    void draw_picture(float left, float top, float width, float height, float pixels);
    void take_comparison_key(int key);
    void draw_comparison();
    void draw_side_panels();
    void draw_bottom_panels();
    PanelContext panel_context();
    void draw_status(float width, float height);
    std::string status() const;

    std::filesystem::path settings_file_;
    ViewerSettings settings_;
    Document document_, before_;  // before_: the document before the file that is being opened
    DrawWorker worker_;
    Saving saving_;
    PictureTexture texture_;
    ComparisonView comparison_view_;
    PrecisionInSight precision_;
    std::vector<std::unique_ptr<Panel>> panels_;
    PathPrompt prompt_;
    CameraControl control_;
    ClipMenus clip_menus_;
    PictureArea area_;
    glm::dvec2 pointer_{-1};
    std::optional<SeenPoint> seen_;  // visible point of the data under the pointer

    std::shared_ptr<const Shown> shown_;
    std::shared_ptr<const ScreenPicture> uploaded_;
    DrawRequest requested_;  // last request, without its scene
    std::uint64_t requests_ = 0;
    // Time of the first input since the last request.
    std::optional<DrawRequest::Clock::time_point> input_at_;
    std::uint64_t opened_ = 0;  // Revisions::data of the last file that could be opened
    bool wants_size_ = false;   // take_wanted_size() will return a size
    glm::vec2 beside_{0};       // size of the window minus that of the picture, in ImGui's units
    float pixels_ = 1;          // screen pixels per unit of ImGui
    double changed_at_ = 0;     // time of the last change during a drag
    std::vector<std::filesystem::path> waiting_;  // files to save once the picture is full
    std::string message_;                         // last error or result
    bool bad_ = false;                            // message_ is an error
    bool help_ = false, closing_ = false;
};

}  // namespace lamina::view
