// SPDX-License-Identifier: Apache-2.0
#include "raw_options.h"

#include <cmath>
#include <cstdlib>
#include <sstream>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "base/value_type.h"
#include "volume_files/numbered_files.h"

namespace lamina {
namespace {

[[noreturn]] void reject(const RawOptions& options) {
    throw UsageError(
        fmt::format("--raw {}: expected X,Y,Z,TYPE or X,Y,Z,TYPE,SX,SY,SZ: samples along x, y and "
                    "z, one of {}, and the distances between them",
                    shortened(options.layout), value_type_list()));
}

double distance_of(const std::string& word, const RawOptions& options) {
    char* end = nullptr;
    const double distance = std::strtod(word.c_str(), &end);
    if (word.empty() || *end != '\0' || !(distance > 0) || std::isinf(distance)) reject(options);
    return distance;
}

}  // namespace

void add_raw_options(CLI::App& verb, RawOptions& options) {
    verb.add_option("--raw", options.layout,
                    "The file is a volume without a header: samples along x (fastest), y and z, "
                    "their type (int8, uint8, ... uint64, float, double), and their distances")
        ->option_text("X,Y,Z,TYPE[,SX,SY,SZ]");
    verb.add_option("--raw-offset", options.offset, "With --raw: bytes before the first sample")
        ->option_text("BYTES");
    verb.add_flag("--big-endian", options.big_endian,
                  "With --raw: the most significant byte is the first");
}

VolumeRequest request_of(const RawOptions& options) {
    if (options.layout.empty()) {
        if (options.offset != 0 || options.big_endian)
            throw UsageError("--raw-offset and --big-endian: expected --raw, too");
        return {};
    }
    if (options.offset < 0) {
        throw UsageError(
            fmt::format("--raw-offset {}: expected a whole number from 0", options.offset));
    }
    std::vector<std::string> words;
    std::istringstream stream(options.layout);
    for (std::string word; std::getline(stream, word, ',');) words.push_back(word);
    if ((words.size() != 4 && words.size() != 7) || !value_type_of(words[3])) reject(options);
    VolumeRequest request;
    request.raw = RawLayout{{}, words[3], options.offset, options.big_endian};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto size = whole_number(words[axis]);
        if (!size || *size < 1 || *size > (std::int64_t{1} << 40)) reject(options);
        request.raw->size[axis] = *size;
    }
    if (words.size() == 7) {
        request.spacing = {distance_of(words[4], options), distance_of(words[5], options),
                           distance_of(words[6], options)};
    }
    return request;
}

}  // namespace lamina
