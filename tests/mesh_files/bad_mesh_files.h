// SPDX-License-Identifier: Apache-2.0
// The fixture of the tests of bad mesh files.
#pragma once

#include "mesh_files.h"

namespace lamina::testing {

class BadMeshFiles : public MeshFiles {
  protected:
    void expect_bad(const std::string& name, const std::string& bytes,
                    std::initializer_list<std::string> parts) {
        const auto path = write(name, bytes);
        SCOPED_TRACE(bytes.substr(0, 300));
        const std::string message = error_of([&] { read_mesh(path); });
        const std::string stem =
            name.substr(0, name.find('.') + 1);  // a message may name either of two files
        expect_error([&] { throw Error(message); }, {stem});
        expect_error([&] { throw Error(message); }, parts);
    }

    // Expects that a file gives a mesh with valid indices or an Error of one line.
    void expect_survives(const std::string& name, const std::string& bytes) {
        const auto path = write(name, bytes);
        try {
            const MeshData mesh = read_mesh(path);
            for (const Tet& tet : mesh.tets) {
                for (const std::int32_t corner : tet) {
                    ASSERT_GE(corner, 0);
                    ASSERT_LT(corner, static_cast<std::int64_t>(mesh.points.size()));
                }
            }
            ++read_;
        } catch (const Error& error) {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
            ++refused_;
        }
    }
    int read_ = 0, refused_ = 0;
};

inline std::string with(std::string text, const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

}  // namespace lamina::testing
