// SPDX-License-Identifier: Apache-2.0
#include "render/scene_renderer.h"

#include <fmt/format.h>

#include <cassert>

#include "base/client.h"
#include "base/enum_words.h"
#include "base/profile.h"
#include "compositing/codes.h"
#include "facts/mesh_facts.h"
#include "plan/choices.h"
#include "plan/volume_shares.h"
#include "projection/project_renderer.h"
#include "scene/clip.h"
#include "slicing/slab_trials.h"
#include "slicing/slice_renderer.h"

namespace lamina {

std::vector<std::string> open_keys(const Scene& scene) {
    std::vector<std::string> keys;
    const auto add = [&](const char* key, const auto& value) {
        if (value.is_automatic()) keys.emplace_back(key);
    };
    add("transfer_function", scene.transfer_function);
    add("camera", scene.camera);
    if (scene.lighting) add("lighting", *scene.lighting);
    if (const Lighting* const given = given_lighting(scene.lighting))
        add("lighting.smallest_gradient", given->smallest_gradient);
    if (scene.method != Method::trace) add("render.target", scene.target);
    if (scene.method == Method::slice) {
        const SliceSettings& slice = scene.slice;
        add("render.slice.samples", slice.samples);
        add("render.slice.classification", slice.classification);
        add("render.slice.filter", slice.filter);
        if (slice.dither) add("render.slice.dither.period", slice.dither->period);
        if (slice.tree) add("render.slice.tree", *slice.tree);
    }
    if (scene.method == Method::project) {
        const ProjectSettings& project = scene.project;
        add("render.project.geometry", project.geometry);
        if (project.tree) add("render.project.tree", *project.tree);
    }
    return keys;
}

Resolved::Resolved(Scene scene) : scene_(std::move(scene)) {
    assert(open_keys(scene_).empty());
}

void Frames::set_size(int width, int height) {
    Scene changed = scene();
    changed.width = width;
    changed.height = height;
    set_scene(std::move(changed));
}

void Frames::set_transfer_function(const TransferFunction& transfer_function) {
    Scene changed = scene();
    changed.transfer_function = transfer_function;
    set_scene(std::move(changed));
}

void Frames::set_clip(const Clip& clip) {
    Scene changed = scene();
    changed.clip = clip;
    set_scene(std::move(changed));
}

// Measures, plans and makes renderers for a SceneRenderer; slicing and projection have one each. A
// Drawing keeps the renderer that it made last. Between two calls the scene may change only in the
// ways that SceneRenderer announces by measuring again.
class Drawing {
  public:
    virtual ~Drawing() = default;

    virtual const char* activity() const = 0;  // for progress: "slicing"

    // Measures the facts that depend on data and transfer function. measure_view() must be called
    // next.
    virtual void measure_data(const Scene& scene) = 0;
    // Measures the facts that depend on the view. `planned`: the plan of an earlier view, or null
    // for the first view. Facts that this plan has settled for all views are not measured again.
    // Returns whether rays of the view were sampled.
    virtual bool measure_view(const Scene& scene, const Capabilities& capabilities,
                              const Plan* planned) = 0;

    // Draws trial pictures if an automatic choice needs them; with `many_frames` also if they may
    // find settings that make later frames faster.
    virtual void make_trials(const Scene& /*scene*/, const Capabilities& /*capabilities*/,
                             bool /*many_frames*/) {}
    // `for_people`: the plan also says how much work each omission saves.
    virtual Plan plan(const Scene& scene, const Capabilities& capabilities,
                      const OmissionSwitch& omissions, bool for_people) const = 0;
    // Replaces every "auto" by the choice of the plan.
    virtual Resolved resolve(Scene scene, const Plan& plan) const = 0;
    virtual std::string explanation(const Plan& plan, const Capabilities& capabilities) const = 0;

    virtual Warnings warnings(const Resolved& resolved, const Plan& plan) = 0;

    // Adds the results of the last frame; the renderer must exist.
    virtual void add_to(FrameStatistics& /*statistics*/) const {}

    // As in SceneRenderer. A view must be measured before.
    virtual std::vector<IndexBox> shares() const { return {}; }
    virtual std::vector<int> front_to_back(const Scene& /*scene*/) const { return {0}; }

