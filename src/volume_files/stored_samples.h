// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "base/client.h"
#include "base/value_type.h"
#include "lamina/volume.h"
#include "volume/labels.h"

namespace lamina {

// The samples that a reader has read from a file, x fastest, in native byte order. Their values are
// scale * sample + offset, computed in double precision.
struct StoredSamples {
    std::string file;  // for messages
    ValueType type = ValueType::uint8;
    std::shared_ptr<void> bytes;
    double scale = 1;  // finite, not 0
    double offset = 0;

    bool is_plain() const { return scale == 1 && offset == 0; }
};

// Convert binary16 (IEEE 754), which was read as uint16 in native byte order, to float.
float widened_half(std::uint16_t half);
StoredSamples widened_halves(const StoredSamples& halves, std::int64_t count);

// Reverse the bytes of words of 1, 2, 4 or 8 bytes: on all cores, or in this thread alone.
void swap_bytes(void* words, std::int64_t count, std::size_t word_bytes);
void swap_bytes_alone(void* words, std::int64_t count, std::size_t word_bytes);

// Returns the type of numbers of `bytes` bytes, or nothing. Floats always have a sign.
std::optional<ValueType> number_type(std::size_t bytes, bool integers, bool has_sign);

// Returns the volume's type if samples of `type` are drawn as they are, else nothing.
std::optional<SampleType> drawn_type(ValueType type);

// Makes the volume that is drawn. uint8, int16, uint16 and float samples stay as they are, int8
// become int16. Other integers, and integers scaled by integers, become the first of uint8, int16,
// uint16 and float that holds all of them; all others become float. Values that float does not hold
// are rounded, or become infinite; one warning counts those of unscaled samples.
// Whole numbers that become or are floats may be labels: if `lookup` or, without it, the grid or
// label_signs() says so, they become the first of uint8, int16 and uint16 that holds all of
// them, else codes (VolumeLabels), and a warning says so. Scaled samples are labels only if
// `lookup` or the grid says so. A warning says if the grid calls samples labels that are not whole.
Volume drawn_volume(const Grid& grid, const StoredSamples& samples,
                    const std::optional<VolumeLookup>& lookup);

// Tells if samples are taken for labels by their signs. A warning says so, or why they are not if
// they look like labels.
bool taken_by_signs(const std::string& file, const LabelSigns& signs);

}  // namespace lamina
