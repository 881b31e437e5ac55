// SPDX-License-Identifier: Apache-2.0
// --only-below: no file outside the folder is opened, whichever file names it. HDF5 files are
// tested in tests/volume_files/array_oracle_test.cpp.
#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>

#include "cli/faults_test_case.h"

namespace lamina {
namespace {

namespace fs = std::filesystem;

class OnlyBelow : public FaultsTestCase {
  protected:
    void SetUp() override {
        FaultsTestCase::SetUp();
        fs::create_directory(up);
        write_bytes_to(folder / "secret.raw", std::string(64, 's'));
        write_bytes_to(up / "own.raw", std::string(64, 'o'));
        fs::create_symlink(folder / "secret.raw", up / "link.raw");
    }
    void write_nhdr(const std::string& name, const std::string& data) const {
        write_bytes_to(up / name,
                       "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\n"
                       "data file: " +
                           data + "\n\n");
    }
    void write_mhd(const std::string& name, const std::string& data) const {
        write_bytes_to(up / name,
                       "ObjectType = Image\nNDims = 3\nDimSize = 4 4 4\nElementType = MET_UCHAR\n"
                       "ElementDataFile = " +
                           data + "\n");
    }
    std::vector<std::string> below(std::vector<std::string> arguments) const {
        arguments.insert(arguments.end(), {"--only-below", up});
        return arguments;
    }
    // Expects that the option refuses a file that is read without it, and that nothing is written.
    void expect_refused(const fs::path& file) const {
        EXPECT_EQ(lamina_run({"info", file}).exit_code, 0) << file;
        expect_refused_by({"info", file});
        expect_refused_by({"render", file, "-o", out / "p.png", "--context", "cpu"});
        EXPECT_TRUE(fs::is_empty(out)) << file;
    }
    void expect_refused_by(const std::vector<std::string>& arguments) const {
        expect_one_line(lamina_run(below(arguments)), 1, {"not opened: it is not below", up});
    }
    void expect_read(const fs::path& file) const {
        const ProgramResult result = lamina_run(below({"info", file}));
        EXPECT_EQ(result.exit_code, 0) << file << ": " << result.err;
    }

