// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "facts/mesh_facts.h"
#include "lamina/error_figure.h"
#include "lamina/project_settings.h"
#include "plan/compositing_plan.h"
#include "plan/light_choice.h"
#include "preintegration/table_cache.h"
#include "visibility/visibility_order.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Ways to integrate the fragments of a tet between its front and its back.
enum class SegmentSource {
    constant,   // the transfer function is constant over the mesh: no scalar is needed
    table,      // one look-up in a table with equally spaced scalars
    parts,      // tets are cut at the transfer function's points. Opacity has a closed form; colour
                // is one look-up in a table that does not depend on the transfer function
                // (optics/segment_integral.h)
    cut_table,  // up to three look-ups in a table whose scalar nodes lie on the transfer function's
                // points
    analytic,   // the linear pieces between those points, each in closed form
    mean,       // the mean of the optics at front and back: Coloring::attenuation
    vertices    // no integration: Coloring::vertex
};

// The picture that projection draws. Renderers prepare for it once.
struct ProjectedPicture : CompositingPlan, LightPlan {
    SegmentSource source = SegmentSource::table;
    Interpolation interpolation = Interpolation::perspective;
    Thickness thickness = Thickness::exact;
    OrderMethod visibility = OrderMethod::exact;
    // Tets that hide one another in rings are ordered pixel by pixel (visibility/ring_order.h).
    bool solve_rings = false;
    ProjectGeometry geometry = ProjectGeometry::silhouette;  // never automatic
    ProjectDither dither = ProjectDither::none;
    std::uint32_t seed = 1;     // for dithering and stochastic rounding
    std::vector<int> tree;      // bifurcation factors of fixed-point nodes; empty: none
    bool scattered = false;     // the tets of a tree's leaf come from all over the mesh
    bool orthographic = false;  // rays are parallel; fragments need no division
    bool single_color = false;  // the colour is a constant of the program
    // the setup in float32 draws a tet if float32 can find its faces
    bool plain = true;
    bool draw_transparent = false;  // transparent tets are drawn, too
    bool nothing_visible = false;   // no tet is drawn
    bool table_filtered = false;    // tables are read through the texture unit's filter
    // Eye-space depth of the near plane, in the plan's units, as are lengths in tables.
    double near_depth = 0;
    ValueRange range;  // scalars, [0, 1] in shaders; lo < hi
    // The range is the window of visible scalars. Scalars may lie outside it; there the transfer
    // function is constant.
    bool windowed = false;
    TablePlan table;  // for SegmentSource::table (uniform) and ::cut_table (knots)

    // Tells whether the program, not the blending unit, rounds opacity to codes.
    bool in_codes() const { return emulation.has_value() || dither != ProjectDither::none; }

    friend bool operator==(const ProjectedPicture&, const ProjectedPicture&) = default;
};

// Remarks on the projection change no picture.
struct ProjectRemarks {
    std::string target_reason;  // for "target": "auto"
    MeshFacts::TrialError trial_error;
    ErrorFigure error;  // of the picture
};

struct ProjectPlan : ProjectedPicture, ProjectRemarks {
    const ProjectedPicture& picture() const { return *this; }
};

const char* name_of(SegmentSource source);

}  // namespace lamina
