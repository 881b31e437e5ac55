// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/input_file.h"
#include "base/json_text.h"
#include "volume_files/zip_archive.h"

namespace lamina {

// Returns a member of an object, or null if it has none of that name or is no object.
inline const nlohmann::json* member_of(const nlohmann::json& object, const char* key) {
    const auto found = object.is_object() ? object.find(key) : object.end();
    return found == object.end() ? nullptr : &*found;
}

// Returns the text of a member of an object; empty if it has none of that name.
inline std::string text_member(const nlohmann::json& object, const char* key) {
    const nlohmann::json* const found = member_of(object, key);
    return found != nullptr && found->is_string() ? found->get<std::string>() : std::string();
}

// Returns a value as messages show it: one short line.
inline std::string json_excerpt(const nlohmann::json& value) {
    return one_line(json_text(value).substr(0, 100));
}

// The present state of a file; all 0 if there is none.
struct ZarrFileState {
    std::uint64_t state = 0;  // a hash of size and time
    std::uint64_t bytes = 0, inode = 0;
    std::int64_t changed = 0;  // nanoseconds
};

// The files of a Zarr hierarchy: those of folders, or the members of a ZIP archive, which are named
// as if the archive were a folder: "a.zip/0/zarr.json". Safe from any thread. Functions throw
// Error.
class ZarrStore {
  public:
    ZarrStore() = default;
    // `path`: a folder, an archive, or a place in an archive.
    explicit ZarrStore(const std::filesystem::path& path);

    // Returns the folder in which a hierarchy begins: `path`, or, if that is an archive without
    // files of Zarr at its root, the only folder there that has some.
    std::filesystem::path root(const std::filesystem::path& path) const;
    bool has(const std::filesystem::path& folder, const char* file) const;  // never throws
    // Tells if a folder has the header or attributes of a group or array. Never throws.
    bool has_header(const std::filesystem::path& folder) const;
    // Returns the folders in a folder, links to folders too, but at most most_folders.
    static constexpr std::size_t most_folders = 10'000;  // that a search for arrays looks into
    std::vector<std::filesystem::path> folders_in(const std::filesystem::path& folder) const;
    ZarrFileState state(const std::filesystem::path& file) const;
    ByteBuffer read(const std::filesystem::path& file) const;
    // Reads a part of a file, which must have it.
    ByteBuffer read(const std::filesystem::path& file, std::uint64_t begin,
                    std::uint64_t count) const;
    // Reads an object. NaN and infinities without quotes, which Python writes, become words.
    nlohmann::json read_object(const std::filesystem::path& file) const;
    // Returns the file of the disk in which a file of the hierarchy lies.
    std::filesystem::path on_disk(const std::filesystem::path& file) const {
        return archive_ ? archive_path_ : file;
    }

  private:
    std::string member_name(const std::filesystem::path& file) const;
    const ZipMember& member(const std::filesystem::path& file) const;
    std::shared_ptr<const ByteBuffer> unpacked(const ZipMember& stored) const;

    // The compressed member of which a part was read last.
    struct Unpacked {
        std::mutex access;
        std::string name;
        std::shared_ptr<const ByteBuffer> bytes;
    };

    std::filesystem::path archive_path_;
    std::shared_ptr<const ZipArchive> archive_;  // null: files in folders
    std::shared_ptr<Unpacked> last_;
};

// Returns the archive in which a path lies, or is itself; empty if none. Never throws.
std::filesystem::path archive_of(const std::filesystem::path& path);

}  // namespace lamina
