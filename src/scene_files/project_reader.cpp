// SPDX-License-Identifier: Apache-2.0
#include "scene_files/project_reader.h"

#include "base/enum_words.h"
#include "scene/coloring.h"
#include "scene_files/tree_reader.h"

namespace lamina {
namespace {

TableSettings read_table(JsonReader reader) {
    TableSettings table;
    if (reader.has("scalar")) table.scalar = static_cast<int>(reader.whole("scalar", 2, 4096));
    if (reader.has("length")) table.length = static_cast<int>(reader.whole("length", 1, 64));
    table.mapping = reader.choice<LengthMapping>("mapping", enum_words<LengthMapping>());
    table.store = reader.choice<TableStore>("store", enum_words<TableStore>());
    table.format = reader.choice<TableFormat>("format", enum_words<TableFormat>());
    table.construction =
        reader.choice<TableConstruction>("construction", enum_words<TableConstruction>());
    reader.close();
    return table;
}

// Values interpolated between the vertices of a fan cannot be drawn with one polygon around a tet.
void check_geometry(JsonReader& reader, const ProjectSettings& project) {
    if (project.geometry != ProjectGeometry::silhouette) return;
    if (project.interpolation == Interpolation::linear)
        reader.reject("geometry", "\"triangles\" for linear interpolation, or \"auto\"");
    if (mixes_colors(project.coloring)) {
        reader.reject("geometry", fmt::format("\"triangles\" for the coloring \"{}\", or \"auto\"",
                                              name_of(project.coloring)));
    }
}

}  // namespace

ProjectSettings read_project(JsonReader reader) {
    ProjectSettings project;
    project.coloring = reader.choice<Coloring>("coloring", enum_words<Coloring>());
    project.interpolation =
        reader.choice<Interpolation>("interpolation", enum_words<Interpolation>());
    project.thickness = reader.choice<Thickness>("thickness", enum_words<Thickness>());
    project.order = reader.choice<ProjectOrder>("order", enum_words<ProjectOrder>());
    project.geometry = reader.choice<ProjectGeometry>("geometry", enum_words<ProjectGeometry>());
    project.dither = reader.choice<ProjectDither>("dither", enum_words<ProjectDither>());
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