    // Replaces the renderer; the new one takes over the data that both need.
    virtual void make_renderer(const Resolved& resolved, const Plan& plan,
                               const Capabilities& capabilities) = 0;
    virtual FrameRenderer* renderer() const = 0;  // null before there is one
};

namespace {

class SliceDrawing : public Drawing {
  public:
    SliceDrawing(std::shared_ptr<const VolumeData> data, const PictureShare& share,
                 std::shared_ptr<TableCache> tables)
        : data_(std::move(data)), share_(share), tables_(std::move(tables)) {}

    const char* activity() const override { return "slicing"; }

    void measure_data(const Scene& scene) override {
        facts_ = lamina::measure_data(scene, data_->volume, data_->bricks);
        trials_ = {};
        shares_.reset();
    }

    // If the scene of a later view has its table already, no rays are needed to choose one. OpenGL
    // keeps the shares of the first view whose rays meet the box: a GPU would wait for others, and
    // a choice that changed with them would take other programs while the camera turns.
    bool measure_view(const Scene& scene, const Capabilities& capabilities,
                      const Plan* planned) override {
        lamina::measure_view(scene, facts_);
        const bool kept = planned != nullptr && !capabilities.cpu && facts_.ray_shares.box > 0;
        if (!kept) facts_.ray_shares = measure_ray_shares(scene, data_->volume, facts_);
        facts_.scalar_rays = {};
        if (planned == nullptr || !scene.slice.table.is_given())
            facts_.scalar_rays = measure_scalar_rays(scene, data_->volume, facts_);
        // Shares stay when the view changes, so that each renderer keeps its part of the data.
        if (share_.count > 1 && !shares_)
            shares_.emplace(scene, facts_, data_->bricks, !data_->volume.in_memory(), share_.count);
        return !kept || !facts_.scalar_rays.rays.empty();
    }

    void make_trials(const Scene& scene, const Capabilities& capabilities,
                     bool many_frames) override {
        // Trial pictures of a volume that stays in its files cost more reading than faster frames
        // save.
        many_frames = many_frames && data_->volume.in_memory();
        trials_ = try_samples(scene, data_->volume, data_->bricks, facts_, capabilities,
                              many_frames, *tables_);
    }

    Plan plan(const Scene& scene, const Capabilities& capabilities, const OmissionSwitch& omissions,
              bool for_people) const override {
        const auto plan_with = [&](const OmissionSwitch& allowed) {
            return for_people ? make_plan(scene, facts_, capabilities, allowed, trials_, tables_)
                              : plan_alone(scene, facts_, capabilities, allowed, trials_, tables_);
        };
        Plan plan = plan_with(omissions);
        if (!shares_) return plan;
        // Renderers look for several constant slabs at a time, counted from the first slab that
        // they draw. With shares the result would depend on who draws a slab.
        if (plan.slice.constant_regions && !plan.slice.integrates_cells()) {
            OmissionSwitch fewer = omissions;
            fewer.kept.insert("constant_regions");
            plan = plan_with(fewer);
        }
        plan.slice.share = shares_->boxes()[static_cast<std::size_t>(share_.number)];
        return plan;
    }

    Resolved resolve(Scene scene, const Plan& plan) const override {
        const SlicePlan& slice = plan.slice;
        SliceSettings& settings = scene.slice;
        settings.samples = slice.slabs;
        settings.classification = slice.classification;
        if (settings.filter.is_automatic())
            settings.filter =
                slice.sampling == VolumeSampling::hardware ? Filter::hardware : Filter::exact;
        if (settings.tree ? settings.tree->is_automatic()
                          : scene.target.is_automatic() && slice.target != Target::float32) {
            settings.tree.reset();
            if (const auto& tree = slice.tree)
                settings.tree =
                    TreeSettings{tree->factors, tree->nodes, tree->code, tree->alpha_bits};
        }
        if (settings.dither && settings.dither->period.is_automatic())
            settings.dither->period = dither_period_for(slice.slabs);
        const TableRequest& table = slice.table.request;
        if (slice.uses_table() && table.colored)
            settings.table = SliceTableSettings{table.scalar_nodes, table.length_layers,
                                                table.max_length / slice.unit};
        scene.target = slice.target;
        return Resolved(std::move(scene));
    }

    std::string explanation(const Plan& plan, const Capabilities& capabilities) const override {
        return explain(plan, facts_, capabilities);
    }

