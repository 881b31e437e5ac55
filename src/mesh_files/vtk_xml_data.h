// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/input_file.h"
#include "base/value_type.h"

namespace lamina {

// An encoded array of a VTK XML file, from its beginning to the end of the text or data that may
// belong to it.
struct VtkXmlSource {
    std::string_view text;                   // base64
    const RandomAccessFile* file = nullptr;  // or its bytes begin .. end - 1
    std::uint64_t begin = 0, end = 0;
    bool base64 = true;

    std::uint64_t left() const { return file != nullptr ? end - begin : text.size(); }
    void skip(std::uint64_t count) {
        if (file != nullptr)
            begin += count;
        else
            text.remove_prefix(count);
    }
};

// How a VTK XML file encodes its binary arrays: attributes of its VTKFile element.
struct VtkXmlEncoding {
    bool swap_bytes = false;
    ValueType header_type = ValueType::uint32;
    std::string compressor;  // empty: none
};

// Values in their own type and native byte order.
struct VtkXmlValues {
    ValueType type = ValueType::uint8;
    ByteBuffer bytes;
};

// Reads `count` values of `type` from binary data, as vtkXMLDataParser does: a header (the length,
// or the lengths of the compressed blocks), then the values. Checks lengths before it takes memory.
// The source then begins behind them. read_vtk_xml_bytes() leaves the file's byte order. Throws
// Error. `what`: names the file and the array in messages.
ByteBuffer read_vtk_xml_bytes(VtkXmlSource& source, const VtkXmlEncoding& encoding, ValueType type,
                              std::int64_t count, const std::string& what);
template <typename To>
std::vector<To> read_vtk_xml_values(VtkXmlSource& source, const VtkXmlEncoding& encoding,
                                    ValueType type, std::int64_t count, const std::string& what);

}  // namespace lamina
