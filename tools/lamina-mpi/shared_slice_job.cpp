// SPDX-License-Identifier: Apache-2.0
#include "shared_slice_job.h"

#include <fmt/format.h>

#include <optional>

#include "base/error.h"
#include "base/stage.h"
#include "render/context_choice.h"
#include "render/warnings.h"

namespace lamina {
namespace {

void check(const RenderRequest& request) {
    const Scene& scene = request.scene;
    if (request.context != ContextChoice::automatic && request.context != ContextChoice::cpu) {
        throw UsageError(fmt::format(
            "--context {}: expected cpu: ranks draw with the native engine, which alone draws a "
            "part of a volume",
            name_of(request.context)));
    }
    if (scene.method == Method::slice) return;
    fail("{}: render.method: found {}, expected slice: {}", scene.file.string(),
         name_of(scene.method),
         scene.method == Method::trace
             ? "the reference tracer takes one process"
             : "parts of a mesh may lie before and behind one another at once, so that no order of "
               "their pictures is right");
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

class SharedSliceJob : public RenderJob {
  public:
    SharedSliceJob(const RenderRequest& request, Leader& leader)
        : request_(request), leader_(leader) {
        check(request);
    }
    ~SharedSliceJob() override {
        if (number_ >= 0) leader_.close(number_);
    }

    Plan plan(RenderStats& stats) override {
        number_ = leader_.open(request_.scene, request_.data.volume, request_.omissions,
                               request_.many_frames);
        const auto& took = own().stages_ms();
        stats.stages_ms["measure"] += took.at("facts") + took.at("trials");
        stats.stages_ms["plan"] = took.at("plan");
        stats.stages_ms["set_up"] = took.at("set_up");
        const Capabilities& capabilities = own().capabilities();
        const int count = leader_.ranks().count();
        stats.renderer = capabilities.renderer;
        stats.context = fmt::format("{}, {} {}", renderer_and_threads(capabilities), count,
                                    count == 1 ? "rank" : "ranks");
        stats.on_tiles = true;
        const Plan plan = own().plan();
        stats.counts["non_finite_samples"] = request_.data.volume->bricks.non_finite;
        warn_of_all(own().warnings());
        return plan;
    }
    Scene resolved_scene() override { return own().resolved_scene(); }
    std::string explanation(const Plan& /*plan*/) const override {
        return leader_.renderer(number_).own().explanation();
    }

    void draw(const Plan& plan, RenderStats& stats) override { draw_first({}, plan, stats); }
    void draw_frame(const Camera& camera) override { leader_.draw(number_, camera); }
    void draw_view(const Camera& camera, const Plan& plan, RenderStats& stats) override {
        if (!image_) return draw_first(camera, plan, stats);
        draw_timed(camera, stats);
    }

    std::size_t write(PictureFile& file, const PictureAttributes& attributes) override {
        return file.write(*image_, request_.scene.background, attributes,
                          request_.scene.color_space);
    }

  private:
    SceneRenderer& own() { return leader_.renderer(number_).own(); }

    void draw_timed(const std::optional<Camera>& camera, RenderStats& stats) {
        Stage frame("frame");
        frame.count("frame", static_cast<double>(stats.frames_ms.size()));
        leader_.draw(number_, camera);
        stats.frames_ms.push_back(frame.end());
        image_ = leader_.renderer(number_).picture();
    }

    void draw_first(const std::optional<Camera>& camera, const Plan& plan, RenderStats& stats) {
        draw_timed(camera, stats);
        warn_of_picture(request_.scene, *request_.data.field(), *image_);
        const auto& reports = leader_.renderer(number_).reports();
        for (const RankReport& report : reports)
            stats.fragments += static_cast<std::uint64_t>(report.segments);
        stats.ranks = to_json(reports);
        stats.samples = plan.slice.slabs;
        stats.bytes_host = own().renderer().byte_count();
    }

    const RenderRequest request_;
    Leader& leader_;
    int number_ = -1;
    std::optional<Image> image_;  // the last one to be written
};

}  // namespace

std::unique_ptr<RenderJob> make_shared_slice_job(const RenderRequest& request, Leader& leader) {
    return std::make_unique<SharedSliceJob>(request, leader);
}

}  // namespace lamina
