// SPDX-License-Identifier: Apache-2.0
#include "model/precision_in_sight.h"

#include <utility>

namespace lamina::view {

// Returns true if the full picture shows the current document.
bool PrecisionInSight::is_of(const Document& document, const Shown& shown) {
    return shown.full && shown.resolved && shown.failure.empty() &&
           shown.full_revisions == document.revisions();
}

void PrecisionInSight::follow(const Document& document, const Shown& shown) {
    if (shown.frame != last_frame_) {
        last_frame_ = shown.frame;
        frames.add(shown.frame_statistics, shown.kind == PictureKind::moving);
    }
    comparison.follow(shown);
    if (is_of(document, shown) && shown.full_revisions != recorded_) {
        recorded_ = shown.full_revisions;
        attempts.add(document.scene(), *shown.resolved, shown.plan.error.known(), shown.statistics);
    }
    if (shown.full_revisions == recorded_) attempts.measured(shown.share_traced, shown.error);
}

void PrecisionInSight::pin(const Document& document, const Shown& shown) {
    if (!is_of(document, shown)) return;
    comparison.pin(document.scene(), shown);
    comparison.follow(shown);
}

void PrecisionInSight::go_on_with(Document& document, Scene scene, bool keep_view) {
    const Scene& now = document.scene();
    if (keep_view) scene.camera = now.camera;
    if (keep_view || document.size_follows_window) {
        scene.width = now.width;
        scene.height = now.height;
    }
    document.replace(std::move(scene), "going back");
    document.end_step();
}

}  // namespace lamina::view
