// SPDX-License-Identifier: Apache-2.0
#include "study/study_frames.h"

#include <fmt/chrono.h>
#include <sched.h>
#include <sys/utsname.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <ctime>
#include <fstream>
#include <utility>

#include "base/arithmetic.h"
#include "base/client.h"
#include "base/profile.h"
#include "gl/api.h"

namespace lamina::study {
namespace {

double cpu_milliseconds() {
    return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

std::string processor_name() {
    std::ifstream stream("/proc/cpuinfo");
    for (std::string line; std::getline(stream, line);) {
        const std::size_t colon = line.find(": ");
        if (line.starts_with("model name") && colon != std::string::npos)
            return line.substr(colon + 2);
    }
    utsname names{};
    return uname(&names) == 0 ? names.machine : "unknown";
}

int processor_count() {
    cpu_set_t set;
    return sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
}

}  // namespace

std::vector<FrameTimes> time_interleaved(const std::string& label,
                                         const std::vector<TimedFrame>& frames, int rounds) {
    assert(rounds >= 3);
    Progress progress(label, static_cast<std::int64_t>(frames.size()) * (rounds + 1));
    for (const TimedFrame& frame : frames) {
        frame.warm_up();
        progress.advance();
    }
    std::vector<std::vector<double>> ms(frames.size()), cpu(frames.size());
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t i = 0; i < frames.size(); ++i) {
            check_interrupt();
            const double cpu_before = cpu_milliseconds();
            const Stopwatch watch;
            frames[i].draw();
            ms[i].push_back(watch.milliseconds());
            cpu[i].push_back(cpu_milliseconds() - cpu_before);
            progress.advance();
        }
    }
    std::vector<FrameTimes> times;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const auto [fastest, slowest] = std::minmax_element(ms[i].begin(), ms[i].end());
        times.push_back({median(ms[i]), median(cpu[i]), *fastest, *slowest, ms[i].size()});
    }
    return times;
}

nlohmann::ordered_json describe_machine() {
    return {{"machine", processor_name()},
            {"processors", processor_count()},
            {"date", fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr)))}};
}

const Capabilities& DrawContexts::use(const std::string& word) {
    const auto found = contexts_.find(word);
    if (found != contexts_.end()) return found->second.capabilities();
    const Auto<ContextChoice> choice = context_choice(word);
    if (choice != ContextChoice::cpu) {
        before_switch_();
        current_.reset();
        std::erase_if(contexts_,
                      [](const auto& context) { return !context.second.capabilities().cpu; });
    }
    const DrawContext& context = contexts_.try_emplace(word, choice).first->second;
    if (!context.capabilities().cpu) current_ = context.make_current();
    return context.capabilities();
}

StudyFrames::StudyFrames(const Scene& scene, DataStore& data, const Capabilities& capabilities,
                         std::shared_ptr<TableCache> tables)
    : camera_(*scene.camera),
      pipeline_(std::make_unique<Pipeline>(
          scene, data.data_of(scene),
          PipelineOptions{.capabilities = capabilities, .tables = std::move(tables)})) {
    pipeline_->load();
    const std::int64_t before = gl::bytes_allocated();
    const Stopwatch watch;
    pipeline_->draw_frame();
    first_ms_ = watch.milliseconds();
    set_up_ms_ = pipeline_->statistics().stages_ms.at("set_up");
    bytes_gpu_ = gl::bytes_allocated() - before;
    // A study reports errors above max_error itself, so slicing, whose plan warns of them, warns of
    // nothing here.
    if (scene.method == Method::project) pipeline_->warn_of_plan();
}

void StudyFrames::draw() {
    if (turned_) pipeline_->set_camera(camera_);
    turned_ = false;
    pipeline_->draw_frame();
}

void StudyFrames::draw_turned(double degrees) {
    turned_ = true;
    pipeline_->set_camera(turned(camera_, degrees));
    pipeline_->draw_frame();
}

}  // namespace lamina::study
