// SPDX-License-Identifier: Apache-2.0
#include "volume_files/dicom_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>

#include "base/client.h"
#include "base/error.h"
#include "volume_files/stored_data.h"

namespace lamina {
namespace {

using Places = std::vector<std::vector<DicomSlice>>;

struct PhaseAttribute {
    DicomTag tag;
    const char* name;
    bool is_alike = true;  // every place must have the same values; else as many different ones
};

// The attributes that tell phases apart: the first that does is taken.
constexpr PhaseAttribute phase_attributes[] = {
    {dicom_tag::temporal_identifier, "TemporalPositionIdentifier"},
    {dicom_tag::temporal_index, "TemporalPositionIndex"},
    {dicom_tag::trigger_time, "TriggerTime", false},
    {dicom_tag::trigger_delay, "NominalCardiacTriggerDelayTime", false},
    {dicom_tag::acquisition_number, "AcquisitionNumber"},
    {dicom_tag::frame_acquisition_number, "FrameAcquisitionNumber"},
    {dicom_tag::echo_numbers, "EchoNumbers"},
    {dicom_tag::echo_time, "EchoTime"},
    {dicom_tag::effective_echo_time, "EffectiveEchoTime"},
    {dicom_tag::acquisition_time, "AcquisitionTime", false},
    {dicom_tag::frame_acquisition, "FrameAcquisitionDateTime", false},
    {dicom_tag::diffusion_b, "DiffusionBValue"},
    {dicom_tag::inversion_time, "InversionTime"},
    {dicom_tag::flip_angle, "FlipAngle"},
    {dicom_tag::time_slots, "TimeSlotVector"},
    {dicom_tag::energy_windows, "EnergyWindowVector"},
    {dicom_tag::frame_pointer, "the number of the frame"},
    {dicom_tag::dimension_values, "the first of DimensionIndexValues"},
    {dicom_tag::dimension_values, "the second of DimensionIndexValues"},
    {dicom_tag::dimension_values, "the third of DimensionIndexValues"},
    {dicom_tag::instance_number, "InstanceNumber", false}};
constexpr std::size_t attribute_count = std::size(phase_attributes),
                      instance_attribute = attribute_count - 1;

// One or two attributes that together tell phases apart.
struct PhaseKey {
    std::size_t first, second;  // equal: it is one attribute

