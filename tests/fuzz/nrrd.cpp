// SPDX-License-Identifier: Apache-2.0
#include "volume_files/volume_formats.h"

#include <algorithm>
#include <cctype>

#include "input_parts.h"
#include "runs.h"
#include "scratch_folder.h"
#include "volume_check.h"

namespace lamina::fuzz {
namespace {

// Tells whether every line that may be the field `data file` names only files in the scratch
// folder.
bool data_file_stays_in_folder(std::string_view header) {
    std::string lower(header);
    std::ranges::transform(lower, lower.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    for (const char* const field : {"data file", "datafile"}) {
        for (std::size_t at = lower.find(field); at != lower.npos; at = lower.find(field, at + 1)) {
            const std::size_t end = std::min(lower.find('\n', at), lower.size());
            // After LIST all lines are names of files.
            const bool list =
                std::string_view(lower).substr(at, end - at).find("list") != lower.npos;
            const std::size_t length = list ? lower.npos : end - at;
            if (!stays_in_folder(std::string_view(lower).substr(at, length))) return false;
        }
    }
    return true;
}

}  // namespace

void run_nrrd(std::string_view input) {
    const InputParts parts = parts_of(input);
    if (!data_file_stays_in_folder(parts.first)) return;
    const auto file = scratch_file("volume.nrrd", parts.first);
    scratch_file("data", parts.second);
    check_volume([&](const VolumeUse& use) { return open_nrrd(file, {}, use); });
}

}  // namespace lamina::fuzz
