// SPDX-License-Identifier: Apache-2.0
#include "volume_files/raw_volume.h"

#include "base/error.h"
#include "volume_files/plain_grid.h"
#include "volume_files/stored_data.h"

namespace lamina {

Volume read_raw(const std::filesystem::path& path, const VolumeRequest& request) {
    return open_raw(path, request, {});
}

Volume open_raw(const std::filesystem::path& path, const VolumeRequest& request,
                const VolumeUse& use) {
    const RawLayout& raw = *request.raw;
    const auto type = value_type_of(raw.type);
    if (!type) {
        fail("{}: type: found \"{}\", expected one of {}", path.string(), raw.type,
             value_type_list());
    }
    StoredData data;
    data.path = path;
    data.teller = "the layout";
    data.type = *type;
    for (const std::int64_t size : raw.size) {
        if (size < 1)
            fail("{}: size: found {}, expected three numbers above 0", path.string(), size);
        data.axes.emplace_back(size);
    }
    set_byte_order(data, raw.big_endian);
    data.files = {path};
    data.byte_skip = raw.offset;
    return open_stored(plain_grid(raw.size), data, use);
}

}  // namespace lamina
