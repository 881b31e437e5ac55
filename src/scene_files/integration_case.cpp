// SPDX-License-Identifier: Apache-2.0
#include "scene_files/integration_case.h"

#include <cmath>

#include "scene_files/transfer_function_json.h"

namespace lamina {
namespace {

double read_scalar(JsonReader& reader, const std::string& key) {
    const double scalar = reader.number(key);
    if (!(std::abs(scalar) <= 1e300)) reader.reject(key, "a number between -1e300 and 1e300");
    return scalar;
}

}  // namespace

IntegrationCase read_integration_case(JsonReader reader, std::vector<std::string>* warnings) {
    JsonReader given = reader.object("transfer_function");
    const auto colormap_file = colormap_file_of(given);
    TransferFunction transfer_function = read_transfer_function(given, {.warnings = warnings});
    const double front = read_scalar(reader, "sf");
    const double back = read_scalar(reader, "sb");
    const double length = reader.number("length");
    if (!(length >= 0)) reader.reject("length", "a number >= 0");
    reader.close();
    return {std::move(transfer_function), front, back, length, colormap_file};
}

}  // namespace lamina