    const fs::path up = folder / "uploads";
};

TEST_F(OnlyBelow, RestrictsDataFilesOfHeaders) {
    int number = 0;
    const auto each = [&](const std::string& data, bool is_below) {
        const std::string name = fmt::format("h{}", number++);
        write_nhdr(name + ".nhdr", data);
        write_mhd(name + ".mhd", data);
        for (const char* const suffix : {".nhdr", ".mhd"})
            is_below ? expect_read(up / (name + suffix)) : expect_refused(up / (name + suffix));
    };
    each("own.raw", true);
    each("../uploads/own.raw", true);
    each(up / "own.raw", true);
    each("../secret.raw", false);
    each(folder / "secret.raw", false);
    each("link.raw", false);
}

// A folder whose name begins with the folder's name is not below it.
TEST_F(OnlyBelow, RestrictsFilesNamedDirectly) {
    fs::create_directory(folder / "uploads2");
    fs::copy_file(folder / "volume.nrrd", folder / "uploads2/v.nrrd");
    fs::copy_file(folder / "volume.nrrd", up / "v.nrrd");
    fs::create_symlink(folder / "volume.nrrd", up / "linked.nrrd");
    fs::create_directory_symlink(folder / "uploads2", up / "inner");
    expect_read(up / "v.nrrd");
    for (const fs::path& file : {folder / "uploads2/v.nrrd", up / "linked.nrrd",
                                 up / "inner/v.nrrd", up / "../volume.nrrd"})
        expect_refused(file);
}

TEST_F(OnlyBelow, RestrictsPairsOfHeaderAndData) {
    std::string header(352, '\0');  // NIfTI-1: sizeof_hdr, dim, datatype, bitpix, pixdim, magic
    const auto put = [&](std::size_t at, const auto& value) {
        std::memcpy(&header[at], &value, sizeof value);
    };
    put(0, std::int32_t{348});
    put(40, std::array<std::int16_t, 8>{3, 4, 4, 4, 1, 1, 1, 1});
    put(70, std::array<std::int16_t, 2>{2, 8});
    put(76, std::array<float, 8>{1, 1, 1, 1, 1, 1, 1, 1});
    header.replace(344, 4, std::string("ni1\0", 4));
    write_bytes_to(folder / "p.hdr", header);
    fs::copy_file(folder / "secret.raw", folder / "p.img");
    fs::copy_file(folder / "p.hdr", up / "own.hdr");
    fs::copy_file(folder / "p.img", up / "own.img");
    expect_read(up / "own.img");
    fs::copy_file(folder / "p.img", up / "q.img");
    fs::create_symlink(folder / "p.hdr", up / "q.hdr");
    expect_refused(up / "q.img");
}

// No folder outside is searched, and messages do not tell whether a file outside exists.
TEST_F(OnlyBelow, RestrictsFoldersAndHidesWhetherFilesExist) {
    fs::create_directories(folder / "inner/array");
    write_bytes_to(folder / "inner/array/.zarray", "{}");
    fs::create_directory(up / "group.zarr");
    write_bytes_to(up / "group.zarr/.zgroup", R"({"zarr_format": 2})");
    fs::create_directory_symlink(folder / "inner", up / "group.zarr/inner");
    for (const fs::path& file : {up / "group.zarr", folder / "inner", folder / "absent.nrrd"})
        expect_refused_by({"info", file});
    const ProgramResult absent = lamina_run(below({"info", up / "absent.nrrd"}));
    EXPECT_NE(absent.err.find("no such file"), std::string::npos) << absent.err;
}

// Pictures are outputs of lamina, and may be outside.
TEST_F(OnlyBelow, DoesNotRestrictWherePicturesAreWritten) {
    fs::copy_file(folder / "volume.nrrd", up / "volume.nrrd");
    fs::copy_file(folder / "scene.json", up / "scene.json");
    const auto arguments = below({"render", up / "scene.json", "-o", out / "t_%04d.exr",
                                  "--turntable", "3", "--context", "cpu", "--quiet"});
    make(arguments);
    make(arguments);  // reads the pictures that it wrote, to keep them
    EXPECT_TRUE(fs::exists(out / "t_0002.exr"));
}

TEST_F(OnlyBelow, RestrictsFilesNamedByScenes) {
    nlohmann::json scene = nlohmann::json::parse(read_bytes_of(folder / "scene.json"));
    expect_refused_by({"render", folder / "scene.json", "-o", out / "p.png", "--context", "cpu"});
    fs::copy_file(folder / "volume.nrrd", up / "volume.nrrd");
    const auto drawn = [&] {
        write_bytes_to(up / "scene.json", scene.dump());
        return std::vector<std::string>{
            "render", up / "scene.json", "-o", out / "p.png", "--context", "cpu", "--quiet"};
    };
    make(below(drawn()));
    fs::remove(out / "p.png");
    scene["volume"] = "../volume.nrrd";
    expect_refused_by(drawn());
    scene["volume"] = {{"path", "../volume.nrrd"}};
    expect_refused_by(drawn());
    scene["volume"] = "volume.nrrd";
    write_bytes_to(folder / "map.json",
                   R"([{"ColorSpace": "RGB", "RGBPoints": [0, 0, 0, 0, 1, 1, 1, 1]}])");
    scene["transfer_function"]["points"] = {{{"value", 0}, {"extinction", 0}},
                                            {{"value", 255}, {"extinction", 8}}};
    scene["transfer_function"]["colormap"] = "../map.json";
    make(drawn());
    fs::remove(out / "p.png");
    expect_refused_by(drawn());
    EXPECT_TRUE(fs::is_empty(out));
}

TEST_F(OnlyBelow, RestrictsPartsOfMeshes) {
    const auto mesh = [&](const fs::path& file) {
        make({"mesh", folder / "volume.nrrd", "--kuhn", "-o", file, "--quiet"});
    };
    mesh(folder / "piece.vtu");
    mesh(folder / "pair.node");
    fs::copy_file(folder / "piece.vtu", up / "piece.vtu");
    const auto index = [&](const std::string& piece) {
        write_bytes_to(up / "step.pvd",
                       "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"0\" file=\"" +
                           piece + "\"/></Collection></VTKFile>");
    };
    index("piece.vtu");
    expect_read(up / "step.pvd");
    index("../piece.vtu");
    expect_refused(up / "step.pvd");
    fs::copy_file(folder / "pair.node", up / "pair.node");
    fs::create_symlink(folder / "pair.ele", up / "pair.ele");
    expect_refused(up / "pair.node");
}

TEST_F(OnlyBelow, RestrictsChunksAndHeadersOfArrays) {
    const fs::path array = up / "a.zarr";
    fs::create_directory(array);
    const std::string header =
        R"({"zarr_format": 2, "shape": [4, 4, 4], "chunks": [4, 4, 4], "dtype": "|u1",
            "compressor": null, "fill_value": 0, "order": "C", "filters": null})";
    write_bytes_to(array / ".zarray", header);
    fs::copy_file(up / "own.raw", array / "0.0.0");
    expect_read(array);
    fs::remove(array / "0.0.0");
    fs::create_symlink(folder / "secret.raw", array / "0.0.0");
    expect_refused(array);
    fs::remove(array / "0.0.0");
    fs::copy_file(up / "own.raw", array / "0.0.0");
    write_bytes_to(folder / "header", header);
    fs::remove(array / ".zarray");
    fs::create_symlink(folder / "header", array / ".zarray");
    expect_refused(array);
}

TEST_F(OnlyBelow, RefusesWhatIsNotAFolder) {
    for (const fs::path& wrong : {folder / "absent", folder / "scene.json", fs::path()}) {
        const ProgramResult result =
            lamina_run({"info", folder / "volume.nrrd", "--only-below", wrong});
        EXPECT_NE(result.exit_code, 0);
        EXPECT_NE(result.err.find("--only-below"), std::string::npos) << result.err;
    }
}

}  // namespace
}  // namespace lamina
