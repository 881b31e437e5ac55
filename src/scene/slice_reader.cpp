// SPDX-License-Identifier: Apache-2.0
#include "scene/slice_reader.h"

#include "compositing/dither.h"
#include "compositing/tree_shape.h"

namespace lamina {
namespace {

std::uint32_t read_seed(JsonReader& reader) {
    if (!reader.has("seed")) return 1;
    return static_cast<std::uint32_t>(reader.whole("seed", 0, 0xffffffff));
}

DitherSettings read_dither(JsonReader reader) {
    DitherSettings dither;
    if (reader.has("period")) {
        if (reader.value("period") == "auto") {
            dither.period.reset();
        } else if (reader.value("period").is_number()) {
            dither.period = static_cast<int>(reader.whole("period", 1, max_dither_period));
        } else {
            reader.reject("period", fmt::format("a whole number from 1 to {}, or \"auto\"",
                                                max_dither_period));
        }
    }
    dither.seed = read_seed(reader);
    dither.color = reader.flag_or("color", dither.color);
    if (reader.has("increment")) {
        dither.increment = static_cast<int>(reader.whole("increment", 1, 128));
    }
    reader.close();
    return dither;
}

// A list [root, ..., leaf], or as text for the command line: 32x32, 4^5, 1024.
std::vector<int> read_factors(JsonReader& reader) {
    const std::string expected = fmt::format(
        "1 to {} bifurcation factors from 1 to {}, root first, as in [32, 32] or \"32x32\"",
        max_tree_levels, max_tree_factor);
    if (!reader.has("factors")) reader.reject("factors", expected);
    const nlohmann::json& value = reader.value("factors");
    const auto is_factor = [](const nlohmann::json& factor) {
        return factor.is_number_integer() && factor.get<double>() >= 1 &&
               factor.get<double>() <= max_tree_factor;
    };
    if (value.is_string()) {
        try {
            return parse_factors(value.get<std::string>());
        } catch (const Error&) {
            reader.reject("factors", expected);
        }
    }
    if (is_factor(value)) return {value.get<int>()};
    if (!value.is_array() || value.empty() || value.size() > max_tree_levels ||
        !std::all_of(value.begin(), value.end(), is_factor)) {
        reader.reject("factors", expected);
    }
    return value.get<std::vector<int>>();
}

TreeSettings read_tree(JsonReader reader) {
    TreeSettings tree;
    tree.factors = read_factors(reader);
    tree.nodes = reader.choice<NodeArithmetic>(
        "nodes", {{"shader", NodeArithmetic::shader}, {"fixed", NodeArithmetic::fixed}});
    tree.code = reader.choice<NodeCode>(
        "code",
        {{"minimax", NodeCode::minimax}, {"phi", NodeCode::phi}, {"alpha", NodeCode::alpha}});
    if (reader.has("alpha_bits")) {
        if (reader.value("alpha_bits") != 8 && reader.value("alpha_bits") != 16) {
            reader.reject("alpha_bits", "8 or 16");
        }
        tree.alpha_bits = reader.value("alpha_bits").get<int>();
    }
    reader.close();
    return tree;
}

}  // namespace

SliceSettings read_slice(JsonReader reader) {
    SliceSettings slice;
    if (reader.has("samples") && reader.value("samples") != "auto") {
        if (!reader.value("samples").is_number()) {
            reader.reject("samples",
                          fmt::format("a whole number from 1 to {}, or \"auto\"", max_slabs));
        }
        slice.samples = static_cast<int>(reader.whole("samples", 1, max_slabs));
    }
    slice.classification = reader.choice<Classification>(
        "classification",
        {{"post", Classification::post}, {"preintegrated", Classification::preintegrated}});
    slice.order = reader.choice<Order>("order", {{"back_to_front", Order::back_to_front},
                                                 {"front_to_back", Order::front_to_back}});
    slice.filter =
        reader.choice<Filter>("filter", {{"exact", Filter::exact}, {"hardware", Filter::hardware}});
    if (reader.has("dither")) slice.dither = read_dither(reader.object("dither"));
    if (reader.has("tree")) {
        if (reader.value("tree") == "auto") {
            slice.tree = TreeSettings{.automatic = true, .factors = {}};
        } else if (reader.value("tree").is_object()) {
            slice.tree = read_tree(reader.object("tree"));
        } else {
            reader.reject("tree", "an object {\"factors\": ...}, or \"auto\"");
        }
    }
    reader.close();
    return slice;
}

Emulation read_emulation(JsonReader reader) {
    Emulation emulation;
    if (reader.has("bits")) {
        emulation.bits = static_cast<int>(reader.whole("bits", 1, max_code_bits));
    }
    emulation.alpha =
        reader.choice<AlphaRounding>("alpha", {{"truncate", AlphaRounding::truncate},
                                               {"nearest", AlphaRounding::nearest},
                                               {"stochastic", AlphaRounding::stochastic}});
    emulation.over = reader.choice<OverRounding>(
        "over", {{"separate", OverRounding::separate}, {"fused", OverRounding::fused}});
    emulation.seed = read_seed(reader);
    reader.close();
    return emulation;
}

}  // namespace lamina
