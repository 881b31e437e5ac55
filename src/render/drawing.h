// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "plan/frame_renderer.h"
#include "plan/plan.h"

namespace lamina {

// Slicing and projection each have one for a session: it measures, plans and makes renderers in
// their own way. From call to call scenes differ in what the session was told to change alone.
class Drawing {
  public:
    virtual ~Drawing() = default;

    virtual const char* activity() const = 0;  // for progress: "slicing"

    // Measures what the data and the transfer function say. The view must be measured after it.
    virtual void measure_data(const Scene& scene) = 0;
    // What the view says. `planned`: the plan of a view before, null for the first; what it has
    // settled for all views is not measured again.
    virtual void measure_view(const Scene& scene, const Plan* planned) = 0;

    // Draws pictures for what is automatic, where it takes some to choose.
    virtual void make_trials(const Scene& /*scene*/, const Capabilities& /*capabilities*/) {}
    // `for_people`: with what omissions save.
    virtual Plan plan(const Scene& scene, const Capabilities& capabilities,
                      const OmissionSwitch& omissions, bool for_people) const = 0;
    // The scene with what the plan has chosen instead of "auto".
    virtual Scene resolved(Scene scene, const Plan& plan) const = 0;
    virtual std::string explanation(const Plan& plan, const Capabilities& capabilities) const = 0;

    // `before`: the renderer that it takes the place of, or null; what both hold is kept.
    virtual std::unique_ptr<FrameRenderer> make_renderer(const Scene& scene, const Plan& plan,
                                                         const Capabilities& capabilities,
                                                         FrameRenderer* before) const = 0;
};

}  // namespace lamina
