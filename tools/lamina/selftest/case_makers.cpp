// SPDX-License-Identifier: Apache-2.0
#include "selftest/case_makers.h"

#include <fmt/format.h>

#include <glm/geometric.hpp>
#include <optional>
#include <utility>

#include "base/error.h"
#include "selftest/layered_box.h"
#include "selftest/picture_bounds.h"

namespace lamina::selftest {
namespace {

constexpr const char* from_layers =
    "Exact: every ray layer by layer in closed form. Bound: the ray cut as this way to draw cuts "
    "it, every optical depth and colour an interval of what coordinates, scalars and lengths off "
    "by 16 roundings of a float32 (double for traces), and codes, can make of it, composited as "
    "intervals.";
constexpr const char* from_tets =
    "Exact: one colour, and optical depths of all tets along the ray. Bound: every face off by "
    "9e-6 of its tet's longest edge (1e-9 for traces), and roundings of every blend.";
constexpr const char* from_both = "The pictures may differ by what both bounds allow together.";

std::shared_ptr<const SceneMesh> drawn_mesh(MeshData data) {
    MeshScalar scalar = std::move(data.point_scalars.at(0));
    data.point_scalars.clear();
    return std::make_shared<const SceneMesh>(
        SceneMesh{TetMesh(std::move(data), "self-test"), std::move(scalar), false, {}});
}

CaseOutcome outcome_of(const Fit& fit) {
    return {fit.fits ? Verdict::passed : Verdict::failed, fit.error, fit.bound, fit.largest_error,
            fit.where};
}

struct Drawn {
    PreciseImage picture;
    PictureBounds bounds;
};

Drawn draw(const PictureMaker& maker, const SelftestScene& subject, const DrawingWay& way) {
    const Scene scene = way.scene_of(subject.scene);
    if (!way.draws_mesh())
        return {maker.draw(scene, SceneData(subject.box.volume())),
                layered_picture(subject, way, nullptr)};
    const auto mesh = drawn_mesh(subject.mesh(subject.box));
    return {maker.draw(scene, SceneData(mesh)), layered_picture(subject, way, &*mesh)};
}

}  // namespace

std::vector<SelftestCase> cases_of(const std::string& group,
                                   const std::vector<SelftestScene>& scenes,
                                   const std::vector<DrawingWay>& ways) {
    std::vector<SelftestCase> cases;
    for (const SelftestScene& scene : scenes) {
        for (const DrawingWay& way : ways) {
            if (way.draws_mesh() && !scene.mesh) continue;
            cases.push_back({group, scene.name, way.name, scene.about + ". " + from_layers,
                             [scene, way](const PictureMaker& maker) {
                                 const Drawn drawn = draw(maker, scene, way);
                                 return outcome_of(fit_of(drawn.picture, drawn.bounds));
                             }});
        }
    }
    return cases;
}

SelftestCase case_of(const std::string& group, const MeshScene& subject, const DrawingWay& way) {
    return {group, subject.name, way.name, subject.about + ". " + from_tets,
            [subject, way](const PictureMaker& maker) {
                const auto mesh = drawn_mesh(subject.mesh());
                FrameStatistics statistics;
                const Scene scene = way.scene_of(subject.scene);
                const PreciseImage picture = maker.draw(scene, SceneData(mesh), &statistics);
                CaseOutcome outcome =
                    outcome_of(fit_of(picture, one_color_picture(subject.scene, way, *mesh)));
                // Pictures whose tets need no order have no count.
                const auto cycles = statistics.counts.find("cycles");
                if (subject.cyclic && cycles != statistics.counts.end() && cycles->second == 0) {
                    outcome.verdict = Verdict::failed;
                    outcome.note = "no cycle is reported";
                }
                return outcome;
            }};
}

SelftestCase same_picture_case(const std::string& group, const std::string& name,
                               const SelftestScene& a, const SelftestScene& b,
                               const DrawingWay& way) {
    return {group, name, way.name, b.about + ". " + from_both,
            [a, b, way](const PictureMaker& maker) {
                const Drawn one = draw(maker, a, way);
                const Drawn other = draw(maker, b, way);
                const CaseOutcome alone = outcome_of(fit_of(other.picture, other.bounds));
                if (alone.verdict != Verdict::passed) return alone;
                return outcome_of(fit_of(one.picture, one.bounds, other.picture, other.bounds));
            }};
}

SelftestCase refusal_case(const std::string& group, const SelftestScene& scene,
                          const DrawingWay& way, const std::string& reason) {
    return {
        group, scene.name, way.name, scene.about + ". Drawing must end with an error.",
        [scene, way, reason](const PictureMaker& maker) {
            try {
                draw(maker, scene, way);
            } catch (const Error& error) {
                const std::string message = error.what();
                const bool is_said = message.find(reason) != std::string::npos;
                return CaseOutcome{is_said ? Verdict::passed : Verdict::failed, 0, 0, 0, message};
            }
            return CaseOutcome{Verdict::failed, 0, 0, 0, "was drawn"};
        }};
}

TransferFunction optics_of(const std::vector<TransferKnot>& knots) {
    return TransferFunction::linear(knots);
}

Camera camera_at(const LayeredBox& box, double distance, double fov_y) {
    Camera camera;
    camera.center = box.world({.5, .5, .5});
    const glm::dvec3 diagonal = box.world({1, 1, 1}) - box.world({0, 0, 0});
    const glm::dvec3 direction = glm::normalize(glm::dvec3(.53, .41, .74));
    camera.eye = camera.center + distance * glm::length(diagonal) * direction;
    camera.up = {.1, 1, .05};
    camera.fov_y = fov_y;
    return camera;
}

SelftestScene plain_scene(const std::string& name, const std::string& about) {
    SelftestScene subject;
    subject.name = name;
    subject.about = about;
    subject.scene.transfer_function = optics_of({{0, {{1, 1, 1}, .5}}, {1, {{1, 1, 1}, 2}}});
    subject.scene.camera = camera_at(subject.box, 1.5, 40);
    subject.scene.width = 24;
    subject.scene.height = 18;
    subject.scene.slice.samples = 64;
    subject.mesh = [](const LayeredBox& box) { return kuhn_tets(box, 1); };
    return subject;
}

}  // namespace lamina::selftest
