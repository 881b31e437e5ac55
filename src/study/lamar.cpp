// SPDX-License-Identifier: Apache-2.0
#include "study/lamar.h"

namespace lamina {

const std::vector<LamarItem>& lamar_items() {
    static const std::vector<LamarItem> items{
        {"table1", reproduce_table1},   {"table2", reproduce_table2},
        {"table3", reproduce_table3},   {"figure2", reproduce_figure2},
        {"figure3", reproduce_figure3}, {"figure4", reproduce_figure4},
        {"figure5", reproduce_figure5}, {"figure9", reproduce_figure9},
        {"order", reproduce_order},     {"dithering", reproduce_dithering},
    };
    return items;
}

}  // namespace lamina
