// SPDX-License-Identifier: Apache-2.0
#include "study/lamar.h"

namespace lamina {

const std::vector<LamarItem>& lamar_items() {
    static const std::vector<LamarItem> items{
        {"table1", reproduce_table1, nullptr},       {"table2", reproduce_table2, nullptr},
        {"table3", reproduce_table3, nullptr},       {"table4", nullptr, draw_table4},
        {"figure1", nullptr, draw_figure1},          {"figure2", reproduce_figure2, nullptr},
        {"figure3", reproduce_figure3, nullptr},     {"figure4", reproduce_figure4, nullptr},
        {"figure5", reproduce_figure5, nullptr},     {"figure6", nullptr, draw_figure6},
        {"figure9", reproduce_figure9, nullptr},     {"figure10", nullptr, draw_figure10},
        {"order", reproduce_order, nullptr},         {"order_mixing", nullptr, draw_order_mixing},
        {"dithering", reproduce_dithering, nullptr}, {"times", nullptr, draw_times},
    };
    return items;
}

}  // namespace lamina
