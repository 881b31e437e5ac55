// SPDX-License-Identifier: Apache-2.0
#include "memory_option.h"

#include <cmath>
#include <cstdlib>
#include <string>

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"

namespace lamina {
namespace {

constexpr double least = 1 << 20, most = 0x1p62;

// Bytes, or as many K, M, G or T of 1024.
double bytes_of(const std::string& text) {
    char* end = nullptr;
    double bytes = std::strtod(text.c_str(), &end);
    const std::string unit = end;
    const std::size_t power = unit.empty() ? 0 : std::string("KMGT").find(unit) + 1;
    const bool known = unit.empty() || (unit.size() == 1 && power > 0);
    bytes *= std::pow(1024.0, static_cast<double>(power));
    if (text.empty() || !known || !(bytes >= least && bytes <= most)) {
        throw UsageError(
            fmt::format("--memory: found {}, expected a size of 1M or more, such as 800M or 1.5G",
                        shortened(text)));
    }
    return bytes;
}

}  // namespace

void add_memory_option(CLI::App& verb) {
    verb.add_option_function<std::string>(
            "--memory",
            [](const std::string& text) {
                set_memory_limit(static_cast<std::uint64_t>(bytes_of(text)));
            },
            "How much memory the data may take, as 800M or 1.5G (of 1024^3 bytes), beside 200 MB "
            "of the program itself: parts of larger volumes are read when they are drawn (raw "
            "NRRD, "
            "MetaImage and --raw, Zarr); half of the machine's memory where this is not given")
        ->option_text("SIZE");
}

}  // namespace lamina
