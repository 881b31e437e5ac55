// SPDX-License-Identifier: Apache-2.0
#include "version_text.h"
#include "simd/instruction_set.h"

#include <fmt/ranges.h>

#include "base/process.h"
#include "git_commit.h"
#include "mesh_files/mesh_file.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

std::string found_programs() {
    std::vector<std::string> parts;
    for (const char* const name : {"lamina-tetrahedralize", "lamina-view"}) {
        const auto program = find_program(name);
        parts.push_back(fmt::format("{} ({})", name, program ? program->string() : "not found"));
    }
    return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace

std::string version_text() {
    return fmt::format("lamina " LAMINA_VERSION
                       "\ncommit: {}\ninstructions: {} (this machine has {})\nvolumes: {}\nmeshes: "
                       "{}\nprograms: {}",
                       git_commit, instruction_set(), fmt::join(instruction_sets(), ", "),
                       volume_format_names(), mesh_format_list, found_programs());
}

}  // namespace lamina
