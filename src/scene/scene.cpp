// SPDX-License-Identifier: Apache-2.0
#include "lamina/scene.h"

#include "base/client.h"
#include "base/enum_words.h"
#include "base/error.h"
#include "scene/scene_mesh.h"
#include "volume/generate.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

const VolumeFile& file_of_volume(const Scene& scene) {
    if (const VolumeFile* const file = scene.volume_file()) return *file;
    fail("no volume was given, and the scene names none");
}

}  // namespace

// The words of scene files and messages.
const char* name_of(Method method) {
    return word_of(method, {"slice", "project", "trace"});
}

const char* name_of(Target target) {
    return word_of(target, {"float32", "float16", "fixed16", "fixed8", "emulated"});
}

const char* name_of(TraceOf of) {
    return word_of(of, {"volume", "mesh"});
}

const char* name_of(NanPolicy policy) {
    return word_of(policy, {"error", "transparent"});
}

const char* name_of(Classification classification) {
    return word_of(classification, {"post", "preintegrated", "exact"});
}

const char* name_of(Order order) {
    return word_of(order, {"back_to_front", "front_to_back"});
}

const char* name_of(Filter filter) {
    return word_of(filter, {"exact", "hardware"});
}

const char* name_of(NodeArithmetic nodes) {
    return word_of(nodes, {"shader", "fixed"});
}

const char* name_of(NodeCode code) {
    return word_of(code, {"minimax", "phi", "alpha"});
}

const char* name_of(AlphaRounding rounding) {
    return word_of(rounding, {"truncate", "nearest", "stochastic"});
}

const char* name_of(OverRounding rounding) {
    return word_of(rounding, {"separate", "fused"});
}

const char* name_of(Coloring coloring) {
    return word_of(coloring, {"preintegrated", "attenuation", "vertex", "analytic"});
}

const char* name_of(Interpolation interpolation) {
    return word_of(interpolation, {"perspective", "linear"});
}

const char* name_of(Thickness thickness) {
    return word_of(thickness, {"exact", "dz"});
}

const char* name_of(ProjectOrder order) {
    return word_of(order, {"mpvo", "exact", "centroid", "none"});
}

const char* name_of(ProjectGeometry geometry) {
    return word_of(geometry, {"silhouette", "triangles"});
}

const char* name_of(ProjectDither dither) {
    return word_of(dither, {"none", "alpha", "after_blend"});
}

const char* name_of(LengthMapping mapping) {
    return word_of(mapping, {"octave", "log2", "linear"});
}

const char* name_of(TableStore store) {
    return word_of(store, {"mean_extinction", "opacity"});
}

const char* name_of(TableFormat format) {
    return word_of(format, {"fixed16", "fixed8", "float16", "float32"});
}

const char* name_of(TableConstruction construction) {
    return word_of(construction, {"exact", "incremental"});
}

Volume load_volume(const Scene& scene, const std::filesystem::path& only_below) {
    const OnlyBelowScope scope(only_below);
    if (const auto* request = std::get_if<GeneratorRequest>(&scene.volume))
        return generate(*request);
    const VolumeFile& file = file_of_volume(scene);
    return read_volume(file.path, file.selection);
}

Volume open_volume(const Scene& scene) {
    if (const auto* request = std::get_if<GeneratorRequest>(&scene.volume))
        return generate(*request);
    const VolumeFile& file = file_of_volume(scene);
    return open_volume(
        file.path, file.selection,
        {.residence = VolumeUse::Residence::as_fits, .lit = scene.lighting.has_value()});
}

}  // namespace lamina
