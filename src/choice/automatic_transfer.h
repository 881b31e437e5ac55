// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "choice/padding.h"
#include "choice/value_distribution.h"
#include "lamina/transfer_function.h"
#include "optics/colormap.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// A user may ask for these.
struct TransferWishes {
    std::optional<Colormap> colormap{};  // in place of its own colours
    std::optional<ValueRange> range{};   // what shows, lo < hi: values below are transparent
};

struct AutomaticTransfer {
    // Its extinctions are relative, the largest 1: how dense the data are to be depends on the
    // view.
    TransferFunction transfer_function;
    std::string reason;     // for people: what shows, and what not
    std::string padding{};  // for people: which values are padding; empty if none are
};

// Chooses a transfer function by the values of a field (docs/first-picture.md): common values are
// transparent, and the rarer the values beyond them are, the denser and the brighter they show. The
// same values give the same function. `least_padding_share`: see find_padding().
AutomaticTransfer choose_transfer_function(const ValueDistribution& values, bool whole_numbers,
                                           const TransferWishes& wishes = {},
                                           double least_padding_share = least_padding);

}  // namespace lamina
