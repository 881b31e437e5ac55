// SPDX-License-Identifier: Apache-2.0
#include "papers/lamar.h"

#include "papers/figure_files.h"

namespace lamina::papers {

const std::vector<LamarItem>& lamar_items() {
    static const std::vector<LamarItem> items{
        {"table1", {"table1.csv"}, reproduce_table1, nullptr},
        {"table2", {"table2.csv"}, reproduce_table2, nullptr},
        {"table3", {"table3.csv"}, reproduce_table3, nullptr},
        {"table4", {"table4.csv"}, nullptr, draw_table4},
        {"figure1", {"figure1.csv"}, nullptr, draw_figure1},
        {"figure2", ramp_figure_files("figure2"), reproduce_figure2, nullptr},
        {"figure3", ramp_figure_files("figure3"), reproduce_figure3, nullptr},
        {"figure4", ramp_figure_files("figure4"), reproduce_figure4, nullptr},
        {"figure5", ramp_figure_files("figure5"), reproduce_figure5, nullptr},
        {"figure6", {}, nullptr, draw_figure6},
        {"figure9", ramp_figure_files("figure9"), reproduce_figure9, nullptr},
        {"figure10", {"figure10.csv"}, nullptr, draw_figure10},
        {"order", {"order.csv", "order.svg"}, reproduce_order, nullptr},
        {"order_mixing", {"order_mixing.csv"}, nullptr, draw_order_mixing},
        {"dithering",
         {"dithering_periods.csv", "dithering_periods.svg", "dithering_increments.csv",
          "dithering_increments.svg", "dithering_spans.csv"},
         reproduce_dithering,
         nullptr},
        {"times", {"times.csv", "times_barriers.csv", "times_palettes.csv"}, nullptr, draw_times},
    };
    return items;
}

}  // namespace lamina::papers
