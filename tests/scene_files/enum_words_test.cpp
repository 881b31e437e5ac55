// SPDX-License-Identifier: Apache-2.0
// Tests that the words of enums are those of the schema, and that shaders number enums like C++.
#include "base/enum_words.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cctype>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "base/input_file.h"
#include "base/json_text.h"
#include "lamina/scene.h"
#include "plan/plan.h"

namespace lamina {
namespace {

std::string text_of_shader(const std::string& name) {
    return read_file_bytes(fmt::format("{}/shaders/{}", LAMINA_SOURCE_DIR, name));
}

// Expects that a shader has a line `#define PREFIX_WORD number` for each value of an enum, and none
// for other numbers.
template <typename Enum>
void expect_numbers(const std::string& shader, const std::string& prefix) {
    const std::string text = text_of_shader(shader);
    const std::string start = fmt::format("#define {}", prefix);
    std::size_t count = 0;
    for (std::size_t at = text.find(start); at != std::string::npos; at = text.find(start, at + 1))
        ++count;
    const auto words = enum_words<Enum>();
    EXPECT_EQ(count, words.size()) << shader << " " << prefix;
    for (const auto& [word, value] : words) {
        std::string name = prefix;
        for (const char* c = word; *c != '\0'; ++c)
            name += static_cast<char>(std::toupper(static_cast<unsigned char>(*c)));
        const std::string line = fmt::format("#define {} {}", name, static_cast<int>(value));
        const std::size_t at = text.find(line);
        ASSERT_NE(at, std::string::npos) << shader << ": " << line;
        EXPECT_FALSE(std::isalnum(static_cast<unsigned char>(text[at + line.size()]))) << line;
    }
}

TEST(EnumWords, HaveTheNumbersOfTheShaders) {
    expect_numbers<NodeCode>("compositing/node_code.glsl", "CODE_");
    expect_numbers<AlphaRounding>("compositing/codes.glsl", "ROUND_");
    expect_numbers<SegmentSource>("projection/sources.glsl", "SOURCE_");
    expect_numbers<LengthMapping>("preintegration/uniform_table.glsl", "MAPPING_");
    expect_numbers<TableStore>("preintegration/uniform_table.glsl", "STORE_");
}

template <typename Enum>
std::string words_of() {
    std::string words;
    for (const auto& [word, value] : enum_words<Enum>()) {
        EXPECT_EQ(name_of(value), std::string(word));
        if (!words.empty()) words += ' ';
        words += word;
    }
    return words;
}

TEST(EnumWords, AreThoseOfSceneFilesInTheOrderOfMessages) {
    EXPECT_EQ(words_of<Method>(), "slice project trace");
    EXPECT_EQ(words_of<Target>(), "float32 float16 fixed16 fixed8 emulated");
    EXPECT_EQ(words_of<TraceOf>(), "volume mesh");
    EXPECT_EQ(words_of<NanPolicy>(), "error transparent");
    EXPECT_EQ(words_of<ImageColorSpace>(), "linear display");
    EXPECT_EQ(words_of<AnnotationPosition>(),
              "top_left top top_right left right bottom_left bottom bottom_right");
    EXPECT_EQ(words_of<Projection>(), "perspective orthographic");
    EXPECT_EQ(words_of<Classification>(), "post preintegrated exact");
    EXPECT_EQ(words_of<Order>(), "back_to_front front_to_back");
    EXPECT_EQ(words_of<Filter>(), "exact hardware");
    EXPECT_EQ(words_of<NodeArithmetic>(), "shader fixed");
    EXPECT_EQ(words_of<NodeCode>(), "minimax phi alpha");
    EXPECT_EQ(words_of<AlphaRounding>(), "truncate nearest stochastic");
    EXPECT_EQ(words_of<OverRounding>(), "separate fused");
    EXPECT_EQ(words_of<Coloring>(), "preintegrated attenuation vertex analytic");
    EXPECT_EQ(words_of<Interpolation>(), "perspective linear");
    EXPECT_EQ(words_of<Thickness>(), "exact dz");
    EXPECT_EQ(words_of<ProjectGeometry>(), "silhouette triangles");
    EXPECT_EQ(words_of<ProjectDither>(), "none alpha after_blend");
    EXPECT_EQ(words_of<LengthMapping>(), "octave log2 linear");
    EXPECT_EQ(words_of<TableStore>(), "mean_extinction opacity");
    EXPECT_EQ(words_of<TableFormat>(), "fixed16 fixed8 float16 float32");
    EXPECT_EQ(words_of<TableConstruction>(), "exact incremental");
}

// Returns every list of words in a part of the schema, as a text with a space between words.
std::set<std::string> lists_in(const nlohmann::json& schema) {
    std::set<std::string> lists;
    if (schema.is_object() && schema.contains("enum")) {
        std::string words;
        for (const nlohmann::json& word : schema["enum"]) {
            if (!word.is_string()) continue;
            if (!words.empty()) words += ' ';
            words += word.get<std::string>();
        }
        lists.insert(words);
    }
    for (const nlohmann::json& part : schema) {
        if (part.is_structured()) lists.merge(lists_in(part));
    }
    return lists;
}

TEST(EnumWords, AreThoseOfTheSchema) {
    const std::set<std::string> lists =
        lists_in(load_json(LAMINA_SOURCE_DIR "/docs/scene.schema.json"));
    // "auto" comes first if it is the default, else last.
    for (const std::string& words : {words_of<Method>(),
                                     words_of<Target>() + " auto",
                                     words_of<TraceOf>(),
                                     words_of<NanPolicy>(),
                                     words_of<Projection>(),
                                     "auto " + words_of<AnnotationPosition>(),
                                     "auto " + words_of<Classification>(),
                                     words_of<Order>(),
                                     words_of<Filter>() + " auto",
                                     words_of<NodeArithmetic>(),
                                     words_of<NodeCode>(),
                                     words_of<AlphaRounding>(),
                                     words_of<OverRounding>(),
                                     words_of<Coloring>(),
                                     words_of<Interpolation>(),
                                     words_of<Thickness>(),
                                     "auto " + words_of<ProjectOrder>(),
                                     "auto " + words_of<ProjectGeometry>(),
                                     words_of<ProjectDither>(),
                                     words_of<LengthMapping>(),
                                     words_of<TableStore>(),
                                     words_of<TableFormat>(),
                                     words_of<TableConstruction>()})
        EXPECT_TRUE(lists.contains(words)) << words;
}

TEST(EnumWords, AreFoundAndListedForMessages) {
    EXPECT_EQ(value_of_word<NodeCode>("phi"), NodeCode::phi);
    EXPECT_EQ(value_of_word<NodeCode>("ph"), std::nullopt);
    EXPECT_EQ(value_of_word<NodeCode>(""), std::nullopt);
    EXPECT_EQ(alternatives<NodeCode>(), "minimax, phi or alpha");
    EXPECT_EQ(alternatives<NanPolicy>(), "error or transparent");
}

}  // namespace
}  // namespace lamina
