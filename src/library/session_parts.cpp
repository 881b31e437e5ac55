// SPDX-License-Identifier: Apache-2.0
#include "library/session_parts.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "choice/value_distribution.h"
#include "scene/camera.h"
#include "scene/lighting_check.h"

namespace lamina {
namespace {

int arena_threads(int threads) {
    if (threads < 0) fail("threads: found {}, expected 0 (all) or more", threads);
    return threads == 0 ? tbb::task_arena::automatic : threads;
}

}  // namespace

void check_view(const Camera& camera, int width, int height) {
    if (width < 1 || height < 1)
        fail("image: found {} x {} pixels, expected 1 x 1 or more", width, height);
    View(camera, width, height);
}

Session::Parts::Parts(Scene scene, const SessionOptions& options)
    : only_below(allowed_folder(options.only_below)), threads(arena_threads(options.threads)) {
    check_view(scene.camera.value_or({}), scene.width, scene.height);
    check_lighting(scene);
    pipeline = std::make_unique<Pipeline>(
        std::move(scene), SceneData(),
        PipelineOptions{.context = options.context, .many_frames = options.many_frames});
    pipeline->data().keep_volume();
}

Session::Parts::~Parts() {
    run([&] { pipeline.reset(); });
}

// Each picture repeats its warnings, so they are kept once.
void Session::Parts::keep_warning(const std::string& text) {
    const std::lock_guard lock(keeping);
    if (std::ranges::find(warnings, text) == warnings.end()) warnings.push_back(text);
}

ValueHistogram Session::Parts::histogram(int bins) {
    if (bins < 1) fail("histogram: found {} intervals, expected 1 or more", bins);
    const Scene& scene = pipeline->scene();
    const std::unique_ptr<Field> field = pipeline->field();
    SceneData& data = pipeline->data();
    const std::shared_ptr<const void> drawn =
        scene.draws_mesh() ? std::shared_ptr<const void>(data.mesh(scene)) : data.volume(scene);
    if (counted.lock() != drawn) counts = field->distribution();
    counted = drawn;
    return binned(counts, field->range(), field->whole_numbers(), bins);
}

}  // namespace lamina
