// SPDX-License-Identifier: Apache-2.0
#include "volume_files/zarr_store.h"

#include <sys/stat.h>

#include <algorithm>
#include <initializer_list>
#include <set>

#include "base/content_hash.h"

namespace lamina {
namespace {

using Path = std::filesystem::path;

ZarrFileState state_of_file(const Path& file) {
    expect_allowed(file);
    struct stat found {};
    if (stat(file.c_str(), &found) != 0) return {};
    ContentHash hash;
    const std::int64_t words[] = {found.st_size, found.st_mtim.tv_sec, found.st_mtim.tv_nsec};
    hash.add(words, sizeof words);
    return {hash.word() | 1,  // not 0
            static_cast<std::uint64_t>(found.st_size), static_cast<std::uint64_t>(found.st_ino),
            found.st_ctim.tv_sec * std::int64_t{1'000'000'000} + found.st_ctim.tv_nsec};
}

// Puts NaN, Infinity and -Infinity in quotes. They are no JSON, but Python's json writes them.
std::string with_quoted_numbers(std::string_view text) {
    std::string quoted;
    bool in_string = false;
    for (std::size_t at = 0; at < text.size(); ++at) {
        if (text[at] == '"') in_string = !in_string;
        if (in_string && text[at] == '\\') quoted += text[at++];
        std::string_view word;
        for (const std::string_view one : {"NaN", "Infinity", "-Infinity"})
            if (!in_string && text.substr(at).starts_with(one)) word = one;
        if (!word.empty()) {
            quoted.append("\"").append(word).append("\"");
            at += word.size() - 1;
        } else if (at < text.size()) {
            quoted += text[at];
        }
    }
    return quoted;
}

}  // namespace

Path archive_of(const Path& path) {
    std::error_code unreadable;
    for (Path above = path; !above.empty(); above = above.parent_path()) {
        if (std::filesystem::is_regular_file(above, unreadable))
            return has_zip_mark(above) ? above : Path();
        if (std::filesystem::exists(above, unreadable) || above == above.parent_path()) break;
    }
    return {};
}

ZarrStore::ZarrStore(const Path& path) : archive_path_(archive_of(path)) {
    std::error_code unreadable;
    if (archive_path_.empty() && std::filesystem::is_regular_file(path, unreadable))
        fail("{}: found a file, expected a folder or a ZIP archive", path.string());
    if (archive_path_.empty()) return;
    expect_allowed(archive_path_);
    archive_ = std::make_shared<const ZipArchive>(archive_path_);
    last_ = std::make_shared<Unpacked>();
}

std::string ZarrStore::member_name(const Path& file) const {
    const Path inside =
        file.lexically_normal().lexically_relative(archive_path_.lexically_normal());
    return inside == "." ? "" : inside.string();
}

const ZipMember& ZarrStore::member(const Path& file) const {
    const ZipMember* const found = archive_->find(member_name(file));
    if (found == nullptr) fail("{}: no such file", file.string());
    return *found;
}

Path ZarrStore::root(const Path& path) const {
    if (!archive_ || path != archive_path_ || has_header(path)) return path;
    std::vector<Path> folders = folders_in(path);
    std::erase_if(folders, [&](const Path& folder) { return !has_header(folder); });
    return folders.size() == 1 ? folders[0] : path;
}

bool ZarrStore::has_header(const Path& folder) const {
    return std::ranges::any_of(
        std::initializer_list<const char*>{"zarr.json", ".zarray", ".zgroup", ".zattrs"},
        [&](const char* name) { return has(folder, name); });
}

bool ZarrStore::has(const Path& folder, const char* file) const {
    if (archive_) return archive_->find(member_name(folder / file)) != nullptr;
    std::error_code unreadable;
    return std::filesystem::exists(folder / file, unreadable);
}

std::vector<Path> ZarrStore::folders_in(const Path& folder) const {
    std::set<Path> folders;
    if (archive_) {
        std::string begin = member_name(folder);
        if (!begin.empty()) begin += '/';
        const auto& members = archive_->members();
        for (auto one = members.lower_bound(begin); one != members.end() &&
                                                    one->first.starts_with(begin) &&
                                                    folders.size() < most_folders;) {
            const std::size_t end = one->first.find('/', begin.size());
            if (end == std::string::npos) {
                ++one;
                continue;
            }
            folders.insert(archive_path_ / one->first.substr(0, end));
            one = members.lower_bound(one->first.substr(0, end) + static_cast<char>('/' + 1));
        }
    } else {
        expect_allowed(folder);
        for (const auto& entry : std::filesystem::directory_iterator(folder)) {
            std::error_code unreadable;  // a link to itself
            if (folders.size() < most_folders && entry.is_directory(unreadable))
                folders.insert(entry.path());
        }
    }
    return {folders.begin(), folders.end()};
}

ZarrFileState ZarrStore::state(const Path& file) const {
    if (!archive_) return state_of_file(file);
    const ZipMember* const found = archive_->find(member_name(file));
    if (found == nullptr) return {};
    ZarrFileState now = state_of_file(archive_path_);
    now.bytes = found->bytes;
    return now;
}

ByteBuffer ZarrStore::read(const Path& file) const {
    return archive_ ? archive_->read(member(file)) : read_large_file(file);
}

// Returns a compressed member, which parts of it need as a whole; the last one stays in memory.
std::shared_ptr<const ByteBuffer> ZarrStore::unpacked(const ZipMember& stored) const {
    const std::lock_guard lock(last_->access);
    if (last_->name != stored.name || !last_->bytes) {
        last_->bytes = nullptr;
        last_->bytes = std::make_shared<const ByteBuffer>(archive_->read(stored));
        last_->name = stored.name;
    }
    return last_->bytes;
}

ByteBuffer ZarrStore::read(const Path& file, std::uint64_t begin, std::uint64_t count) const {
    std::uint64_t first = 0;
    if (archive_) {
        const ZipMember& stored = member(file);
        first = archive_->place_of(stored);
        if (begin > stored.bytes || count > stored.bytes - begin)
            fail("{}: found {} bytes, expected more", file.string(), stored.bytes);
        if (!stored.is_stored()) {
            ByteBuffer part(count);
            unpacked(stored)->text().copy(part.data(), count, begin);
            return part;
        }
    }
    ByteBuffer part(count);
    RandomAccessFile(on_disk(file)).read(first + begin, part.data(), count);
    return part;
}

nlohmann::json ZarrStore::read_object(const Path& file) const {
    expect_allowed(on_disk(file));
    if (const auto bytes = state(file).bytes; bytes > most_json_bytes)
        fail("{}: found {} bytes, expected at most {}", file.string(), bytes, most_json_bytes);
    nlohmann::json object;
    try {
        object = parse_json(with_quoted_numbers(read(file).text()));
    } catch (const JsonSyntaxError& problem) {
        fail("{}: {}", file.string(), problem.what());
    }
    if (!object.is_object())
        fail("{}: found {}, expected an object", file.string(), json_excerpt(object));
    return object;
}

}  // namespace lamina
