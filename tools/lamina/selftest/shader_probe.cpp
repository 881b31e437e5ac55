// SPDX-License-Identifier: Apache-2.0
#include "selftest/shader_probe.h"

#include <fmt/format.h>

#include "base/arithmetic.h"
#include "base/client.h"
#include "base/enum_words.h"
#include "base/profile.h"

namespace lamina::selftest {
namespace {

// Pixels of a tile's edge in shaders/study/probe.comp, and slices in a row in probe.glsl.
constexpr int tile = 16, slices_in_a_row = 16;
constexpr int volume_unit = 0, slices_unit = 1;
constexpr unsigned words_binding = 0, results_binding = 1;

std::vector<std::uint8_t> samples() {
    std::vector<std::uint8_t> samples(std::size_t{ShaderProbe::edge} * ShaderProbe::edge *
                                      ShaderProbe::edge);
    for (std::size_t i = 0; i < samples.size(); ++i)
        samples[i] = ShaderProbe::sample(static_cast<int>(i));
    return samples;
}

// Returns the durations of OpenGL's spans in milliseconds.
std::vector<double> opengl_times(const Profile& profile) {
    std::vector<double> times;
    for (const Profile::Span& span : profile.spans()) {
        if (span.row == Profile::opengl_row)
            times.push_back(1e-6 * static_cast<double>(span.end_ns - span.begin_ns));
    }
    return times;
}

}  // namespace

const char* name_of(ProbeKernel kernel) {
    return word_of(kernel, {"arithmetic", "texels", "gathers", "words"});
}

std::vector<ProbeWay> probe_ways() {
    std::vector<ProbeWay> ways;
    for (const ProbeKernel kernel :
         {ProbeKernel::arithmetic, ProbeKernel::texels, ProbeKernel::gathers, ProbeKernel::words}) {
        ways.push_back({kernel});
        for (const bool morton : {false, true}) {
            if (morton && kernel == ProbeKernel::arithmetic) continue;  // nothing depends on it
            for (const int group : {32, 64, 128}) ways.push_back({kernel, group, morton});
        }
    }
    return ways;
}

std::uint8_t ShaderProbe::sample(int index) {
    return static_cast<std::uint8_t>(static_cast<std::uint32_t>(index) * 2654435761u >> 24);
}

ShaderProbe::ShaderProbe(int width, int height)
    : width_(width),
      height_(height),
      volume_(gl::Texture::make_3d(gl::TextureFormat::r8, edge, edge, edge)),
      slices_(gl::Texture::make_2d(gl::TextureFormat::r8, slices_in_a_row * edge,
                                   edge / slices_in_a_row * edge)),
      results_(sizeof(float) * static_cast<std::size_t>(width) * static_cast<std::size_t>(height)),
      target_(gl::Texture::make_2d(gl::TextureFormat::r32f, width, height)) {
    const std::vector<std::uint8_t> bytes = samples();
    volume_.upload({0, 0, 0, edge, edge, edge}, bytes);
    constexpr std::size_t slice = std::size_t{edge} * edge;
    for (int z = 0; z < edge; ++z) {
        const gl::TexelBox box{
            z % slices_in_a_row * edge, z / slices_in_a_row * edge, 0, edge, edge, 1};
        slices_.upload(box, std::span(bytes).subspan(static_cast<std::size_t>(z) * slice, slice));
    }
    words_ = gl::Buffer(std::span(bytes));
}

gl::Program ShaderProbe::program_of(const ProbeWay& way) const {
    gl::Defines defines;
    defines.set("KERNEL", static_cast<int>(way.kernel));
    if (way.morton) defines.set("MORTON", 1);
    if (way.group > 0) defines.set("GROUP", way.group);
    gl::Program program = way.group > 0
                              ? gl::Program("study/probe.comp", defines)
                              : gl::Program("gl/full_screen.vert", "study/probe.frag", defines);
    if (way.group > 0) program.set("size", glm::ivec2(width_, height_));
    program.set("rounds", rounds);
    program.set("pixel_step", glm::ivec2(pixel_step(width_), pixel_step(height_)));
    program.set("last_sample", glm::vec3(edge - 1));
    program.set("largest_code", 255.0f);
    program.set("volume", volume_unit);
    program.set("slices", slices_unit);
    return program;
}

void ShaderProbe::draw(const gl::Program& program, const ProbeWay& way) {
    if (way.group == 0) {
        target_.bind();
        gl::draw_full_screen(program, any_);
    } else {
        const int tiles = ((width_ + tile - 1) / tile) * ((height_ + tile - 1) / tile);
        program.dispatch(tiles * tile * tile / way.group);
    }
}

std::vector<float> ShaderProbe::values_of(const ProbeWay& way) const {
    std::vector<float> values(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    if (way.group > 0) {
        results_.read(std::span(values));
    } else {
        const Image image = target_.read_back();
        auto value = values.begin();
        for (int y = height_ - 1; y >= 0; --y) {
            for (int x = 0; x < width_; ++x) *value++ = image.pixel(x, y)[0];
        }
    }
    return values;
}

ProbeResult ShaderProbe::run(const ProbeWay& way, int timed) {
    constexpr double warm_up_ms = 100;
    const gl::Program program = program_of(way);
    volume_.bind(volume_unit);
    slices_.bind(slices_unit);
    words_.bind_storage(words_binding);
    results_.bind_storage(results_binding);
    gl::Fence done;
    const auto run_once = [&] {
        const Stopwatch watch;
        timeline_.begin("probe");
        draw(program, way);
        timeline_.end();
        done.set();
        done.wait();
        return watch.milliseconds();
    };
    const Stopwatch warming;
    do {
        run_once();
    } while (warming.milliseconds() < warm_up_ms);

    const Profile profile;  // the timeline records from here on
    std::vector<double> wall_ms;
    for (int i = 0; i < timed; ++i) {
        check_interrupt();
        wall_ms.push_back(run_once());
    }
    timeline_.collect();
    ProbeResult result{values_of(way), std::nullopt, median(wall_ms)};
    const std::vector<double> opengl_ms = opengl_times(profile);
    if (!opengl_ms.empty()) result.opengl_ms = median(opengl_ms);
    return result;
}

nlohmann::ordered_json probe_json(int width, int height) {
    using Json = nlohmann::ordered_json;
    constexpr int timed = 9;
    ShaderProbe probe(width, height);
    Json ways = Json::array();
    ProbeResult fragments;
    Progress progress("probe", static_cast<std::int64_t>(probe_ways().size()));
    for (const ProbeWay& way : probe_ways()) {
        const bool computed = way.group > 0;
        const ProbeResult result = probe.run(way, timed);
        if (!computed) fragments = result;
        const double times_as_fast = result.opengl_ms ? *fragments.opengl_ms / *result.opengl_ms
                                                      : fragments.wall_ms / result.wall_ms;
        ways.push_back({{"kernel", name_of(way.kernel)},
                        {"shader", computed ? "compute" : "fragment"},
                        {"group", way.group},
                        {"order", !computed    ? "rasteriser"
                                  : way.morton ? "morton"
                                               : "rows"},
                        {"opengl_ms", result.opengl_ms ? Json(*result.opengl_ms) : Json()},
                        {"wall_ms", result.wall_ms},
                        {"times_as_fast", times_as_fast},
                        {"same_values", result.values == fragments.values}});
        progress.advance();
    }
    return {{"width", width}, {"height", height}, {"rounds", ShaderProbe::rounds}, {"ways", ways}};
}

std::string probe_table(const nlohmann::ordered_json& probe) {
    std::string table =
        fmt::format("{:<11} {:<9} {:>5} {:<11} {:>10} {:>10} {:>13}\n", "kernel", "shader", "group",
                    "order", "OpenGL ms", "wall ms", "times as fast");
    for (const auto& way : probe["ways"]) {
        const auto& opengl_ms = way["opengl_ms"];
        table +=
            fmt::format("{:<11} {:<9} {:>5} {:<11} {:>10} {:>10.3f} {:>13.2f}{}\n",
                        way["kernel"].get<std::string>(), way["shader"].get<std::string>(),
                        way["group"].get<int>(), way["order"].get<std::string>(),
                        opengl_ms.is_null() ? "-" : fmt::format("{:.3f}", opengl_ms.get<double>()),
                        way["wall_ms"].get<double>(), way["times_as_fast"].get<double>(),
                        way["same_values"] ? "" : "  other values");
    }
    return table;
}

}  // namespace lamina::selftest
