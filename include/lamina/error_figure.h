// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "lamina/export.h"

namespace lamina {

// How a picture's error is known.
enum class ErrorKind {
    unknown,  // the scene states something that nothing was measured of, or the mesh overlaps
              // itself
    derived,  // a bound: no pixel is worse
    trials,   // found with other settings on rays of the view, which were traced or drawn finely
    sampled   // found on rays of the view and tets of the mesh, chosen where it is worst
};
// The word in statistics: "unknown", "derived", "trials", "sampled".
LAMINA_API const char* name_of(ErrorKind kind);

// The largest error of a picture: of any pixel and channel, in 1/255, against the truth. Only a
// derived figure is a bound. Others are missed by at most 1.5 times, in at most one of 1000
// pictures (tools/fuzz_scenes judges that).
struct ErrorFigure {
    ErrorKind kind = ErrorKind::unknown;
    double value = 0;       // 0 if unknown
    std::int64_t rays = 0;  // of trials and samples

    // The value; none if it is unknown.
    std::optional<double> known() const {
        return kind == ErrorKind::unknown ? std::nullopt : std::optional(value);
    }
    friend bool operator==(const ErrorFigure&, const ErrorFigure&) = default;
};

// "at most 0.05 / 255", "0.9 / 255 by trials on 1024 rays", "0.06 / 255, sampled on 1024 rays",
// "unknown".
LAMINA_API std::string text_of(const ErrorFigure& error);

}  // namespace lamina
