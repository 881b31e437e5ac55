// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mesh_files/value_type.h"

namespace lamina {

// How a VTK XML file codes its binary arrays: the attributes of its VTKFile element.
struct VtuEncoding {
    bool swap_bytes = false;
    ValueType header_type = ValueType::uint32;
    std::string compressor;  // empty: none
};

// Where the bytes of one array begin.
struct VtuSource {
    std::string_view text;  // from there as far as it could go; once read, without what was read
    bool base64 = false;
};

// `count` values of `type`, from binary data as vtkXMLDataParser reads them: a header (the length,
// or the lengths of the compressed blocks), then the values. Checks lengths before it takes memory.
// Throws Error; `what`: the file and array, for messages.
template <typename To>
std::vector<To> read_vtu_data(VtuSource& source, const VtuEncoding& encoding, ValueType type,
                              std::int64_t count, const std::string& what);

}  // namespace lamina
