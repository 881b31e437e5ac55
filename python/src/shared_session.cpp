// SPDX-License-Identifier: Apache-2.0
#include "shared_session.h"

#include <atomic>
#include <utility>

namespace lamina::python {

std::shared_ptr<Image> SharedSession::free_picture() {
    if (!picture_ || picture_.use_count() > 1) return std::make_shared<Image>();
    // Whoever held it last has finished reading before it is written again.
    std::atomic_thread_fence(std::memory_order_acquire);
    return picture_;
}

Drawn SharedSession::draw(std::stop_token stop, const ProgressCallback& progress) {
    const std::lock_guard turn(turn_);
    const std::shared_ptr<Image> picture = free_picture();
    session_.draw(*picture, std::move(stop), progress);
    picture_ = picture;
    Drawn drawn;
    drawn.picture = picture;
    drawn.scene = session_.resolved_scene();
    if (drawn.scene.method != Method::trace) {
        drawn.plan = session_.plan();
        drawn.explanation = session_.explanation();
    }
    drawn.statistics = session_.statistics();
    drawn.warnings = session_.take_warnings();
    return drawn;
}

Drawn SharedSession::trace(std::stop_token stop, const ProgressCallback& progress) {
    const std::lock_guard turn(turn_);
    Drawn drawn;
    drawn.truth = std::make_shared<PreciseImage>(session_.trace(std::move(stop), progress));
    drawn.scene = session_.chosen_scene();
    drawn.scene.trace_of = drawn.scene.draws_mesh() ? TraceOf::mesh : TraceOf::volume;
    drawn.scene.method = Method::trace;
    drawn.statistics = session_.trace_statistics();
    drawn.warnings = session_.take_warnings();
    return drawn;
}

Scene SharedSession::resolved_scene() {
    const std::lock_guard turn(turn_);
    return session_.resolved_scene();
}

std::string SharedSession::explanation() {
    const std::lock_guard turn(turn_);
    return session_.explanation();
}

}  // namespace lamina::python