    Warnings warnings(const Resolved& resolved, const Plan& plan) override {
        Warnings all = data_warnings(*data_);
        for (std::string& warning : plan_warnings(resolved.scene(), plan.slice))
            all.push_back(std::move(warning));
        return all;
    }

    void make_renderer(const Resolved& resolved, const Plan& plan,
                       const Capabilities& capabilities) override {
        const Scene& scene = resolved.scene();
        const SliceReuse ready = renderer_ ? renderer_->reusable() : SliceReuse();
        renderer_ = make_slice_renderer(data_->volume, *scene.transfer_function, facts_, plan.slice,
                                        capabilities, scene.width, scene.height, ready);
    }

    FrameRenderer* renderer() const override { return renderer_.get(); }

    std::vector<IndexBox> shares() const override {
        return shares_ ? shares_->boxes() : std::vector<IndexBox>();
    }

    std::vector<int> front_to_back(const Scene& scene) const override {
        if (!shares_) return {0};
        return shares_->front_to_back(facts_.grid, View(*scene.camera, scene.width, scene.height));
    }

  private:
    std::shared_ptr<const VolumeData> data_;
    PictureShare share_;
    std::shared_ptr<TableCache> tables_;
    std::optional<VolumeShares> shares_;
    Facts facts_;
    SampleTrials trials_;
    std::unique_ptr<SliceRenderer> renderer_;
};

ProjectOrder order_of(OrderMethod method) {
    switch (method) {
        case OrderMethod::mpvo:
            return ProjectOrder::mpvo;
        case OrderMethod::exact:
            return ProjectOrder::exact;
        case OrderMethod::centroid:
            return ProjectOrder::centroid;
        case OrderMethod::none:
            return ProjectOrder::none;
    }
    unreachable_enum();
}

class ProjectDrawing : public Drawing {
  public:
    ProjectDrawing(std::shared_ptr<const SceneMesh> mesh, std::shared_ptr<TableCache> tables)
        : whole_(std::move(mesh)), mesh_(whole_), tables_(std::move(tables)) {}

    const char* activity() const override { return "projecting"; }

    void measure_data(const Scene& scene) override {
        clip_mesh(scene);
        facts_ = lamina::measure_data(scene, *mesh_);
        facts_.clipped_away = clipped_away_;
        if (!is_right_order(scene.project.order)) return;
        std::optional<MeshOverlap>& overlap = mesh_ == whole_ ? whole_overlap_ : overlap_;
        if (!overlap) overlap = measure_overlap(*mesh_, facts_.convexity, mesh_ != whole_);
        facts_.overlap = *overlap;
    }

    // Trial rays choose between a table whose nodes lie on the transfer function's points, and
    // integration that is right everywhere. If an earlier plan did not choose the table, there is
    // nothing left to choose, and later views measure no rays.
    bool measure_view(const Scene& scene, const Capabilities& /*capabilities*/,
                      const Plan* planned) override {
        lamina::measure_view(scene, *mesh_, facts_);
        const bool settled = planned != nullptr && !planned->project.nothing_visible &&
                             planned->project.source != SegmentSource::cut_table;
        if (settled) {
            facts_.trial_rays.clear();
            facts_.last_error = planned->project.trial_error;
        } else {
            measure_rays(scene, *mesh_, facts_);
        }
        return !settled;
    }

    Plan plan(const Scene& scene, const Capabilities& capabilities, const OmissionSwitch& omissions,
              bool /*for_people*/) const override {
        return make_plan(scene, facts_, capabilities, omissions, tables_);
    }

    // If the order is automatic and there is a tree, the order stays automatic: leaves of a tree
    // take tets from all over the mesh. So it does if tets overlap: each view decides anew whether
    // these can be ordered (orders_slowly()).
    Resolved resolve(Scene scene, const Plan& plan) const override {
        const ProjectPlan& project = plan.project;
        ProjectSettings& settings = scene.project;
        if (settings.order.is_automatic() && !settings.tree && facts_.overlap.none())
            settings.order = order_of(project.visibility);
        settings.geometry = project.geometry;
        if (project.source == SegmentSource::analytic) settings.coloring = Coloring::analytic;
        scene.target = project.target;
        return Resolved(std::move(scene));
    }

