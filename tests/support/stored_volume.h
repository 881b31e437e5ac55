// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstring>
#include <functional>
#include <memory>
#include <utility>

#include "base/content_hash.h"
#include "base/error.h"
#include "lamina/volume.h"
#include "volume/volume_store.h"

namespace lamina::test {

// Gives the samples of a volume in memory as if they were in files.
class SourceInMemory : public SampleSource {
  public:
    explicit SourceInMemory(Volume volume, std::array<std::int64_t, 3> block = {0, 0, 0})
        : volume_(std::move(volume)), block_(block) {}

    void read(const SampleBox& box, void* to) const override {
        samples_read += box.count();
        if (before_read) before_read(box);
        const std::size_t bytes = bytes_of(volume_.type());
        const auto& size = volume_.grid().size;
        const auto* const from = static_cast<const char*>(volume_.data());
        auto* at = static_cast<char*>(to);
        for (std::int64_t z = 0; z < box.size[2]; ++z) {
            for (std::int64_t y = 0; y < box.size[1]; ++y) {
                const std::int64_t place =
                    ((box.first[2] + z) * size[1] + box.first[1] + y) * size[0] + box.first[0];
                const std::size_t count = static_cast<std::size_t>(box.size[0]) * bytes;
                std::memcpy(at, from + static_cast<std::size_t>(place) * bytes, count);
                at += count;
            }
        }
    }
    std::array<std::int64_t, 3> block() const override { return block_; }
    void check_unchanged() const override {
        if (changed) fail("the files were changed");
    }
    std::filesystem::path main_file() const override { return "volume"; }
    std::string name() const override { return "in memory " + identity(); }
    std::string identity() const override {
        ContentHash hash;
        hash.add(volume_.data(), volume_.byte_count());
        return hash.hex();
    }

    mutable std::atomic<std::int64_t> samples_read{0};  // by all reads so far
    std::function<void(const SampleBox&)> before_read;  // called by read()
    bool changed = false;                               // makes check_unchanged() fail

  private:
    Volume volume_;
    std::array<std::int64_t, 3> block_;
};

inline Volume stored(const Volume& volume, std::array<std::int64_t, 3> block = {0, 0, 0}) {
    return Volume(
        volume.grid(), volume.type(),
        std::make_shared<const VolumeStore>(volume.grid(), volume.type(),
                                            std::make_unique<const SourceInMemory>(volume, block)));
}

}  // namespace lamina::test
