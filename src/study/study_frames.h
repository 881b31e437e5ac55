// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "render/draw_context.h"
#include "render/pipeline.h"
#include "study/data_store.h"

namespace lamina::study {

// A frame to time. `draw` draws it and returns when it is complete; `warm_up` prepares it.
struct TimedFrame {
    std::string name;
    std::function<void()> warm_up, draw;
};

struct FrameTimes {
    double ms = 0;            // median, by the clock
    double cpu_ms = 0;        // median, of all threads of the process
    double min = 0, max = 0;  // ms, by the clock
    std::size_t count = 0;
};

// Times frames in rounds A B C, A B C, ..., so that a slow phase of the machine affects all of
// them. `rounds` must be at least 3.
std::vector<FrameTimes> time_interleaved(const std::string& label,
                                         const std::vector<TimedFrame>& frames, int rounds);

// Returns {machine, processors, date}: the processor's name, the number of processors that this
// process may use, and today's date (UTC).
nlohmann::ordered_json describe_machine();

// Contexts by their words (--context), made when first asked for. Only one OpenGL context exists at
// a time; it is current in the thread that asked for it.
class DrawContexts {
  public:
    // `before_switch`: called before an OpenGL context is destroyed, also by the destructor; must
    // destroy the renderers that use it.
    explicit DrawContexts(std::function<void()> before_switch)
        : before_switch_(std::move(before_switch)) {}
    ~DrawContexts() { before_switch_(); }
    DrawContexts(const DrawContexts&) = delete;
    DrawContexts& operator=(const DrawContexts&) = delete;

    // Returns the capabilities of the context. Throws Error if it cannot be made.
    const Capabilities& use(const std::string& word);

  private:
    std::function<void()> before_switch_;
    std::map<std::string, DrawContext> contexts_;
    std::unique_ptr<gl::CurrentContext> current_;
};

// A scene of method slice or project that is drawn again and again. The data and the context must
// outlive it. `tables`: pre-integration tables that the frames of a study share.
class StudyFrames {
  public:
    StudyFrames(const Scene& scene, DataStore& data, const Capabilities& capabilities,
                std::shared_ptr<TableCache> tables);

    void draw();
    // Draws a frame with the scene's eye turned about its centre.
    void draw_turned(double degrees);

    const Scene& scene() const { return pipeline_->scene(); }
    // Returns the durations of set-up and last frame, by stage.
    std::map<std::string, double> stages_ms() const {
        return pipeline_->renderer().renderer().stages_ms();
    }
    Image picture() const { return pipeline_->renderer().picture(); }
    double set_up_ms() const { return set_up_ms_; }
    // Returns the time of facts, automatic choices, set-up and first frame, without reading the
    // data.
    double first_ms() const { return first_ms_; }
    bool on_cpu() const { return pipeline_->capabilities().cpu; }
    // Returns the OpenGL memory that was allocated for the first frame and is kept, in bytes.
    std::int64_t bytes_gpu() const { return bytes_gpu_; }
    std::int64_t bytes_host() const { return pipeline_->renderer().renderer().byte_count(); }
    std::int64_t bytes() const { return bytes_gpu() + bytes_host(); }

  private:
    Camera camera_;  // the scene's own
    std::unique_ptr<Pipeline> pipeline_;
    bool turned_ = false;
    double set_up_ms_ = 0, first_ms_ = 0;
    std::int64_t bytes_gpu_ = 0;
};

}  // namespace lamina::study
