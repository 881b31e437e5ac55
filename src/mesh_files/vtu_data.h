// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/input_file.h"
#include "base/value_type.h"
#include "mesh_files/vtu_source.h"

namespace lamina {

// How a VTK XML file encodes its binary arrays: attributes of its VTKFile element.
struct VtuEncoding {
    bool swap_bytes = false;
    ValueType header_type = ValueType::uint32;
    std::string compressor;  // empty: none
};

// Values in their own type and native byte order.
struct VtuValues {
    ValueType type = ValueType::uint8;
    ByteBuffer bytes;
};

// Reads `count` values of `type` from binary data, as vtkXMLDataParser does: a header (the length,
// or the lengths of the compressed blocks), then the values. Checks lengths before it takes memory.
// Throws Error. `what`: names the file and the array in messages. The
// source then begins behind it.
// The bytes of the values, in the file's byte order.
ByteBuffer read_vtu_bytes(VtuSource& source, const VtuEncoding& encoding, ValueType type,
                          std::int64_t count, const std::string& what);
template <typename To>
std::vector<To> read_vtu_data(VtuSource& source, const VtuEncoding& encoding, ValueType type,
                              std::int64_t count, const std::string& what);

}  // namespace lamina
