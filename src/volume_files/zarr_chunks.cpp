// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <cstring>

#include "base/error.h"
#include "base/file_bytes.h"
#include "base/parallel.h"
#include "base/warning.h"
#include "volume_files/stored_axes.h"
#include "volume_files/stored_samples.h"
#include "volume_files/zarr_array.h"

namespace lamina {
namespace {

using Triple = std::array<std::int64_t, 3>;  // of z, y, x

constexpr std::int64_t most_chunks = 1'000'000;

template <typename Word>
void copy_row(const char* from, std::size_t step, char* to, std::int64_t count) {
    for (std::int64_t i = 0; i < count; ++i)
        std::memcpy(to + static_cast<std::size_t>(i) * sizeof(Word),
                    from + static_cast<std::size_t>(i) * step, sizeof(Word));
}

// Reads the chunks that hold what is selected.
class ZarrReader {
  public:
    ZarrReader(const ZarrArray& array, const ZarrSelection& selection)
        : array_(array), selection_(selection), bytes_(bytes_of(array.type)) {
        for (std::size_t i = 0; i < 3; ++i) {
            const int axis = selection.axes[i];
            if (axis < 0) continue;
            const auto at = static_cast<std::size_t>(axis);
            size_[i] = array.shape[at];
            edge_[i] = array.chunks[at];
            counts_[i] = array.chunk_count(at);
        }
    }

    std::shared_ptr<void> read() {
        const std::size_t bytes = checked_bytes();
        const std::shared_ptr<void> memory = sample_memory(bytes);
        to_ = static_cast<char*>(memory.get());
        parallel_for(chunk_total(), 1, [&](std::int64_t chunk) { read_chunk(chunk); });
        if (array_.swap) swap_bytes(to_, static_cast<std::int64_t>(bytes / bytes_), bytes_);
        if (missing_ > 0) {
            warn(fmt::format("{}: {} of {} chunks are not there: they have the fill value {}",
                             array_.folder.string(), missing_.load(), chunk_total(), array_.fill));
        }
        return memory;
    }

  private:
    std::int64_t chunk_total() const { return counts_[0] * counts_[1] * counts_[2]; }

    // What the volume takes; the files must be able to hold that.
    std::size_t checked_bytes() const {
        const std::string name = array_.folder.string();
        std::int64_t total = 1;
        for (const std::int64_t count : counts_) {
            if (__builtin_mul_overflow(total, count, &total) || total > most_chunks) {
                fail("{}: chunks: found {} x {} x {} of them, expected at most {}", name,
                     counts_[2], counts_[1], counts_[0], most_chunks);
            }
        }
        const StoredAxis axes[] = {{size_[2], {}}, {size_[1], {}}, {size_[0], {}}};
        const std::size_t bytes = stored_bytes(name, axes, bytes_);
        std::size_t there = 0;
        for (std::int64_t chunk = 0; chunk < total; ++chunk) {
            if ((chunk & 0xfff) == 0) check_interrupt();
            std::error_code missing;
            const std::uintmax_t size = std::filesystem::file_size(file_of(chunk), missing);
            if (!missing) there += size;
        }
        if (there == 0) {
            fail("{}: found no chunk, expected files as {}", name,
                 file_of(0).lexically_relative(array_.folder).string());
        }
        if (bytes / most_chunk_expansion > there) {
            fail("{}: the array promises {} bytes, its chunks have {}, which cannot hold them",
                 name, bytes, there);
        }
        return bytes;
    }

    Triple place_of(std::int64_t chunk) const {
        return {chunk / (counts_[1] * counts_[2]), chunk / counts_[2] % counts_[1],
                chunk % counts_[2]};
    }

    std::filesystem::path file_of(std::int64_t chunk) const {
        const Triple place = place_of(chunk);
        std::string name;
        for (std::size_t axis = 0; axis < array_.shape.size(); ++axis) {
            std::int64_t number = selection_.index[axis] / array_.chunks[axis];
            for (std::size_t i = 0; i < 3; ++i) {
                if (selection_.axes[i] == static_cast<int>(axis)) number = place[i];
            }
            if (axis > 0) name += array_.separator;
            name += std::to_string(number);
        }
        return array_.folder / name;
    }

