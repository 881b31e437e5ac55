// SPDX-License-Identifier: Apache-2.0
#include "papers/kraus.h"

#include "papers/compared_pictures.h"

namespace lamina::papers {
namespace {

// Returns the files of an item that shows meshes one by one: NAME_MESH.png and .csv, and `also`.
std::vector<std::string> files_of_meshes(const std::string& name,
                                         const std::vector<std::string>& meshes,
                                         std::vector<std::string> also = {}) {
    for (const std::string& mesh : meshes) {
        const auto files = compared_picture_files(name + "_" + mesh);
        also.insert(also.end(), files.begin(), files.end());
    }
    return also;
}

}  // namespace

const std::vector<KrausItem>& kraus_items() {
    static const std::vector<KrausItem> items{
        {"figure7", compared_picture_files("figure7"), nullptr, draw_kraus_figure7},
        {"figure8", compared_picture_files("figure8"), nullptr, draw_kraus_figure8},
        {"figure9", compared_picture_files("figure9"), nullptr, draw_kraus_figure9},
        {"figure10", files_of_meshes("figure10", {"graded", "plate", "bluntfin"}), nullptr,
         draw_kraus_figure10},
        {"artifacts", {"artifacts.csv"}, nullptr, draw_kraus_artifacts},
        {"preintegration", {"preintegration.csv"}, nullptr, draw_kraus_preintegration},
        {"orders",
         files_of_meshes("orders", {"bluntfin", "combustor", "torso", "box", "graded", "plate"},
                         {"orders.csv"}),
         nullptr, draw_kraus_orders},
        {"table1", {"table1.csv"}, nullptr, draw_kraus_table1},
        {"table2", {"table2.csv"}, nullptr, draw_kraus_table2},
    };
    return items;
}

}  // namespace lamina::papers
