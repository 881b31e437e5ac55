// SPDX-License-Identifier: Apache-2.0
#include "study/kraus.h"

namespace lamina {

const std::vector<KrausItem>& kraus_items() {
    static const std::vector<KrausItem> items{
        {"figure7", nullptr, draw_kraus_figure7},
        {"figure8", nullptr, draw_kraus_figure8},
        {"figure9", nullptr, draw_kraus_figure9},
        {"figure10", nullptr, draw_kraus_figure10},
        {"artifacts", nullptr, draw_kraus_artifacts},
        {"preintegration", nullptr, draw_kraus_preintegration},
        {"orders", nullptr, draw_kraus_orders},
        {"table1", nullptr, draw_kraus_table1},
        {"table2", nullptr, draw_kraus_table2},
    };
    return items;
}

}  // namespace lamina
