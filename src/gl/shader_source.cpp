// SPDX-License-Identifier: Apache-2.0
#include "gl/shader_source.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <sstream>

#include <fmt/ranges.h>
#include "base/error.h"

namespace lamina::gl {

namespace {

std::optional<std::string> find_in_override(const std::string& name) {
    const char* directory = std::getenv("LAMINA_SHADER_DIR");
    if (!directory || !*directory) return std::nullopt;
    std::error_code ignored;
    if (!std::filesystem::is_directory(directory, ignored))
        fail("{}: no such folder (LAMINA_SHADER_DIR)", directory);
    const std::filesystem::path path = std::filesystem::path(directory) / name;
    if (!std::filesystem::is_regular_file(path, ignored)) return std::nullopt;
    std::ifstream file(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(file), {}};
    if (!file) fail("{}: cannot be read (LAMINA_SHADER_DIR)", path.string());
    return text;
}

}  // namespace

std::vector<std::string> shader_names() {
    std::vector<std::string> names;
    for (const EmbeddedFile& shader : embedded_shaders()) names.emplace_back(shader.name);
    return names;
}

std::optional<std::string> find_shader(const std::string& name) {
    if (auto text = find_in_override(name)) return text;
    for (const EmbeddedFile& shader : embedded_shaders()) {
        if (shader.name == name) return std::string(shader.text);
    }
    return std::nullopt;
}

namespace {

// Returns the word after the line's '#', such as "include" or "version". It is empty if the line is
// no directive. It is searched for by hand, because a regular expression for each line takes more
// time than all else that composes a shader.
std::string directive_of(const std::string& line) {
    constexpr const char* space = " \t\v\f\r\n";
    const std::size_t sign = line.find_first_not_of(space);
    if (sign == std::string::npos || line[sign] != '#') return {};
    const std::size_t first = line.find_first_not_of(space, sign + 1);
    if (first == std::string::npos) return {};
    const auto is_of_word = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
    return {line.begin() + static_cast<std::ptrdiff_t>(first),
            std::find_if_not(line.begin() + static_cast<std::ptrdiff_t>(first), line.end(),
                             is_of_word)};
}

class Composer {
  public:
    Composer(const ShaderFinder& find, ShaderSource& source) : find_(find), source_(source) {}

    void append_main() {
        append_file(source_.name, "shader");
        if (!has_version_) fail_without_version();
    }

  private:
    // `wanted_by` begins the message if the file is missing.
    void append_file(const std::string& name, const std::string& wanted_by) {
        const std::optional<std::string> text = find_(name);
        if (!text) fail("{}: no such shader file: {}", wanted_by, name);
        open_.push_back(name);
        std::istringstream lines(*text);
        std::string line;
        for (int number = 1; std::getline(lines, line); ++number) append_line(line, {name, number});
        open_.pop_back();
    }

    void append_line(const std::string& line, const ShaderLine& place) {
        const std::string directive = directive_of(line);
        if (!has_version_ && !directive.empty()) {
            append_version(line, place);
        } else if (directive == "include") {
            append_include(line, place);
        } else {
            append_text(line, place);
        }
    }

    void append_text(const std::string& line, const ShaderLine& place) {
        source_.text += line + '\n';
        source_.lines.push_back(place);
    }

    void append_version(const std::string& line, const ShaderLine& place) {
        static const std::regex pattern("^\\s*#\\s*version\\s+450\\s+core\\s*(//.*)?$");
        if (!std::regex_match(line, pattern)) fail_without_version();
        has_version_ = true;
        append_text("#version 450 core", place);
        // Without this pragma NVIDIA's compiler turns (1 - p) - q into 1 - (p + q), and small
        // opacities lose their digits. Other compilers ignore it (GLSL 4.50, 3.3).
        append_text("#pragma optionNV(fastmath off)", place);
        for (const auto& [name, value] : source_.defines.list) {
            append_text("#define " + name + ' ' + value, place);
        }
    }

    [[noreturn]] void fail_without_version() const {
        fail("shader {}: expected '#version 450 core' as the first directive", source_.name);
    }

    void append_include(const std::string& line, const ShaderLine& place) {
        static const std::regex pattern("^\\s*#\\s*include\\s*\"([^\"]+)\"\\s*(//.*)?$");
        const std::string where = fmt::format("shader {}:{}", place.file, place.number);
        std::smatch match;
        if (!std::regex_match(line, match, pattern)) {
            fail("{}: expected #include \"FILE\", found '{}'", where, one_line(line));
        }
        const std::string name = match[1];
        if (std::find(open_.begin(), open_.end(), name) != open_.end()) {
            fail("{}: {} includes itself: {} -> {}", where, name, fmt::join(open_, " -> "), name);
        }
        // Repeated includes are left to the preprocessor: only it knows which #if branches are
        // alive.
        const std::string guard = guard_of(name);
        append_text("#ifndef " + guard, place);
        append_text("#define " + guard, place);
        append_file(name, where);
        append_text("#endif", place);
    }

    std::string guard_of(const std::string& name) {
        const auto number = guards_.try_emplace(name, guards_.size()).first->second;
        return fmt::format("INCLUDED_FILE_{}", number);
    }

    const ShaderFinder& find_;
    ShaderSource& source_;
    std::vector<std::string> open_;  // the chain of includes, the main file first
    std::map<std::string, std::size_t> guards_;
    bool has_version_ = false;
};

}  // namespace

Defines& Defines::set(std::string name, std::string value) {
    list.emplace_back(std::move(name), std::move(value));
    return *this;
}

Defines& Defines::set(std::string name, int value) {
    return set(std::move(name), std::to_string(value));
}

ShaderSource compose_shader(const std::string& name, const Defines& defines) {
    return compose_shader(name, defines, find_shader);
}

ShaderSource compose_shader(const std::string& name, const Defines& defines,
                            const ShaderFinder& find) {
    ShaderSource source{name, {}, defines, {}};
    Composer(find, source).append_main();
    return source;
}

std::string readable_log(const std::string& log, const ShaderSource& source) {
    // Positions look like "0:12(3): error: ..." (Mesa), "0(12) : error ..." (NVIDIA) or "ERROR:
    // 0:12: ..." (glslang).
    static const std::regex place(
        "^(?:ERROR: |WARNING: )?\\d+[:(](\\d{1,8})(?:\\(\\d+\\)|\\))?\\s*:\\s*");
    std::string text;
    std::istringstream lines(log);
    std::string line;
    while (std::getline(lines, line)) {
        std::smatch match;
        if (std::regex_search(line, match, place)) {
            const std::size_t number = std::stoul(match[1]);
            if (number >= 1 && number <= source.lines.size()) {
                const ShaderLine& origin = source.lines[number - 1];
                line = fmt::format("{}:{}: {}", origin.file, origin.number, match.suffix().str());
            }
        }
        text += line + ' ';
    }
    return one_line(text);
}

}  // namespace lamina::gl
