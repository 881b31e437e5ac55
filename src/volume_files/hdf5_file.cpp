// SPDX-License-Identifier: Apache-2.0
#include "volume_files/hdf5_file.h"

#include <fmt/format.h>

#include <memory>
#include <string_view>

#include "base/input_file.h"
#include "volume_files/file_source.h"
#include "volume_files/hdf5_source.h"
#include "volume_files/stored_samples.h"
#include "volume_files/volume_opening.h"

namespace lamina {
namespace {

// "FILE.h5:/PATH" in two; the second is empty where the path is a file's.
struct ArrayPath {
    std::filesystem::path file;
    std::string array;
};

ArrayPath array_path(const std::filesystem::path& path) {
    std::error_code unreadable;
    if (std::filesystem::exists(path, unreadable)) return {path, ""};
    const std::string text = path.string();
    for (std::size_t at = text.find(":/"); at != std::string::npos; at = text.find(":/", at + 1)) {
        const std::filesystem::path file = text.substr(0, at);
        if (std::filesystem::is_regular_file(file, unreadable)) return {file, text.substr(at + 1)};
    }
    return {path, ""};
}

// Tells where the samples of an array lie that its file holds as they are.
StoredData raw_data(const std::filesystem::path& file, const Hdf5Head& head) {
    StoredData data;
    data.path = file;
    data.teller = "the array";
    data.type = head.type;
    for (const std::int64_t size : head.grid.size) data.axes.emplace_back(size);
    for (std::size_t i = 0; i < 2; ++i)
        if (head.outer[i] > 1) data.axes.emplace_back(head.outer[i], head.taken[i], "", true);
    set_byte_order(data, head.raw.big_endian);
    data.files = {file};
    data.offset = head.raw.offset;
    return data;
}

}  // namespace

bool is_hdf5(const std::filesystem::path& path) {
    constexpr std::string_view signature("\x89HDF\r\n\x1a\n", 8);
    const std::filesystem::path file = array_path(path).file;
    std::error_code unreadable;
    if (std::filesystem::is_directory(file, unreadable)) return false;
    const std::string beginning = file_beginning(file, 2048 + signature.size());
    for (const std::size_t at : {0, 512, 1024, 2048}) {
        if (beginning.size() > at && std::string_view(beginning).substr(at).starts_with(signature))
            return true;
    }
    return false;
}

Volume read_hdf5(const std::filesystem::path& path, const VolumeRequest& request) {
    return open_hdf5(path, request, {});
}

Volume open_hdf5(const std::filesystem::path& path, const VolumeRequest& request,
                 const VolumeUse& use) {
    const ArrayPath named = array_path(path);
    expect_regular_file(named.file);
    const Hdf5Place place{named.file.string(), named.array.empty() ? request.array : named.array,
                          request};
    auto process = std::make_unique<Hdf5Process>(place);
    const Hdf5Head& head = process->head();
    const auto type = drawn_type(head.type);
    const bool is_scaled = head.scale != 1 || head.offset != 0;
    if (!type || is_scaled || head.elsewhere) {
        std::string why = fmt::format("its samples are of type {}", name_of(head.type));
        if (is_scaled) why = "its samples are scaled";
        if (head.elsewhere) why = "its samples lie in another file";
        expect_room(path.string(),
                    static_cast<std::uint64_t>(head.grid.sample_count()) * bytes_of(head.type), use,
                    why);
    } else if (stays_in_files(head.grid, *type, use)) {
        if (head.raw.offset < 0 || head.has_missing)
            return stored_volume(head.grid, *type,
                                 std::make_unique<Hdf5Source>(place, std::move(process)));
        return stored_volume(
            head.grid, *type,
            std::make_unique<FileSource>(raw_data(named.file, head), head.grid.size));
    }
    return drawn_volume(head.grid,
                        {path.string(), head.type, process->read_all(), head.scale, head.offset});
}

std::vector<std::filesystem::path> files_of_hdf5(const std::filesystem::path& path) {
    return {array_path(path).file};
}

}  // namespace lamina
