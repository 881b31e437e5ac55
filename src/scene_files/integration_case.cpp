// SPDX-License-Identifier: Apache-2.0
#include "scene_files/integration_case.h"

#include <cmath>

#include "scene_files/transfer_keys.h"

namespace lamina {
namespace {

double read_scalar(JsonReader& reader, const std::string& key) {
    const double scalar = reader.number(key);
    if (!(std::abs(scalar) <= 1e300)) reader.reject(key, "a number between -1e300 and 1e300");
    return scalar;
}

}  // namespace

IntegrationCase read_integration_case(JsonReader reader) {
    ReadTransfer read = read_transfer_function(reader.object("transfer_function"));
    if (!read.function) {
        reader.fail_at("transfer_function.colormap_range",
                       "is missing, expected [lo, hi]: there are no data here");
    }
    const double front = read_scalar(reader, "sf");
    const double back = read_scalar(reader, "sb");
    const double length = reader.number("length");
    if (!(length >= 0)) reader.reject("length", "a number >= 0");
    reader.close();
    return {std::move(*read.function), std::move(read.given), front, back, length};
}

}  // namespace lamina
