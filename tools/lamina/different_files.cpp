// SPDX-License-Identifier: Apache-2.0
#include "different_files.h"

#include <fmt/format.h>

#include "base/error.h"

namespace lamina {

void expect_different_files(const std::vector<std::filesystem::path>& files,
                            const std::string& roles) {
    const auto same = [](const std::filesystem::path& a, const std::filesystem::path& b) {
        std::error_code ignored;
        return !a.empty() && !b.empty() &&
               std::filesystem::weakly_canonical(a, ignored) ==
                   std::filesystem::weakly_canonical(b, ignored);
    };
    for (std::size_t i = 0; i < files.size(); ++i) {
        for (std::size_t k = i + 1; k < files.size(); ++k) {
            if (same(files[i], files[k]))
                throw UsageError(
                    fmt::format("{}: expected different files for {}", files[k].string(), roles));
        }
    }
}

}  // namespace lamina
