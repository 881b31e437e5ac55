// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/export.h"

namespace lamina {

// Where the layers lie along length, and what runs straight between two of them. With L layers and
// dl = max_length / 2^(L-2) the latter two have nodes 0, dl, 2 dl, 4 dl, ..., max_length.
enum class LengthMapping {
    octave,  // linear in length between two layers
    log2,    // Kraus 2004, Equation 1: linear in log2 of length from dl on
    linear   // equally spaced lengths
};
enum class TableStore {
    // tbar = optical depth / length, and with colour the emission tbar * C / alpha: what stays
    // bounded and smooth as the length goes to 0 (docs/numerics.md, section 5). A single layer is
    // the limit at length 0.
    mean_extinction,
    // alpha and the associated colour C themselves: the paper's. A single layer is that of
    // max_length.
    opacity
};
enum class TableFormat { fixed16, fixed8, float16, float32 };
enum class TableConstruction {
    exact,       // every entry by the closed form of its segment
    incremental  // layers from those of shorter segments (Weiler et al. 2003): the paper's
};

// Of pre-integration tables with equally spaced scalars.
struct TableSettings {
    int scalar = 256;
    int length = 16;
    LengthMapping mapping = LengthMapping::octave;
    TableStore store = TableStore::mean_extinction;
    TableFormat format = TableFormat::fixed16;
    TableConstruction construction = TableConstruction::exact;
};

LAMINA_API const char* name_of(LengthMapping mapping);
LAMINA_API const char* name_of(TableStore store);
LAMINA_API const char* name_of(TableFormat format);
LAMINA_API const char* name_of(TableConstruction construction);

}  // namespace lamina
