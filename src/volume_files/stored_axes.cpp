// SPDX-License-Identifier: Apache-2.0
#include "volume_files/stored_axes.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "base/client.h"
#include "base/error.h"

namespace lamina {
namespace {

using Axes = std::span<const StoredAxis>;

// Arrays up to this size are read as a whole and cut up in memory.
constexpr std::size_t scratch_bytes = std::size_t{1} << 22;

std::size_t product(Axes axes, std::size_t value_bytes) {
    for (const StoredAxis& axis : axes) value_bytes *= static_cast<std::size_t>(axis.size);
    return value_bytes;
}

bool takes_all(Axes axes) {
    return std::ranges::none_of(axes,
                                [](const StoredAxis& axis) { return axis.taken.has_value(); });
}

template <std::size_t bytes>
char* gather_values(const char* from, const StoredAxis& channels, std::int64_t count, char* to) {
    from += static_cast<std::size_t>(*channels.taken) * bytes;
    const std::size_t step = static_cast<std::size_t>(channels.size) * bytes;
    for (std::int64_t i = 0; i < count; ++i, from += step, to += bytes)
        std::memcpy(to, from, bytes);
    return to;
}

// One value of each sample along the second axis; copies of known size are one instruction each.
char* gather_row(const char* from, Axes axes, std::size_t value_bytes, char* to) {
    switch (value_bytes) {
        case 1:
            return gather_values<1>(from, axes[0], axes[1].size, to);
        case 2:
            return gather_values<2>(from, axes[0], axes[1].size, to);
        case 4:
            return gather_values<4>(from, axes[0], axes[1].size, to);
        default:
            return gather_values<8>(from, axes[0], axes[1].size, to);
    }
}

// Copies what is taken of the array at `from` and returns the end of the copy.
char* gather(const char* from, Axes axes, std::size_t value_bytes, char* to) {
    if (takes_all(axes)) {
        const std::size_t bytes = product(axes, value_bytes);
        std::memcpy(to, from, bytes);
        return to + bytes;
    }
    if (axes.size() == 2 && axes[0].taken && !axes[1].taken)
        return gather_row(from, axes, value_bytes, to);
    const Axes inner = axes.first(axes.size() - 1);
    const StoredAxis& outer = axes.back();
    const std::size_t step = product(inner, value_bytes);
    const std::int64_t first = outer.taken.value_or(0);
    const std::int64_t end = outer.taken ? first + 1 : outer.size;
    for (std::int64_t i = first; i < end; ++i)
        to = gather(from + static_cast<std::size_t>(i) * step, inner, value_bytes, to);
    return to;
}

class TakenReader {
  public:
    TakenReader(ByteReader& reader, std::size_t value_bytes, char* to)
        : reader_(reader), value_bytes_(value_bytes), to_(to) {}

    void read(Axes axes) {
        check_interrupt();
        const std::size_t bytes = product(axes, value_bytes_);
        if (takes_all(axes)) {
            reader_.read(to_, bytes);
            to_ += bytes;
            return;
        }
        const Axes inner = axes.first(axes.size() - 1);
        const StoredAxis& outer = axes.back();
        const std::size_t inner_bytes = product(inner, value_bytes_);
        if (bytes <= scratch_bytes) {
            scratch_.resize(bytes);
            reader_.read(scratch_.data(), bytes);
            to_ = gather(scratch_.data(), axes, value_bytes_, to_);
        } else if (outer.taken) {
            reader_.skip(static_cast<std::size_t>(*outer.taken) * inner_bytes);
            read(inner);
            reader_.skip(static_cast<std::size_t>(outer.size - *outer.taken - 1) * inner_bytes);
        } else {
            read_pieces(axes, inner_bytes);
        }
    }

  private:
    // As many steps along the last axis at once as fit the scratch memory.
    void read_pieces(Axes axes, std::size_t inner_bytes) {
        std::vector<StoredAxis> piece(axes.begin(), axes.end());
        const auto most = static_cast<std::int64_t>(
            std::max<std::size_t>(1, scratch_bytes / std::max<std::size_t>(1, inner_bytes)));
        for (std::int64_t done = 0; done < axes.back().size; done += piece.back().size) {
            piece.back().size = std::min(most, axes.back().size - done);
            read(piece.back().size == 1 ? axes.first(axes.size() - 1) : Axes(piece));
        }
    }

    ByteReader& reader_;
    std::size_t value_bytes_;
    char* to_;
    std::vector<char> scratch_;
};

std::size_t checked_product(const std::string& file, Axes axes, std::size_t value_bytes,
                            bool taken_only) {
    std::uint64_t bytes = value_bytes;
    bool overflow = false;
    for (const StoredAxis& axis : axes) {
        if (taken_only && axis.taken) continue;
        overflow |= __builtin_mul_overflow(bytes, static_cast<std::uint64_t>(axis.size), &bytes);
    }
    if (overflow || bytes > (std::uint64_t{1} << 62)) {
        std::vector<std::int64_t> sizes;
        for (const StoredAxis& axis : axes) sizes.push_back(axis.size);
        fail("{}: the header promises {} samples of {} bytes, more than any file holds", file,
             fmt::join(sizes, " x "), value_bytes);
    }
    return bytes;
}

}  // namespace

std::size_t stored_bytes(const std::string& file, Axes axes, std::size_t value_bytes) {
    return checked_product(file, axes, value_bytes, false);
}

std::size_t taken_bytes(const std::string& file, Axes axes, std::size_t value_bytes) {
    return checked_product(file, axes, value_bytes, true);
}

void read_taken(ByteReader& reader, Axes axes, std::size_t value_bytes, void* to) {
    TakenReader(reader, value_bytes, static_cast<char*>(to)).read(axes);
}

void take_of_memory(const char* from, Axes axes, std::size_t value_bytes, char* to) {
    gather(from, axes, value_bytes, to);
}

StoredAxis taken_axis(const std::string& file, const char* what,
                      const std::optional<std::int64_t>& wanted, std::int64_t count) {
    if (wanted && (*wanted < 0 || *wanted >= count)) {
        fail("{}: {}: found {}, expected a whole number from 0 to {}: the file has {}", file, what,
             *wanted, count - 1, count);
    }
    return {count, wanted.value_or(0), what, wanted.has_value()};
}

void say_taken(const std::string& file, Axes axes) {
    for (const StoredAxis& axis : axes) {
        if (!axis.taken || axis.told || axis.size == 1) continue;
        warn(fmt::format("{}: {} 0 of {} is taken: \"{}\" in the volume tells another", file,
                         axis.what, axis.size, axis.what));
    }
}

std::int64_t taken_of(const std::string& file, const char* what,
                      const std::optional<std::int64_t>& wanted, std::int64_t count) {
    const StoredAxis axis = taken_axis(file, what, wanted, count);
    say_taken(file, {&axis, 1});
    return *axis.taken;
}

}  // namespace lamina
