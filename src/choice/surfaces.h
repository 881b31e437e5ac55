// SPDX-License-Identifier: Apache-2.0
// Chooses which surfaces of a field show, and how (docs/first-picture.md).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "choice/value_distribution.h"
#include "lamina/transfer_function.h"

namespace lamina {

class Field;

// The field behind a distribution of values.
struct TransferSubject {
    const Field* field = nullptr;  // null: nothing but the values is known
    // Returns the world length of the median ray through the data; must be set if `field` is.
    std::function<double()> median_path{};
};

// Tells whether the data are a sheet, inside of which is nothing to see: a mesh through which the
// median path is short.
bool is_sheet(const TransferSubject& subject);

// Points of a transfer function that shows surfaces; extinctions are per world unit.
struct ChosenSurfaces {
    std::vector<TransferKnot> points;  // none if no value but the common ones exists
    std::string reason;                // for people: which values show, and which do not
};

// Chooses surfaces of materials, if the values have humps, or else of values evenly spread by the
// share of the field that they enclose. `padding.rest` must have two different values or more.
ChosenSurfaces choose_surfaces(const Padding& padding, bool whole_numbers,
                               const TransferSubject& subject);

// Chooses surfaces of values within a range, lo < hi; all values below it are transparent.
ChosenSurfaces choose_surfaces_within(const ValueDistribution& values, const ValueRange& range,
                                      bool whole_numbers, const TransferSubject& subject);

}  // namespace lamina
