// SPDX-License-Identifier: Apache-2.0
// Checks that no two types have the same name. Two definitions of a type in one program are
// undefined behaviour, which no compiler reports.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

namespace lamina {
namespace {

namespace fs = std::filesystem;

// Returns the types that a file defines in named namespaces, as "namespace::Type". Definitions of
// types begin at the start of a line, those of members do not.
std::set<std::string> types_of(const fs::path& file) {
    static const std::regex opened("namespace ([A-Za-z_0-9:]*) ?\\{.*");
    static const std::regex type(
        "(?:template ?<.*> ?)?(?:struct|class|enum class|enum) (?:LAMINA_API "
        ")?([A-Za-z_][A-Za-z_0-9]*)(?: "
        "final)?(?: ?:[^:].*| ?\\{.*)");
    std::set<std::string> found;
    std::vector<std::string> spaces;
    std::ifstream stream(file);
    std::smatch match;
    for (std::string line; std::getline(stream, line);) {
        if (std::regex_match(line, match, opened) && line.find('}') == std::string::npos) {
            spaces.push_back(match[1]);
        } else if (line == "LAMINA_SIMD_BEGIN") {
            spaces.push_back("lamina::one instruction set");
        } else if ((line.starts_with("}  // namespace") || line == "LAMINA_SIMD_END") &&
                   !spaces.empty()) {
            spaces.pop_back();
        } else if (std::regex_match(line, match, type)) {
            std::string name;
            bool hidden = false;
            for (const std::string& space : spaces) {
                hidden = hidden || space.empty();
                name += space + "::";
            }
            if (!hidden) found.insert(name + match[1].str());
        }
    }
    return found;
}

TEST(Names, StandForOneTypeEach) {
    std::map<std::string, std::string> defined_in;
    for (const char* const folder : {"include", "src", "tools"}) {
        for (const auto& entry :
             fs::recursive_directory_iterator(fs::path(LAMINA_SOURCE_DIR) / folder)) {
            const std::string extension = entry.path().extension();
            if (extension != ".h" && extension != ".cpp") continue;
            for (const std::string& type : types_of(entry.path())) {
                const auto [first, added] = defined_in.emplace(type, entry.path().string());
                EXPECT_TRUE(added) << type << ": " << first->second << " and " << entry.path();
            }
        }
    }
    EXPECT_GT(defined_in.size(), 300u);
    EXPECT_TRUE(defined_in.contains("lamina::TransferFunction"));
}

}  // namespace
}  // namespace lamina
