// SPDX-License-Identifier: Apache-2.0
#include "volume_files/zarr_source.h"

#include <fmt/ranges.h>

#include "base/content_hash.h"
#include "volume_files/stored_samples.h"

namespace lamina {
namespace {

std::array<std::int64_t, 3> x_first(const ZarrChunks::Triple& of) {
    return {of[2], of[1], of[0]};
}

}  // namespace

ZarrSource::ZarrSource(ZarrChunks chunks)
    : ChunkedSource(x_first(chunks.size()), x_first(chunks.edge()), bytes_of(chunks.array().type)),
      chunks_(std::move(chunks)),
      header_(FileState::of(chunks_.array().folder / ".zarray")) {}

void ZarrSource::decode(std::int64_t chunk, const SampleBox& box, void* to) const {
    chunks_.copy(chunks_.decoded(chunk), chunk, box, static_cast<char*>(to));
    const ZarrArray& array = chunks_.array();
    if (array.swap) swap_bytes_alone(to, box.count(), bytes_of(array.type));
}

bool ZarrSource::is_zero(std::int64_t chunk) const {
    return chunks_.array().fill == 0 && chunks_.state(chunk) == 0;
}

std::string ZarrSource::name() const {
    return fmt::format("{} {} {}", std::filesystem::absolute(chunks_.array().folder).string(),
                       fmt::join(chunks_.size(), " "), chunks_.selection_text());
}

std::string ZarrSource::identity() const {
    ContentHash hash;
    hash.add(name());
    hash.add(header_.text());
    const std::uint64_t files = chunks_.files();
    hash.add(&files, sizeof files);
    return hash.hex();
}

}  // namespace lamina
