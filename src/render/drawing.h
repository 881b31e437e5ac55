// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "lamina/frame_statistics.h"
#include "plan/frame_renderer.h"
#include "plan/plan.h"
#include "render/resolved.h"
#include "render/warnings.h"

namespace lamina {

// Measures, plans and makes renderers for a SceneRenderer. Slicing and projection implement it,
// each in its own way, and keep the renderer that they made last. Between calls the scene changes
// only in what the renderer was told to change.
class Drawing {
  public:
    virtual ~Drawing() = default;

    virtual const char* activity() const = 0;  // for progress: "slicing"

    // Measures the facts that depend on the data and the transfer function. measure_view() must
    // follow.
    virtual void measure_data(const Scene& scene) = 0;
    // Measures the facts that depend on the view. `planned`: the plan of an earlier view, or null
    // for the first view. Facts that this plan has settled for all views are not measured again.
    virtual void measure_view(const Scene& scene, const Plan* planned) = 0;

    // Draws trial pictures if an automatic choice needs them. `many_frames`: also if they may make
    // later frames quicker.
    virtual void make_trials(const Scene& /*scene*/, const Capabilities& /*capabilities*/,
                             bool /*many_frames*/) {}
    // `for_people`: the plan also says how much work each omission saves.
    virtual Plan plan(const Scene& scene, const Capabilities& capabilities,
                      const OmissionSwitch& omissions, bool for_people) const = 0;
    // Replaces every "auto" by the choice of the plan.
    virtual Resolved resolve(Scene scene, const Plan& plan) const = 0;
    virtual std::string explanation(const Plan& plan, const Capabilities& capabilities) const = 0;

    // Returns sentences for people about the data, the plan and, once a frame is drawn, about the
    // frame.
    virtual Warnings warnings(const Resolved& resolved, const Plan& plan) = 0;

    // Adds the results of the last frame; the renderer must exist.
    virtual void add_to(FrameStatistics& /*statistics*/) const {}

    // For renderers that draw one picture together, once a view is measured: the parts of the
    // volume that they draw; and their numbers, nearer ones first.
    virtual std::vector<IndexBox> shares() const { return {}; }
    virtual std::vector<int> front_to_back(const Scene& /*scene*/) const { return {0}; }

    // Replaces the renderer; the new one takes over the data that both need.
    virtual void make_renderer(const Resolved& resolved, const Plan& plan,
                               const Capabilities& capabilities) = 0;
    virtual FrameRenderer* renderer() const = 0;  // null before there is one
};

}  // namespace lamina
