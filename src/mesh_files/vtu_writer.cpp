// SPDX-License-Identifier: Apache-2.0
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "mesh_files/mesh_file.h"

namespace lamina {
namespace {

constexpr std::size_t block_bytes = std::size_t{1} << 20;
constexpr std::int64_t tetra = 10;

// Returns an array in the form of the appended data: header, then blocks.
std::string compress(const void* values, std::size_t size) {
    const std::size_t count = (size + block_bytes - 1) / block_bytes;
    std::vector<std::string> blocks(count);
    parallel_for(static_cast<std::int64_t>(count), 1, [&](std::int64_t i) {
        const std::size_t begin = static_cast<std::size_t>(i) * block_bytes;
        const std::size_t length = std::min(block_bytes, size - begin);
        std::string& block = blocks[static_cast<std::size_t>(i)];
        uLongf packed = compressBound(length);
        block.resize(packed);
        const int result =
            compress2(reinterpret_cast<Bytef*>(block.data()), &packed,
                      static_cast<const Bytef*>(values) + begin, length, Z_DEFAULT_COMPRESSION);
        if (result != Z_OK) throw std::bad_alloc();  // compressBound leaves no other reason
        block.resize(packed);
    });
    std::vector<std::uint64_t> header{count, block_bytes, size % block_bytes};
    for (const std::string& block : blocks) header.push_back(block.size());
    std::string packed(reinterpret_cast<const char*>(header.data()),
                       header.size() * sizeof(std::uint64_t));
    for (const std::string& block : blocks) packed += block;
    return packed;
}

std::string escaped(const std::string& name) {
    std::string text;
    for (const char c : one_line(name)) {
        switch (c) {
            case '&':
                text += "&amp;";
                break;
            case '<':
                text += "&lt;";
                break;
            case '>':
                text += "&gt;";
                break;
            case '"':
                text += "&quot;";
                break;
            default:
                text += c;
        }
    }
    return text;
}

// Writes the elements and, after them, the data.
class Writer {
  public:
    void open(const std::string& element) { xml_ += "      <" + element + ">\n"; }
    void close(const std::string& element) { xml_ += "      </" + element + ">\n"; }

    template <typename T>
    void array(const char* type, const std::string& name, int components,
               const std::vector<T>& values) {
        xml_ += fmt::format(
            "        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" "
            "format=\"appended\" offset=\"{}\"/>\n",
            type, escaped(name), components, data_.size());
        static_assert(sizeof(T) % 4 == 0 || sizeof(T) == 1);
        data_ += compress(values.data(), values.size() * sizeof(T));
    }

    void scalars(const std::string& element, const std::vector<MeshScalar>& all) {
        xml_ += all.empty() ? "      <" + element + ">\n"
                            : "      <" + element + " Scalars=\"" + escaped(all[0].name) + "\">\n";
        for (const MeshScalar& scalar : all) array("Float64", scalar.name, 1, scalar.values);
        close(element);
    }

    const std::string& xml() const { return xml_; }
    const std::string& data() const { return data_; }

  private:
    std::string xml_, data_;
};

template <typename T>
std::vector<T> offsets(std::size_t tets) {
    std::vector<T> ends(tets);
    for (std::size_t i = 0; i < tets; ++i) ends[i] = static_cast<T>(4 * (i + 1));
    return ends;
}

}  // namespace

void write_vtu(AtomicFile& file, const MeshData& mesh) {
    static_assert(sizeof(glm::dvec3) == 3 * sizeof(double) && sizeof(Tet) == 16);
    Writer writer;
    writer.scalars("PointData", mesh.point_scalars);
    writer.scalars("CellData", mesh.cell_scalars);
    writer.open("Points");
    writer.array("Float64", "Points", 3, mesh.points);
    writer.close("Points");
    writer.open("Cells");
    writer.array("Int32", "connectivity", 1, mesh.tets);
    if (4 * mesh.tets.size() <= std::numeric_limits<std::int32_t>::max()) {
        writer.array("Int32", "offsets", 1, offsets<std::int32_t>(mesh.tets.size()));
    } else {
        writer.array("Int64", "offsets", 1, offsets<std::int64_t>(mesh.tets.size()));
    }
    writer.array("UInt8", "types", 1, std::vector<std::uint8_t>(mesh.tets.size(), tetra));
    writer.close("Cells");

    file.write(fmt::format(
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"{}\" "
        "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n"
        "  <UnstructuredGrid>\n    <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
        std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian",
        mesh.points.size(), mesh.tets.size()));
    file.write(writer.xml());
    file.write("    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n   _");
    file.write(writer.data());
    file.write("\n  </AppendedData>\n</VTKFile>\n");
}

}  // namespace lamina
