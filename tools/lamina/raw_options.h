// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "lamina/volume_request.h"

namespace lamina {

// A file without a header, as the command line describes it.
struct RawOptions {
    std::string layout;  // "X,Y,Z,TYPE" or "X,Y,Z,TYPE,SX,SY,SZ"; empty: the file has a header
    std::int64_t offset = 0;
    bool big_endian = false;
};

void add_raw_options(CLI::App& verb, RawOptions& options);

// Throws UsageError for what is no layout.
VolumeRequest request_of(const RawOptions& options);

}  // namespace lamina
