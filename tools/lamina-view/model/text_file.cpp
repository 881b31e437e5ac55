// SPDX-License-Identifier: Apache-2.0
#include "model/text_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <system_error>

#include "lamina/error.h"

namespace lamina::view {

void save_text(const std::filesystem::path& file, const std::string& text) {
    std::filesystem::path part = file;
    part += fmt::format(".{}.part", getpid());
    std::error_code problem;
    {
        std::ofstream stream(part, std::ios::binary | std::ios::trunc);
        stream << text;
        stream.close();
        if (!stream) problem = std::make_error_code(std::errc::io_error);
    }
    if (!problem) std::filesystem::rename(part, file, problem);
    if (!problem) return;
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw Error(fmt::format("{}: cannot be written: {}", file.string(), problem.message()));
}

}  // namespace lamina::view
