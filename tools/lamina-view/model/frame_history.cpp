// SPDX-License-Identifier: Apache-2.0
#include "model/frame_history.h"

#include <algorithm>

namespace lamina::view {

// Returns true if the full picture shows the current document.
bool PrecisionInSight::is_of(const Document& document, const Shown& shown) {
    return shown.full && shown.resolved && shown.failure.empty() &&
           shown.full_revisions == document.revisions();
}

void PrecisionInSight::follow(const Document& document, const Shown& shown) {
    if (shown.frame != last_frame_) {
        last_frame_ = shown.frame;
        frames.add(shown.frame_statistics, shown.kind == PictureKind::moving);
    }
    comparison.follow(shown);
    if (is_of(document, shown) && shown.full_revisions != recorded_) {
        recorded_ = shown.full_revisions;
        attempts.add(document.scene(), *shown.resolved, shown.plan.error.known(), shown.statistics);
    }
    if (shown.full_revisions == recorded_) attempts.measured(shown.share_traced, shown.error);
}

void PrecisionInSight::pin(const Document& document, const Shown& shown) {
    if (!is_of(document, shown)) return;
    comparison.pin(document.scene(), shown);
    comparison.follow(shown);
}

void PrecisionInSight::go_on_with(Document& document, Scene scene, bool keep_view) {
    const Scene& now = document.scene();
    if (keep_view) scene.camera = now.camera;
    if (keep_view || document.size_follows_window) {
        scene.width = now.width;
        scene.height = now.height;
    }
    document.replace(std::move(scene), "going back");
    document.end_step();
}

const std::vector<std::string>& FrameHistory::stage_names() {
    static const std::vector<std::string> names = {"facts",  "trials", "plan",     "set_up",
                                                   "tables", "upload", "geometry", "order",
                                                   "draw",   "other"};
    return names;
}

// Finds the stages that were done for this picture. Statistics keep the last time of each stage, so
// a stage was done if its time has changed. The time of set_up contains those of tables and upload.
void FrameHistory::add(const FrameStatistics& statistics, bool moving) {
    std::map<std::string, double> done;
    for (const auto& [stage, ms] : statistics.stages_ms) {
        const auto before = last_.find(stage);
        if (ms > 0 && (before == last_.end() || before->second != ms)) done[stage] = ms;
    }
    last_ = statistics.stages_ms;
    if (const auto set_up = done.find("set_up"); set_up != done.end()) {
        for (const char* part : {"tables", "upload"})
            if (done.contains(part)) set_up->second -= done[part];
        set_up->second = std::max(set_up->second, 0.0);
    }
    FrameCost cost{.ms = statistics.draw_ms, .moving = moving, .stages = {}};
    double known = 0;
    for (const std::string& stage : stage_names()) {
        if (!done.contains(stage)) continue;
        // Threads overlap, and clocks are read one after another, so stages are cut to the total
        // time.
        const double ms = std::min(done[stage], cost.ms - known);
        if (ms > 0) cost.stages.emplace_back(stage, ms);
        known += std::max(ms, 0.0);
    }
    if (cost.ms > known) cost.stages.emplace_back("other", cost.ms - known);
    frames_.push_back(std::move(cost));
    if (frames_.size() > most_frames) frames_.pop_front();
}

double FrameHistory::longest_ms() const {
    double longest = 0;
    for (const FrameCost& frame : frames_) longest = std::max(longest, frame.ms);
    return longest;
}

double FrameHistory::median_ms(bool moving) const {
    std::vector<double> times;
    for (const FrameCost& frame : frames_)
        if (frame.moving == moving) times.push_back(frame.ms);
    if (times.empty()) return 0;
    const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
    std::ranges::nth_element(times, middle);
    return *middle;
}

}  // namespace lamina::view
