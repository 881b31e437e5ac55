// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/output_file.h"
#include "lamina/scene.h"

namespace lamina {

// Name that means stdout for outputs, and stdin for scenes.
inline constexpr const char* standard_stream = "-";

// Opens the output that an option names: a file, or stdout. Throws Error if it cannot be written.
std::unique_ptr<OutputFile> open_named(const std::string& name);

// Throws UsageError if a file that a command writes is also read, or written twice, under any of
// its names (links included). Empty paths are ignored; "-" is stdout, which can be written once.
void expect_different_files(const std::vector<std::filesystem::path>& read,
                            const std::vector<std::filesystem::path>& written);

// Checks the folder that a verb will write into, before the verb reads, computes or writes
// anything. Throws UsageError if one of the files `names` in it is in `read`; and, unless `force`,
// Error if one exists that the verb did not write (base/output_file.h).
void expect_own_folder(const std::filesystem::path& folder, const std::string& verb,
                       const std::vector<std::string>& names,
                       const std::vector<std::filesystem::path>& read, bool force);

// Text of --force for --help.
inline constexpr const char* force_help =
    "Replace files of the folder that this verb did not write, but never one that it reads";

// Returns the files that a scene needs: its own, and the volume, mesh and colour map that it names.
std::vector<std::filesystem::path> files_of(const Scene& scene);

enum class PictureFormat { exr, png, npy };

// Returns the format of `output` (-o): by its suffix, or `format` (--format) for stdout. Throws
// UsageError if the two do not determine it or contradict each other.
PictureFormat picture_format(const std::string& output, const std::string& format);

}  // namespace lamina
