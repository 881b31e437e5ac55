// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace lamina {

// The work of a frame, as a plan predicts it.
struct Work {
    double segments = 0;  // segments of rays in slabs that are evaluated
    double fetches = 0;   // fetches of the volume's texels by OpenGL's fragments
    double tets = 0;      // projected tets, or cell fragments where tets are cut
    double ordered = 0;   // tets put in visibility order
    double passes = 0;    // layers that are composited onto images one by one
    double bytes = 0;     // size of the volume, tables and images that are read and written

    // The amounts that are not 0, with their names.
    std::vector<std::pair<const char*, double>> amounts() const;
};

Work operator-(const Work& a, const Work& b);

// For example "12.3 M segments, 4.1 kB": the amounts above 0.
std::string to_text(const Work& work);

}  // namespace lamina
