// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace lamina {

// What a frame takes, as a plan predicts it.
struct Work {
    double segments = 0;  // of rays through slabs, evaluated
    double fetches = 0;   // of the volume's texels, by OpenGL's fragments
    double tets = 0;      // or the parts that they are cut into, projected
    double ordered = 0;   // tets put in visibility order
    double passes = 0;    // layers put into images one by one
    double bytes = 0;     // of volume, tables and images as they are drawn from and into

    // Those that are not 0, by name.
    std::vector<std::pair<const char*, double>> amounts() const;
};

Work operator-(const Work& a, const Work& b);

// "12.3 M segments, 4.1 kB": what is above 0.
std::string to_text(const Work& work);

}  // namespace lamina
