// SPDX-License-Identifier: Apache-2.0
// Checks in the program's file that it was built with LAMINA_HARDENED (cmake/LaminaTargets.cmake).
#include <gtest/gtest.h>
#include <link.h>

#include <cstring>
#include <string>
#include <vector>

#include "support/temporary_folder.h"

namespace lamina {
namespace {

// Reads an executable in ELF format ("ELF-64 Object File Format", version 1.5): its header says
// where the segments are listed, and one segment is a list of entries for the loader.
class Executable {
  public:
    explicit Executable(const std::string& path)
        : bytes_(read_bytes_of(path)), header_(at<ElfW(Ehdr)>(0)) {}

    bool is_placed_by_the_loader() const {
        return header_.e_type == ET_DYN && (dynamic(DT_FLAGS_1) & DF_1_PIE) != 0;
    }
    bool binds_before_it_runs() const { return (dynamic(DT_FLAGS_1) & DF_1_NOW) != 0; }
    bool has_segment(ElfW(Word) type) const {
        for (const auto& segment : segments())
            if (segment.p_type == type) return true;
        return false;
    }
    // Tells whether a name in the file, such as that of a function to be linked, ends with
    // `suffix`.
    bool names(const std::string& suffix) const {
        return bytes_.find(suffix + '\0') != std::string::npos;
    }

  private:
    template <typename Part>
    Part at(std::size_t offset) const {
        Part part;
        std::memcpy(&part, bytes_.data() + offset, sizeof part);
        return part;
    }
    std::vector<ElfW(Phdr)> segments() const {
        std::vector<ElfW(Phdr)> found;
        for (std::size_t i = 0; i < header_.e_phnum; ++i)
            found.push_back(at<ElfW(Phdr)>(header_.e_phoff + i * sizeof(ElfW(Phdr))));
        return found;
    }
    // Returns the value of a loader entry, or 0 if there is none.
    std::uint64_t dynamic(std::int64_t tag) const {
        for (const auto& segment : segments()) {
            if (segment.p_type != PT_DYNAMIC) continue;
            for (std::size_t i = 0; i < segment.p_filesz / sizeof(ElfW(Dyn)); ++i) {
                const auto entry = at<ElfW(Dyn)>(segment.p_offset + i * sizeof(ElfW(Dyn)));
                if (entry.d_tag == tag) return entry.d_un.d_val;
            }
        }
        return 0;
    }

    std::string bytes_;
    ElfW(Ehdr) header_;
};

TEST(Hardening, AppliesToReleaseBuilds) {
    if (!LAMINA_HARDENED) GTEST_SKIP() << "no release build";
    for (const std::string program : {LAMINA_BINARY, LAMINA_TETRAHEDRALIZE_BINARY}) {
        if (program.empty()) continue;  // built without TetGen
        const Executable executable(program);
        EXPECT_TRUE(executable.is_placed_by_the_loader()) << program;
        EXPECT_TRUE(executable.has_segment(PT_GNU_RELRO)) << program;
        EXPECT_TRUE(executable.binds_before_it_runs()) << program;
        EXPECT_TRUE(executable.names("__stack_chk_fail")) << program;
        EXPECT_TRUE(executable.names("_chk")) << program;  // __fread_chk, __memcpy_chk, ...
    }
}

}  // namespace
}  // namespace lamina
