// SPDX-License-Identifier: Apache-2.0
#include "picture_format.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "base/error.h"
#include "named_output.h"

namespace lamina {
namespace {

std::optional<PictureFormat> format_of(const std::string& word) {
    if (word == "exr") return PictureFormat::exr;
    if (word == "png") return PictureFormat::png;
    if (word == "npy") return PictureFormat::npy;
    return std::nullopt;
}

}  // namespace

PictureFormat picture_format(const std::string& output, const std::string& format) {
    const bool piped = output == standard_stream;
    if (piped && format.empty())
        throw UsageError("-o -: expected --format png, exr or npy, too: a pipe has no suffix");
    if (!piped && !format.empty()) {
        throw UsageError(fmt::format(
            "--format {}: only with -o -; the suffix of {} gives its format", format, output));
    }
    const std::string suffix = std::filesystem::path(output).extension().string();
    const auto found = format_of(piped ? format : suffix.substr(suffix.empty() ? 0 : 1));
    if (found) return *found;
    if (piped) throw UsageError(fmt::format("--format {}: expected one of png, exr, npy", format));
    throw UsageError(
        fmt::format("-o {}: found the suffix \"{}\", expected .exr, .png or .npy", output, suffix));
}

}  // namespace lamina
