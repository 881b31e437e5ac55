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

// Returns largest_difference() for each pixel of two pictures of equal size.
PictureDifference difference_of(const Image& a, const Image& b);
// Returns the signed difference a - b of one pixel, in 1/255, in the channel (red, green, blue or
// opacity) in which it is largest.
float largest_difference(const float* a, const float* b);

// Returns the end of a colour scale, in 1/255: the largest |e|, rounded up to 1, 2 or 5 times a
// power of ten, but at least smallest_range.
double fitting_range(const PictureDifference& difference);
inline constexpr double smallest_range = 1e-4;

// Returns true if both scenes have the same camera and picture size; false if a camera is
// automatic.
inline bool same_view(const Scene& a, const Scene& b) {
    if (a.camera.is_automatic() || b.camera.is_automatic()) return false;
    const Camera &from = *a.camera, &to = *b.camera;
    return a.width == b.width && a.height == b.height && from.projection == to.projection &&
           from.eye == to.eye && from.center == to.center && from.up == to.up &&
           from.fov_y == to.fov_y && from.height == to.height;
}

// The picture A to compare the edited picture B with: a pinned picture, or the tracer's picture of
// B as far as it is drawn.
enum class CompareWith { pinned, truth };
enum class CompareBy { nothing, flip, wipe, side_by_side, difference };

// A comparison of two full pictures. While B moves, nothing is compared.
class Comparison {
  public:
    CompareWith with = CompareWith::pinned;
    CompareBy by = CompareBy::nothing;
    bool flipped = false;         // CompareBy::flip: A is shown in place of B
    double wipe = .5;             // share of the picture's width that shows A, from the left
    std::optional<double> range;  // end of the colour scale, in 1/255; none: fitting_range()
    float strength = 1;           // opacity of these colours over the picture, 0 to 1

    // Pins the full picture that is shown, of this scene, as A.
    void pin(const Scene& scene, const Shown& shown);
    void unpin();
    // Shows A in place of B, or B again.
    void flip();
    void next_mode();  // the next CompareBy, without flip
    void next_with();
    const std::shared_ptr<const PinnedPicture>& pinned() const { return pinned_; }

    // Takes the pictures to compare from `shown`, and measures their difference.
    void follow(const Shown& shown);
    // Returns why nothing can be compared with B; empty if something can.
    const std::string& missing() const { return missing_; }
    bool active() const { return by != CompareBy::nothing && missing_.empty(); }

    // Return A, B and their difference, as follow() found them, or null.
    const std::shared_ptr<const ScreenPicture>& other() const { return other_; }
    const std::shared_ptr<const ScreenPicture>& edited() const { return edited_; }
    const std::shared_ptr<const PictureDifference>& difference() const { return difference_; }
    ErrorNorms norms() const { return norms_; }  // of B minus A
    double shown_range() const;                  // `range`, or fitting_range()
    // Returns the difference in false colours (lamina::difference_codes). Pixels without a known
    // difference show B.
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
