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

// A kind of frame to time. `draw` draws one frame and returns when it is complete; `warm_up`
// prepares it.
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
// them. There must be at least three rounds.
std::vector<FrameTimes> time_interleaved(const std::string& label,
                                         const std::vector<TimedFrame>& frames, int rounds);

// Returns {machine, processors, date}: the processor's name, how many of them this process may run
// on, and today (UTC).
nlohmann::ordered_json describe_machine();

// Contexts by their words (--context), made when first asked for. Of those with OpenGL only one is
// there at a time, current in the thread that asked for it.
class DrawContexts {
  public:
    // `before_switch`: called before an OpenGL context is destroyed; it must destroy its renderers.
    explicit DrawContexts(std::function<void()> before_switch)
        : before_switch_(std::move(before_switch)) {}
    ~DrawContexts() { before_switch_(); }
    DrawContexts(const DrawContexts&) = delete;
    DrawContexts& operator=(const DrawContexts&) = delete;

    // Throws Error if there is no such context.
    const Capabilities& use(const std::string& word);

  private:
    std::function<void()> before_switch_;
    std::map<std::string, DrawContext> contexts_;
    std::unique_ptr<gl::CurrentContext> current_;
};

// A scene of method slice or project, prepared to be drawn again and again. The data and the
// context must outlive it. `tables`: those of the study.
class StudyFrames {
  public:
    StudyFrames(const Scene& scene, DataStore& data, const Capabilities& capabilities,
                std::shared_ptr<TableCache> tables);

    void draw();
    // Draws a frame with the scene's eye turned about its centre.
    void draw_turned(double degrees);

    const Scene& scene() const { return pipeline_->scene(); }
    // Durations of preparing and of the last frame.
    std::map<std::string, double> stages_ms() const {
        return pipeline_->renderer().renderer().stages_ms();
    }
    Image picture() const { return pipeline_->renderer().picture(); }
    double set_up_ms() const { return set_up_ms_; }
    // Time of the facts, the choice of what is automatic, the set-up and the first frame. Reading
    // the data is not in it.
    double first_ms() const { return first_ms_; }
    bool on_cpu() const { return pipeline_->capabilities().cpu; }
    // Bytes of OpenGL memory after the first frame.
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
