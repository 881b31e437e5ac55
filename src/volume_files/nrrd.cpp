// SPDX-License-Identifier: Apache-2.0
#include "volume_files/nrrd.h"

#include "base/input_file.h"
#include "volume_files/nrrd_header.h"

namespace lamina {

bool is_nrrd(const std::filesystem::path& path) {
    return file_beginning(path, 5).starts_with("NRRD0");
}

Volume read_nrrd(const std::filesystem::path& path, const VolumeRequest& request) {
    return open_nrrd(path, request, {});
}

Volume open_nrrd(const std::filesystem::path& path, const VolumeRequest& request,
                 const VolumeUse& use) {
    const NrrdHeader header = read_nrrd_header(path, request);
    return open_stored(header.grid, header.data, use);
}

std::vector<std::filesystem::path> files_of_nrrd(const std::filesystem::path& path) {
    std::vector<std::filesystem::path> files{path};
    for (const auto& data : read_nrrd_header(path).data.files)
        if (data != path) files.push_back(data);
    return files;
}

}  // namespace lamina
