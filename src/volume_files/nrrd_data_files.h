// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace lamina {

// What the field `data file` of a NRRD header names: one file, a list ("LIST", then the names, one
// a line, up to the end of the header file), or a pattern ("slice%03d.raw MIN MAX STEP").
struct NrrdDataFiles {
    std::vector<std::string> names;
    std::optional<std::size_t>
        axes_each;  // the first axes, which one file holds, where this is said
};

// `path` and `line` are for messages; `following`: the header after the field's line. Throws Error.
NrrdDataFiles nrrd_data_files(const std::string& path, int line, const std::string& value,
                              const std::string& following);

}  // namespace lamina
