// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "choice/value_distribution.h"
#include "lamina/transfer_function.h"
#include "optics/colormap.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Settings that a user may ask for.
struct TransferWishes {
    std::optional<Colormap> colormap{};  // replaces the chosen colours
    std::optional<ValueRange> range{};   // the visible range, lo < hi: values below are transparent
};

struct AutomaticTransfer {
    // Extinctions are relative, the largest is 1: the density of the data depends on the view.
    TransferFunction transfer_function;
    std::string reason;     // for people: which values show, and which do not
    std::string padding{};  // for people: which values are padding; empty if none are
};

// Chooses a transfer function from the values of a field (docs/first-picture.md): common values are
// transparent; the rarer a value beyond them is, the denser and brighter it shows. The result
// depends on the values alone. `least_padding_share`: see find_padding().
AutomaticTransfer choose_transfer_function(const ValueDistribution& values, bool whole_numbers,
                                           const TransferWishes& wishes = {},
                                           double least_padding_share = least_padding);

// Returns a transfer function for labels (few whole numbers, two or more): the most frequent one is
// transparent, each other has a colour of its own, which ends halfway to its neighbours.
AutomaticTransfer label_transfer(const ValueDistribution& values);

// Returns the function with its first and last point moved to the ends of the range, lo < hi, and
// all others in proportion. Throws Error if it has a single point, or if the range is so narrow
// that three points would get one value.
TransferFunction stretched(const TransferFunction& transfer_function, const ValueRange& range);

// Returns the function with the colours of a map, spread from its first to its last point unless
// the map has a range of its own (Colormap::own_range). A function of one point gets the middle
// colour.
TransferFunction recolored(const TransferFunction& transfer_function, Colormap colormap);

}  // namespace lamina
