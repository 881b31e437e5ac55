// SPDX-License-Identifier: Apache-2.0
// Checks rules of the project that a compiler does not: which module may include which, licence
// lines, sizes of files, citations.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "support/temporary_folder.h"

namespace lamina {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> words_of(const char* text) {
    std::istringstream words(text);
    return {std::istream_iterator<std::string>(words), {}};
}

// The modules, lowest first, from src/CMakeLists.txt. A module may include only itself and the
// modules before it.
const std::vector<std::string> modules = words_of(LAMINA_MODULES);
const fs::path source = LAMINA_SOURCE_DIR;

std::size_t height_of(const std::string& module) {
    return static_cast<std::size_t>(std::find(modules.begin(), modules.end(), module) -
                                    modules.begin());
}
bool is_module(const std::string& name) {
    return height_of(name) < modules.size();
}

std::vector<fs::path> files_under(const std::vector<std::string>& folders) {
    std::vector<fs::path> files;
    for (const std::string& folder : folders) {
        for (const auto& entry : fs::recursive_directory_iterator(source / folder)) {
            if (entry.is_regular_file()) files.push_back(entry.path());
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

// Returns the folders of all modules: those of the library, and those that belong to one program.
std::vector<std::string> module_folders() {
    std::vector<std::string> folders;
    for (const char* const parent : {"src", "tools/lamina", "tools/lamina-mpi"}) {
        for (const auto& entry : fs::directory_iterator(source / parent)) {
            if (entry.is_directory())
                folders.push_back(fs::relative(entry.path(), source).generic_string());
        }
    }
    return folders;
}

std::vector<std::string> all_matches(const std::string& text, const char* pattern) {
    const std::regex expression(pattern, std::regex::ECMAScript | std::regex::multiline);
    std::vector<std::string> found;
    for (std::sregex_iterator m(text.begin(), text.end(), expression), end; m != end; ++m) {
        found.push_back((*m)[1]);
    }
    return found;
}

std::string module_of(const std::string& include) {
    return include.substr(0, include.find('/'));
}

// Returns a line for each file that a file of the module includes, or module that its
// CMakeLists.txt links, against the rules.
std::vector<std::string> wrong_includes(const std::string& module, const std::string& file_name,
                                        const std::string& text) {
    std::vector<std::string> wrong;
    const bool may_use_gl =
        module == "gl" ||
        ((module == "executors" || module == "slicing" || module == "projection") &&
         file_name.starts_with("gl_"));
    for (const std::string& include : all_matches(text, R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])")) {
        if (include == "glad/gl.h" && !may_use_gl) wrong.push_back(include);
    }
    for (const std::string& include : all_matches(text, R"(^\s*#\s*include\s*"([^"]+)\")")) {
        if (include == "glad/gl.h") continue;
        const std::string other = module_of(include);
        if (other == "lamina") continue;  // include/lamina: below all modules
        if (!is_module(other) || height_of(other) > height_of(module)) wrong.push_back(include);
    }
    if (file_name == "CMakeLists.txt") {
        for (const std::string& other : all_matches(text, R"(\blamina_([a-z_]+)\b)")) {
            if (is_module(other) && height_of(other) > height_of(module)) {
                wrong.push_back("lamina_" + other);
            }
        }
    }
    return wrong;
}

// Returns what a text cites but the checkout lacks: pages of docs/, and their sections ("section
// 4", "sections 2 and 3") and headings in quotation marks, which may follow after a comma.
// Citations may continue in the next line.
std::vector<std::string> wrong_citations(const std::string& text) {
    std::vector<std::string> wrong;
    if (text.find("docs/") == std::string::npos) return wrong;
    static const std::regex between_literals(R"("\s*\n\s*")"), line_end(R"(\s*\n\s*(//|#)?\s*)");
    static const std::regex citation(
        R"re(\bdocs/([\w/.-]*\w\.md)(?:, (?:sections? (\d+(?:\.\d+)?)(?: and (\d+(?:\.\d+)?))?|equations? \((\d+\.\d+)\)|"([^"]+)"))?)re");
    const std::string joined =
        std::regex_replace(std::regex_replace(text, between_literals, ""), line_end, " ");
    for (std::sregex_iterator m(joined.begin(), joined.end(), citation), end; m != end; ++m) {
        const std::string name = "docs/" + (*m)[1].str();
        if (!fs::is_regular_file(source / name)) {
            wrong.push_back(name);
            continue;
        }
        const std::string page = read_bytes_of(source / name);
        for (const std::size_t group : {2u, 3u}) {
            const std::string section = (*m)[group];
            const bool part = section.find('.') != std::string::npos;
            const std::string heading = part ? "\n### " + section + " " : "\n## " + section + ". ";
            if (!section.empty() && page.find(heading) == std::string::npos)
                wrong.push_back(name + ", section " + section);
        }
        const std::string equation = (*m)[4];
        if (!equation.empty() && page.find(" (" + equation + ")\n") == std::string::npos)
            wrong.push_back(name + ", equation " + equation);
        const std::string title = (*m)[5];
        if (!title.empty() && page.find("# " + title + "\n") == std::string::npos)
            wrong.push_back(name + ", \"" + title + "\"");
    }
    return wrong;
}

bool is_code(const fs::path& path) {
    static const std::vector<std::string> suffixes = {".h",    ".cpp",   ".glsl", ".vert", ".frag",
                                                      ".comp", ".cmake", ".py",   ".sh",   ".txt",
                                                      ".html", ".css",   ".js"};
    const std::string suffix = path.extension();
    return suffix.empty() || std::find(suffixes.begin(), suffixes.end(), suffix) != suffixes.end();
}

TEST(Modules, TheCheckItselfSeesViolations) {
    using Wrong = std::vector<std::string>;
    EXPECT_EQ(wrong_includes("image", "a.h", "#include \"slicing/x.h\"\n"), Wrong{"slicing/x.h"});
    EXPECT_EQ(wrong_includes("image", "a.h", "\n  # include \"scene/x.h\"\n"), Wrong{"scene/x.h"});
    EXPECT_EQ(wrong_includes("image", "a.h", "#include \"x.h\"\n"), Wrong{"x.h"});
    EXPECT_EQ(wrong_includes("image", "a.h", "#include <png.h>\n#include \"image/x.h\"\n"),
              Wrong{});
    EXPECT_EQ(wrong_includes("slicing", "a.h", "#include \"base/x.h\"\n#include \"gl/x.h\"\n"),
              Wrong{});
    EXPECT_EQ(wrong_includes("slicing", "a.h", "#include <glad/gl.h>\n"), Wrong{"glad/gl.h"});
    EXPECT_EQ(wrong_includes("slicing", "a.h", "#include \"glad/gl.h\"\n"), Wrong{"glad/gl.h"});
    EXPECT_EQ(wrong_includes("slicing", "gl_executor.h", "#include <glad/gl.h>\n"), Wrong{});
    EXPECT_EQ(wrong_includes("gl", "texture.h", "#include <glad/gl.h>\n"), Wrong{});
    EXPECT_EQ(wrong_includes("scene", "gl_facts.h", "#include <glad/gl.h>\n"), Wrong{"glad/gl.h"});
    EXPECT_EQ(
        wrong_includes("optics", "CMakeLists.txt", "lamina_module(x LINK lamina_gl lamina_base)"),
        Wrong{"lamina_gl"});
}

TEST(Modules, IncludeOnlyThemselvesAndLowerModules) {
    int seen = 0;
    std::set<std::string> found;
    for (const std::string& folder : module_folders()) {
        const std::string module = fs::path(folder).filename();
        EXPECT_TRUE(is_module(module)) << folder << " is not a module of the list";
        EXPECT_TRUE(found.insert(module).second) << folder << " has the name of another module";
        for (const fs::path& file : files_under({folder})) {
            ++seen;
            for (const std::string& wrong :
                 wrong_includes(module, file.filename(), read_bytes_of(file))) {
                ADD_FAILURE() << file << " may not use " << wrong;
            }
        }
    }
    EXPECT_GT(seen, 20);
    EXPECT_EQ(found.size(), modules.size());
}

// Returns the names of the library Highway in a text, which only the module simd may use.
// HWY_TARGET_TOGGLE is allowed: it guards headers that are included once for each instruction set.
std::vector<std::string> highway_words(const std::string& text) {
    std::vector<std::string> words = all_matches(text, R"((<hwy/[^>]*>))");
    for (const char* pattern : {R"(\b(hn::\w*))", R"(\b(hwy::\w*))", R"(\b(HWY_\w+))"}) {
        for (const std::string& word : all_matches(text, pattern))
            if (word != "HWY_TARGET_TOGGLE") words.push_back(word);
    }
    return words;
}

TEST(Simd, TheCheckItselfSeesViolations) {
    using Words = std::vector<std::string>;
    EXPECT_EQ(highway_words("#include <hwy/highway.h>\n"), Words{"<hwy/highway.h>"});
    EXPECT_EQ(highway_words("a = hn::Add(b, c);"), Words{"hn::Add"});
    EXPECT_EQ(highway_words("hwy::Prefetch(p);"), Words{"hwy::Prefetch"});
    EXPECT_EQ(highway_words("HWY_INLINE void f();"), Words{"HWY_INLINE"});
    EXPECT_EQ(highway_words("#if defined(X) == defined(HWY_TARGET_TOGGLE)"), Words{});
}

TEST(Simd, IsTheOnlyModuleThatNamesHighway) {
    for (const fs::path& file : files_under({"include", "src", "python", "tools", "tests"})) {
        const std::string name = fs::relative(file, source).generic_string();
        if (name.starts_with("src/simd/") || name.starts_with("tools/lab/measure_cpu/") ||
            name == "tests/base/modules_test.cpp" ||
            !(name.ends_with(".h") || name.ends_with(".cpp")))
            continue;
        for (const std::string& word : highway_words(read_bytes_of(file)))
            ADD_FAILURE() << name << " names " << word << ", which is for src/simd";
    }
}

// The plain tracer checks the reference tracer, so it must share no code with it, and its source
// must be short enough to be verified by reading.
TEST(PlainTracer, SharesNoCodeWithTheTracerAndIsShort) {
    const std::set<std::string> data{"base/parallel.h", "base/client.h", "scene/camera.h",
                                     "scene/clip.h",    "scene/scene.h", "volume/volume_store.h"};
    std::ptrdiff_t lines = 0;
    for (const fs::path& file : files_under({"src/plain"})) {
        const std::string text = read_bytes_of(file);
        if (file.extension() == ".cpp") lines += std::count(text.begin(), text.end(), '\n');
        for (const std::string& include : all_matches(text, R"(^\s*#\s*include\s*"([^"]+)\")")) {
            EXPECT_TRUE(include.starts_with("lamina/") || include.starts_with("plain/") ||
                        data.contains(include))
                << file << " includes " << include;
        }
    }
    EXPECT_GT(lines, 100);
    EXPECT_LE(lines, 400);
}

// A user of the library needs GLM and no other library.
TEST(PublicHeaders, IncludeEachOtherGlmAndTheStandardLibrary) {
    for (const fs::path& file : files_under({"include"})) {
        const std::string text = read_bytes_of(file);
        for (const std::string& include :
             all_matches(text, R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])")) {
            const bool standard = include.find_first_of("./") == std::string::npos;
            EXPECT_TRUE(standard || include.starts_with("glm/") || include.starts_with("lamina/"))
                << file << " includes " << include;
        }
    }
}

// The Python module uses only what other programs can use, too.
TEST(PythonModule, IncludesPublicHeadersAndItsOwn) {
    for (const fs::path& file : files_under({"python/src"})) {
        for (const std::string& include :
             all_matches(read_bytes_of(file), R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])")) {
            EXPECT_FALSE(is_module(module_of(include))) << file << " includes " << include;
        }
    }
}

TEST(SourceFiles, BeginWithTheLicence) {
    for (const fs::path& file :
         files_under({"include", "src", "python", "tools", "shaders", "share", "tests", "cmake"})) {
        if (!is_code(file) || file.string().find("/tests/fuzz/corpus/") != std::string::npos)
            continue;
        const std::string text = read_bytes_of(file);
        // On the second line if the first must be #! or #version.
        const std::size_t line = text.find("SPDX-License-Identifier: Apache-2.0");
        EXPECT_TRUE(line != std::string::npos &&
                    std::count(text.begin(), text.begin() + line, '\n') < 2)
            << file << " does not begin with the SPDX line";
    }
}

TEST(Citations, TheCheckItselfSeesViolations) {
    using Wrong = std::vector<std::string>;
    // Apart from the names, or this file would itself contain wrong citations.
    const std::string docs = "docs/";
    EXPECT_EQ(wrong_citations("// (" + docs + "numerics.md, section 4), " + docs + "scene.md."),
              Wrong{});
    EXPECT_EQ(wrong_citations("// " + docs + "numerics.md,\n    // sections 2\n// and 3"), Wrong{});
    EXPECT_EQ(wrong_citations("# " + docs + "scene.md, \"What is\n# drawn\""), Wrong{});
    EXPECT_EQ(wrong_citations("// " + docs + "nothing.md"), Wrong{docs + "nothing.md"});
    EXPECT_EQ(wrong_citations("// " + docs + "numerics.md, section\n  // 99"),
              Wrong{docs + "numerics.md, section 99"});
    EXPECT_EQ(wrong_citations("\"" + docs + "numerics.md, \"\n  \"section 99\""),
              Wrong{docs + "numerics.md, section 99"});
    EXPECT_EQ(wrong_citations(docs + "numerics.md, sections 2 and 99"),
              Wrong{docs + "numerics.md, section 99"});
    EXPECT_EQ(
        wrong_citations(docs + "numerics.md, section 9.2, " + docs + "numerics.md, equation (9.2)"),
        Wrong{});
    EXPECT_EQ(wrong_citations(docs + "numerics.md, section 9.99"),
              Wrong{docs + "numerics.md, section 9.99"});
    EXPECT_EQ(wrong_citations(docs + "numerics.md, equation (9.99)"),
              Wrong{docs + "numerics.md, equation 9.99"});
    EXPECT_EQ(wrong_citations(docs + "scene.md, \"Nothing\""),
              Wrong{docs + "scene.md, \"Nothing\""});
}

TEST(Citations, LeadToDocumentsAndSectionsThatExist) {
    for (const fs::path& file : files_under(
             {"include", "src", "python", "tools", "shaders", "share", "tests", "cmake", "docs"})) {
        if (!is_code(file) && file.extension() != ".md") continue;
        for (const std::string& wrong : wrong_citations(read_bytes_of(file))) {
            ADD_FAILURE() << file << " cites " << wrong << ", which is not there";
        }
    }
}

TEST(SourceFiles, AreShortEnoughToRead) {
    for (const fs::path& file :
         files_under({"include", "src", "python", "tools", "shaders", "share"})) {
        if (!is_code(file)) continue;
        const std::string text = read_bytes_of(file);
        EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 700) << file;
    }
}

// A step from a scene to its picture: a pattern that its calls match, a word that all its calls
// contain, and the files that define or may call it.
struct PipelineStep {
    const char* word;
    const char* call;
    std::vector<std::string> definitions;
};

std::vector<PipelineStep> pipeline_steps() {
    const std::string tracers = "src/reference/";
    return {
        {"open_volume(", R"(\b(open_volume\(scene\b))", {"src/scene/scene.cpp"}},
        {"load_mesh(", R"(\b(load_mesh\())", {"src/scene/scene."}},
        {"scene_mesh(",
         R"(\b(scene_mesh\())",
         {"src/scene/scene.", "src/library/sampling.cpp"}},  // samples points, makes no picture
        {"choose(", R"(\b(choose\([^)]))", {"src/choice/choose."}},
        {"plan", R"(\b((?:make_plan|plan_alone)\())", {"src/plan/plan."}},
        {"try_samples(", R"(\b(try_samples\())", {"src/slicing/slab_trials."}},
        {"make_slice_renderer(", R"(\b(make_slice_renderer\())", {"src/slicing/slice_renderer."}},
        {"make_project_renderer(",
         R"(\b(make_project_renderer\())",
         {"src/projection/project_renderer."}},
        {"SceneRenderer", R"(\b(SceneRenderer>?(?:| \w+)[({]))", {}},
        {"trace_",
         R"(\b(trace_(?:volume|mesh|pixels)\())",
         {tracers, "src/slicing/trial_truth.cpp"}},  // measures the errors of slabs that are tried
        {"scene_tracer.h", R"((reference/scene_tracer\.h))", {tracers}},
        {"trace_plainly(", R"(\b(trace_plainly\())", {"src/plain/"}}};
}

bool defines(const PipelineStep& step, const std::string& file) {
    return std::ranges::any_of(step.definitions, [&](const std::string& beginning) {
        return file.starts_with(beginning);
    });
}

TEST(Pipeline, IsTheOnlyWayFromASceneToItsPicture) {
    std::set<std::string> seen;  // words of the steps that the pipeline itself calls
    for (const fs::path& file : files_under({"src", "tools", "python"})) {
        if (!is_code(file)) continue;
        const std::string name = fs::relative(file, source).generic_string();
        const std::string text = read_bytes_of(file);
        for (const PipelineStep& step : pipeline_steps()) {
            if (text.find(step.word) == std::string::npos) continue;
            if (all_matches(text, step.call).empty()) continue;
            if (name.starts_with("src/render/")) {
                seen.insert(step.word);
                continue;
            }
            EXPECT_TRUE(defines(step, name))
                << name << " has " << step.word << ": it should be a client of render/pipeline.h";
        }
    }
    // All but `trace_`, which the pipeline calls through scene_tracer.h.
    EXPECT_EQ(seen.size(), pipeline_steps().size() - 1);
}

// Renderers may take over parts of the renderer before, but code must not use casts to find out
// their type: the code that makes them knows it.
TEST(Renderers, AreNotAskedForTheirType) {
    for (const fs::path& file : files_under({"src", "tools", "python"})) {
        if (!is_code(file)) continue;
        const std::string text = read_bytes_of(file);
        if (text.find("dynamic_cast") == std::string::npos) continue;
        EXPECT_TRUE(all_matches(text, R"re(\b(dynamic_cast<[^>]*Renderer))re").empty()) << file;
    }
}

}  // namespace
}  // namespace lamina
