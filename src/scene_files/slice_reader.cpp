// SPDX-License-Identifier: Apache-2.0
#include "scene_files/slice_reader.h"

#include "base/enum_words.h"
#include "compositing/dither.h"
#include "scene_files/tree_reader.h"

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

SliceTableSettings read_slice_table(JsonReader reader) {
    SliceTableSettings table;
    if (reader.has("scalar")) table.scalars = static_cast<int>(reader.whole("scalar", 2, 4096));
    if (reader.has("length")) table.lengths = static_cast<int>(reader.whole("length", 1, 64));
    table.max_length = reader.number_or("max_length", table.max_length);
    if (!(table.max_length >= 0)) reader.reject("max_length", "a length of 0 or more");
    reader.close();
    return table;
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
    slice.classification =
        reader.choice<Classification>("classification", enum_words<Classification>());
    slice.order = reader.choice<Order>("order", enum_words<Order>());
    slice.filter = reader.choice<Filter>("filter", enum_words<Filter>());
    if (reader.has("dither")) slice.dither = read_dither(reader.object("dither"));
    slice.tree = read_tree(reader);
    if (reader.has("table") && reader.value("table") != "auto") {
        if (!reader.value("table").is_object())
            reader.reject("table", "an object {\"scalar\": ...}, or \"auto\"");
        slice.table = read_slice_table(reader.object("table"));
    }
    reader.close();
    return slice;
}

Emulation read_emulation(JsonReader reader) {
    Emulation emulation;
    if (reader.has("bits")) {
        emulation.bits = static_cast<int>(reader.whole("bits", 1, max_code_bits));
    }
    emulation.alpha = reader.choice<AlphaRounding>("alpha", enum_words<AlphaRounding>());
    emulation.over = reader.choice<OverRounding>("over", enum_words<OverRounding>());
    emulation.seed = read_seed(reader);
    reader.close();
    return emulation;
}

}  // namespace lamina
