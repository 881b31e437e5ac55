// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "choice/surfaces.h"
#include "choice/value_distribution.h"
#include "lamina/transfer_function.h"
#include "lamina/volume.h"
#include "optics/colormap.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Settings of a transfer function that a user may ask for.
struct TransferAdjustments {
    std::optional<Colormap> colormap{};  // replaces the chosen colours
    std::optional<ValueRange> range{};   // the visible range, lo < hi: values below are transparent
};

// A transfer function that was chosen from the data.
struct AutomaticTransfer {
    TransferFunction transfer_function = TransferFunction::linear({TransferKnot{}});
    std::string reason{};  // for people: which values show, and which do not
    // For people: which values are padding, or which label a margin; empty if none are.
    std::string padding{};
    // False: extinctions are relative, the largest is 1, and choose() scales them for the data.
    bool per_world_unit = false;
    // Opacity that the median of the rays that meet something visible then gets.
    double median_opacity = .9;
};

// Chooses a transfer function (docs/first-picture.md): surfaces of materials or of rare values
// show, common values and noise are transparent. `least_padding_share`: see find_padding().
// `labels`: what the file says of labels, if all values are labels; each then has a colour, and a
// range is one of the file's numbers.
AutomaticTransfer choose_transfer_function(const ValueDistribution& values, bool whole_numbers,
                                           const TransferAdjustments& adjustments = {},
                                           double least_padding_share = least_padding,
                                           const VolumeLabels* labels = nullptr,
                                           const TransferSubject& subject = {});

// Returns the function with its points moved in proportion to a range, lo < hi. Throws Error if it
// has a single point, or if three points would get one value.
TransferFunction stretched(const TransferFunction& transfer_function, const ValueRange& range);

// Returns the function with the colours of a map, spread from its first to its last point unless
// the map has a range of its own; a single point gets the middle colour.
TransferFunction recolored(const TransferFunction& transfer_function, Colormap colormap);

}  // namespace lamina
