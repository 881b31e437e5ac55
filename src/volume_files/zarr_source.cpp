// SPDX-License-Identifier: Apache-2.0
#include "volume_files/zarr_source.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <thread>

#include "base/content_hash.h"
#include "base/memory_limit.h"
#include "volume_files/stored_samples.h"

namespace lamina {
namespace {

// Of decoded chunks: an eighth of the memory limit, up to this; more where that is less than two a
// thread.
constexpr std::uint64_t most_kept = std::uint64_t{1} << 26;

}  // namespace

ZarrSource::ZarrSource(ZarrChunks chunks)
    : chunks_(std::move(chunks)), header_(FileState::of(chunks_.array().folder / ".zarray")) {}

std::array<std::int64_t, 3> ZarrSource::block() const {
    return {chunks_.edge()[2], chunks_.edge()[1], chunks_.edge()[0]};
}

std::uint64_t ZarrSource::memory() const {
    const std::uint64_t fewest = 2 * std::max(1u, std::thread::hardware_concurrency());
    return std::max(std::min(most_kept, memory_limit() / 8), fewest * chunks_.chunk_bytes());
}

template <typename Visit>
void ZarrSource::for_each_chunk(const SampleBox& box, const Visit& visit) const {
    ZarrChunks::Triple first{}, last{};
    for (std::size_t i = 0; i < 3; ++i) {
        first[i] = box.first[2 - i] / chunks_.edge()[i];
        last[i] = (box.first[2 - i] + box.size[2 - i] - 1) / chunks_.edge()[i];
    }
    for (std::int64_t z = first[0]; z <= last[0]; ++z) {
        for (std::int64_t y = first[1]; y <= last[1]; ++y) {
            for (std::int64_t x = first[2]; x <= last[2]; ++x) visit(chunks_.number_of({z, y, x}));
        }
    }
}

// The chunk's place among the kept ones; the one used least recently makes room for it.
std::shared_ptr<ZarrSource::Kept> ZarrSource::kept(std::int64_t chunk) const {
    const std::lock_guard lock(access_);
    std::shared_ptr<Kept>& found = decoded_[chunk];
    if (!found) found = std::make_shared<Kept>();
    found->used = ++clock_;
    const std::shared_ptr<Kept> result = found;
    if (decoded_.size() * chunks_.chunk_bytes() > memory()) {
        const auto oldest = std::ranges::min_element(
            decoded_, {}, [](const auto& each) { return each.second->used; });
        decoded_.erase(oldest);
    }
    return result;
}

void ZarrSource::read(const SampleBox& box, void* to) const {
    for_each_chunk(box, [&](std::int64_t chunk) {
        const std::shared_ptr<Kept> one = kept(chunk);
        std::call_once(one->once, [&] { one->samples = chunks_.decoded(chunk); });
        chunks_.copy(one->samples, chunk, box, static_cast<char*>(to));
    });
    const ZarrArray& array = chunks_.array();
    if (array.swap) swap_bytes_alone(to, box.count(), bytes_of(array.type));
}

bool ZarrSource::known_as_zero(const SampleBox& box) const {
    if (chunks_.array().fill != 0) return false;
    bool zero = true;
    for_each_chunk(box, [&](std::int64_t chunk) { zero = zero && chunks_.state(chunk) == 0; });
    return zero;
}

std::string ZarrSource::name() const {
    return fmt::format("{} {} {}", std::filesystem::absolute(chunks_.array().folder).string(),
                       fmt::join(chunks_.size(), " "), chunks_.selection_text());
}

std::string ZarrSource::identity() const {
    ContentHash hash;
    hash.add(name());
    hash.add(header_.text());
    for (std::int64_t chunk = 0; chunk < chunks_.count(); ++chunk) {
        const std::uint64_t state = chunks_.state(chunk);
        hash.add(&state, sizeof state);
    }
    return hash.hex();
}

}  // namespace lamina
