// SPDX-License-Identifier: Apache-2.0
#include "volume_files/folder_files.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <system_error>

namespace lamina {
namespace {

bool is_digit(char letter) {
    return letter >= '0' && letter <= '9';
}

// Takes the digits, or the other letters, at the beginning of a name.
std::string_view take_run(std::string_view& name) {
    const bool digits = is_digit(name[0]);
    std::size_t count = 0;
    while (count < name.size() && is_digit(name[count]) == digits) ++count;
    const std::string_view run = name.substr(0, count);
    name.remove_prefix(count);
    return run;
}

std::string_view without_zeros(std::string_view digits) {
    return digits.substr(std::min(digits.find_first_not_of('0'), digits.size()));
}

bool comes_before(std::string_view a, std::string_view b) {
    const std::string_view whole_a = a, whole_b = b;
    while (!a.empty() && !b.empty()) {
        std::string_view run_a = take_run(a), run_b = take_run(b);
        if (is_digit(run_a[0]) && is_digit(run_b[0])) {
            run_a = without_zeros(run_a);
            run_b = without_zeros(run_b);
            if (run_a.size() != run_b.size()) return run_a.size() < run_b.size();
        }
        if (run_a != run_b) return run_a < run_b;
    }
    if (a.empty() != b.empty()) return a.empty();
    return whole_a < whole_b;  // names that differ in leading zeros alone
}

}  // namespace

std::vector<std::filesystem::path> files_in_folder(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    std::error_code error;
    for (auto entry = std::filesystem::directory_iterator(folder, error);
         !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
        std::error_code ignored;
        const auto& path = entry->path();
        if (path.filename().string()[0] != '.' && entry->is_regular_file(ignored))
            files.push_back(path);
    }
    std::ranges::sort(files, [](const auto& a, const auto& b) {
        return comes_before(a.filename().string(), b.filename().string());
    });
    return files;
}

}  // namespace lamina
