// SPDX-License-Identifier: Apache-2.0
#include "scene/project_reader.h"

#include "scene/tree_reader.h"

namespace lamina {
namespace {

TableSettings read_table(JsonReader reader) {
    TableSettings table;
    if (reader.has("scalar")) table.scalar = static_cast<int>(reader.whole("scalar", 2, 4096));
    if (reader.has("length")) table.length = static_cast<int>(reader.whole("length", 1, 64));
    table.mapping = reader.choice<LengthMapping>("mapping", {{"octave", LengthMapping::octave},
                                                             {"log2", LengthMapping::log2},
                                                             {"linear", LengthMapping::linear}});
    table.store = reader.choice<TableStore>(
        "store",
        {{"mean_extinction", TableStore::mean_extinction}, {"opacity", TableStore::opacity}});
    table.format = reader.choice<TableFormat>("format", {{"fixed16", TableFormat::fixed16},
                                                         {"fixed8", TableFormat::fixed8},
                                                         {"float16", TableFormat::float16},
                                                         {"float32", TableFormat::float32}});
    table.construction = reader.choice<TableConstruction>(
        "construction",
        {{"exact", TableConstruction::exact}, {"incremental", TableConstruction::incremental}});
    reader.close();
    return table;
}

// One polygon around a tet cannot carry what is interpolated between the vertices of a fan.
void check_geometry(JsonReader& reader, const ProjectSettings& project) {
    if (project.geometry != ProjectGeometry::silhouette) return;
    if (project.interpolation == Interpolation::linear)
        reader.reject("geometry", "\"triangles\" for linear interpolation, or \"auto\"");
    if (project.coloring == Coloring::vertex || project.coloring == Coloring::attenuation) {
        reader.reject("geometry", fmt::format("\"triangles\" for the coloring \"{}\", or \"auto\"",
                                              name_of(project.coloring)));
    }
}

}  // namespace

ProjectSettings read_project(JsonReader reader) {
    ProjectSettings project;
    project.coloring =
        reader.choice<Coloring>("coloring", {{"preintegrated", Coloring::preintegrated},
                                             {"attenuation", Coloring::attenuation},
                                             {"vertex", Coloring::vertex},
                                             {"analytic", Coloring::analytic}});
    project.interpolation = reader.choice<Interpolation>(
        "interpolation",
        {{"perspective", Interpolation::perspective}, {"linear", Interpolation::linear}});
    project.thickness =
        reader.choice<Thickness>("thickness", {{"exact", Thickness::exact}, {"dz", Thickness::dz}});
    project.order = reader.choice<ProjectOrder>("order", {{"auto", ProjectOrder::automatic},
                                                          {"mpvo", ProjectOrder::mpvo},
                                                          {"exact", ProjectOrder::exact},
                                                          {"centroid", ProjectOrder::centroid},
                                                          {"none", ProjectOrder::none}});
    project.geometry =
        reader.choice<ProjectGeometry>("geometry", {{"auto", ProjectGeometry::automatic},
                                                    {"silhouette", ProjectGeometry::silhouette},
                                                    {"triangles", ProjectGeometry::triangles}});
    project.dither =
        reader.choice<ProjectDither>("dither", {{"none", ProjectDither::none},
                                                {"alpha", ProjectDither::alpha},
                                                {"after_blend", ProjectDither::after_blend}});
    if (reader.has("table") && reader.value("table") != "auto") {
        if (!reader.value("table").is_object())
            reader.reject("table", "an object {\"scalar\": ...}, or \"auto\"");
        project.table = read_table(reader.object("table"));
    }
    check_geometry(reader, project);
    project.tree = read_tree(reader);
    reader.close();
    return project;
}

}  // namespace lamina
