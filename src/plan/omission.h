// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace lamina {

// The predicted work of a frame.
struct Work {
    double segments = 0;  // segments of rays in slabs that are evaluated
    double fetches = 0;   // fetches of the volume's texels by OpenGL's fragments
    double tets = 0;      // projected tets, or cell fragments if tets are cut
    double ordered = 0;   // tets put in visibility order
    double passes = 0;    // layers that are composited onto images one by one
    double bytes = 0;     // size of the volume, tables and images that are read and written

    // Returns the amounts that are not 0, with their names.
    std::vector<std::pair<const char*, double>> amounts() const;
};

Work operator-(const Work& a, const Work& b);

// Returns, for example, "12.3 M segments, 4.1 kB": the amounts above 0.
std::string to_text(const Work& work);

// Work that is left out because this scene does not need it.
struct Omission {
    std::string name;    // as in --no-omit=NAME
    std::string reason;  // the fact that decided
    Work saves{};        // predicted work that it saves in a frame
};

// The omissions that the user has switched off.
struct OmissionSwitch {
    bool none = false;           // --no-omit: leave out nothing
    std::set<std::string> kept;  // --no-omit=NAME
    bool allows(const std::string& name) const { return !none && !kept.contains(name); }
};
std::vector<std::string> omission_names();

// Collects the omissions of a planner, in the order of its choices.
struct Omissions {
    const OmissionSwitch& allowed;
    std::vector<Omission> list = {};

    // Returns true, and records the omission, if the scene does not need `name` and the user has
    // not switched that off.
    bool leave_out(bool unneeded, const std::string& name, const std::string& reason) {
        if (!unneeded || !allowed.allows(name)) return false;
        list.push_back({name, reason});
        return true;
    }
};

}  // namespace lamina
