// SPDX-License-Identifier: Apache-2.0
#include "render/scene_renderer.h"

#include <cassert>
#include <utility>

#include "base/client.h"
#include "base/profile.h"
#include "base/progress.h"
#include "render/project_drawing.h"
#include "render/slice_drawing.h"

namespace lamina {

SceneRenderer::SceneRenderer(Scene scene, std::shared_ptr<const VolumeData> volume,
                             const Capabilities& capabilities, OmissionSwitch omissions,
                             const PictureShare& share, std::shared_ptr<TableCache> tables)
    : asked_(std::move(scene)),
      capabilities_(capabilities),
      omissions_(std::move(omissions)),
      drawing_(std::make_unique<SliceDrawing>(std::move(volume), share, std::move(tables))) {
    assert(asked_.method == Method::slice);
    assert(share.count == 1 || capabilities_.tiles);
}

SceneRenderer::SceneRenderer(Scene scene, std::shared_ptr<const SceneMesh> mesh,
                             const Capabilities& capabilities, OmissionSwitch omissions,
                             std::shared_ptr<TableCache> tables)
    : asked_(std::move(scene)),
      capabilities_(capabilities),
      omissions_(std::move(omissions)),
      drawing_(std::make_unique<ProjectDrawing>(std::move(mesh), std::move(tables))) {
    assert(asked_.method == Method::project);
}

template <typename Change>
void SceneRenderer::change(const Change& change_scene) {
    change_scene(asked_);
    if (resolved_) resolved_->change(change_scene);
    view_measured_ = planned_ = false;
}

void SceneRenderer::set_camera(const Camera& camera) {
    change([&](Scene& scene) { scene.camera = camera; });
}

void SceneRenderer::set_size(int width, int height) {
    assert(width > 0 && height > 0);
    change([&](Scene& scene) {
        scene.width = width;
        scene.height = height;
    });
    renderer_fits_ = false;
}

// A table belongs to one transfer function, so it is chosen again.
void SceneRenderer::set_transfer_function(const TransferFunction& transfer_function) {
    change([&](Scene& scene) { scene.transfer_function = transfer_function; });
    if (resolved_) resolved_->change([&](Scene& scene) { scene.slice.table = asked_.slice.table; });
    data_measured_ = renderer_fits_ = false;
    plan_.reset();
}

void SceneRenderer::set_clip(const Clip& clip) {
    change([&](Scene& scene) { scene.clip = clip; });
    data_measured_ = renderer_fits_ = false;
}

void SceneRenderer::set_scene(Scene scene) {
    assert(scene.method == asked_.method);
    asked_ = std::move(scene);
    data_measured_ = renderer_fits_ = false;
    choose_again();
}

void SceneRenderer::expect_many_frames() {
    many_frames_ = true;
    choose_again();
}

void SceneRenderer::choose_again() {
    resolved_.reset();
    plan_.reset();
    view_measured_ = planned_ = false;
}

const Resolved& SceneRenderer::resolved() {
    plan();
    return *resolved_;
}

void SceneRenderer::measure() {
    const Scene& scene = resolved_ ? resolved_->scene() : asked_;
    Stage measuring("facts");
    if (!data_measured_) {
        drawing_->measure_data(scene);
        ++counts_.data;
        data_measured_ = true;
        view_measured_ = planned_ = false;
    }
    if (!view_measured_) {
        drawing_->measure_view(scene, plan_ ? &*plan_ : nullptr);
        ++counts_.views;
        view_measured_ = true;
    }
    stages_ms_["facts"] = measuring.end();
}

const Plan& SceneRenderer::plan() {
    if (planned_) return *plan_;
    measure();
    const bool first = !resolved_;
    if (first) {
        Stage trying("trials");
        drawing_->make_trials(asked_, capabilities_, many_frames_);
        ++counts_.trials;
        stages_ms_["trials"] = trying.end();
    }
    Stage planning("plan");
    const Scene& scene = first ? asked_ : resolved_->scene();
    plan_ = drawing_->plan(scene, capabilities_, omissions_, first);
    ++counts_.plans;
    resolved_ = drawing_->resolve(scene, *plan_);
    planned_ = true;
    stages_ms_["plan"] = planning.end();
    return *plan_;
}

std::string SceneRenderer::explanation() {
    return drawing_->explanation(plan(), capabilities_);
}

Warnings SceneRenderer::warnings() {
    plan();
    return drawing_->warnings(*resolved_, *plan_);
}

std::vector<IndexBox> SceneRenderer::shares() {
    plan();
    return drawing_->shares();
}

std::vector<int> SceneRenderer::front_to_back() {
    plan();
    return drawing_->front_to_back(resolved_->scene());
}

void SceneRenderer::set_up() {
    plan();
    FrameRenderer* const ready = drawing_->renderer();
    if (ready != nullptr && renderer_fits_ && ready->take(*plan_)) return;
    Stage setting_up("set_up");
    drawing_->make_renderer(*resolved_, *plan_, capabilities_);
    ++counts_.renderers;
    renderer_fits_ = true;
    stages_ms_["set_up"] = setting_up.end();
}

const FrameRenderer& SceneRenderer::renderer() {
    set_up();
    return *drawing_->renderer();
}

void SceneRenderer::draw(std::stop_token stop) {
    Client client = ClientScope::current();
    if (stop.stop_possible()) client.stop = std::move(stop);
    const ClientScope scope(std::move(client));
    set_up();
    FrameRenderer& renderer = *drawing_->renderer();
    Progress progress(drawing_->activity(), renderer.step_count());
    const Scene& scene = resolved_->scene();
    renderer.draw(View(*scene.camera, scene.width, scene.height), &progress);
}

Image SceneRenderer::picture() const {
    assert(drawing_->renderer() != nullptr);
    return drawing_->renderer()->read();
}

void SceneRenderer::read(Image& picture) const {
    assert(drawing_->renderer() != nullptr);
    drawing_->renderer()->read(picture);
}

void SceneRenderer::add_to(FrameStatistics& statistics) {
    for (const auto& [stage, ms] : stages_ms_) statistics.stages_ms[stage] = ms;
    if (planned_ && plan_->method == Method::slice) statistics.slabs = plan_->slice.slabs;
    const FrameRenderer* const renderer = drawing_->renderer();
    if (renderer == nullptr) return;
    for (const auto& [stage, ms] : renderer->stages_ms()) statistics.stages_ms[stage] = ms;
    statistics.fragments = renderer->fragments();
    statistics.bytes = renderer->byte_count();
    statistics.counts["clamped_colors"] = clamped_colors(resolved_->scene());
    drawing_->add_to(statistics);
}

}  // namespace lamina
