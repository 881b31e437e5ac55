// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "lamina/auto.h"
#include "lamina/export.h"
#include "lamina/table_settings.h"
#include "lamina/tree_settings.h"

namespace lamina {

// Ways to compute the colour of a projected tetrahedron.
enum class Coloring {
    preintegrated,  // a table over (scalar at the front, at the back, length), Roettger et al. 2000
    attenuation,    // mean of colours and mean extinction of front and back, Stein et al. 1994
    vertex,   // colours and opacities are interpolated between vertices, Shirley and Tuchman 1990
    analytic  // the transfer function's pieces, each in closed form
};
enum class Interpolation { perspective, linear };
enum class Thickness {
    exact,
    dz  // difference of eye-space depths (Kraus 2004, section 2.3)
};
enum class ProjectOrder { mpvo, exact, centroid, none };
enum class ProjectGeometry {
    silhouette,  // one polygon around the tet, faces as linear functions of the pixel
    triangles    // three or four triangles around a thick vertex (Kraus 2004, Figure 3)
};
// Ways to round opacity at random to codes of 8 or 16 bits.
enum class ProjectDither {
    none,
    alpha,       // the fragment's opacity, before the blending unit rounds again (Kraus 2004,
                 // section 4.2)
    after_blend  // the result of a programmable blend, which is unbiased (docs/numerics.md, section
                 // 8)
};

struct ProjectSettings {
    Coloring coloring = Coloring::preintegrated;
    Interpolation interpolation = Interpolation::perspective;
    Thickness thickness = Thickness::exact;
    Auto<ProjectOrder> order;
    Auto<ProjectGeometry> geometry;
    ProjectDither dither = ProjectDither::none;
    Auto<TableSettings> table;
    // Without one tets are blended one by one. An automatic one is refused: a tree over tets needs
    // factors.
    std::optional<Auto<TreeSettings>> tree;
};

LAMINA_API const char* name_of(Coloring coloring);
LAMINA_API const char* name_of(Interpolation interpolation);
LAMINA_API const char* name_of(Thickness thickness);
LAMINA_API const char* name_of(ProjectOrder order);
LAMINA_API const char* name_of(ProjectGeometry geometry);
LAMINA_API const char* name_of(ProjectDither dither);

}  // namespace lamina
