// SPDX-License-Identifier: Apache-2.0
#include "work/draw_worker.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <vector>

#include "lamina/image.h"
#include "lamina/volume.h"
#include "model/navigator.h"
#include "support/temporary_folder.h"

namespace lamina::view {
namespace {

const SessionOptions native{.context = ContextChoice::cpu};

Volume waves(int size) {
    auto samples = std::make_shared<std::vector<float>>();
    for (int i = 0; i < size * size * size; ++i)
        samples->push_back(.5f + .5f * std::sin(.11f * static_cast<float>(i)));
    Grid grid;
    grid.size = {size, size, size};
    grid.centering.fill(Centering::cell);
    const float* const first = samples->data();
    return {grid, SampleType::float32, {std::move(samples), first}};
}

// Worker with a scene that names a volume file and leaves everything else automatic.
class DrawWorkers : public testing::Test {
  protected:
    DrawWorkers() {
        save_volume(waves(12), file_);
        request_.scene = load_scene(file_);
        request_.scene.width = 70;
        request_.scene.height = 50;
        request_.revisions.data = 1;
    }

    void turn(double degrees) {
        request_.scene.camera = turned(*request_.scene.camera, degrees);
        ++request_.revisions.camera;
    }

    // Puts the worker's choices into the request, as the viewer's document does.
    void take_chosen() {
        request_.scene = *shown()->chosen;
        request_.scene.file = file_;
    }

    void ask() {
        request_.number = ++number_;
        worker_.request(request_);
    }

    std::shared_ptr<const Shown> shown() const { return worker_.shown(); }

    // Waits until `reached` is true. Fails after 100 s, longer than any machine needs.
    std::shared_ptr<const Shown> wait(const std::function<bool(const Shown&)>& reached) {
        std::unique_lock lock(mutex_);
        std::shared_ptr<const Shown> now;
        const bool in_time = changed_.wait_for(lock, std::chrono::seconds(100), [&] {
            now = worker_.shown();
            return reached(*now);
        });
        EXPECT_TRUE(in_time);
        return now;
    }
    std::shared_ptr<const Shown> wait_full() {
        return wait([&](const Shown& shown) {
            return shown.full && shown.full_revisions == request_.revisions &&
                   shown.kind != PictureKind::moving;
        });
    }
    std::shared_ptr<const Shown> wait_truth() {
        return wait([&](const Shown& shown) {
            return shown.truth && shown.full_revisions == request_.revisions &&
                   shown.activity.empty();
        });
    }

    TemporaryFolder folder_;
    std::filesystem::path file_ = folder_ / "waves.nrrd";
    DrawRequest request_;
    std::uint64_t number_ = 0;

  private:
    std::mutex mutex_;
    std::condition_variable changed_;

