// SPDX-License-Identifier: Apache-2.0
#include "work/session_steps.h"

#include <exception>
#include <utility>

#include "lamina/error.h"
#include "lamina/picture_file.h"

namespace lamina::view {

SessionSteps::SessionSteps(const SessionOptions& options, std::function<void(const Shown&)> publish)
    : options_(options), publish_(std::move(publish)) {}

SessionSteps::~SessionSteps() = default;

void SessionSteps::begin(DrawRequest request) {
    request_ = std::move(request);
    next_ = !session_ || applied_.data != request_.revisions.data ? Next::load : Next::full;
}

void SessionSteps::step(const std::stop_token& stop) {
    try {
        switch (next_) {
            case Next::nothing:
                return;
            case Next::load:
                return load(stop);
            case Next::full:
                return draw_full(stop);
        }
    } catch (const Interrupted&) {
    } catch (const std::exception& error) {
        fail(error.what());
    }
}

void SessionSteps::fail(const std::string& message) {
    next_ = Next::nothing;
    shown_.activity.clear();
    shown_.failure = message;
    shown_.failed = request_.revisions;
    publish_(shown_);
}

ProgressCallback SessionSteps::progress() {
    return [this](const std::string& activity, double share) {
        shown_.activity = activity;
        shown_.share_done = share;
        publish_(shown_);
    };
}

void SessionSteps::load(const std::stop_token& stop) {
    shown_.activity = "loading";
    shown_.share_done = 0;
    shown_.failure.clear();
    publish_(shown_);
    SessionOptions options = options_;
    options.stop = stop;
    auto session = std::make_unique<Session>(request_.scene, options);
    session_ = std::move(session);
    applied_ = request_.revisions;
    shown_.loaded = applied_.data;
    shown_.histogram = std::make_shared<const ValueHistogram>(session_->histogram(512));
    publish_chosen();
    next_ = Next::full;
}

void SessionSteps::publish_chosen() {
    shown_.chosen = std::make_shared<const Scene>(session_->chosen_scene());
    shown_.chosen_of = applied_;
    publish_(shown_);
}

// Hands the session what has changed, by the call that costs least.
void SessionSteps::apply() {
    const Scene& scene = request_.scene;
    const Revisions& asked = request_.revisions;
    if (asked == applied_) return;
    const Revisions before = std::exchange(applied_, {.data = asked.data});
    if (asked.settings != before.settings) {
        session_->set_scene(scene);
    } else {
        if (asked.size != before.size) session_->set_size(scene.width, scene.height);
        if (asked.camera != before.camera) session_->set_camera(scene.camera);
        if (asked.clip != before.clip) session_->set_clip(scene.clip);
        if (asked.transfer_function != before.transfer_function)
            session_->set_transfer_function(scene.transfer_function);
    }
    applied_ = asked;
    publish_chosen();
}

void SessionSteps::draw_full(const std::stop_token& stop) {
    apply();
    auto picture = std::make_shared<Image>();
    session_->draw(*picture, stop, progress());
    const Scene& resolved = session_->resolved_scene();
    auto screen = std::make_shared<ScreenPicture>();
    screen->width = picture->width;
    screen->height = picture->height;
    screen->rgb = screen_codes(*picture, resolved.background, resolved.color_space);
    shown_.kind = PictureKind::full;
    shown_.revisions = shown_.full_revisions = request_.revisions;
    shown_.screen = std::move(screen);
    shown_.full = std::move(picture);
    shown_.resolved = std::make_shared<const Scene>(resolved);
    shown_.statistics = session_->statistics();
    const bool planned = resolved.method != Method::trace;
    shown_.plan = planned ? session_->plan() : PlanSummary();
    shown_.explanation = planned ? session_->explanation() : std::string();
    shown_.warnings = session_->take_warnings();
    shown_.failure.clear();
    shown_.activity.clear();
    next_ = Next::nothing;
    publish_(shown_);
}

}  // namespace lamina::view
