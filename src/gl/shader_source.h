// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lamina::gl {

// What a shader is specialised by: `#define NAME VALUE` lines, in this order.
struct Defines {
    std::vector<std::pair<std::string, std::string>> list;

    Defines& set(std::string name, std::string value);
    Defines& set(std::string name, int value);

    friend bool operator==(const Defines&, const Defines&) = default;
};

// The text of a shader file, or nothing where there is none.
using ShaderFinder = std::function<std::optional<std::string>(const std::string& name)>;

// Where a line of a composed shader comes from.
struct ShaderLine {
    std::string file;
    int number;
};

// A shader ready for the compiler.
struct ShaderSource {
    std::string name;
    std::string text;
    Defines defines;
    // Of every line of `text`. Not #line directives: Mesa loses their file number in some of its
    // messages.
    std::vector<ShaderLine> lines;
};

// Composes the shader `name`. Its first directive must be `#version 450 core`; the defines follow
// it. A line `#include "compositing/over.glsl"` stands for that file, named from the root of
// shaders/, unless the compiler has seen it already; it may be under an #if. A file that is
// missing, a cycle and a malformed include are Errors that name file and line.
ShaderSource compose_shader(const std::string& name, const Defines& defines = {});
ShaderSource compose_shader(const std::string& name, const Defines& defines,
                            const ShaderFinder& find);

// A compiler's log on one line, with the places in the files instead of those in the text:
// "slicing/slab.frag:12: ...".
std::string readable_log(const std::string& log, const ShaderSource& source);

}  // namespace lamina::gl
