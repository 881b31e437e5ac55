// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lamina/settings.h"

namespace lamina {

// Place of an annotation: a corner of the picture, or the middle of one of its edges.
enum class AnnotationPosition {
    top_left,
    top,
    top_right,
    left,
    right,
    bottom_left,
    bottom,
    bottom_right
};

LAMINA_API const char* name_of(AnnotationPosition position);

// How one annotation is drawn beside the picture.
struct Annotation {
    static constexpr double least_size = 0.25, largest_size = 4;

    Auto<AnnotationPosition> position;  // automatic: each kind of annotation has its own place
    double size = 1;                    // factor on the size, which follows the picture's height
    // Title and free texts: the text. Colour bar: what stands above it; if empty, the name and unit
    // of the data. UTF-8; lines are parted by "\n".
    std::string text;
    // How numbers are written: one "{}", "{:.Nf}", "{:.Ne}" or "{:.Ng}" with text around it. If
    // empty, with as many digits as the numbers need.
    std::string format;

    friend bool operator==(const Annotation&, const Annotation&) = default;
};

// All that is drawn beside a picture (docs/annotations.md). It is no part of the picture's numbers.
struct Annotations {
    static constexpr std::size_t most_texts = 32;

    // If both colour bar and labels are wanted, data that are labels get the legend of labels, and
    // other data the colour bar.
    std::optional<Annotation> colorbar, labels;
    std::optional<Annotation> scale_bar, axes, box, title;
    std::vector<Annotation> texts;

    bool any() const {
        return colorbar || labels || scale_bar || axes || box || title || !texts.empty();
    }
    friend bool operator==(const Annotations&, const Annotations&) = default;
};

}  // namespace lamina
