// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lamina/image.h"
#include "lamina/scene.h"
#include "work/shown.h"

namespace lamina::view {

// a - b, of pictures of one size.
PictureDifference difference_of(const Image& a, const Image& b);
// Returns the signed difference of one pixel (red, green, blue and opacity) in the channel in which
// it is largest.
float largest_difference(const float* a, const float* b);

// Returns the largest |e|, rounded up to 1, 2 or 5 times a power of ten: a scale that the whole
// difference fits into. Pictures that are equal get the smallest one.
double fitting_range(const PictureDifference& difference);
inline constexpr double smallest_range = 1e-4;

// Tells whether pictures of both scenes show the same from the same place, pixel by pixel; they do
// not if a camera is not chosen yet.
inline bool same_view(const Scene& a, const Scene& b) {
    if (a.camera.is_automatic() || b.camera.is_automatic()) return false;
    const Camera &from = *a.camera, &to = *b.camera;
    return a.width == b.width && a.height == b.height && from.projection == to.projection &&
           from.eye == to.eye && from.center == to.center && from.up == to.up &&
           from.fov_y == to.fov_y && from.height == to.height;
}

// The picture A beside the edited picture B: a pinned picture, or as much of B as the tracer has
// drawn so far.
enum class CompareWith { pinned, truth };
enum class CompareBy { nothing, flip, wipe, side_by_side, difference };

// A comparison of two pictures, both of them full: while B moves there is nothing to compare.
class Comparison {
  public:
    CompareWith with = CompareWith::pinned;
    CompareBy by = CompareBy::nothing;
    bool flipped = false;         // CompareBy::flip: the other picture is seen
    double wipe = .5;             // of the picture's width, left of which the other one is seen
    std::optional<double> range;  // of the difference's colours, in 1/255; none: what fits
    float strength = 1;           // of these colours over the picture, 0 to 1

    // Makes the full picture that is shown, which is of this scene, A.
    void pin(const Scene& scene, const Shown& shown);
    void unpin();
    // Exchanges the places of the two pictures.
    void flip();
    void next_way();  // of CompareBy, but for flip
    void next_with();
    const std::shared_ptr<const PinnedPicture>& pinned() const { return pinned_; }

    // Takes the pictures to show: A, if it was drawn again, and B.
    void follow(const Shown& shown);
    // Reason why there is nothing to be seen beside B; empty if there is.
    const std::string& missing() const { return missing_; }
    bool active() const { return by != CompareBy::nothing && missing_.empty(); }

    // Pictures and difference that follow() found; null if there are none.
    const std::shared_ptr<const ScreenPicture>& other() const { return other_; }
    const std::shared_ptr<const ScreenPicture>& edited() const { return edited_; }
    const std::shared_ptr<const PictureDifference>& difference() const { return difference_; }
    ErrorNorms norms() const { return norms_; }  // of the difference: B less the other one
    double shown_range() const;                  // `range`, or what fits
    // The difference in false colours (lamina::difference_codes), as far as it is known; elsewhere
    // B.
    std::shared_ptr<const ScreenPicture> colors();

  private:
    std::string find_pictures(const Shown& shown);
    std::string find_pinned(const Shown& shown);
    void measure(const Shown& shown);

    std::shared_ptr<const PinnedPicture> pinned_;
    std::uint64_t pins_ = 0;
    std::string missing_;
    std::shared_ptr<const ScreenPicture> other_, edited_;
    std::shared_ptr<const PictureDifference> difference_;
    ErrorNorms norms_;
    double fitting_ = smallest_range;
    // Inputs of the last measurement and colouring.
    std::shared_ptr<const Image> measured_a_, measured_b_;
    std::shared_ptr<const PictureDifference> colored_;
    double colored_range_ = 0;
    std::shared_ptr<const ScreenPicture> colors_;
};

}  // namespace lamina::view
