// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Stores the results ("answers") of a slow function of a brick's range. Samples of 8 bits have few
// different ranges, so if there are many bricks, the constructor computes all answers. Otherwise
// each reader keeps a hash table of its latest answers, because bricks in a hole have one range.
template <typename Answer>
class RangeAnswers {
    static_assert(!std::is_same_v<Answer, bool>);  // threads may not write to one vector<bool>
  public:
    using Compute = std::function<Answer(const ValueRange&)>;

    // `ranges` must outlive this.
    RangeAnswers(const BrickRanges& ranges, Compute compute)
        : ranges_(ranges), compute_(std::move(compute)) {
        if (ranges.type() == SampleType::uint8 && ranges.size() > many) answer_all();
    }

    // Answers for bricks. Each thread needs a reader of its own.
    class Reader {
      public:
        explicit Reader(const RangeAnswers& answers) : answers_(answers) {
            if (answers.of_bytes_.empty()) remembered_.resize(std::size_t{1} << address_bits);
        }

        Answer operator[](std::size_t brick) {
            if (remembered_.empty()) return answers_.of_bytes_[answers_.ranges_.byte_pair(brick)];
            const BrickRange range = answers_.ranges_[brick];
            const auto bits = [](float value) {
                return std::uint64_t{std::bit_cast<std::uint32_t>(value)};
            };
            const std::uint64_t mixed =
                (bits(range.lo) << 32 | bits(range.hi)) * 0x9e3779b97f4a7c15u;  // 2^64 / phi
            Remembered& entry = remembered_[mixed >> (64 - address_bits)];
            if (entry.range.lo != range.lo || entry.range.hi != range.hi)
                entry = {range, answers_.compute_(ValueRange{range.lo, range.hi})};
            return entry.answer;
        }

        // Sets the answers for consecutive bricks, faster in large holes (ranges [0, 0]).
        void fill(std::size_t first, std::span<Answer> answers) {
            while (!answers.empty()) {
                const std::size_t count = std::min(answers.size(), together);
                if (answers_.ranges_.all_zero(first, count)) {
                    std::fill_n(answers.begin(), count, (*this)[first]);
                } else {
                    for (std::size_t i = 0; i < count; ++i) answers[i] = (*this)[first + i];
                }
                first += count;
                answers = answers.subspan(count);
            }
        }

      private:
        static constexpr int address_bits = 12;
        static constexpr std::size_t together = 2048;  // bricks of a group in fill()

        struct Remembered {
            BrickRange range{std::numeric_limits<float>::quiet_NaN(), 0};  // NaN: equal to no range
            Answer answer{};
        };
        const RangeAnswers& answers_;
        std::vector<Remembered> remembered_;
    };

  private:
    static constexpr std::size_t many = 1 << 20;  // bricks; with more, answer_all() is called
    static constexpr int values = 256;            // that a sample of 8 bits can have

    void answer_all() {
        of_bytes_.resize(std::size_t{values} * values);
        parallel_for(values, 1, [&](std::int64_t hi) {
            for (std::int64_t lo = 0; lo <= hi; ++lo) {
                of_bytes_[static_cast<std::size_t>(lo + values * hi)] =
                    compute_({static_cast<double>(lo), static_cast<double>(hi)});
            }
        });
    }

    const BrickRanges& ranges_;
    Compute compute_;
    std::vector<Answer> of_bytes_;  // by BrickRanges::byte_pair(); empty: not computed
};

}  // namespace lamina
