// SPDX-License-Identifier: Apache-2.0
#include "base/error.h"

#include <filesystem>
#include <new>
#include <system_error>

#include "base/text.h"

namespace lamina {

std::string one_line(const std::string& text) {
    std::string line;
    for (const char c : text) {
        const bool blank = static_cast<unsigned char>(c) <= ' ';
        if (!blank)
            line += c;
        else if (!line.empty() && line.back() != ' ')
            line += ' ';
    }
    while (!line.empty() && line.back() == ' ') line.pop_back();
    return line;
}

namespace {

constexpr std::size_t most_of_path = 100;  // bytes of a path that a message shows

template <typename... Kinds>
bool is_one_of(const std::exception& error) {
    return ((dynamic_cast<const Kinds*>(&error) != nullptr) || ...);
}

}  // namespace

std::string error_text(const std::exception& error) {
    if (is_one_of<Error, UsageError, Interrupted>(error)) return error.what();
    if (is_one_of<std::bad_alloc>(error)) return "out of memory";
    if (const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&error)) {
        return fmt::format("{}: {}", shortened(file->path1().string(), most_of_path),
                           file->code().message());
    }
    if (const auto* system = dynamic_cast<const std::system_error*>(&error))
        return fmt::format("the system refuses: {}", system->code().message());
    return "a mistake of lamina, not of what it was given: please report this command with the "
           "files that it reads and the output of 'lamina --version'";
}

}  // namespace lamina
