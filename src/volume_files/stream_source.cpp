// SPDX-License-Identifier: Apache-2.0
#include "volume_files/stream_source.h"

#include <algorithm>

#include "base/error.h"
#include "volume_files/stored_samples.h"

namespace lamina {

bool StreamSource::can_read(const StoredData& data) {
    const auto axes = std::ranges::count_if(
        data.axes, [](const StoredAxis& axis) { return !axis.taken.has_value(); });
    const bool packed = data.encoding == DataEncoding::gzip || data.encoding == DataEncoding::bzip2;
    return packed && axes == 3 && drawn_type(data.type) && !data.is_scaled();
}

StreamSource::StreamSource(const StoredData& data, const std::array<std::int64_t, 3>& size)
    : data_(data), reader_(data_), file_(FileState::of(data.files.front())), slices_(size[2]) {
    say_taken(data.path.string(), data.axes);
    const auto last = std::ranges::find_if(data_.axes.rbegin(), data_.axes.rend(),
                                           [](const StoredAxis& axis) { return !axis.taken; });
    inner_.assign(data_.axes.begin(), last.base());
    outer_.assign(last.base(), data_.axes.end());
    bytes_ = reader_.open_all();
    skip_outer(true);
}

// What of the axes behind z is not taken, before the samples or after them.
void StreamSource::skip_outer(bool is_before) const {
    std::size_t bytes = stored_bytes(data_.path.string(), inner_, bytes_of(data_.type));
    for (const StoredAxis& axis : outer_) {
        const std::int64_t count = is_before ? *axis.taken : axis.size - 1 - *axis.taken;
        bytes_->skip(static_cast<std::size_t>(count) * bytes);
        bytes *= static_cast<std::size_t>(axis.size);
    }
}

void StreamSource::read(const SampleBox& box, void* to) const {
    if (box.first[2] != next_)
        fail("{}: slice {} is read after slice {}", data_.path.string(), box.first[2], next_ - 1);
    std::vector<StoredAxis> axes = inner_;
    axes.back().size = box.size[2];
    read_taken(*bytes_, axes, bytes_of(data_.type), to);
    if (data_.swap_bytes) swap_bytes(to, box.count(), bytes_of(data_.type));
    next_ += box.size[2];
    if (next_ < slices_) return;
    skip_outer(false);
    reader_.warn_of_surplus(*bytes_);
}

}  // namespace lamina