    std::string name() const {
        const char* const words = phase_attributes[first].name;
        return first == second ? words
                               : fmt::format("{} and {}", words, phase_attributes[second].name);
    }
};

using PhaseValue = std::array<double, 2>;

std::optional<double> value_of(const DicomSlice& slice, std::size_t wanted) {
    for (const auto& [which, value] : slice.frame->phase)
        if (which == wanted) return value;
    return {};
}

std::optional<PhaseValue> value_of(const DicomSlice& slice, const PhaseKey& key) {
    const auto first = value_of(slice, key.first), second = value_of(slice, key.second);
    if (!first || !second) return {};
    return PhaseValue{*first, *second};
}

// Returns the values of the slices at a place in rising order; none if one lacks a value, or if two
// have the same.
std::vector<PhaseValue> values_at(const std::vector<DicomSlice>& place, const PhaseKey& key) {
    std::vector<PhaseValue> values;
    for (const DicomSlice& slice : place) {
        const auto value = value_of(slice, key);
        if (!value) return {};
        values.push_back(*value);
    }
    std::ranges::sort(values);
    return std::ranges::adjacent_find(values) == values.end() ? values : std::vector<PhaseValue>{};
}

// Tells if the numbers of images, in rising order at each place, show what belongs together: those
// of each phase lie between those of the phases before and after it, or those of each place follow
// each other.
bool are_in_order(const std::vector<std::vector<PhaseValue>>& places) {
    const std::size_t count = places[0].size();
    bool consecutive = true, apart = true;
    for (std::size_t phase = 1; phase < count; ++phase) {
        double before = places[0][phase - 1][0], after = places[0][phase][0];
        for (const auto& values : places) {
            consecutive = consecutive && values[phase][0] == values[phase - 1][0] + 1;
            before = std::max(before, values[phase - 1][0]);
            after = std::min(after, values[phase][0]);
        }
        apart = apart && before < after;
    }
    return consecutive || apart;
}

bool tells_apart(const Places& places, const PhaseKey& key) {
    const bool alike =
        phase_attributes[key.first].is_alike && phase_attributes[key.second].is_alike;
    if (key.first != key.second && !alike) return false;
    std::vector<std::vector<PhaseValue>> all;
    for (const auto& place : places) {
        all.push_back(values_at(place, key));
        if (all.back().empty() || all.back().size() != all[0].size()) return false;
        if (alike && all.back() != all[0]) return false;
    }
    return key.first != instance_attribute || are_in_order(all);
}

// Returns the first attribute that tells the slices at every place apart, else the first two that
// do together.
std::optional<PhaseKey> found_key(const Places& places) {
    for (std::size_t i = 0; i < attribute_count; ++i)
        if (tells_apart(places, {i, i})) return PhaseKey{i, i};
    for (std::size_t i = 0; i < attribute_count; ++i)
        for (std::size_t j = i + 1; j < attribute_count; ++j)
            if (tells_apart(places, {i, j})) return PhaseKey{i, j};
    return {};
}

// Removes slices with the same pixels as an earlier one at their place, and says how many.
void remove_twins(Places& places, const std::string& file) {
    constexpr std::size_t most = 64;  // slices at a place that are compared
    std::size_t removed = 0;
    for (auto& place : places) {
        if (place.size() > most) continue;
        std::vector<DicomSlice> kept;
        std::multimap<std::uint64_t, DicomSlice> known;  // by hash: each file is read once
        for (const DicomSlice& slice : place) {
            check_interrupt();
            const auto hash = pixel_hash(*slice.image, *slice.frame);
            const auto is_same = [&](const auto& other) {
                const auto& [image, frame] = other.second;
                return same_pixels(*image, *frame, *slice.image, *slice.frame);
            };
            if (hash) {
                const auto [first, last] = known.equal_range(*hash);
                if (std::any_of(first, last, is_same)) continue;
                known.emplace(*hash, slice);
            }
            kept.push_back(slice);
        }
        removed += place.size() - kept.size();
        place = std::move(kept);
    }
    if (removed > 0) {
        say("{}: found {} slices too many, with the place and pixels of others: they are "
            "not used",
            file, removed);
    }
}

void expect_as_many(const Places& places, const std::string& file) {
    for (const auto& place : places) {
        if (place.size() == places[0].size()) continue;
        fail("{}: found {} images at the place of {}, and {} at that of {}, expected as many", file,
             place.size(), place[0].name(), places[0].size(), places[0][0].name());
    }
}

}  // namespace

std::string DicomSlice::name() const {
    const std::string name = image->file.filename().string();
    return image->frame_count == 1 ? name : fmt::format("frame {} of {}", frame->index + 1, name);
}

std::vector<std::pair<std::size_t, double>> phase_of(const DicomElements& elements,
                                                     std::size_t frame, std::size_t frames) {
    std::vector<std::pair<std::size_t, double>> phase;
    std::size_t dimension = 0;
    for (std::size_t i = 0; i < attribute_count; ++i) {
        const DicomTag tag = phase_attributes[i].tag;
        std::vector<double> numbers;
        std::size_t which = 0;
        if (tag == dicom_tag::time_slots || tag == dicom_tag::energy_windows) {
            numbers = elements.number_of_frame(tag, frame, frames);
        } else if (tag == dicom_tag::frame_pointer) {
            if (frames > 1) numbers = {static_cast<double>(frame + 1)};
        } else {
            numbers = elements.numbers(tag, frame);
            if (tag == dicom_tag::dimension_values) which = dimension++;
        }
        if (which < numbers.size()) phase.emplace_back(i, numbers[which]);
    }
    return phase;
}

std::vector<DicomSlice> slices_of_time(Places places, const std::string& file,
                                       const VolumeRequest& request, VolumeContents* contents) {
    const auto single = [](const auto& place) { return place.size() == 1; };
    std::optional<PhaseKey> key;
    if (!std::ranges::all_of(places, single)) {
        key = found_key(places);
        if (!key) {
            remove_twins(places, file);
            expect_as_many(places, file);
            key = found_key(places);
        }
    }
    if (!std::ranges::all_of(places, single)) {
        if (!key) {
            fail(
                "{}: found {} images at the place of {} that nothing tells apart: expected "
                "different TemporalPositionIdentifier, TriggerTime, AcquisitionNumber, "
                "EchoNumbers, "
                "EchoTime or AcquisitionTime",
                file, places[0].size(), places[0][0].name());
        }
        say("{}: the {} images at each place are times: {} tells them apart", file,
            places[0].size(), key->name());
        for (auto& place : places) {
            std::ranges::sort(place, {},
                              [&](const DicomSlice& slice) { return *value_of(slice, *key); });
        }
        for (const DicomSlice& slice : places[0]) {
            if (contents == nullptr) break;
            const PhaseValue value = *value_of(slice, *key);
            std::string name = fmt::format("{} {}", phase_attributes[key->first].name, value[0]);
            if (key->first != key->second)
                name += fmt::format(", {} {}", phase_attributes[key->second].name, value[1]);
            contents->times.push_back(name);
        }
    }
    const auto time = static_cast<std::size_t>(
        taken_of(file, "time", request.time, static_cast<std::int64_t>(places[0].size())));
    std::vector<DicomSlice> slices;
    for (const auto& place : places) slices.push_back(place[time]);
    return slices;
}

}  // namespace lamina
