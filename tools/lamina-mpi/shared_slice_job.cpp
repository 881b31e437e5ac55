// SPDX-License-Identifier: Apache-2.0
#include "shared_slice_job.h"

#include "base/error.h"
#include "base/stage.h"
#include "loaded_volume.h"
#include "render/context_choice.h"
#include "render/picture_warnings.h"

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
        Stage opening("ranks");
        number_ = leader_.open(request_.scene, request_.data.volume, request_.omissions,
                               request_.many_frames);
        stats.stages_ms["ranks"] = opening.end();
        const Capabilities& capabilities = own().capabilities();
        stats.renderer = capabilities.renderer;
        const int count = leader_.ranks().count();
        stats.context = fmt::format("{}, {} {}", renderer_and_threads(capabilities), count,
                                    count == 1 ? "rank" : "ranks");
        stats.on_tiles = true;
        report_volume(request_, *request_.data.volume, stats);
        return own().plan();
    }
    Scene resolved_scene() override { return own().resolved_scene(); }
    std::string explanation(const Plan& /*plan*/) const override {
        return leader_.renderer(number_).own().explanation();
    }

    void draw(const Plan& plan, RenderStats& stats) override {
        draw_view(request_.scene.camera, plan, stats);
        warn_of_picture(request_.scene, *request_.data.field(), picture());
    }
    void draw_frame(const Camera& camera) override { leader_.draw(number_, camera); }
    void draw_view(const Camera& camera, const Plan& plan, RenderStats& stats) override {
        Stage frame("frame");
        frame.count("frame", static_cast<double>(stats.frames_ms.size()));
        leader_.draw(number_, camera);
        stats.frames_ms.push_back(frame.end());
        const auto& reports = leader_.renderer(number_).reports();
        stats.fragments = 0;
        for (const RankReport& report : reports)
            stats.fragments += static_cast<std::uint64_t>(report.segments);
        stats.ranks = to_json(reports);
        stats.samples = plan.slice.slabs;
        stats.bytes_host = own().renderer().byte_count();
    }

    std::size_t write(PictureFile& file, const PictureAttributes& attributes) override {
        return file.write(picture(), request_.scene.background, attributes,
                          request_.scene.color_space);
    }

  private:
    SceneRenderer& own() { return leader_.renderer(number_).own(); }
    const Image& picture() const { return leader_.renderer(number_).picture(); }

    const RenderRequest request_;
    Leader& leader_;
    int number_ = -1;
};

}  // namespace

std::unique_ptr<RenderJob> make_shared_slice_job(const RenderRequest& request, Leader& leader) {
    return std::make_unique<SharedSliceJob>(request, leader);
}

}  // namespace lamina
