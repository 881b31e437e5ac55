// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lamina/error.h"
#include "lamina/scene.h"

namespace lamina {

// How the error of a picture was found.
enum class ErrorKind {
    unknown,  // nothing was measured for a setting of the scene, or tets overlap and have no order
    derived,  // a bound: no pixel is worse
    trials,   // measured on rays of the view that were also traced, or drawn with finer settings
    sampled,  // measured on rays of the view and on tets that are likely to have the largest errors
    estimated  // by the rule that cuts lit rays: each piece keeps its share of max_error, but
               // nothing limits how many faint ones a ray has
};
// Returns the word in statistics: "unknown", "derived", "trials", "sampled" or "estimated".
LAMINA_API const char* name_of(ErrorKind kind);

// Largest error of any pixel and channel of a picture against the truth, in 1/255. Only a derived
// figure is a bound. Other figures are exceeded in at most one of 1000 pictures, and then at most
// 1.5 times (tools/fuzz_scenes tests that); noise under strong light exceeds estimates more often.
struct ErrorFigure {
    ErrorKind kind = ErrorKind::unknown;
    double value = 0;       // 0 if unknown
    std::int64_t rays = 0;  // number of rays of trials and samples
    // Bound, in 1/255, for rays that run along a surface at which the transfer function is steep,
    // if `value` does not hold for them (docs/precision.md, "Jumps"). 0: it does.
    double along_ramps = 0;

    // Returns the value, or nothing if it is unknown.
    std::optional<double> known() const {
        return kind == ErrorKind::unknown ? std::nullopt : std::optional(value);
    }
    friend bool operator==(const ErrorFigure&, const ErrorFigure&) = default;
};

// Returns a text: "at most 0.05 / 255", "0.9 / 255 by trials on 1024 rays", "0.06 / 255, sampled on
// 1024 rays", "0.8 / 255, estimated", or "unknown". "; along ramps at most 9.5 / 255" follows if
// there is such a bound.
LAMINA_API std::string text_of(const ErrorFigure& error);

// Summary of the plan by which a picture is drawn.
struct PlanSummary {
    // Work that the scene does not need, and why it may be left out.
    struct LeftOut {
        std::string name, reason;
    };

    Method method = Method::slice;
    Target target = Target::float32;
    int slabs = 0;  // number of slabs of slicing
    // Error of the picture, including the rounding of compositing, in 1/255; below 255.
    ErrorFigure error;
    std::vector<LeftOut> left_out;
};

// Cost of a picture, and counts of what was done for it (docs/stats.md explains the names).
struct FrameStatistics {
    std::string drawn_by;                     // the renderer, and its number of threads if known
    double draw_ms = 0;                       // duration of the call of draw()
    std::map<std::string, double> stages_ms;  // time of each stage when it last ran
    std::int64_t fragments = 0;  // segments of rays that were composited; 0: not counted
    std::int64_t bytes = 0;      // memory beside the data themselves
    double trace_error = 0;      // the tracer's estimate of its error, in 1/255

    std::string renderer;         // drawn_by without its threads
    bool native = false;          // true if the cpu engine drew
    int slabs = 0;                // number of slabs of the method slice
    std::int64_t tets_drawn = 0;  // tets that cover the centre of a pixel
    std::int64_t bytes_gpu = 0;   // OpenGL memory, including the data
    // Error of a mesh that was made from a volume, as a share of the volume's range of values.
    std::optional<double> mesh_error;
    std::map<std::string, std::int64_t> counts;  // what was clamped, skipped, dropped, ...
};

// Distribution of the data's values, by volume: the share shares[i] of all finite values lies in
// interval i. The intervals are equally wide and reach from `lo` to `hi`.
struct ValueHistogram {
    double lo = 0, hi = 0;
    double least = 0, most = 0;  // the finite values' range
    std::vector<double> shares;  // >= 0, their sum is 1; empty if no value is finite
};

}  // namespace lamina
