// SPDX-License-Identifier: Apache-2.0
#include "frame_names.h"

#include <fmt/format.h>

#include <cctype>

#include "base/error.h"

namespace lamina {
namespace {

[[noreturn]] void reject(const std::string& pattern, const std::string& found) {
    throw UsageError(
        fmt::format("-o {}: {}, expected one number, as in out_%04d.png, in the name of the file",
                    pattern, found));
}

// Returns the directive that begins with the percent sign at `at`: "%%", or a number such as
// "%04d".
std::string directive_at(const std::string& pattern, std::size_t at) {
    std::size_t end = at + 1;
    if (pattern[end] == '%') return "%%";
    if (pattern[end] == '0') {
        const auto digit = [&] { return std::isdigit(static_cast<unsigned char>(pattern[end])); };
        ++end;
        if (digit() && pattern[end] != '0') ++end;
        if (end != at + 3) end = at + 1;  // "%0d" is no number of digits
    }
    if (pattern[end] != 'd')
        reject(pattern, fmt::format("found \"{}\"", pattern.substr(at, end - at + 1)));
    return pattern.substr(at, end - at + 1);
}

}  // namespace

FrameNames::FrameNames(const std::string& pattern) {
    const std::size_t name_start = pattern.rfind('/') + 1;  // 0 if there is no folder
    std::string folder, before, after;
    bool numbered = false;
    for (std::size_t at = 0; at < pattern.size();) {
        std::string& text = at < name_start ? folder : numbered ? after : before;
        if (pattern[at] != '%') {
            text += pattern[at++];
            continue;
        }
        const std::string directive = directive_at(pattern, at);
        at += directive.size();
        if (directive == "%%") {
            text += '%';
            continue;
        }
        if (numbered) reject(pattern, "found several numbers");
        if (at <= name_start) reject(pattern, "found a number in the name of the folder");
        numbered = true;
        digits_ = directive.size() > 2 ? directive[2] - '0' : 0;
    }
    if (!numbered) reject(pattern, "found no number");
    folder_ = folder;
    before_ = before;
    after_ = after;
}

std::string FrameNames::name(int frame) const {
    return fmt::format("{}{:0{}}{}", before_, frame, digits_, after_);
}

std::string FrameNames::record_name(const char* series) const {
    return std::filesystem::path(before_ + series + after_).replace_extension(".json").string();
}

}  // namespace lamina
