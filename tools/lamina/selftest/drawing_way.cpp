// SPDX-License-Identifier: Apache-2.0
#include "selftest/drawing_way.h"

#include <algorithm>
#include <cassert>

#include "render/pipeline.h"

namespace lamina::selftest {

PreciseImage PictureMaker::draw(const Scene& scene, const SceneData& data,
                                FrameStatistics* statistics) const {
    if (scene.method == Method::trace) {
        SceneData shared = data;
        return trace_picture(scene, shared).image;
    }
    Pipeline pipeline(scene, data, {.capabilities = capabilities_, .tables = tables_});
    pipeline.draw_frame();
    if (statistics != nullptr) *statistics = pipeline.statistics();
    Image picture;
    pipeline.read(picture);
    return to_double(picture);
}

namespace {

// Rounding of float targets. In float32 a blend has about four roundings. In float16 fragment and
// result are stored with 11 bits, and subnormal numbers in steps of 2^-24.
constexpr BlendRounding of_float32{0, 0, 0, 0x1p-22};
constexpr BlendRounding of_float16{0, 0x1p-24, 0x1p-24, 0x1p-10};

// Returns the rounding of n-bit codes: opacity is truncated or rounded at random, by at most one
// code. Colour and result are off by at most one code each, however the driver rounds before and
// after weighting (docs/numerics.md, section 2).
constexpr BlendRounding of_codes(int bits) {
    const double code = 1.0 / ((1 << bits) - 1);
    return {code, code, code, 0};
}

DrawingWay slice(const std::string& name, const std::function<void(Scene&)>& set,
                 const BlendRounding& rounding = of_float32) {
    const auto post_unless_set = [set](Scene& scene) {
        scene.slice.classification = Classification::post;
        set(scene);
    };
    return {"slice " + name, Method::slice, TraceOf::volume, post_unless_set, rounding};
}

DrawingWay project(const std::string& name, const std::function<void(Scene&)>& set,
                   const BlendRounding& rounding = of_float32) {
    return {"project " + name, Method::project, TraceOf::mesh, set, rounding};
}

}  // namespace

Scene DrawingWay::scene_of(const Scene& scene) const {
    Scene drawn = scene;
    drawn.method = method;
    drawn.trace_of = trace_of;
    if (set) set(drawn);
    return drawn;
}

std::vector<DrawingWay> traces() {
    const auto tolerance = [](Scene& scene) { scene.trace_tolerance = 1e-12; };
    return {{"trace volume", Method::trace, TraceOf::volume, tolerance, {}},
            {"trace mesh", Method::trace, TraceOf::mesh, tolerance, {}}};
}

std::vector<DrawingWay> float_ways() {
    return {
        slice("post float32", [](Scene&) {}),
        slice("post float32 front_to_back",
              [](Scene& scene) { scene.slice.order = Order::front_to_back; }),
        slice("preintegrated float32",
              [](Scene& scene) { scene.slice.classification = Classification::preintegrated; }),
        slice("exact float32",
              [](Scene& scene) { scene.slice.classification = Classification::exact; }),
        project("float32", [](Scene&) {}),
        project("analytic float32",
                [](Scene& scene) { scene.project.coloring = Coloring::analytic; }),
    };
}

std::vector<DrawingWay> coarse_ways() {
    const auto target = [](Target which) {
        return [which](Scene& scene) { scene.target = which; };
    };
    const auto codes = [](int bits, AlphaRounding alpha, OverRounding over) {
        return [=](Scene& scene) {
            scene.target = Target::emulated;
            scene.emulate = {bits, alpha, over, 1};
        };
    };
    struct Coarse {
        std::string name;
        std::function<void(Scene&)> set;
        BlendRounding rounding;
    };
    const Coarse all[] = {{"float16", target(Target::float16), of_float16},
                          {"fixed16", target(Target::fixed16), of_codes(16)},
                          {"fixed8", target(Target::fixed8), of_codes(8)},
                          {"emulated 8 truncate separate",
                           codes(8, AlphaRounding::truncate, OverRounding::separate), of_codes(8)},
                          {"emulated 12 nearest fused",
                           codes(12, AlphaRounding::nearest, OverRounding::fused), of_codes(12)},
                          {"emulated 8 stochastic fused",
                           codes(8, AlphaRounding::stochastic, OverRounding::fused), of_codes(8)}};
    std::vector<DrawingWay> ways;
    for (const Coarse& each : all)
        ways.push_back(slice("post " + each.name, each.set, each.rounding));
    for (const Coarse& each : all) ways.push_back(project(each.name, each.set, each.rounding));
    return ways;
}

DrawingWay tree_way(const std::string& name, const std::vector<int>& factors, Target target) {
    // The slabs of a leaf are composited in float32, so no blend rounds codes. The codes of inner
    // images add tree_error() (picture_bounds.cpp) to the whole picture.
    return slice("tree " + name + " " + name_of(target), [factors, target](Scene& scene) {
        scene.target = target;
        scene.slice.tree = TreeSettings{factors, NodeArithmetic::shader, NodeCode::minimax, 8};
    });
}

std::vector<DrawingWay> tree_ways() {
    return {tree_way("8x8", {8, 8}, Target::fixed8), tree_way("8x8", {8, 8}, Target::fixed16),
            tree_way("4x4x4", {4, 4, 4}, Target::fixed8), tree_way("8x8", {8, 8}, Target::float32)};
}

DrawingWay way_named(const std::string& name) {
    const std::vector<DrawingWay> ways = float_ways();
    const auto found = std::ranges::find(ways, name, &DrawingWay::name);
    assert(found != ways.end());
    return *found;
}

std::vector<DrawingWay> traces_and(const std::vector<std::string>& names) {
    std::vector<DrawingWay> ways = traces();
    for (const std::string& name : names) ways.push_back(way_named(name));
    return ways;
}

}  // namespace lamina::selftest
