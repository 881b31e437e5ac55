// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/given_transfer.h"
#include "scene_files/json_reader.h"

namespace lamina {

// A segment that `lamina integrate` integrates.
struct IntegrationCase {
    TransferFunction transfer_function;
    GivenTransfer given;
    double front = 0, back = 0;  // scalars, up to 1e300
    double length = 0;           // world units, >= 0
};

// Reads {"transfer_function", "sf", "sb", "length"} and closes the reader. Throws KeyError.
IntegrationCase read_integration_case(JsonReader reader);

}  // namespace lamina
