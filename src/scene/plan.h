// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "compositing/dither.h"
#include "scene/capabilities.h"
#include "scene/facts.h"
#include "scene/mesh_facts.h"
#include "scene/scene.h"
#include "scene/tree_choice.h"

namespace lamina {

// What was left out because this scene does not need it.
struct Omission {
    std::string name;    // as in --no-omit=NAME
    std::string reason;  // the fact that decided, and what it saves
};

// Which omissions the user has switched off.
struct OmissionSwitch {
    bool none = false;           // --no-omit: leave out nothing
    std::set<std::string> kept;  // --no-omit=NAME
    bool allows(const std::string& name) const { return !none && !kept.contains(name); }
};
std::vector<std::string> omission_names();

// Where the fragments of the slicing renderer get the scalar from.
enum class VolumeSampling {
    none,      // the transfer function is constant over the volume: no scalar is needed
    fetch,     // eight texel fetches and float arithmetic
    filtered,  // linear filter of a float texture, where that was measured to be exact
    hardware,  // linear filter of a texture in the file's own type, with the hardware's weights
};

// Who computes OVER on what a target holds.
enum class Blending {
    native,   // the blending unit
    fetch,    // the program, which reads its pixel (GL_EXT_shader_framebuffer_fetch)
    barrier,  // the program, which reads the target as a texture, with a barrier between slabs
};

// A part of the volume that one texture holds: samples first .. first + size - 1; neighbours share
// a layer of samples.
struct TextureBrick {
    std::array<std::int64_t, 3> first{0, 0, 0};
    std::array<std::int64_t, 3> size{1, 1, 1};
};

struct TablePlan {
    int scalar_nodes = 256;
    int length_layers = 1;
    double max_length = 0;  // world units
    bool colored = true;
};

struct SlicePlan {
    int slabs = 1;
    Target target = Target::float32;
    std::optional<Emulation> emulation;  // for Target::emulated
    Blending blending = Blending::native;
    std::optional<Dither> dither;
    std::optional<TreePlan> tree;
    std::optional<double> error_bound;  // of "tree": "auto", in 1/255, with its reason
    std::string tree_reason;
    Classification classification = Classification::post;
    Order order = Order::back_to_front;
    VolumeSampling sampling = VolumeSampling::fetch;
    bool float_texture = false;    // samples normalised to their range and stored as R32F
    bool table_filtered = false;   // tables go through the texture unit's filter instead of fetches
    bool orthographic = false;     // rays are parallel: one direction, one length per depth
    bool single_color = false;     // colour is a constant of the program
    bool precise_rays = true;      // rays and chords in double precision
    bool nan_transparent = false;  // samples may be NaN
    int batches = 1;               // draws of a frame, each waited for: progress, and Ctrl-C
    bool nothing_visible = false;  // no slab is drawn
    TablePlan table;               // for Classification::preintegrated
    IndexBox drawn;  // polygons cover this part of the box (segments are those of the whole box)
    std::vector<TextureBrick> bricks;

    bool has_tree(NodeArithmetic nodes) const { return tree && tree->nodes == nodes; }
    // Bits of a code where slabs are rounded to codes in the program.
    int code_bits() const {
        return emulation ? emulation->bits : target == Target::fixed16 ? 16 : 8;
    }
    bool uses_table() const {
        return classification == Classification::preintegrated && sampling != VolumeSampling::none;
    }
};

// What will run: a pure function of scene, facts and capabilities, printable.
struct Plan {
    Method method = Method::slice;
    SlicePlan slice;  // for Method::slice
    std::vector<Omission> omitted;
};

// Throws Error when the context cannot do what the scene asks for, naming the limit.
Plan make_plan(const Scene& scene, const Facts& facts, const Capabilities& capabilities,
               const OmissionSwitch& omissions);
// For methods that draw a mesh (Scene::draws_mesh).
Plan make_plan(const Scene& scene, const MeshFacts& facts);

// A table for people: what runs, then what is left out and why (--explain).
std::string explain(const Plan& plan, const Facts& facts, const Capabilities& capabilities);
std::string explain(const Plan& plan, const MeshFacts& facts);

}  // namespace lamina
