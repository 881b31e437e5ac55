// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "lamina/error_norms.h"
#include "lamina/image.h"
#include "lamina/picture_tile.h"
#include "lamina/scene.h"
#include "model/picture_difference.h"
#include "work/shown.h"

namespace lamina::view {

// A full picture that the tracer replaces tile by tile, and the error that this finds.
class TracedPicture {
  public:
    // `full`: null if there is none to be measured.
    TracedPicture(std::shared_ptr<const Image> full, std::shared_ptr<const ScreenPicture> screen,
                  const Scene& scene);

    void add(const PictureTile& tile, const PreciseImage& truth);

    double share() const;      // of the pixels that are traced
    ErrorNorms error() const;  // of these, as error_of() has it of a traced picture in float32
    const ScreenPicture& screen() const { return screen_; }
    // The full picture less the truth, as far as that is traced. Empty if there is no full picture.
    const PictureDifference& missed() const { return missed_; }

  private:
    void measure(const PictureTile& tile, const Image& traced, int row);

    std::shared_ptr<const Image> full_;
    ScreenPicture screen_;
    PictureDifference missed_;
    glm::dvec3 background_;
    ImageColorSpace space_;
    std::int64_t pixels_ = 0;
    double largest_ = 0, sum_ = 0, squares_ = 0;
};

}  // namespace lamina::view
