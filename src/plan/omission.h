// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <vector>

#include "plan/work.h"

namespace lamina {

// Work that is left out because this scene does not need it.
struct Omission {
    std::string name;    // as in --no-omit=NAME
    std::string reason;  // the fact that decided
    Work saves{};        // predicted work that it saves in a frame
};

// Which omissions the user has switched off.
struct OmissionSwitch {
    bool none = false;           // --no-omit: leave out nothing
    std::set<std::string> kept;  // --no-omit=NAME
    bool allows(const std::string& name) const { return !none && !kept.contains(name); }
};
std::vector<std::string> omission_names();

}  // namespace lamina
