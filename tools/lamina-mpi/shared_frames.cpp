// SPDX-License-Identifier: Apache-2.0
#include "shared_frames.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "base/client.h"
#include "base/error.h"
#include "render/draw_context.h"

namespace lamina {

void check_shared(const Scene& scene, const Auto<ContextChoice>& context) {
    if (context.value_or(ContextChoice::cpu) != ContextChoice::cpu) {
        throw UsageError(fmt::format(
            "--context {}: expected cpu: ranks draw with the cpu engine, which alone draws a "
            "part of a volume",
            name_of(context)));
    }
    if (scene.method == Method::slice) return;
    fail("{}: render.method: found {}, expected slice: {}", scene.file.string(),
         name_of(scene.method),
         scene.method == Method::trace
             ? "the reference tracer takes one process"
             : "parts of a mesh may lie before and behind one another at once, so that no order of "
               "their pictures is right");
}

SharedFrames::SharedFrames(Leader& leader, const Scene& scene, SceneData& data,
                           const PipelineOptions& options)
    : leader_(leader),
      scene_(scene),
      data_(data),
      omissions_(options.omissions),
      many_frames_(options.many_frames),
      number_(leader.open(scene_, data_, omissions_, many_frames_)) {}

SharedFrames::~SharedFrames() {
    leader_.close(number_);
}

void SharedFrames::set_scene(Scene scene) {
    const int next = leader_.open(scene, data_, omissions_, many_frames_);
    leader_.close(std::exchange(number_, next));
    scene_ = std::move(scene);
    camera_.reset();
}

void SharedFrames::draw(std::stop_token stop) {
    if (stop.stop_requested()) throw Interrupted();
    leader_.draw(number_, camera_);
}

void SharedFrames::read(Image& picture) const {
    picture = leader_.renderer(number_).picture();
}

void SharedFrames::add_to(FrameStatistics& statistics) {
    const FrameStatistics of_this = own().statistics();
    const Capabilities& capabilities = own().capabilities();
    const int count = leader_.ranks().count();
    statistics.renderer = capabilities.renderer;
    statistics.drawn_by = fmt::format("{}, {} {}", renderer_and_threads(capabilities), count,
                                      count == 1 ? "rank" : "ranks");
    statistics.native = true;
    statistics.slabs = of_this.slabs;
    statistics.bytes = of_this.bytes;
    for (const char* const stage : {"facts", "trials", "plan", "set_up"})
        statistics.stages_ms[stage] = of_this.stages_ms.at(stage);
    for (const RankReport& report : leader_.renderer(number_).reports())
        statistics.fragments += report.segments;
}

nlohmann::ordered_json to_json(const std::vector<RankReport>& reports) {
    auto json = nlohmann::ordered_json::array();
    for (const RankReport& report : reports) {
        json.push_back({{"machine", report.machine.data()},
                        {"threads", report.threads},
                        {"draw_ms", report.draw_ms},
                        {"composite_ms", report.composite_ms},
                        {"segments", report.segments},
                        {"bytes_sent", report.bytes_sent},
                        {"messages_sent", report.messages_sent},
                        {"peak_rss_mb", static_cast<double>(report.peak_memory) / (1 << 20)}});
    }
    return json;
}

}  // namespace lamina
