// SPDX-License-Identifier: Apache-2.0
#include "volume_files/chunked_source.h"

#include <algorithm>
#include <cstring>
#include <thread>

#include "base/memory.h"
#include "volume/brick_cache.h"

namespace lamina {
namespace {

// Of decoded chunks: an eighth of the memory limit, up to this; more where the chunks that one row
// of bricks touches take more, up to a quarter; and two a thread at least.
constexpr std::uint64_t most_kept = std::uint64_t{1} << 26;

using Triple = std::array<std::int64_t, 3>;

// `count`: of all chunks along each axis.
std::uint64_t bytes_to_keep(const Triple& edge, const Triple& count, std::uint64_t chunk_bytes) {
    std::int64_t touched = count[0];  // by a row of bricks, read before the next row is
    for (const std::size_t axis : {1, 2})
        touched *= std::min(count[axis], BrickCache::samples / edge[axis] + 2);
    const std::uint64_t limit = memory_limit();
    const std::uint64_t row = static_cast<std::uint64_t>(touched) * chunk_bytes;
    const std::uint64_t fewest = 2 * std::max(1u, std::thread::hardware_concurrency());
    return std::max(
        {std::min(most_kept, limit / 8), std::min(row, limit / 4), fewest * chunk_bytes});
}

}  // namespace

ChunkedSource::ChunkedSource(const Triple& size, const Triple& edge, std::size_t sample_bytes)
    : size_(size), edge_(edge), sample_bytes_(sample_bytes), chunk_bytes_(sample_bytes) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        count_[axis] = (size_[axis] + edge_[axis] - 1) / edge_[axis];
        chunk_bytes_ *= static_cast<std::size_t>(edge_[axis]);
    }
    most_kept_ = bytes_to_keep(edge_, count_, chunk_bytes_);
}

template <typename Visit>
void ChunkedSource::for_each_chunk(const SampleBox& box, const Visit& visit) const {
    std::array<std::int64_t, 3> first{}, last{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        first[axis] = box.first[axis] / edge_[axis];
        last[axis] = (box.first[axis] + box.size[axis] - 1) / edge_[axis];
    }
    for (std::int64_t z = first[2]; z <= last[2]; ++z) {
        for (std::int64_t y = first[1]; y <= last[1]; ++y) {
            for (std::int64_t x = first[0]; x <= last[0]; ++x) {
                SampleBox own{{x * edge_[0], y * edge_[1], z * edge_[2]}, edge_};
                for (std::size_t axis = 0; axis < 3; ++axis)
                    own.size[axis] = std::min(edge_[axis], size_[axis] - own.first[axis]);
                visit((z * count_[1] + y) * count_[0] + x, own);
            }
        }
    }
}

// The chunk's place among the kept ones; the one used least recently makes room for it.
std::shared_ptr<ChunkedSource::Kept> ChunkedSource::kept(std::int64_t chunk) const {
    const std::lock_guard lock(access_);
    std::shared_ptr<Kept>& found = decoded_[chunk];
    if (!found) found = std::make_shared<Kept>();
    found->used = ++clock_;
    const std::shared_ptr<Kept> result = found;
    if (decoded_.size() * chunk_bytes_ > most_kept_) {
        const auto oldest = std::ranges::min_element(
            decoded_, {}, [](const auto& each) { return each.second->used; });
        decoded_.erase(oldest);
    }
    return result;
}

void ChunkedSource::copy_part(const char* chunk, const SampleBox& from, const SampleBox& box,
                              char* to) const {
    std::array<std::int64_t, 3> begin{}, count{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        begin[axis] = std::max(from.first[axis], box.first[axis]);
        count[axis] =
            std::min(from.first[axis] + from.size[axis], box.first[axis] + box.size[axis]) -
            begin[axis];
    }
    const auto place_in = [&](const SampleBox& whole, std::int64_t y, std::int64_t z) {
        return static_cast<std::size_t>(
                   ((z - whole.first[2]) * whole.size[1] + y - whole.first[1]) * whole.size[0] +
                   begin[0] - whole.first[0]) *
               sample_bytes_;
    };
    const std::size_t row_bytes = static_cast<std::size_t>(count[0]) * sample_bytes_;
    for (std::int64_t z = begin[2]; z < begin[2] + count[2]; ++z)
        for (std::int64_t y = begin[1]; y < begin[1] + count[1]; ++y)
            std::memcpy(to + place_in(box, y, z), chunk + place_in(from, y, z), row_bytes);
}

void ChunkedSource::read(const SampleBox& box, void* to) const {
    for_each_chunk(box, [&](std::int64_t chunk, const SampleBox& own) {
        const std::shared_ptr<Kept> one = kept(chunk);
        std::call_once(one->once, [&] {
            ByteBuffer samples(static_cast<std::size_t>(own.count()) * sample_bytes_);
            decode(chunk, own, samples.data());
            one->samples = std::move(samples);
        });
        copy_part(one->samples.data(), own, box, static_cast<char*>(to));
    });
}

bool ChunkedSource::known_as_zero(const SampleBox& box) const {
    bool zero = true;
    for_each_chunk(box,
                   [&](std::int64_t chunk, const SampleBox&) { zero = zero && is_zero(chunk); });
    return zero;
}

}  // namespace lamina
