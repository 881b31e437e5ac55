// SPDX-License-Identifier: Apache-2.0
#include "work/session_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "lamina/error.h"
#include "lamina/image.h"
#include "lamina/scene.h"
#include "model/comparison.h"

namespace lamina::view {

// A full picture that the tracer replaces tile by tile, with its error in the traced pixels.
class TracedPicture {
  public:
    // `full`: picture whose error is measured, or null. `screen`: pixels shown until traced.
    TracedPicture(std::shared_ptr<const Image> full, std::shared_ptr<const ScreenPicture> screen,
                  const Scene& scene);

    void add(const PictureTile& tile, const PreciseImage& truth);

    double share() const;      // share of the pixels that are traced, 0 to 1
    ErrorNorms error() const;  // error in these pixels, as error_of() computes it in float32
    const ScreenPicture& screen() const { return screen_; }
    // Returns the full picture minus the traced pixels; empty if there is no full picture.
    const PictureDifference& missed() const { return missed_; }

  private:
    void measure(const PictureTile& tile, const Image& traced, int row);

    std::shared_ptr<const Image> full_;
    ScreenPicture screen_;
    PictureDifference missed_;
    glm::dvec3 background_;
    ImageColorSpace space_;
    std::int64_t pixels_ = 0;
    double largest_ = 0, sum_ = 0, squares_ = 0;  // of errors in 1/255: max |e|, sums of e, e^2
};

TracedPicture::TracedPicture(std::shared_ptr<const Image> full,
                             std::shared_ptr<const ScreenPicture> screen, const Scene& scene)
    : full_(std::move(full)), background_(scene.background), space_(scene.color_space) {
    if (full_)
        missed_ = {
            full_->width, full_->height,
            std::vector<float>(full_->rgba.size() / 4, std::numeric_limits<float>::quiet_NaN())};
    if (screen && screen->width == scene.width && screen->height == scene.height) {
        screen_ = *screen;
        return;
    }
    screen_.width = scene.width;
    screen_.height = scene.height;
    screen_.rgb.resize(3 * static_cast<std::size_t>(scene.width) *
                       static_cast<std::size_t>(scene.height));
}

namespace {

std::shared_ptr<const Image> part_of(const Image& picture, const PictureTile& tile) {
    auto part = std::make_shared<Image>(tile.width, tile.height);
    for (int row = 0; row < tile.height; ++row)
        std::copy_n(picture.pixel(tile.column, tile.row + row), 4 * tile.width,
                    part->pixel(0, row));
    return part;
}

}  // namespace

void TracedPicture::add(const PictureTile& tile, const PreciseImage& truth) {
    Image traced(tile.width, tile.height);
    traced.space = space_;
    if (full_ && full_->annotations) traced.annotations = part_of(*full_->annotations, tile);
    for (int row = 0; row < tile.height; ++row) {
        const double* const from = truth.pixel(tile.column, tile.row + row);
        std::transform(from, from + 4 * tile.width, traced.pixel(0, row),
                       [](double number) { return static_cast<float>(number); });
        if (full_) measure(tile, traced, row);
    }
    const std::vector<std::uint8_t> codes = screen_codes(traced, background_);
    const auto line = static_cast<std::ptrdiff_t>(3 * tile.width);
    for (std::ptrdiff_t row = 0; row < tile.height; ++row) {
        const std::ptrdiff_t to =
            3 * (static_cast<std::ptrdiff_t>(tile.row + row) * screen_.width + tile.column);
        std::copy_n(codes.begin() + row * line, line, screen_.rgb.begin() + to);
    }
    pixels_ += static_cast<std::int64_t>(tile.width) * tile.height;
}

void TracedPicture::measure(const PictureTile& tile, const Image& traced, int row) {
    const float* const full = full_->pixel(tile.column, tile.row + row);
    const float* const truth = traced.pixel(0, row);
    float* const missed =
        &missed_
             .e[static_cast<std::size_t>(tile.row + row) * static_cast<std::size_t>(missed_.width) +
                static_cast<std::size_t>(tile.column)];
    for (int i = 0; i < traced.width; ++i)
        missed[i] = largest_difference(full + 4 * i, truth + 4 * i);
    for (int i = 0; i < 4 * traced.width; ++i) {
        const double e = 255 * (static_cast<double>(full[i]) - static_cast<double>(truth[i]));
        largest_ = std::max(largest_, std::abs(e));
        sum_ += e;
        squares_ += e * e;
    }
}

double TracedPicture::share() const {
    return static_cast<double>(pixels_) / (static_cast<double>(screen_.width) * screen_.height);
}

ErrorNorms TracedPicture::error() const {
    if (pixels_ == 0) return {};
    const double numbers = 4 * static_cast<double>(pixels_);
    return {largest_, sum_ / numbers, std::sqrt(squares_ / numbers)};
}

namespace {

nlohmann::json flat(const Scene& scene) {
    return nlohmann::json::parse(scene_text(scene)).flatten();
}

std::string dotted(std::string pointer) {
    std::ranges::replace(pointer, '/', '.');
    return pointer.substr(1);
}

using Clock = std::chrono::steady_clock;

// Target time for drawing a coarse picture: 50 ms from input to screen, minus 15 for the window.
constexpr double moving_target_ms = 35;
constexpr double tile_publish_ms = 100;  // least time between publishing traced tiles
constexpr int histogram_bins = 512;

double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

std::shared_ptr<const ScreenPicture> screen_of(const Image& picture, const Scene& scene) {
    auto screen = std::make_shared<ScreenPicture>();
    screen->width = picture.width;
    screen->height = picture.height;
    screen->rgb = screen_codes(picture, scene.background);
    return screen;
}

}  // namespace

std::vector<std::string> automatic_differences(const Scene& before, const Scene& after,
                                               const Scene& asked) {
    const nlohmann::json from = flat(before), to = flat(after), open = flat(asked);
    std::vector<std::string> differences;
    for (const auto& [key, value] : to.items()) {
        if (open.value(key, nlohmann::json("auto")) != "auto") continue;
        const nlohmann::json was = from.value(key, nlohmann::json());
        if (was != value)
            differences.push_back(
                fmt::format("{}: {} -> {}", dotted(key), was.dump(), value.dump()));
    }
    return differences;
}

SessionSteps::SessionSteps(const SessionOptions& options, std::function<void(const Shown&)> publish)
    : options_(options), publish_(std::move(publish)), coarse_size_(moving_target_ms) {}

SessionSteps::~SessionSteps() = default;

void SessionSteps::begin(DrawRequest request) {
    request_ = std::move(request);
    const bool loaded = session_ && applied_.data == request_.revisions.data;
    next_ = loaded ? step_after_data() : Next::load;
    forget_tiles();
}

// If tracing was stopped, shows the full picture again.
void SessionSteps::forget_tiles() {
    if (shown_.activity == "tracing") shown_.activity.clear();
    if (shown_.kind != PictureKind::traced || shown_.truth) return;
    shown_.kind = shown_.full ? PictureKind::full : PictureKind::none;
    shown_.screen = shown_.full_screen;
    shown_.share_traced = 0;
    shown_.error = {};
    shown_.missed.reset();
    if (next_ == Next::nothing) publish_(shown_);
}

SessionSteps::Next SessionSteps::step_after_data() const {
    if (request_.moving) return Next::moving;
    const bool drawn = shown_.full && shown_.full_revisions == request_.revisions &&
                       shown_.revisions == request_.revisions && shown_.failure.empty();
    return drawn ? step_after_full() : Next::full;
}

SessionSteps::Next SessionSteps::step_after_full() const {
    const std::shared_ptr<const PinnedPicture> a = pinned();
    if (a && shown_.resolved && !same_view(a->scene, *shown_.resolved) &&
        pinned_failed_ != request_.revisions)
        return Next::pinned;
    return request_.trace && !shown_.truth ? Next::trace : Next::nothing;
}

// Returns the pinned picture as last drawn.
std::shared_ptr<const PinnedPicture> SessionSteps::pinned() const {
    const auto& asked = request_.pinned;
    if (!asked || asked->data != request_.revisions.data) return {};
    return shown_.pinned && shown_.pinned->number == asked->number ? shown_.pinned : asked;
}

void SessionSteps::step(const std::stop_token& stop) {
    try {
        switch (next_) {
            case Next::nothing:
                return;
            case Next::load:
                return load(stop);
            case Next::moving:
                return draw_moving(stop);
            case Next::full:
                return draw_full(stop);
            case Next::pinned:
                return draw_pinned(stop);
            case Next::trace:
                return trace(stop);
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
    shown_.failed_request = request_.number;
    publish_(shown_);
}

ProgressCallback SessionSteps::progress() {
    return [this](const std::string& activity, double share) {
        shown_.activity = activity;
        shown_.share_done = share;
        publish_(shown_);
    };
}

// Loads the data. The old session is kept until the new one exists: its picture stays if that
// fails.
void SessionSteps::load(const std::stop_token& stop) {
    shown_.activity = "loading";
    shown_.share_done = 0;
    publish_(shown_);
    SessionOptions options = options_;
    options.stop = stop;
    auto session = std::make_unique<Session>(request_.scene, options);
    session_ = std::move(session);
    applied_ = chosen_ = request_.revisions;
    full_size_ = true;
    holds_pinned_ = false;
    coarse_size_ = CoarseSize(moving_target_ms);
    shown_.loaded = applied_.data;
    shown_.bounds = session_->bounds();
    shown_.histogram = std::make_shared<const ValueHistogram>(session_->histogram(histogram_bins));
    shown_.chosen = std::make_shared<const Scene>(session_->chosen_scene());
    shown_.chosen_of = applied_;
    forget_pictures();
    next_ = step_after_data();
    publish_(shown_);
}

// Forgets the pictures; the screen keeps the old one until there is another.
void SessionSteps::forget_pictures() {
    shown_.kind = PictureKind::none;
    shown_.probe.reset();
    shown_.full.reset();
    shown_.full_screen.reset();
    shown_.resolved.reset();
    shown_.truth.reset();
    shown_.missed.reset();
    shown_.share_traced = 0;
    shown_.error = {};
}

// Passes changes to the session by the cheapest calls. Nothing automatic is chosen again.
void SessionSteps::apply_change() {
    const Scene& scene = request_.scene;
    const Revisions& asked = request_.revisions;
    if (asked == applied_ && !holds_pinned_) return;
    const Revisions before = std::exchange(applied_, {.data = asked.data});
    const bool open = scene.camera.is_automatic() || scene.transfer_function.is_automatic();
    if (holds_pinned_ || open || asked.settings != before.settings) {
        session_->set_scene(scene);
        holds_pinned_ = false;
    } else {
        if (asked.camera != before.camera) session_->set_camera(*scene.camera);
        if (asked.clip != before.clip) session_->set_clip(scene.clip);
        if (asked.transfer_function != before.transfer_function)
            session_->set_transfer_function(*scene.transfer_function);
    }
    applied_ = asked;
}

// Sets a coarse size. Returns the divisor of the picture's sides.
double SessionSteps::set_size_for_moving() {
    const Scene& scene = request_.scene;
    const double divisor = request_.coarse ? coarse_size_.divisor() : 1;
    const int width = std::max(1, static_cast<int>(std::lround(scene.width / divisor)));
    const int height = std::max(1, static_cast<int>(std::lround(scene.height / divisor)));
    if (width == session_->scene().width && height == session_->scene().height) return divisor;
    session_->set_size(width, height);
    full_size_ = false;
    return divisor;
}

void SessionSteps::draw_moving(const std::stop_token& stop) {
    const auto start = Clock::now();
    apply_change();
    const double divisor = set_size_for_moving();
    const Image& picture = session_->draw(stop);
    show(PictureKind::moving, picture);
    shown_.moving_ms = ms_since(start);
    coarse_size_.add(divisor, shown_.moving_ms);
    next_ = Next::nothing;
    publish_(shown_);
}

// Chooses automatic keys again if anything has changed.
void SessionSteps::choose() {
    if (chosen_ == request_.revisions && full_size_ && !holds_pinned_) return;
    applied_ = {.data = request_.revisions.data};
    session_->set_scene(request_.scene);
    if (request_.words) session_->adjust(*request_.words);
    holds_pinned_ = false;
    applied_ = chosen_ = request_.revisions;
    full_size_ = true;
    shown_.chosen = std::make_shared<const Scene>(session_->chosen_scene());
    shown_.chosen_of = applied_;
}

void SessionSteps::draw_full(const std::stop_token& stop) {
    choose();
    if (session_->scene().method == Method::trace) {
        shown_.full.reset();
        shown_.truth.reset();
        shown_.full_screen.reset();
        shown_.warnings.clear();
        return trace(stop);
    }
    auto picture = std::make_shared<Image>();
    session_->draw(*picture, stop, progress());
    // Another method may draw other data.
    shown_.histogram = std::make_shared<const ValueHistogram>(session_->histogram(histogram_bins));
    shown_.full = picture;
    shown_.full_revisions = request_.revisions;
    shown_.bounds = session_->bounds();
    tell_plan();
    show(PictureKind::full, *picture);
    shown_.full_screen = shown_.screen;
    coarse_size_.add(1, shown_.statistics.stages_ms["draw"]);
    shown_.activity.clear();
    shown_.share_traced = 0;
    shown_.error = {};
    shown_.missed.reset();
    shown_.truth.reset();
    next_ = step_after_full();
    publish_(shown_);
}

// Draws A with the session, which otherwise has the scene of B and gets it back with the next step
// that needs it.
void SessionSteps::draw_pinned(const std::stop_token& stop) {
    auto drawn = std::make_shared<PinnedPicture>(*pinned());
    drawn->scene.camera = shown_.resolved->camera;
    drawn->scene.width = shown_.resolved->width;
    drawn->scene.height = shown_.resolved->height;
    holds_pinned_ = true;
    try {
        session_->set_scene(drawn->scene);
        auto picture = std::make_shared<Image>();
        session_->draw(*picture, stop, progress());
        drawn->screen = screen_of(*picture, session_->scene());
        drawn->picture = std::move(picture);
        drawn->resolved = session_->resolved_scene();
        drawn->statistics = session_->statistics();
        drawn->expected =
            drawn->scene.method == Method::trace ? std::nullopt : session_->plan().error.known();
        session_->take_warnings();
        shown_.pinned = std::move(drawn);
    } catch (const Error& error) {
        pinned_failed_ = request_.revisions;
        shown_.warnings.push_back(std::string("A cannot be drawn in this view: ") + error.what());
    }
    shown_.activity.clear();
    next_ = step_after_full();
    publish_(shown_);
}

void SessionSteps::tell_plan() {
    const bool planned = session_->scene().method != Method::trace;
    auto resolved = std::make_shared<const Scene>(session_->resolved_scene());
    shown_.chosen_again.clear();
    if (shown_.resolved)
        shown_.chosen_again = automatic_differences(*shown_.resolved, *resolved, session_->scene());
    shown_.resolved = std::move(resolved);
    shown_.statistics = planned ? session_->statistics() : session_->trace_statistics();
    shown_.plan = planned ? session_->plan() : PlanSummary();
    shown_.explanation = planned ? session_->explanation() : std::string();
}

void SessionSteps::show(PictureKind kind, const Image& picture) {
    shown_.kind = kind;
    shown_.revisions = request_.revisions;
    shown_.asked_at = request_.asked_at;
    shown_.screen = screen_of(picture, session_->scene());
    shown_.probe = session_->probe();
    shown_.warnings.clear();
    add_warnings();
    shown_.failure.clear();
    ++shown_.frame;
    shown_.frame_statistics = session_->statistics();
}

void SessionSteps::trace(const std::stop_token& stop) {
    choose();
    TracedPicture traced(shown_.full, shown_.full_screen, session_->scene());
    auto published = Clock::now();
    shown_.activity = "tracing";
    const PreciseImage& truth =
        session_->trace(stop, {}, [&](const PictureTile& tile, const PreciseImage& picture) {
            traced.add(tile, picture);
            if (ms_since(published) < tile_publish_ms) return;
            show_traced(traced);
            publish_(shown_);
            published = Clock::now();
        });
    show_traced(traced);
    take_truth(truth);
    next_ = step_after_full();
    publish_(shown_);
}

void SessionSteps::show_traced(const TracedPicture& traced) {
    shown_.kind = PictureKind::traced;
    shown_.revisions = request_.revisions;
    shown_.asked_at = request_.asked_at;
    shown_.screen = std::make_shared<const ScreenPicture>(traced.screen());
    shown_.share_done = shown_.share_traced = traced.share();
    shown_.error = traced.error();
    if (shown_.full) shown_.missed = std::make_shared<const PictureDifference>(traced.missed());
}

void SessionSteps::take_truth(const PreciseImage& truth) {
    shown_.truth = std::make_shared<const PreciseImage>(truth);
    shown_.trace_error = session_->trace_statistics().trace_error;
    const Image as_float = to_float(truth);
    if (truth.annotations) shown_.screen = screen_of(as_float, session_->scene());
    if (shown_.full) {
        shown_.error = error_of(*shown_.full, as_float);
    } else {  // the scene itself asks for the traced picture
        shown_.full = std::make_shared<const Image>(as_float);
        shown_.full_screen = shown_.screen;
        shown_.full_revisions = request_.revisions;
        tell_plan();
        shown_.probe = session_->probe();
        shown_.failure.clear();
    }
    add_warnings();
    shown_.activity.clear();
}

void SessionSteps::add_warnings() {
    for (std::string& warning : session_->take_warnings())
        if (std::ranges::find(shown_.warnings, warning) == shown_.warnings.end())
            shown_.warnings.push_back(std::move(warning));
}

}  // namespace lamina::view