    std::string explanation(const Plan& plan, const Capabilities& capabilities) const override {
        return explain(plan, facts_, capabilities);
    }

    Warnings warnings(const Resolved& resolved, const Plan& plan) override {
        const Scene& scene = resolved.scene();
        if (!data_warnings_) data_warnings_ = data_warnings(scene, *whole_);
        Warnings all = *data_warnings_;
        const auto add = [&](Warnings more) {
            for (std::string& warning : more) all.push_back(std::move(warning));
        };
        add(plan_warnings(scene, plan.project, facts_.overlap));
        if (renderer_) add(frame_warnings(renderer_->order_report()));
        return all;
    }

    void add_to(FrameStatistics& statistics) const override {
        statistics.tets_drawn = renderer_->tets_drawn();
        if (!renderer_->sorts_tets()) return;
        const OrderReport& order = renderer_->order_report();
        statistics.counts["cycles"] = order.cycles;
        statistics.counts["cyclic_tets"] = order.cyclic_tets;
        statistics.counts["pairs_in_wrong_order"] = order.broken;
    }

    void make_renderer(const Resolved& resolved, const Plan& plan,
                       const Capabilities& capabilities) override {
        const Scene& scene = resolved.scene();
        const bool same_mesh = renderer_ && renderer_->kept_mesh() == mesh_.get();
        auto made = make_project_renderer(*mesh_, *scene.transfer_function, plan.project,
                                          capabilities, scene.width, scene.height,
                                          same_mesh ? renderer_->reusable() : ProjectReuse());
        made->keep(mesh_);
        renderer_ = std::move(made);
    }

    FrameRenderer* renderer() const override { return renderer_.get(); }

  private:
    void clip_mesh(const Scene& scene) {
        const bool lit = scene.lighting.has_value();
        if (scene.clip == clip_ && (lit_ || !lit)) return;
        clip_ = scene.clip;
        lit_ = lit;
        mesh_ = clipped_mesh(whole_, clip_, lit, name_of_mesh(scene));
        overlap_.reset();
        clipped_away_ = mesh_ == nullptr;
        if (clipped_away_) mesh_ = whole_;
    }

    std::shared_ptr<const SceneMesh> whole_;
    std::shared_ptr<const SceneMesh> mesh_;  // after clipping; whole_ if nothing is cut away
    std::shared_ptr<TableCache> tables_;
    Clip clip_;
    bool lit_ = false;
    bool clipped_away_ = false;
    std::optional<MeshOverlap> overlap_;        // of mesh_ if it is clipped, once it is measured
    std::optional<MeshOverlap> whole_overlap_;  // of whole_, which has pairs
    std::optional<Warnings> data_warnings_;     // of whole_, once they are asked for
    MeshFacts facts_;
    std::unique_ptr<ProjectRenderer> renderer_;
};

}  // namespace

SceneRenderer::SceneRenderer(Scene scene, std::shared_ptr<const VolumeData> volume,
                             const Capabilities& capabilities, OmissionSwitch omissions,
                             const PictureShare& share, std::shared_ptr<TableCache> tables)
    : asked_(std::move(scene)),
      capabilities_(capabilities),
      omissions_(std::move(omissions)),
      drawing_(std::make_unique<SliceDrawing>(std::move(volume), share, std::move(tables))) {
    assert(asked_.method == Method::slice);
    assert(share.count == 1 || capabilities_.cpu);
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

SceneRenderer::~SceneRenderer() = default;

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

// A pre-integration table belongs to one transfer function, so another table is chosen.
void SceneRenderer::set_transfer_function(const TransferFunction& transfer_function) {
    change([&](Scene& scene) { scene.transfer_function = transfer_function; });
    if (resolved_) resolved_->change([&](Scene& scene) { scene.slice.table = asked_.slice.table; });
    data_measured_ = renderer_fits_ = false;
    plan_.reset();
}

void SceneRenderer::set_clip(const Clip& clip) {
    change([&](Scene& scene) {
        scene.clip = clip;
        scene.project.order = asked_.project.order;  // the clip may remove tets that overlap
    });
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
        if (drawing_->measure_view(scene, capabilities_, plan_ ? &*plan_ : nullptr)) ++counts_.rays;
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
    if (ready != nullptr && renderer_fits_ && ready->try_switch_to(*plan_)) return;
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
