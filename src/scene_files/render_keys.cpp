// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "compositing/codes.h"
#include "compositing/tree_shape.h"
#include "scene/scene.h"
#include "scene_files/keys.h"
#include "scene_files/scene_keys.h"

namespace lamina {
namespace {

// Reads the factors of a compositing tree: [root, ..., leaf], 1024, "32x32", "4^5" or "1024".
std::vector<int> read_factors(JsonReader& reader, const std::string& key) {
    const std::string expected = fmt::format(
        "1 to {} bifurcation factors from 1 to {}, root first, as in [32, 32] or \"32x32\"",
        max_tree_levels, max_tree_factor);
    if (!reader.has(key)) reader.reject(key, expected);
    const nlohmann::json& value = reader.value(key);
    const auto is_factor = [](const nlohmann::json& factor) {
        return factor.is_number_integer() && factor.get<double>() >= 1 &&
               factor.get<double>() <= max_tree_factor;
    };
    if (value.is_string()) {
        try {
            return parse_factors(value.get<std::string>());
        } catch (const Error&) {
            reader.reject(key, expected);
        }
    }
    if (is_factor(value)) return {value.get<int>()};
    if (!value.is_array() || value.empty() || value.size() > max_tree_levels ||
        !std::ranges::all_of(value, is_factor)) {
        reader.reject(key, expected);
    }
    return value.get<std::vector<int>>();
}

Form<std::vector<int>> factors_form() {
    const KeyJson list{{"type", "array"},
                       {"items", reference_to("factor")},
                       {"minItems", 1},
                       {"maxItems", max_tree_levels}};
    const KeyJson text{{"type", "string"},
                       {"pattern", "^[0-9]+(\\^[0-9]+)?(x[0-9]+(\\^[0-9]+)?)*$"}};
    return {read_factors,
            [](const std::vector<int>& factors) { return KeyJson(factors); },
            {{"oneOf", KeyJson::array({list, reference_to("factor"), text})}}};
}

void tree_keys(KeyTable<TreeSettings>& keys) {
    keys.key("factors", &TreeSettings::factors, factors_form(),
             "Bifurcation factors from the root to the leaves.")
        .required();
    keys.key("nodes", &TreeSettings::nodes, words_form<NodeArithmetic>());
    keys.key("code", &TreeSettings::code, words_form<NodeCode>());
    keys.key("alpha_bits", &TreeSettings::alpha_bits, code_bits_form());
}

Form<Auto<TreeSettings>> tree_form() {
    auto form = automatic_form(object_form(table_of<tree_keys>), &nlohmann::json::is_object,
                               "an object {\"factors\": ...}, or \"auto\"");
    form.schema = reference_to("tree");
    return form;
}

void dither_keys(KeyTable<DitherSettings>& keys) {
    keys.key("seed", &DitherSettings::seed, seed_form());
    keys.key("color", &DitherSettings::color, flag_form());
    keys.key("increment", &DitherSettings::increment, whole_form<int>(1, 128),
             "Between the two codes.");
    keys.key(
        "period", &DitherSettings::period,
        automatic_form(whole_form<int>(1, max_dither_period), &nlohmann::json::is_number,
                       fmt::format("a whole number from 1 to {}, or \"auto\"", max_dither_period)),
        "Slabs after which the pattern repeats; auto: N.");
}

void slice_table_keys(KeyTable<SliceTableSettings>& keys) {
    keys.key("scalar", &SliceTableSettings::scalars, whole_form<int>(2, 4096));
    keys.key("length", &SliceTableSettings::lengths, whole_form<int>(1, 64));
    keys.key("max_length", &SliceTableSettings::max_length,
             number_form({.from = 0}, "a length of 0 or more"), "Longest segment, world units.");
}

// The form of a pre-integration table. An automatic one is left out when written.
template <typename Table>
Form<Auto<Table>> table_form(const KeyTable<Table>& (*table)()) {
    auto form = automatic_form(object_form(table), &nlohmann::json::is_object,
                               "an object {\"scalar\": ...}, or \"auto\"");
    form.write = [table](const Auto<Table>& value) {
        return value.is_given() ? table().json(*value) : KeyJson();
    };
    return form;
}

void slice_keys(KeyTable<SliceSettings>& keys) {
    keys.key("samples", &SliceSettings::samples,
             automatic_form(whole_form<int>(1, max_slabs), &nlohmann::json::is_number,
                            fmt::format("a whole number from 1 to {}, or \"auto\"", max_slabs)),
             "Slabs N, or auto: the fewest that keep render.max_error.");
    keys.key("classification", &SliceSettings::classification,
             automatic_words_form(SliceSettings().classification));
    keys.key("order", &SliceSettings::order, words_form<Order>());
    keys.key("filter", &SliceSettings::filter, automatic_words_form(SliceSettings().filter));
    keys.key("dither", &SliceSettings::dither, optional_form(object_form(table_of<dither_keys>)),
             "Along depth, of the codes of fixed-point slabs.");
    keys.key("tree", &SliceSettings::tree, optional_form(tree_form()));
    keys.key("table", &SliceSettings::table, table_form(table_of<slice_table_keys>),
             "Pre-integration table; auto: the plan chooses it for the view.");
}

void emulation_keys(KeyTable<Emulation>& keys) {
    keys.key("bits", &Emulation::bits, whole_form<int>(1, max_code_bits), "Of a code.");
    keys.key("alpha", &Emulation::alpha, words_form<AlphaRounding>());
    keys.key("over", &Emulation::over, words_form<OverRounding>());
    keys.key("seed", &Emulation::seed, seed_form());
}

void project_table_keys(KeyTable<TableSettings>& keys) {
    keys.key("scalar", &TableSettings::scalar, whole_form<int>(2, 4096));
    keys.key("length", &TableSettings::length, whole_form<int>(1, 64));
    keys.key("mapping", &TableSettings::mapping, words_form<LengthMapping>());
    keys.key("store", &TableSettings::store, words_form<TableStore>());
    keys.key("format", &TableSettings::format, words_form<TableFormat>());
    keys.key("construction", &TableSettings::construction, words_form<TableConstruction>());
}

// Rejects "silhouette" (one polygon for a tet) for colourings that interpolate in triangles.
void check_geometry(JsonReader& reader, const ProjectSettings& project) {
    if (project.geometry != ProjectGeometry::silhouette) return;
    if (project.interpolation == Interpolation::linear)
        reader.reject("geometry", "\"triangles\" for linear interpolation, or \"auto\"");
    if (mixes_colors(project.coloring)) {
        reader.reject("geometry", fmt::format("\"triangles\" for the coloring \"{}\", or \"auto\"",
                                              name_of(project.coloring)));
    }
}

void project_keys(KeyTable<ProjectSettings>& keys) {
    keys.key("coloring", &ProjectSettings::coloring, words_form<Coloring>());
    keys.key("interpolation", &ProjectSettings::interpolation, words_form<Interpolation>());
    keys.key("thickness", &ProjectSettings::thickness, words_form<Thickness>());
    keys.key("order", &ProjectSettings::order, automatic_words_form(ProjectSettings().order));
    keys.key("geometry", &ProjectSettings::geometry,
             automatic_words_form(ProjectSettings().geometry));
    keys.key("dither", &ProjectSettings::dither, words_form<ProjectDither>());
    keys.key("table", &ProjectSettings::table, table_form(table_of<project_table_keys>),
             "Pre-integration table; auto: the cheapest that keeps its error under max_error / "
             "2 and .5 / 255.");
    keys.check(check_geometry);
    keys.key("tree", &ProjectSettings::tree, optional_form(tree_form()), "Of nodes fixed.");
}

void trace_keys(KeyTable<Scene>& keys) {
    keys.key("of", &Scene::trace_of, words_form<TraceOf>(), "The volume if the scene has one.")
        .without_default();
    keys.check([](JsonReader& reader, Scene& scene) {
        const bool volume = has_volume(reader, scene), mesh = has_mesh(reader, scene);
        if (!reader.has("of")) {
            scene.trace_of = volume ? TraceOf::volume : TraceOf::mesh;
        } else if (scene.trace_of == TraceOf::volume && !volume) {
            reader.reject("of", "\"mesh\": the scene has no volume");
        } else if (scene.trace_of == TraceOf::mesh && !mesh) {
            reader.reject("of", "\"volume\": the scene has no mesh");
        }
    });
    // 1e-12: the tracer's own rounding exceeds smaller tolerances.
    keys.key("tolerance", &Scene::trace_tolerance,
             number_form({.from = 1e-12, .up_to = 1}, "a number from 1e-12 to 1"),
             "Error bound, of full scale.");
}

void check_method(JsonReader& reader, Scene& scene) {
    if (scene.method == Method::slice && !has_volume(reader, scene))
        reader.reject("method", "\"project\" or \"trace\" for a scene without a volume");
    if (scene.method == Method::project && !has_mesh(reader, scene))
        reader.reject("method",
                      "\"slice\" or \"trace\" for a scene without a mesh (mesh.tolerance=.02 makes "
                      "one of the volume)");
    const bool emulates = scene.method == Method::project && scene.target == Target::emulated;
    if (emulates && scene.project.dither == ProjectDither::alpha) {
        reader.fail_at("project.dither",
                       "found \"alpha\" with the target \"emulated\", expected \"none\" or "
                       "\"after_blend\": render.emulate.alpha says how opacity is rounded there");
    }
}

}  // namespace

KeyJson tree_schema() {
    return {{"oneOf", KeyJson::array({{{"const", "auto"}}, table_of<tree_keys>().schema()})}};
}

void render_keys(KeyTable<Scene>& keys) {
    keys.key("method", &Scene::method, words_form<Method>(),
             "Left out: slice for scenes with a volume, project for others.")
        .without_default();
    keys.check([](JsonReader& reader, Scene& scene) {
        if (!reader.has("method"))
            scene.method = has_volume(reader, scene) ? Method::slice : Method::project;
    });
    keys.key("target", &Scene::target, automatic_words_form(Scene().target));
    keys.object("emulate", &Scene::emulate, table_of<emulation_keys>,
                "Fixed-point compositing step by step, for target emulated.");
    keys.key("max_error", &Scene::max_error,
             number_form({.above = 0, .up_to = 255},
                         "a number above 0 and up to 255 (in 1/255 of full scale)"),
             "Bound for what is automatic, in 1/255 of full scale.");
    keys.object("slice", &Scene::slice, table_of<slice_keys>, "Slices of a volume.");
    keys.object("project", &Scene::project, table_of<project_keys>, "Projected tetrahedra.");
    keys.object("trace", table_of<trace_keys>, "The reference tracer.");
    keys.check(check_method);
}

}  // namespace lamina
