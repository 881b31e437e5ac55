// SPDX-License-Identifier: Apache-2.0
#include "study/study_merge.h"

#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "scene/json_reader.h"
#include "study/run_list.h"
#include "study/study_output.h"

namespace lamina {
namespace {

RunList read_list(const StudyFolder& folder) {
    return run_list_from(load_json(folder.run_list()), folder.run_list());
}

// Empty where there is no such file.
std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void copy_whole(const std::filesystem::path& from, const std::filesystem::path& into) {
    AtomicFile copy(into);
    std::ifstream stream(from, std::ios::binary);
    std::vector<char> block(std::size_t{1} << 20);
    while (stream) {
        check_interrupt();
        stream.read(block.data(), static_cast<std::streamsize>(block.size()));
        copy.write(block.data(), static_cast<std::size_t>(stream.gcount()));
    }
    if (!stream.eof()) fail("{}: cannot read", from.string());
    copy.commit();
}

void copy_files(const std::filesystem::path& from, const std::filesystem::path& into) {
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(from, error)) {
        const std::filesystem::path to = into / entry.path().filename();
        const std::string suffix = to.extension().string();
        if ((suffix == ".npy" || suffix == ".json" || suffix == ".exr") &&
            !std::filesystem::exists(to))
            copy_whole(entry.path(), to);
    }
}

}  // namespace

void merge_studies(const std::vector<std::filesystem::path>& from, const StudyFolder& into) {
    const RunList list = read_list(StudyFolder(from.front()));
    std::map<std::string, std::filesystem::path> journals;  // by name
    const auto check = [&](const StudyFolder& folder) {
        const RunList other = read_list(folder);
        if (other.id() != list.id()) {
            fail("{}: holds another study, \"{}\", than {}, \"{}\"", folder.path.string(),
                 other.title, from.front().string(), list.title);
        }
    };
    for (const std::filesystem::path& path : from) {
        const StudyFolder folder(path);
        check(folder);
        for (const auto& journal : folder.journals()) {
            const auto [found, added] = journals.emplace(journal.filename().string(), journal);
            if (!added) {
                fail("{} and {} are the same shard: expected different ones",
                     found->second.string(), journal.string());
            }
        }
    }
    if (std::filesystem::exists(into.run_list())) check(into);
    for (const auto& [name, journal] : journals) {
        if (!bytes_of(journal).starts_with(bytes_of(into.path / name))) {
            fail("{}: holds other records than {}: expected a folder without this shard",
                 (into.path / name).string(), journal.string());
        }
    }
    into.make();
    write_run_list(into, list);
    for (const std::filesystem::path& path : from) {
        const StudyFolder folder(path);
        copy_files(folder.references(), into.references());
        copy_files(folder.pictures(), into.pictures());
    }
    for (const auto& [name, journal] : journals) {
        std::error_code ignored;
        if (!std::filesystem::equivalent(journal, into.path / name, ignored))
            copy_whole(journal, into.path / name);
    }
}

}  // namespace lamina
