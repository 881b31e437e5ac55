// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <cassert>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "lamina/error.h"

namespace lamina {

// Stands for "auto" in scene files.
struct Automatic {
    friend bool operator==(Automatic, Automatic) = default;
};
inline constexpr Automatic automatic;

// Holds a value of a scene, or the wish that lamina chooses it: then it is automatic, and is chosen
// once the data, the view or the context that it depends on are known. Auto<T>{} is automatic.
template <typename T>
class Auto {
  public:
    Auto() = default;
    Auto(Automatic) {}  // NOLINT(google-explicit-constructor)
    template <typename Value = T>
    requires(std::convertible_to<Value, T> && !std::same_as<std::remove_cvref_t<Value>, Auto> &&
             !std::same_as<std::remove_cvref_t<Value>, Automatic>)
        Auto(Value&& value)  // NOLINT(google-explicit-constructor)
        : given_(std::forward<Value>(value)) {}

    bool is_automatic() const { return !given_; }
    bool is_given() const { return given_.has_value(); }

    // Return the given value; there must be one.
    const T& operator*() const {
        assert(given_);
        return *given_;
    }
    T& operator*() {
        assert(given_);
        return *given_;
    }
    const T* operator->() const { return &**this; }
    T* operator->() { return &**this; }
    T value_or(T otherwise) const { return given_ ? *given_ : std::move(otherwise); }

    friend bool operator==(const Auto&, const Auto&) = default;
    friend bool operator==(const Auto& open, const T& value) { return open.given_ == value; }
    friend bool operator==(const Auto& open, Automatic) { return open.is_automatic(); }

  private:
    std::optional<T> given_;
};

// Returns the word for a value in scene files.
template <typename Enum>
requires(std::is_enum_v<Enum>) const char* name_of(const Auto<Enum>& value) {
    return value.is_given() ? name_of(*value) : "auto";
}

// Order in which samples of a ray are composited. The first sample is the nearest to the eye.
enum class Order { back_to_front, front_to_back };

// A plane of a clip. It keeps the side to which the normal points: dot(normal, p - point) >= 0.
// Coordinates are in world units; the normal has any length above 0.
struct ClipPlane {
    glm::dvec3 point{0}, normal{0, 0, 1};

    friend bool operator==(const ClipPlane&, const ClipPlane&) = default;
};

// A box of a clip. It keeps what lies between two corners, in world units. Nothing is kept unless
// min <= max on each axis.
struct ClipBox {
    glm::dvec3 min{0}, max{0};

    friend bool operator==(const ClipBox&, const ClipBox&) = default;
};

// A clip keeps the part of the data that lies on the kept side of every plane and in the box.
struct Clip {
    static constexpr std::size_t most_planes = 32;

    std::vector<ClipPlane> planes;  // at most most_planes in scene files
    std::optional<ClipBox> box;

    bool keeps_all() const { return planes.empty() && !box; }

    friend bool operator==(const Clip&, const Clip&) = default;
};

struct Light {
    // Direction towards the light, in world space, of any length but 0. Without a direction the
    // light is a headlight: for every ray it shines from the eye along the ray.
    std::optional<glm::dvec3> direction;
    glm::dvec3 color{1};  // in the scene's colour space, 0..1000

    friend bool operator==(const Light&, const Light&) = default;
};

// Lights the emission by the gradient of the scalar, on both of its sides (docs/numerics.md,
// section 10); extinction stays as it is. Where the gradient is not much longer than
// `smallest_gradient`, lit colours fade into unlit ones.
struct Lighting {
    static constexpr int most_lights = 8;
    static constexpr double largest_term = 1000, largest_power = 1000;
    static constexpr double least_gradient = 1e-150, largest_gradient = 1e150;

    double ambient = .1, diffuse = .7, specular = .2;  // 0..1000
    double power = 10;                                 // exponent of the highlight, 1..1000
    // Length in scalar units per world unit, 1e-150..1e150; chosen from the data if automatic.
    Auto<double> smallest_gradient;
    std::vector<Light> lights = std::vector<Light>(1);  // 1..8; a headlight

