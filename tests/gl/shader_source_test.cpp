// SPDX-License-Identifier: Apache-2.0
#include "gl/program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include "base/error.h"

namespace lamina::gl {
namespace {

using Texts = std::map<std::string, std::string>;

ShaderSource compose(const Texts& texts, const std::string& name, const Defines& defines = {}) {
    return compose_shader(name, defines, [&](const std::string& wanted) {
        const auto found = texts.find(wanted);
        return found == texts.end() ? std::nullopt : std::optional(found->second);
    });
}

std::string message_of(const Texts& texts, const std::string& name) {
    try {
        compose(texts, name);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

// The first lines of every composed shader (gl/program.cpp).
const std::string prelude =
    "#version 450 core\n#pragma optionNV(fastmath off)\n#ifdef GL_ARB_shader_group_vote\n"
    "#extension GL_ARB_shader_group_vote : enable\n#endif\n";

std::string repeated(const std::string& text, int times) {
    std::string all;
    for (int i = 0; i < times; ++i) all += text;
    return all;
}

// Returns the origins of the lines of a composed shader: "a.frag:1 a.frag:2 ...".
std::string places(const ShaderSource& source) {
    std::string text;
    for (const ShaderLine& line : source.lines) {
        text += (text.empty() ? "" : " ") + line.file + ':' + std::to_string(line.number);
    }
    return text;
}

TEST(ShaderSource, InsertsDefinesAfterTheVersion) {
    const ShaderSource source =
        compose({{"a.frag", "// licence\n#version 450 core\nvoid main() {}\n"}}, "a.frag",
                Defines().set("N", 3).set("MODE", "fast"));
    EXPECT_EQ(source.text,
              "// licence\n" + prelude + "#define N 3\n#define MODE fast\nvoid main() {}\n");
    EXPECT_EQ(places(source), "a.frag:1" + repeated(" a.frag:2", 7) + " a.frag:3");
    EXPECT_EQ(source.name, "a.frag");
}

TEST(ShaderSource, GuardsIncludesAndTracksTheirLines) {
    const ShaderSource source = compose({{"a.frag",
                                          "#version 450 core\n#include \"lib/b.glsl\"\n"
                                          "  # include \"lib/c.glsl\" // again\nA\n"},
                                         {"lib/b.glsl", "#include \"lib/c.glsl\"\nB\n"},
                                         {"lib/c.glsl", "C"}},
                                        "a.frag");
    EXPECT_EQ(source.text, prelude +
                               "#ifndef INCLUDED_FILE_0\n#define INCLUDED_FILE_0\n"
                               "#ifndef INCLUDED_FILE_1\n#define INCLUDED_FILE_1\nC\n#endif\n"
                               "B\n#endif\n"
                               "#ifndef INCLUDED_FILE_1\n#define INCLUDED_FILE_1\nC\n#endif\n"
                               "A\n");
    EXPECT_EQ(
        places(source),
        "a.frag:1" + repeated(" a.frag:1", 4) +
            " a.frag:2 a.frag:2 lib/b.glsl:1 lib/b.glsl:1 lib/c.glsl:1 "
            "lib/b.glsl:1 lib/b.glsl:2 a.frag:2 a.frag:3 a.frag:3 lib/c.glsl:1 a.frag:3 a.frag:4");
}

TEST(ShaderSource, NamesMissingFilesAndTheirIncluders) {
    const Texts texts{{"a.frag", "#version 450 core\n\n#include \"b.glsl\"\n"}};
    EXPECT_EQ(message_of(texts, "a.frag"), "shader a.frag:3: no such shader file: b.glsl");
    EXPECT_EQ(message_of(texts, "z.frag"), "shader: no such shader file: z.frag");
}

TEST(ShaderSource, RefusesCycles) {
    const Texts texts{{"a.frag", "#version 450 core\n#include \"b.glsl\"\n"},
                      {"b.glsl", "#include \"c.glsl\"\n"},
                      {"c.glsl", "\n#include \"b.glsl\"\n"}};
    EXPECT_EQ(message_of(texts, "a.frag"),
              "shader c.glsl:2: b.glsl includes itself: a.frag -> b.glsl -> c.glsl -> b.glsl");
}

TEST(ShaderSource, RefusesMalformedIncludesAndAMissingVersion) {
    EXPECT_EQ(message_of({{"a.frag", "#version 450 core\n#include <b.glsl>\n"}}, "a.frag"),
              "shader a.frag:2: expected #include \"FILE\", found '#include <b.glsl>'");
    EXPECT_EQ(message_of({{"a.frag", "void main() {}\n"}}, "a.frag"),
              "shader a.frag: expected '#version 450 core' as the first directive");
    EXPECT_EQ(message_of({{"a.frag", "#version 330\n"}}, "a.frag"),
              "shader a.frag: expected '#version 450 core' as the first directive");
    EXPECT_EQ(message_of({{"a.frag", "#include \"b.glsl\"\n#version 450 core\n"}, {"b.glsl", ""}},
                         "a.frag"),
              "shader a.frag: expected '#version 450 core' as the first directive");
}

TEST(ShaderSource, TranslatesCompilerLogsOfEveryDriver) {
    ShaderSource source;
    source.lines = {{"a.frag", 1}, {"b.glsl", 12}};
    EXPECT_EQ(readable_log("0:2(3): error: no\n", source), "b.glsl:12: error: no");  // Mesa
    EXPECT_EQ(readable_log("0(2) : error C1008: no\n", source),
              "b.glsl:12: error C1008: no");  // NVIDIA
    EXPECT_EQ(readable_log("ERROR: 0:1: 'x' : no\nmore\n", source),
              "a.frag:1: 'x' : no more");  // glslang
    // A line beyond the end of the text.
    EXPECT_EQ(readable_log("0:3(1): error: no\n", source), "0:3(1): error: no");
}

TEST(ShaderFiles, AreEmbeddedAsTheyAreOnDisk) {
    const std::filesystem::path root = std::filesystem::path(LAMINA_SOURCE_DIR) / "shaders";
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
        const std::string extension = entry.path().extension().string();
        if (!std::set<std::string>{".vert", ".frag", ".comp", ".glsl"}.contains(extension))
            continue;
        std::ifstream file(entry.path(), std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        const std::string name = std::filesystem::relative(entry.path(), root).generic_string();
        EXPECT_TRUE(find_shader(name) == text) << name << ": is the build older than the file?";
        ++count;
    }
    EXPECT_EQ(embedded_shaders().size(), count);
    EXPECT_TRUE(std::ranges::is_sorted(embedded_shaders(), {}, &EmbeddedFile::name));
    EXPECT_FALSE(find_shader("no/such.frag").has_value());
}

TEST(ShaderFiles, ComeFromTheDirectoryOfTheEnvironmentFirst) {
    const std::filesystem::path directory =
        std::filesystem::path(testing::TempDir()) / "lamina_shader_dir_test";
    std::filesystem::create_directories(directory / "gl");
    std::ofstream(directory / "gl/full_screen.vert") << "changed";
    const std::string embedded = *find_shader("gl/full_screen.vert");
    setenv("LAMINA_SHADER_DIR", directory.c_str(), 1);
    EXPECT_EQ(find_shader("gl/full_screen.vert"), "changed");
    // Not in the folder, so the embedded one.
    EXPECT_TRUE(find_shader("gl/filter_probe.frag").has_value());
    unsetenv("LAMINA_SHADER_DIR");
    EXPECT_EQ(find_shader("gl/full_screen.vert"), embedded);
    std::filesystem::remove_all(directory);
}

// glslangValidator, an independent compiler, accepts composed shaders.
TEST(ShaderSource, PassesTheReferenceCompiler) {
    const std::string validator = GLSLANG_VALIDATOR;
    if (validator.empty()) GTEST_SKIP() << "no glslangValidator";
    const Texts texts{{"a.frag",
                       "// licence\n#version 450 core\n#include \"b.glsl\"\nout vec4 color;\n"
                       "void main() { color = vec4(b() * SCALE); }\n"},
                      {"b.glsl", "float b() { return 2.0; }\n"}};
    const std::string path = testing::TempDir() + "lamina_composed.frag";
    std::ofstream(path) << compose(texts, "a.frag", Defines().set("SCALE", "0.5")).text;
    EXPECT_EQ(std::system((validator + " '" + path + "' > /dev/null").c_str()), 0);
    std::filesystem::remove(path);
}

}  // namespace
}  // namespace lamina::gl
