// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lamina/scene.h"
#include "parallel/ranks.h"
#include "plan/omission.h"

namespace lamina {

// A scene of a volume, and what is left out of its work, on the way from rank 0 to the others.
class SceneMessage {
  public:
    SceneMessage() = default;  // of the others, before it arrives
    SceneMessage(const Scene& scene, const OmissionSwitch& omissions);

    void broadcast(const Ranks& ranks);

    Scene scene() const;  // throws Error
    OmissionSwitch omissions() const;
    // The folder that the data must be in (base/client.h); empty: anywhere.
    const std::string& only_below() const { return only_below_; }

  private:
    std::string name_, text_;
    std::string volume_;  // absolute path; names of files may have bytes that JSON cannot hold
    std::string kept_;
    std::string only_below_;
};

}  // namespace lamina
