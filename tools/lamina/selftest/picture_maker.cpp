// SPDX-License-Identifier: Apache-2.0
#include "selftest/picture_maker.h"

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

}  // namespace lamina::selftest
