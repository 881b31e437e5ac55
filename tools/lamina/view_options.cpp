// SPDX-License-Identifier: Apache-2.0
#include "view_options.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "optics/colormap.h"

namespace lamina {
namespace {

// Two numbers with a character between them.
template <typename Number>
std::pair<Number, Number> pair_of(const char* option, const std::string& text, char between,
                                  const char* expected) {
    Number first{}, second{};
    const char* const end = text.data() + text.size();
    const auto [middle, problem] = std::from_chars(text.data(), end, first);
    if (problem == std::errc{} && middle != end && *middle == between) {
        const auto [stop, other] = std::from_chars(middle + 1, end, second);
        if (other == std::errc{} && stop == end) return {first, second};
    }
    throw UsageError(fmt::format("{} {}: expected {}", option, shortened(text), expected));
}

ValueRange range_of(const std::string& text) {
    constexpr const char* expected = "LO,HI: two numbers with LO < HI, between -1e300 and 1e300";
    const auto [lo, hi] = pair_of<double>("--range", text, ',', expected);
    if (!(lo < hi && lo >= -1e300 && hi <= 1e300))
        throw UsageError(fmt::format("--range {}: expected {}", shortened(text), expected));
    return {lo, hi};
}

}  // namespace

void add_view_options(CLI::App& verb, ViewOptions& options) {
    const char* const group = "Look";
    verb.add_option("--azimuth", options.turn.azimuth,
                    "Go around what shows, this many degrees to the right of the automatic "
                    "view, or of a scene's camera")
        ->option_text("DEGREES")
        ->group(group);
    verb.add_option("--elevation", options.turn.elevation, "The same, upwards")
        ->option_text("DEGREES")
        ->group(group);
    verb.add_option("--zoom", options.zoom, "Show things this many times as large")
        ->option_text("FACTOR")
        ->group(group);
    verb.add_option("--size", options.size, "Pixels of the picture (800x600)")
        ->option_text("WxH")
        ->group(group);
    verb.add_option("--colormap", options.colormap,
                    "Colours: viridis, inferno, cividis, cool-warm, greys, ct-bone or "
                    "ct-soft-tissue, or a ParaView preset (JSON), spread over the values that show")
        ->option_text("NAME|FILE")
        ->group(group);
    verb.add_option(
            "--range", options.range,
            "Values that show: nothing below LO; colours and density are spread from LO to HI")
        ->option_text("LO,HI")
        ->allow_extra_args(false)
        ->group(group);
    verb.add_option("--density", options.density, "Factor on the extinction")
        ->option_text("FACTOR")
        ->group(group);
    verb.add_option("--background", options.background,
                    "Colour behind the picture: a CSS name, #rrggbb, or linear light [r, g, b]")
        ->option_text("COLOR")
        ->group(group);
}

namespace {

// Throws UsageError if the name is neither a map's nor a file's; a damaged file stays an Error.
Colormap colormap_of(const std::string& name_or_path, ImageColorSpace space) {
    try {
        return load_colormap(name_or_path, space);
    } catch (const Error& error) {
        if (std::filesystem::exists(name_or_path)) throw;
        throw UsageError(fmt::format("--colormap {}", error.what()));
    }
}

}  // namespace

Wishes wishes_of(const ViewOptions& options, ImageColorSpace space) {
    Wishes wishes;
    if (!options.colormap.empty()) {
        Colormap colormap = colormap_of(options.colormap, space);
        // Positions in files of colour maps are rarely values of data: they are stretched over
        // these.
        if (!is_colormap_name(options.colormap)) colormap.own_range = false;
        wishes.transfer.colormap = std::move(colormap);
    }
    if (!options.range.empty()) wishes.transfer.range = range_of(options.range);
    for (const auto& [name, number] : {std::pair{"--azimuth", options.turn.azimuth},
                                       std::pair{"--elevation", options.turn.elevation}}) {
        if (!std::isfinite(number))
            throw UsageError(fmt::format("{} {}: expected a number of degrees", name, number));
    }
    if (!(options.zoom >= 1e-3 && options.zoom <= 1e3))
        throw UsageError(
            fmt::format("--zoom {}: expected a number from .001 to 1000", options.zoom));
    if (!(options.density >= 0 && options.density <= 1e9))
        throw UsageError(
            fmt::format("--density {}: expected a number from 0 to 1e9", options.density));
    wishes.density = options.density;
    wishes.turn = options.turn;
    wishes.zoom = options.zoom;
    return wishes;
}

std::vector<std::string> settings_of(const ViewOptions& options) {
    std::vector<std::string> settings;
    if (!options.size.empty()) {
        const auto [width, height] =
            pair_of<int>("--size", options.size, 'x', "WxH in pixels, as in 800x600");
        settings.push_back(fmt::format("image.width={}", width));
        settings.push_back(fmt::format("image.height={}", height));
    }
    if (!options.background.empty()) settings.push_back("image.background=" + options.background);
    return settings;
}

}  // namespace lamina
