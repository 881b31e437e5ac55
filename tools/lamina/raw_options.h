// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "lamina/volume_request.h"

namespace lamina {

// The layout of a file without a header, from the command line.
struct RawOptions {
    std::string layout;  // "X,Y,Z,TYPE" or "X,Y,Z,TYPE,SX,SY,SZ"; empty: the file has a header
    std::int64_t offset = 0;
    bool big_endian = false;
};

void add_raw_options(CLI::App& verb, RawOptions& options);

// Throws UsageError if the options do not describe a layout.
VolumeRequest request_of(const RawOptions& options);

}  // namespace lamina
