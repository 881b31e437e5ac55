// SPDX-License-Identifier: Apache-2.0
#include "parallel/shared_renderer.h"

#include <fmt/format.h>
#include <unistd.h>

#include <string>
#include <utility>

#include "base/content_hash.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/profile.h"
#include "parallel/ranks.h"
#include "plan/plan.h"

namespace lamina {
namespace {

void add(const IndexBox& box, std::string& text) {
    for (const glm::dvec3& corner : {box.min, box.max})
        text += fmt::format(" {:a} {:a} {:a}", corner.x, corner.y, corner.z);
}

// A hash of all that the renderers of one picture must have in common: the plan, and their shares.
std::string digest_of(const SlicePlan& plan, const std::vector<IndexBox>& shares) {
    const TableRequest& table = plan.table.request;
    std::string text = fmt::format(
        "{} {} {} {} {} {} {} {:a} {} {} {:a} {:a} {:a} {:a} {} {}", plan.slabs,
        static_cast<int>(plan.classification), static_cast<int>(plan.sampling), plan.single_color,
        plan.nan_transparent, plan.linear, plan.nothing_visible, plan.unit, table.scalar_nodes,
        table.length_layers, table.max_length, plan.opaque_depth, plan.curve_error, plan.most_bend,
        plan.bricks.size(), plan.clip.size());
    add(plan.drawn, text);
    for (const IndexBox& share : shares) add(share, text);
    ContentHash hash;
    hash.add(text);
    return hash.hex();
}

[[noreturn]] void refuse(const Scene& scene, const char* key, const std::string& found,
                         const char* expected) {
    fail("{}: {}: found {}, expected {}: several ranks draw one picture in float32",
         scene.file.string(), key, found, expected);
}

// OVER is associative in float only: rounding to codes depends on compositing slab after slab, from
// the first to the last.
Scene checked(Scene scene) {
    if (scene.target.value_or(Target::float32) != Target::float32)
        refuse(scene, "render.target", name_of(scene.target), "float32");
    if (scene.slice.tree) refuse(scene, "render.slice.tree", "a tree", "none");
    if (scene.slice.dither) refuse(scene, "render.slice.dither", "dithering", "none");
    scene.target = Target::float32;
    return scene;
}

}  // namespace

SharedRenderer::SharedRenderer(const Ranks& ranks, Wire wire, const Scene& scene, SceneData data,
                               const OmissionSwitch& omissions, bool many_frames,
                               std::shared_ptr<TableCache> tables)
    : ranks_(ranks),
      own_(checked(scene), std::move(data),
           {.context = ContextChoice::cpu,
            .omissions = omissions,
            .many_frames = many_frames,
            .share = {ranks.number(), ranks.count()},
            .tables = std::move(tables)}),
      composer_(ranks, wire) {}

void SharedRenderer::check_plan() {
    const std::string own = digest_of(own_.plan().slice, own_.renderer().shares());
    std::string of_first = own;
    ranks_.broadcast(of_first);
    agree(ranks_, [&] {
        if (own == of_first) return;
        fail("{}: ranks plan different pictures: expected the same data on all machines",
             own_.asked().file.string());
    });
}

void SharedRenderer::draw(const std::optional<Camera>& camera) {
    std::vector<int> order;
    RankReport report;
    agree(ranks_, [&] {
        Stage drawing("share");
        if (camera) own_.set_camera(*camera);
        own_.draw_frame();
        own_.read(picture_);
        order = own_.renderer().front_to_back();
        report.draw_ms = drawing.end();
    });
    Stage compositing("composite");
    do_or_abort(ranks_, [&] { composer_.compose(order, picture_); });
    report.composite_ms = compositing.end();
    report.threads = own_.capabilities().threads;
    report.segments = own_.renderer().renderer().fragments();
    report.bytes_sent = composer_.bytes_sent();
    report.messages_sent = composer_.messages_sent();
    report.peak_memory = static_cast<std::int64_t>(peak_resident_memory());
    gethostname(report.machine.data(), report.machine.size() - 1);
    reports_.resize(ranks_.leads() ? static_cast<std::size_t>(ranks_.count()) : 0);
    MPI_Gather(&report, sizeof report, MPI_BYTE, reports_.data(), sizeof report, MPI_BYTE, 0,
               ranks_.comm());
}

}  // namespace lamina
