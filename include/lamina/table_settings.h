// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/export.h"

namespace lamina {

// Segment lengths at which the layers of a table lie, and the coordinate that is linear between two
// layers. With L layers and dl = max_length / 2^(L-2), `octave` and `log2` have layers at 0, dl, 2
// dl, 4 dl, ..., max_length.
enum class LengthMapping {
    octave,  // linear in length between two layers
    log2,    // linear in log2 of length from dl on: Kraus 2004, Equation 1
    linear   // equally spaced lengths
};
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

}  // namespace lamina
