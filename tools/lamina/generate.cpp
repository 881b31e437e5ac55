// SPDX-License-Identifier: Apache-2.0
#include "volume/generate.h"

#include <fmt/ranges.h>

#include <charconv>
#include <filesystem>
#include <memory>
#include <string>

#include "base/client.h"
#include "base/error.h"
#include "verbs.h"

namespace lamina {
namespace {

struct GenerateOptions {
    std::string name, output, size;
    std::string type = "uint8";
    bool quiet = false;
};

std::array<std::int64_t, 3> parse_grid_size(const std::string& text) {
    std::array<std::int64_t, 3> size{};
    const char* at = text.data();
    const char* const end = at + text.size();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto [stop, error] = std::from_chars(at, end, size[axis]);
        const bool good_end = axis < 2 ? stop != end && *stop == ',' : stop == end;
        if (error != std::errc{} || !good_end) {
            throw UsageError(
                fmt::format("--size {}: expected X,Y,Z, for example 256,256,128", text));
        }
        at = axis < 2 ? stop + 1 : stop;
    }
    return size;
}

SampleType parse_type(const std::string& text) {
    for (const SampleType type : {SampleType::uint8, SampleType::uint16, SampleType::float32}) {
        if (text == name_of(type)) return type;
    }
    throw UsageError(fmt::format("--type {}: expected uint8, uint16 or float", text));
}

GeneratorRequest request_of(const GenerateOptions& options) {
    GeneratorRequest request;
    request.name = options.name;
    request.type = parse_type(options.type);
    if (!options.size.empty()) request.size = parse_grid_size(options.size);
    try {
        generated_grid(request);
    } catch (const Error& error) {  // its whole input comes from the command line
        throw UsageError(error.what());
    }
    return request;
}

void run(const GenerateOptions& options) {
    Progress::set_quiet(options.quiet);
    const GeneratorRequest request = request_of(options);
    if (std::filesystem::path(options.output).extension() != ".nrrd") {
        throw UsageError(fmt::format("-o {}: expected a name that ends in .nrrd", options.output));
    }
    AtomicFile file(options.output);
    generate_nrrd(file, request);
    file.commit();
}

}  // namespace

void add_generate(CLI::App& app, int& exit_code) {
    (void)exit_code;
    auto* const verb = app.add_subcommand("generate", "Write a volume made by formula");
    const auto options = std::make_shared<GenerateOptions>();
    verb->add_option("NAME", options->name,
                     fmt::format("One of {}", fmt::join(generator_names(), ", ")))
        ->required();
    verb->add_option("-o,--output", options->output, "File to write (.nrrd)")
        ->type_name("FILE")
        ->required();
    verb->add_option(
            "--size", options->size,
            fmt::format(
                "Samples along x, y and z, up to {0} along each axis (128,128,128; ramp: 256,4,1)",
                largest_generated_axis))
        ->type_name("X,Y,Z");
    verb->add_option("--type", options->type, "Of the samples")
        ->option_text("uint8|uint16|float")
        ->capture_default_str();
    verb->add_flag("--quiet", options->quiet, "No progress");
    verb->callback([options] { run(*options); });
}

}  // namespace lamina
