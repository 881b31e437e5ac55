// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "facts/volume_facts.h"
#include "lamina/scene.h"

namespace lamina {

// The error of slicing into so many slabs, found on rays all over the picture.
struct SlabTrial {
    int slabs = 1;
    double error = 0;         // Linf of colour and opacity, in 1/255
    std::int64_t rays = 0;    // number of rays that were tried
    double goal = 0;          // largest error that is allowed: slab_error_goal(), in 1/255
    std::int64_t traced = 0;  // number of these rays that were compared with the reference tracer
    // True: the picture's error may be larger, because the rays are those of a smaller picture, or
    // because not all of them were traced and the tracer found a larger error than the comparison
    // with other numbers of slabs.
    bool doubtful = false;
    bool keeps_goal() const { return error <= goal; }

    friend bool operator==(const SlabTrial&, const SlabTrial&) = default;
};

// Numbers of slabs that were tried if the scene has "auto" (slicing/slab_trials.h tries them).
struct SampleTrials {
    // For "samples": "auto"; otherwise empty.
    std::vector<SlabTrial> exact;
    // For "filter": "auto", with filter weights rounded to 8 bits as in texture units. If the
    // number of slabs is given, the error is that of the weights alone.
    std::vector<SlabTrial> hardware;
};

// Returns the number of slabs, 1 .. max_slabs, that makes `slabs` slabs per voxel along the view.
int slabs_per_voxel(const Facts& facts, double slabs);

// Returns the largest error, in 1/255, that a trial of an automatic number of slabs may find.
// Automatic compositing takes its share of max_error first. The goal is stricter if only `rays` of
// the picture's rays were tried, because the largest error of all rays is then larger than the one
// found. `max_color` and `slabs` matter if the target is automatic, too.
double slab_error_goal(const Scene& scene, double max_color, int slabs, double rays);

// Tells whether the errors fall with about the second power of the number of slabs, as for smooth
// pictures. Otherwise fewer slabs may by chance have a smaller error than more.
bool are_of_second_order(std::vector<SlabTrial> trials);

// Makes the choice of "samples": "auto". It is the fewest slabs whose trial keeps its goal. If none
// does, it is the fewest slabs, of two a voxel or more, whose error is near the least. If nothing
// was tried, it is two slabs a voxel, with an unknown error (NaN).
SlabTrial chosen_slabs(const Facts& facts, const SampleTrials& trials);

// Makes the choice of "filter": "auto": the fewest slabs whose trial with the weights of texture
// units keeps its goal, if any does.
std::optional<SlabTrial> slabs_of_hardware_filter(const SampleTrials& trials);

}  // namespace lamina
