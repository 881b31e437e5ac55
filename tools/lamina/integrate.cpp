// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/client.h"
#include "base/error.h"
#include "base/process.h"
#include "optics/segment_integral.h"
#include "output_files.h"
#include "scene_files/keys.h"
#include "scene_files/scene_keys.h"
#include "verbs.h"

namespace lamina {
namespace {

SegmentIntegral integral_of(const IntegrationCase& segment) {
    return integrate_segment(segment.transfer_function, segment.front, segment.back,
                             segment.length);
}

// Returns the results as JSON. 17 significant digits give every double back unchanged.
std::string text_of(const std::vector<SegmentIntegral>& results) {
    std::string text = "[";
    for (const SegmentIntegral& result : results) {
        text += text.size() > 1 ? ",\n " : "\n ";
        text += fmt::format(R"({{"alpha": {:.17g}, "color": [{:.17g}, {:.17g}, {:.17g}]}})",
                            result.alpha, result.color.r, result.color.g, result.color.b);
    }
    return text + "\n]\n";
}

void integrate(const std::string& cases_file, const std::string& output) {
    const auto file = open_named(output);
    const std::filesystem::path path = cases_file;
    const nlohmann::json cases = load_json(path);
    if (!cases.is_array()) {
        fail("{}: found {}, expected an array of cases", cases_file, cases.type_name());
    }
    std::vector<SegmentIntegral> results;
    std::vector<std::string> warnings;
    std::vector<std::filesystem::path> read{path};
    for (std::size_t i = 0; i < cases.size(); ++i) {
        check_interrupt();
        const std::string place = fmt::format("[{}]", i);
        if (!cases[i].is_object()) {
            fail("{}: {}: found {}, expected an object", cases_file, place, cases[i].type_name());
        }
        const IntegrationCase segment = read_integration_case(JsonReader(cases[i], path, place));
        results.push_back(integral_of(segment));
        const std::filesystem::path colormap = segment.given.colormap_file();
        if (!colormap.empty()) read.push_back(colormap);
        if (auto ramp = opaque_ramp(segment.given)) warnings.push_back(std::move(*ramp));
    }
    expect_different_files(read, {output});
    for (const std::string& warning : warnings) warn(warning);
    file->write(text_of(results));
    file->commit();
}

}  // namespace

void add_integrate(CLI::App& app, int& exit_code) {
    (void)exit_code;
    auto* verb = app.add_subcommand(
        "integrate", "Integrate emission and absorption along segments with a linear scalar");
    const auto cases = std::make_shared<std::string>();
    const auto output = std::make_shared<std::string>(standard_stream);
    verb->add_option("CASES.json", *cases,
                     R"(Array of {"transfer_function", "sf", "sb", "length"}: the scalar at the )"
                     "front and at the back, and the length in world units")
        ->required();
    verb->add_option("-o,--output", *output, "Write the results here; - is stdout, and the default")
        ->type_name("FILE");
    verb->callback([cases, output] { integrate(*cases, *output); });
}

}  // namespace lamina
