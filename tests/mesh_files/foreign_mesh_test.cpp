// SPDX-License-Identifier: Apache-2.0
// Meshes of kinds that are not read are refused by name, with what to do.
#include "bad_mesh_files.h"

namespace lamina {
namespace {

class ForeignMesh : public testing::BadMeshFiles {
  protected:
    void expect_named(const std::string& name, const std::string& bytes,
                      std::initializer_list<std::string> parts) {
        const auto path = write(name, bytes);
        expect_error([&] { expect_no_foreign_mesh(path); }, {name, "which is not read"});
        expect_error([&] { expect_no_foreign_mesh(path); }, parts);
        expect_error([&] { read_mesh(path); }, parts);
    }
};

std::string vtk_xml(const std::string& type) {
    return "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + type + "\" version=\"1.0\">";
}

TEST_F(ForeignMesh, IsNamedByItsContent) {
    expect_named("a.vtm", vtk_xml("vtkMultiBlockDataSet"), {"multi-block", ".pvtu"});
    expect_named("a.vtu", vtk_xml("vtkMultiBlockDataSet"), {"multi-block"});
    expect_named("a.vtpc", vtk_xml("vtkPartitionedDataSetCollection"), {"partitioned"});
    expect_named("a.vthb", vtk_xml("vtkOverlappingAMR"), {"adaptive grids"});
    expect_named("a.vts", vtk_xml("StructuredGrid"), {"curvilinear", "unstructured grid"});
    expect_named("a.pvts", vtk_xml("PStructuredGrid"), {"curvilinear"});
    expect_named("a.vtp", vtk_xml("PolyData"), {"surface", "no volume"});
    expect_named("a", "$MeshFormat\n4.1 0 8\n", {"Gmsh", "meshio"});
    expect_named("a.xml", "<?xml version=\"1.0\" ?>\n<Xdmf Version=\"3.0\">", {"XDMF"});
    expect_named("b.xml", "<?xml version=\"1.0\"?>\n<dolfin xmlns:dolfin=\"x\">", {"FEniCS"});
    expect_named("a.dat", "TITLE = \"flow\"\nVARIABLES = \"X\"\n", {"a Tecplot data set"});
    expect_named("b.dat", "VARIABLES = \"X\", \"Y\"\n", {"a Tecplot data set"});
    expect_named("a.vol", "mesh3d\n\ndimension\n3\n", {"a Netgen mesh"});
    expect_named("a.su2", "% comment\nNDIME= 3\n", {"a SU2 mesh"});
}

TEST_F(ForeignMesh, IsNamedByItsExtension) {
    expect_named("a.msh", "(0 \"Fluent\")", {"Gmsh or ANSYS Fluent"});
    expect_named("a.exo", "CDF\1", {"Exodus", ".vtu"});
    expect_named("a.e", "CDF\2", {"Exodus"});
    expect_named("a.cgns", "\x89HDF\r\n", {"CGNS"});
    expect_named("a.case", "FORMAT\n", {"EnSight"});
    expect_named("a.foam", "", {"OpenFOAM"});
    expect_named("a.vtk.series", "{\"file-series-version\": \"1.0\"}",
                 {"a list of files in time (ParaView)", ".pvd"});
    expect_named("a.plt", "#!TDV112", {"a Tecplot data set"});
    expect_named("a.inp", "*HEADING\n", {"an Abaqus or AVS (UCD) mesh"});
    expect_named("a.med", "\x89HDF\r\n", {"MED"});
}

TEST_F(ForeignMesh, IsNoFileThatIsReadOrMissing) {
    EXPECT_NO_THROW(expect_no_foreign_mesh(folder() / "none.msh"));
    EXPECT_NO_THROW(expect_no_foreign_mesh(write("a.exo", vtk_xml("UnstructuredGrid"))));
    EXPECT_NO_THROW(expect_no_foreign_mesh(write("a.vtu", vtk_xml("PUnstructuredGrid"))));
    EXPECT_NO_THROW(expect_no_foreign_mesh(write("a.vti", vtk_xml("ImageData"))));
}

TEST_F(ForeignMesh, IsNoFileWithAnArrayOrCommentOfSuchAWord) {
    for (const std::string word : {"AMR", "PolyData", "StructuredGrid", "vtkMultiBlockDataSet"}) {
        const std::string array = "<DataArray Name=\"" + word + "\"/>";
        EXPECT_NO_THROW(expect_no_foreign_mesh(write("a.vti", vtk_xml("ImageData") + array)));
        EXPECT_NO_THROW(
            expect_no_foreign_mesh(write("a.vtu", vtk_xml("UnstructuredGrid") + array)));
    }
    EXPECT_NO_THROW(expect_no_foreign_mesh(write("a.nrrd", "NRRD0004\n# of a <Xdmf> file\n")));
    EXPECT_NO_THROW(expect_no_foreign_mesh(write("a.json", "{\"note\": \"$MeshFormat\"}")));
}

TEST_F(ForeignMesh, IsNotTakenForOneThatIsReadByTheNameOfAnArray) {
    const std::string array = "<DataArray Name=\"UnstructuredGrid\"/>";
    EXPECT_FALSE(is_mesh_file(write("a.xml", vtk_xml("ImageData") + array)));
    EXPECT_TRUE(is_mesh_file(write("a.xml", vtk_xml("UnstructuredGrid"))));
}

}  // namespace
}  // namespace lamina