    friend bool operator==(const Lighting&, const Lighting&) = default;
};

// Returns the lighting if it is given, else null.
inline const Lighting* given_lighting(const std::optional<Auto<Lighting>>& lighting) {
    return lighting && lighting->is_given() ? &**lighting : nullptr;
}

// Returns a copy of the given lighting; empty if there is none.
inline std::optional<Lighting> copied_lighting(const std::optional<Auto<Lighting>>& lighting) {
    const Lighting* const given = given_lighting(lighting);
    return given != nullptr ? std::optional<Lighting>(*given) : std::nullopt;
}

// Rounding of an opacity to a code (LaMar 2004, section 4.1: the paper's hardware truncates).
enum class AlphaRounding { truncate, nearest, stochastic };

// Rounding in the compositing operator OVER. separate: each of the two products is rounded, as by
// the paper's hardware. fused: only their sum is rounded.
enum class OverRounding { separate, fused };

// Fixed-point compositing that is computed step by step, not by a blending unit (render.emulate).
struct Emulation {
    int bits = 8;
    AlphaRounding alpha = AlphaRounding::truncate;
    OverRounding over = OverRounding::separate;
    std::uint32_t seed = 1;  // seed of the random numbers of stochastic rounding

    friend bool operator==(const Emulation&, const Emulation&) = default;
};

// Codes by which a node of a compositing tree stores its optical depth S. Here sigma is the optical
// depth that a ray would have if all of it were like the node's part of it (docs/numerics.md,
// section 4).
//
//   phi:     1 - exp(-sigma), the opacity of such a ray, as in the paper
//   alpha:   1 - exp(-S), the node's own opacity
//   minimax: rounding has the same worst effect on the ray's opacity for every sigma
enum class NodeCode { minimax, phi, alpha };

// Arithmetic that composites the children of a node. shader: floats in a shader. fixed: a
// fixed-point buffer, as in the paper.
enum class NodeArithmetic { shader, fixed };

// A compositing tree: the samples of a ray are composited in groups, level by level.
struct TreeSettings {
    std::vector<int> factors;  // children of a node, for each level from the root to the leaves
    NodeArithmetic nodes = NodeArithmetic::shader;
    NodeCode code = NodeCode::minimax;
    int alpha_bits = 8;
};

// Returns the tree if its factors are given, else null.
inline const TreeSettings* given_tree(const std::optional<Auto<TreeSettings>>& tree) {
    return tree && tree->is_given() ? &**tree : nullptr;
}

// How the segment of a ray in a slab gets its colour. post: from the scalar in its middle.
// preintegrated: from a table over the scalars at both ends. exact: integrated cell by cell.
enum class Classification { post, preintegrated, exact };
// Interpolation between samples. exact: trilinear in float32. hardware: by the texture unit, whose
// weights have few bits.
enum class Filter { exact, hardware };

// Dithering along depth: the fixed-point codes of slabs alternate between two codes.
struct DitherSettings {
    // Slabs after which the pattern repeats; if automatic, the number of slabs.
    Auto<int> period = 16;
    std::uint32_t seed = 1;
    bool color = false;
    int increment = 1;
};

inline constexpr int max_slabs = 65536;

// Size of a pre-integration table whose nodes lie on the transfer function's points.
struct SliceTableSettings {
    int scalars = 256;      // approximate number of scalar nodes
    int lengths = 1;        // number of layers along length
    double max_length = 0;  // largest length of a segment in the table, in world units
};

struct SliceSettings {
    Auto<int> samples;  // number of slabs
    Auto<Classification> classification;
    Order order = Order::back_to_front;
    Auto<Filter> filter = Filter::exact;
    std::optional<DitherSettings> dither;
    std::optional<Auto<TreeSettings>> tree;  // if there is no tree, slabs are blended one by one
    Auto<SliceTableSettings> table;
};

// Segment lengths at which the layers of a table lie, and the coordinate that is linear between two
// layers. With L layers and dl = max_length / 2^(L-2), `octave` and `log2` have layers at 0, dl, 2
// dl, 4 dl, ..., max_length.
enum class LengthMapping {
    octave,  // linear in length between two layers
    log2,    // linear in log2 of length from dl on: Kraus 2004, Equation 1
    linear   // equally spaced lengths
};
// Quantities that the entries of a pre-integration table hold.
enum class TableStore {
    // Stores the mean extinction tbar = optical depth / length and, with colour, the emission tbar
    // * C / alpha. Both stay bounded and smooth as the length goes to 0 (docs/numerics.md, section
    // 5). A single layer holds the limit at length 0.
    mean_extinction,
    // Stores alpha and the associated colour C themselves, as the paper does. A single layer holds
    // the entries of max_length.
    opacity
};
enum class TableFormat { fixed16, fixed8, float16, float32 };
enum class TableConstruction {
    exact,       // every entry comes from the closed form of its segment
    incremental  // layers come from those of shorter segments, as in the paper (Weiler et al. 2003)
};

// Settings of a pre-integration table with equally spaced scalars.
struct TableSettings {
    int scalar = 256;  // number of scalars
    int length = 16;   // number of lengths
    LengthMapping mapping = LengthMapping::octave;
    TableStore store = TableStore::mean_extinction;
    TableFormat format = TableFormat::fixed16;
    TableConstruction construction = TableConstruction::exact;
};

LAMINA_API const char* name_of(LengthMapping mapping);
LAMINA_API const char* name_of(TableStore store);
LAMINA_API const char* name_of(TableFormat format);
LAMINA_API const char* name_of(TableConstruction construction);

// Ways to compute the colour of a projected tetrahedron.
enum class Coloring {
    preintegrated,  // a table over (scalar at the front, at the back, length), Roettger et al. 2000
    attenuation,    // mean of colours and mean extinction of front and back, Stein et al. 1994
    vertex,   // colours and opacities are interpolated between vertices, Shirley and Tuchman 1990
    analytic  // the transfer function's pieces, each in closed form
};
// Interpolation over the triangles of a projected tet: correct in perspective, or linear in the
// picture.
enum class Interpolation { perspective, linear };
// Length of a ray in a projected tet.
enum class Thickness {
    exact,
    dz  // difference of eye-space depths in place of the length (Kraus 2004, section 2.3)
};
// Visibility order of tets. mpvo: right for convex meshes. exact: right for all meshes. centroid:
// by the depths of centroids. none: the order of the file.
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
    // If there is no tree, tets are blended one by one. An automatic tree is refused, because a
    // tree over tets needs factors.
    std::optional<Auto<TreeSettings>> tree;
};

LAMINA_API const char* name_of(Coloring coloring);
LAMINA_API const char* name_of(Interpolation interpolation);
LAMINA_API const char* name_of(Thickness thickness);
LAMINA_API const char* name_of(ProjectOrder order);
LAMINA_API const char* name_of(ProjectGeometry geometry);
LAMINA_API const char* name_of(ProjectDither dither);

// Names what draws. osmesa and egl: OpenGL 4.5 without a window; cpu: lamina's own engine, which
// needs no OpenGL. An automatic choice takes a GPU through EGL if there is one, else the cpu
// engine.
enum class ContextChoice { osmesa, egl, cpu };

LAMINA_API const char* name_of(Classification classification);
LAMINA_API const char* name_of(Order order);
LAMINA_API const char* name_of(Filter filter);
LAMINA_API const char* name_of(NodeArithmetic nodes);
LAMINA_API const char* name_of(NodeCode code);
LAMINA_API const char* name_of(AlphaRounding rounding);
LAMINA_API const char* name_of(OverRounding rounding);

}  // namespace lamina