    // Bytes between neighbours along an axis in a chunk.
    std::size_t step_of(std::size_t axis) const {
        std::size_t step = bytes_;
        for (std::size_t i = 0; i < array_.chunks.size(); ++i) {
            if (array_.fortran ? i < axis : i > axis)
                step *= static_cast<std::size_t>(array_.chunks[i]);
        }
        return step;
    }

    void read_chunk(std::int64_t chunk) {
        const std::filesystem::path file = file_of(chunk);
        ByteBuffer samples(static_cast<std::size_t>(array_.chunk_samples()) * bytes_);
        if (std::filesystem::exists(file)) {
            const ByteBuffer stored = read_large_file(file);
            if (samples.size() / most_chunk_expansion > stored.size()) {
                fail("{}: found {} bytes, which cannot hold the {} of a chunk", file.string(),
                     stored.size(), samples.size());
            }
            decode_chunk(array_.codec, stored.text(), samples.span(), file.string());
        } else {
            ++missing_;
            fill(samples);
        }
        copy(samples.data(), place_of(chunk));
    }

    // In the byte order of the file, as the other samples are.
    void fill(ByteBuffer& samples) const {
        with_type(array_.type, [&](auto zero) {
            using Value = decltype(zero);
            Value value = fill_as<Value>();
            char word[sizeof(Value)];
            std::memcpy(word, &value, sizeof(Value));
            if (array_.swap) std::reverse(word, word + sizeof(Value));
            for (std::size_t at = 0; at < samples.size(); at += sizeof(Value))
                std::memcpy(samples.data() + at, word, sizeof(Value));
        });
    }

    template <typename Value>
    Value fill_as() const {
        if constexpr (std::is_floating_point_v<Value>) {
            return static_cast<Value>(array_.fill);
        } else {
            // Whole numbers beyond the type are none that its samples could have.
            const double most = static_cast<double>(std::numeric_limits<Value>::max());
            const double least = static_cast<double>(std::numeric_limits<Value>::min());
            if (!(array_.fill >= least && array_.fill <= most)) {
                fail("{}: fill_value: found {}, expected one that {} holds",
                     (array_.folder / ".zarray").string(), array_.fill, name_of(array_.type));
            }
            return array_.fill >= most ? std::numeric_limits<Value>::max()
                                       : static_cast<Value>(array_.fill);
        }
    }

    void copy(const char* samples, const Triple& place) const {
        for (std::size_t axis = 0; axis < array_.shape.size(); ++axis) {
            if (std::ranges::count(selection_.axes, static_cast<int>(axis)) > 0) continue;
            samples += static_cast<std::size_t>(selection_.index[axis] % array_.chunks[axis]) *
                       step_of(axis);
        }
        Triple begin{}, count{};
        std::array<std::size_t, 3> step{};
        for (std::size_t i = 0; i < 3; ++i) {
            begin[i] = place[i] * edge_[i];
            count[i] = std::min(edge_[i], size_[i] - begin[i]);
            const int axis = selection_.axes[i];
            step[i] = axis < 0 ? 0 : step_of(static_cast<std::size_t>(axis));
        }
        for (std::int64_t z = 0; z < count[0]; ++z) {
            for (std::int64_t y = 0; y < count[1]; ++y) {
                const char* const from = samples + static_cast<std::size_t>(z) * step[0] +
                                         static_cast<std::size_t>(y) * step[1];
                const std::int64_t row = (begin[0] + z) * size_[1] + begin[1] + y;
                copy_samples(from, step[2],
                             to_ + static_cast<std::size_t>(row * size_[2] + begin[2]) * bytes_,
                             count[2]);
            }
        }
    }

    void copy_samples(const char* from, std::size_t step, char* to, std::int64_t count) const {
        if (step == bytes_) {
            std::memcpy(to, from, static_cast<std::size_t>(count) * bytes_);
            return;
        }
        with_type(array_.type, [&](auto zero) { copy_row<decltype(zero)>(from, step, to, count); });
    }

    const ZarrArray& array_;
    const ZarrSelection& selection_;
    std::size_t bytes_;  // of a sample
    Triple size_{1, 1, 1}, edge_{1, 1, 1}, counts_{1, 1, 1};
    char* to_ = nullptr;
    std::atomic<std::int64_t> missing_ = 0;
};

}  // namespace

std::shared_ptr<void> read_zarr_samples(const ZarrArray& array, const ZarrSelection& selection) {
    return ZarrReader(array, selection).read();
}

}  // namespace lamina
