// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/output_file.h"
#include "lamina/scene.h"

namespace lamina {

// The name of stdout for outputs, and of stdin for scenes.
inline constexpr const char* standard_stream = "-";

// The output that an option names: a file, or stdout. Throws Error if it cannot be written.
std::unique_ptr<OutputFile> open_named(const std::string& name);

// Throws UsageError if a file that a command writes is one that it reads, or is written twice:
// by the same name or another, through a link, or as another name of the same bytes on the disk.
// Empty paths are passed over; "-" is stdout, which can be written once.
void expect_different_files(const std::vector<std::filesystem::path>& read,
                            const std::vector<std::filesystem::path>& written);

// Checks the folder that a verb will write into, before it reads, computes or writes anything else.
// Throws UsageError if one of these names in it is a file of `read`, and Error if it is there and
// the verb did not write it (base/output_file.h), unless `force`.
void expect_own_folder(const std::filesystem::path& folder, const std::string& verb,
                       const std::vector<std::string>& names,
                       const std::vector<std::filesystem::path>& read, bool force);

// The help of --force.
inline constexpr const char* force_help =
    "Replace files of the folder that this verb did not write, but never one that it reads";

// Returns the files that a scene is made of: its own, and those that it names: volume, mesh and
// colour map.
std::vector<std::filesystem::path> files_of(const Scene& scene);

enum class PictureFormat { exr, png, npy };

// Returns the format of `output` (-o): that of its suffix, or `format` (--format) for stdout.
// Throws UsageError if the two leave it open or contradict each other.
PictureFormat picture_format(const std::string& output, const std::string& format);

}  // namespace lamina
