// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "lamina/image.h"
#include "lamina/scene.h"
#include "plan/capabilities.h"
#include "preintegration/preintegration_table.h"
#include "render/scene_data.h"
#include "selftest/pixel_bounds.h"

namespace lamina::selftest {

// Draws pictures as `lamina render` does. Virtual, so that tests can replace it by a faulty
// renderer, which the self-test must find.
class PictureMaker {
  public:
    explicit PictureMaker(const Capabilities& capabilities) : capabilities_(capabilities) {}
    virtual ~PictureMaker() = default;

    // `statistics`: set to those of the picture, if not null.
    virtual PreciseImage draw(const Scene& scene, const SceneData& data,
                              FrameStatistics* statistics = nullptr) const;

  private:
    const Capabilities& capabilities_;
    std::shared_ptr<TableCache> tables_ = std::make_shared<TableCache>();
};

// A way to draw a scene of the self-test: method, classification or colouring, target.
struct DrawingWay {
    std::string name;
    Method method = Method::slice;
    TraceOf trace_of = TraceOf::volume;
    std::function<void(Scene&)> set;  // sets further keys of the scene
    BlendRounding rounding;           // rounding of one blend

    bool draws_mesh() const {
        return method == Method::project || (method == Method::trace && trace_of == TraceOf::mesh);
    }
    Scene scene_of(const Scene& scene) const;
};

// Returns the reference tracer, for volumes and for meshes.
std::vector<DrawingWay> traces();
// Returns slicing and projection in float32, with all classifications, both orders and two
// colourings.
std::vector<DrawingWay> float_ways();
// Returns both methods in float16, fixed16, fixed8 and emulated targets.
std::vector<DrawingWay> coarse_ways();
// Returns slicing with trees over 64 slabs, in fixed8, fixed16 and float32.
std::vector<DrawingWay> tree_ways();
DrawingWay tree_way(const std::string& name, const std::vector<int>& factors, Target target);
// Returns the way of float_ways() with this name.
DrawingWay way_named(const std::string& name);
// Returns traces() and these ways of float_ways().
std::vector<DrawingWay> traces_and(const std::vector<std::string>& names);

}  // namespace lamina::selftest
