// SPDX-License-Identifier: Apache-2.0
#include "model/comparison.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "lamina/image.h"

namespace lamina::view {

float largest_difference(const float* a, const float* b) {
    float largest = 0;
    for (int channel = 0; channel < 4; ++channel) {
        const float e = 255 * (a[channel] - b[channel]);
        if (std::abs(e) > std::abs(largest)) largest = e;
    }
    return largest;
}

PictureDifference difference_of(const Image& a, const Image& b) {
    assert(a.width == b.width && a.height == b.height);
    PictureDifference difference{a.width, a.height, std::vector<float>(a.rgba.size() / 4)};
    for (std::size_t pixel = 0; pixel < difference.e.size(); ++pixel)
        difference.e[pixel] = largest_difference(&a.rgba[4 * pixel], &b.rgba[4 * pixel]);
    return difference;
}

double fitting_range(const PictureDifference& difference) {
    double largest = 0;
    for (const float e : difference.e)
        if (!std::isnan(e)) largest = std::max(largest, std::abs(static_cast<double>(e)));
    if (largest <= smallest_range) return smallest_range;
    const double power = std::pow(10, std::floor(std::log10(largest)));
    for (const double step : {1., 2., 5.})
        if (largest <= step * power) return step * power;
    return 10 * power;
}

void Comparison::pin(const Scene& scene, const Shown& shown) {
    if (!shown.full || !shown.full_screen || !shown.resolved) return;
    pinned_ =
        std::make_shared<const PinnedPicture>(PinnedPicture{.number = ++pins_,
                                                            .data = shown.full_revisions.data,
                                                            .scene = scene,
                                                            .resolved = *shown.resolved,
                                                            .picture = shown.full,
                                                            .screen = shown.full_screen,
                                                            .statistics = shown.statistics,
                                                            .expected = shown.plan.error.known()});
}

void Comparison::unpin() {
    pinned_.reset();
}

void Comparison::flip() {
    flipped = by != CompareBy::flip || !flipped;
    by = CompareBy::flip;
}

void Comparison::next_mode() {
    switch (by) {
        case CompareBy::nothing:
        case CompareBy::flip:
            by = CompareBy::wipe;
            return;
        case CompareBy::wipe:
            by = CompareBy::side_by_side;
            return;
        case CompareBy::side_by_side:
            by = CompareBy::difference;
            return;
        case CompareBy::difference:
            by = CompareBy::nothing;
            return;
    }
}

void Comparison::next_with() {
    with = with == CompareWith::pinned ? CompareWith::truth : CompareWith::pinned;
}

void Comparison::follow(const Shown& shown) {
    if (pinned_ && shown.pinned && shown.pinned->number == pinned_->number) pinned_ = shown.pinned;
    if (pinned_ && pinned_->data != shown.full_revisions.data && shown.full) unpin();
    other_.reset();
    edited_.reset();
    missing_ = find_pictures(shown);
    if (missing_.empty())
        measure(shown);
    else
        difference_.reset();
}

std::string Comparison::find_pictures(const Shown& shown) {
    if (!shown.full || !shown.full_screen || shown.kind == PictureKind::moving)
        return "There is no full picture yet";
    edited_ = shown.full_screen;
    if (with == CompareWith::pinned) return find_pinned(shown);
    if (!shown.missed) return "Nothing is traced yet";
    other_ = shown.screen;
    return {};
}

std::string Comparison::find_pinned(const Shown& shown) {
    if (!pinned_) return "Nothing is pinned";
    if (!shown.resolved || !same_view(pinned_->scene, *shown.resolved))
        return "A is not drawn in this view yet";
    if (pinned_->scene.color_space != shown.resolved->color_space)
        return "A and B have different colour spaces";
    other_ = pinned_->screen;
    return {};
}

void Comparison::measure(const Shown& shown) {
    if (with == CompareWith::truth) {
        if (difference_ == shown.missed) return;
        difference_ = shown.missed;
        norms_ = shown.error;
        measured_a_.reset();
    } else if (measured_a_ != pinned_->picture || measured_b_ != shown.full) {
        measured_a_ = pinned_->picture;
        measured_b_ = shown.full;
        difference_ =
            std::make_shared<const PictureDifference>(difference_of(*measured_b_, *measured_a_));
        norms_ = error_of(*measured_b_, *measured_a_);
    } else {
        return;
    }
    fitting_ = fitting_range(*difference_);
}

double Comparison::shown_range() const {
    return range.value_or(fitting_);
}

std::shared_ptr<const ScreenPicture> Comparison::colors() {
    if (!difference_ || !edited_) return {};
    if (difference_ == colored_ && shown_range() == colored_range_) return colors_;
    colored_ = difference_;
    colored_range_ = shown_range();
    auto picture = std::make_shared<ScreenPicture>(*edited_);
    std::vector<float> known;
    known.reserve(difference_->e.size());
    for (const float e : difference_->e)
        if (!std::isnan(e)) known.push_back(e);
    const std::vector<std::uint8_t> codes = difference_codes(known, colored_range_);
    auto from = codes.begin();
    auto to = picture->rgb.begin();
    for (const float e : difference_->e) {
        if (!std::isnan(e)) {
            std::copy_n(from, 3, to);
            from += 3;
        }
        to += 3;
    }
    colors_ = std::move(picture);
    return colors_;
}

}  // namespace lamina::view
