// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "lamina/export.h"

namespace lamina {

// Evidence for the figure of a picture's error.
enum class ErrorKind {
    unknown,  // nothing was measured for a setting of the scene, or the mesh overlaps itself
    derived,  // a bound: no pixel is worse
    trials,   // measured on rays of the view that were traced, or drawn with finer settings
    sampled   // measured on those rays of the view and tets of the mesh that promise the worst
};
// Returns the word in statistics: "unknown", "derived", "trials" or "sampled".
LAMINA_API const char* name_of(ErrorKind kind);

// Largest error of any pixel and channel of a picture against the truth, in 1/255. Only a derived
// figure is a bound. Other figures are exceeded in at most one of 1000 pictures, and then at most
// 1.5 times (tools/fuzz_scenes tests that).
struct ErrorFigure {
    ErrorKind kind = ErrorKind::unknown;
    double value = 0;       // 0 if unknown
    std::int64_t rays = 0;  // number of rays of trials and samples

    // Returns the value, or nothing if it is unknown.
    std::optional<double> known() const {
        return kind == ErrorKind::unknown ? std::nullopt : std::optional(value);
    }
    friend bool operator==(const ErrorFigure&, const ErrorFigure&) = default;
};

// Returns a text: "at most 0.05 / 255", "0.9 / 255 by trials on 1024 rays", "0.06 / 255, sampled on
// 1024 rays", or "unknown".
LAMINA_API std::string text_of(const ErrorFigure& error);

}  // namespace lamina