  protected:
    DrawWorker worker_{native, [this] {
                           const std::lock_guard lock(mutex_);
                           changed_.notify_all();
                       }};
};

TEST_F(DrawWorkers, TheFullPictureMatchesTheSession) {
    request_.trace = false;
    ask();
    const auto first = wait_full();
    Session session(request_.scene, native);
    EXPECT_EQ(first->full->rgba, session.draw().rgba);
    EXPECT_EQ(first->screen->rgb, screen_codes(session.draw(), request_.scene.background));
    EXPECT_EQ(first->loaded, 1u);
    EXPECT_EQ(first->plan.error, session.plan().error);
    EXPECT_TRUE(first->resolved->camera.is_given());
    take_chosen();
    turn(30);
    ask();
    const auto next = wait_full();
    EXPECT_NE(next->full->rgba, first->full->rgba);
    // The resolved scene, saved and loaded, draws the same picture.
    save_scene(*next->resolved, folder_ / "saved.json");
    EXPECT_EQ(Session(load_scene(folder_ / "saved.json"), native).draw().rgba, next->full->rgba);
}

TEST_F(DrawWorkers, WordsAreThoseOfASession) {
    request_.trace = false;
    ask();
    wait_full();
    take_chosen();
    const Words words{.view = "top", .light = "two", .opacity = "linear"};
    request_.words = std::make_shared<const Words>(words);
    ++request_.revisions.settings;
    ask();
    const auto adjusted = wait_full();
    Session session(request_.scene, native);
    session.adjust(words);
    EXPECT_EQ(adjusted->full->rgba, session.draw().rgba);
    EXPECT_TRUE(adjusted->chosen->lighting);
    EXPECT_EQ(adjusted->chosen->camera->eye, session.chosen_scene().camera->eye);
}

TEST_F(DrawWorkers, TheNewestRequestWins) {
    ask();
    wait_full();
    take_chosen();
    for (int i = 0; i < 50; ++i) {
        turn(3);
        request_.moving = i % 2 == 0;
        ask();
    }
    const auto last = wait_full();
    EXPECT_EQ(last->full->rgba, Session(request_.scene, native).draw().rgba);
}

TEST_F(DrawWorkers, MovingPicturesAreCoarseUnlessSwitchedOff) {
    request_.trace = false;
    ask();
    wait_full();
    take_chosen();
    request_.moving = true;
    const auto moved = [&] {
        turn(5);
        ask();
        return wait([&](const Shown& shown) {
            return shown.kind == PictureKind::moving && shown.revisions == request_.revisions;
        });
    };
    request_.coarse = false;
    const auto whole = moved();
    EXPECT_EQ(whole->screen->width, 70);
    request_.coarse = true;
    const auto coarse = moved();
    EXPECT_LE(coarse->screen->width, 70);
    EXPECT_NE(coarse->full_revisions, request_.revisions);
    request_.moving = false;
    ask();
    const auto rest = wait_full();
    EXPECT_EQ(rest->screen->width, 70);
    EXPECT_EQ(rest->full->rgba, Session(request_.scene, native).draw().rgba);
}

TEST_F(DrawWorkers, TheTracerReplacesThePictureAndMeasuresIt) {
    ask();
    const auto end = wait_truth();
    Session session(request_.scene, native);
    const Image picture = session.draw();
    const PreciseImage truth = session.trace();
    EXPECT_EQ(end->truth->rgba, truth.rgba);
    EXPECT_EQ(end->share_traced, 1);
    EXPECT_EQ(end->kind, PictureKind::traced);
    // Compares in float32, as `lamina compare` does with two EXR files.
    const ErrorNorms error = error_of(picture, to_float(truth));
    EXPECT_EQ(end->error.linf, error.linf);
    EXPECT_EQ(end->error.mean, error.mean);
    EXPECT_EQ(end->error.l2, error.l2);
    EXPECT_GT(end->error.linf, 0);
    EXPECT_EQ(end->screen->rgb, screen_codes(to_float(truth), request_.scene.background));
}

TEST_F(DrawWorkers, ScenesToTraceShowTheTruthAlone) {
    request_.scene.method = Method::trace;
    ask();
    const auto end = wait_truth();
    Session session(request_.scene, native);
    EXPECT_EQ(end->truth->rgba, session.trace().rgba);
    EXPECT_EQ(end->full->rgba, to_float(*end->truth).rgba);
    EXPECT_EQ(end->resolved->method, Method::trace);
}

TEST_F(DrawWorkers, FailuresAreReportedAndThePictureStays) {
    request_.trace = false;
    ask();
    const auto good = wait_full();
    const DrawRequest before = request_;
    request_.scene.volume = VolumeFile{folder_ / "gone.nrrd"};
    ++request_.revisions.data;
    ask();
    const auto bad = wait([&](const Shown& now) { return now.failed_request == number_; });
    EXPECT_NE(bad->failure.find("gone.nrrd"), std::string::npos) << bad->failure;
    EXPECT_EQ(bad->full, good->full);
    EXPECT_EQ(bad->loaded, 1u);
    request_ = before;
    ++request_.revisions.settings;
    ask();
    EXPECT_TRUE(wait_full()->failure.empty());
}

TEST_F(DrawWorkers, AWorkerCanEndWhileItLoadsDrawsOrTraces) {
    for (int steps = 0; steps < 3; ++steps) {
        request_.scene.width = 700;
        request_.scene.height = 500;
        DrawWorker other(native, [] {});
        other.request(request_);
        while (steps > 0 && other.shown()->loaded == 0) std::this_thread::yield();
        while (steps > 1 && !other.shown()->full) std::this_thread::yield();
    }
}

}  // namespace
}  // namespace lamina::view
