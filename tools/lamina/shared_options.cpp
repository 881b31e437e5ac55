// SPDX-License-Identifier: Apache-2.0
#include "shared_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <utility>

#include "base/client.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/memory.h"
#include "base/value_type.h"
#include "optics/colormap.h"
#include "output_files.h"
#include "render/pipeline.h"
#include "scene_files/keys.h"
#include "scene_files/scene_reader.h"
#include "volume_files/numbered_files.h"

namespace lamina {
namespace {

constexpr double least = 1 << 20, most = 0x1p62;

// Returns the number of bytes in a text such as "800M": K, M, G and T are powers of 1024.
double bytes_of(const std::string& text) {
    char* end = nullptr;
    double bytes = std::strtod(text.c_str(), &end);
    const std::string unit = end;
    const std::size_t power = unit.empty() ? 0 : std::string("KMGT").find(unit) + 1;
    const bool known = unit.empty() || (unit.size() == 1 && power > 0);
    bytes *= std::pow(1024.0, static_cast<double>(power));
    if (text.empty() || !known || !(bytes >= least && bytes <= most)) {
        throw UsageError(
            fmt::format("--memory: found {}, expected a size of 1M or more, such as 800M or 1.5G",
                        shortened(text)));
    }
    return bytes;
}

[[noreturn]] void reject(const RawOptions& options) {
    throw UsageError(
        fmt::format("--raw {}: expected X,Y,Z,TYPE or X,Y,Z,TYPE,SX,SY,SZ: samples along x, y and "
                    "z, one of {}, and the distances between them",
                    shortened(options.layout), value_type_list()));
}

double distance_of(const std::string& word, const RawOptions& options) {
    char* end = nullptr;
    const double distance = std::strtod(word.c_str(), &end);
    if (word.empty() || *end != '\0' || !(distance > 0) || std::isinf(distance)) reject(options);
    return distance;
}

// Returns two numbers with the character `between` between them.
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

// Throws UsageError if the name is neither a map's nor a file's. A damaged file is an Error.
Colormap colormap_of(const std::string& name_or_path, ImageColorSpace space) {
    try {
        return load_colormap(name_or_path, space);
    } catch (const Error& error) {
        if (std::filesystem::exists(name_or_path)) throw;
        throw UsageError(fmt::format("--colormap {}", error.what()));
    }
}

}  // namespace

void add_memory_option(CLI::App& verb) {
    verb.add_option_function<std::string>(
            "--memory",
            [](const std::string& text) {
                set_memory_limit(static_cast<std::uint64_t>(bytes_of(text)));
            },
            "How much memory the data may take, as 800M or 1.5G (of 1024^3 bytes), beside 200 MB "
            "of the program itself: parts of larger volumes are read when they are drawn (raw "
            "NRRD, "
            "MetaImage and --raw, Zarr); half of the machine's memory where this is not given")
        ->option_text("SIZE");
}

void add_only_below_option(CLI::App& verb) {
    // The callback holds the scope, so it lasts as long as the verb's App, that is, while the verb
    // runs.
    const auto scope = std::make_shared<std::optional<OnlyBelowScope>>();
    verb.add_option_function<std::string>(
            "--only-below",
            [scope](const std::string& name) {
                if (name.empty()) throw UsageError("--only-below: found '', expected a folder");
                try {
                    scope->emplace(*allowed_folder(name, "--only-below"));
                } catch (const Error& error) {
                    throw UsageError(error.what());
                }
            },
            "Refuse every scene and data file that is not below this folder with all links "
            "followed, whoever names it: for files of people whom one does not know")
        ->option_text("FOLDER");
}

void add_raw_options(CLI::App& verb, RawOptions& options) {
    verb.add_option("--raw", options.layout,
                    "The file is a volume without a header: samples along x (fastest), y and z, "
                    "their type (int8, uint8, ... uint64, float, double), and their distances")
        ->option_text("X,Y,Z,TYPE[,SX,SY,SZ]");
    verb.add_option("--raw-offset", options.offset, "With --raw: bytes before the first sample")
        ->option_text("BYTES");
    verb.add_flag("--big-endian", options.big_endian,
                  "With --raw: the most significant byte is the first");
}

VolumeRequest request_of(const RawOptions& options) {
    if (options.layout.empty()) {
        if (options.offset != 0 || options.big_endian)
            throw UsageError("--raw-offset and --big-endian: expected --raw, too");
        return {};
    }
    if (options.offset < 0) {
        throw UsageError(
            fmt::format("--raw-offset {}: expected a whole number from 0", options.offset));
    }
    std::vector<std::string> words;
    std::istringstream stream(options.layout);
    for (std::string word; std::getline(stream, word, ',');) words.push_back(word);
    if ((words.size() != 4 && words.size() != 7) || !value_type_of(words[3])) reject(options);
    VolumeRequest request;
    request.raw = RawLayout{{}, words[3], options.offset, options.big_endian};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto size = whole_number(words[axis]);
        if (!size || *size < 1 || *size > (std::int64_t{1} << 40)) reject(options);
        request.raw->size[axis] = *size;
    }
    if (words.size() == 7) {
        request.spacing = {distance_of(words[4], options), distance_of(words[5], options),
                           distance_of(words[6], options)};
    }
    return request;
}

Scene load_scene(const SceneOptions& options, const std::vector<std::string>& more,
                 nlohmann::json& document, const std::function<void(nlohmann::json&)>& edit) {
    const bool piped = options.file == standard_stream;
    const std::string file = piped ? stdin_name : options.file;
    const VolumeRequest request = request_of(options.raw);
    if (piped && request.raw) throw UsageError("--raw: found -, expected a volume's file");
    document = piped ? load_json_from_stdin() : scene_document(file, request);
    std::vector<std::string> keys;
    const auto apply = [&](const std::string& key, const std::string& value) {
        // A volume or a mesh is an object in JSON if it has other settings than its path.
        const char* const source = key.starts_with("volume.") ? "volume" : "mesh";
        const bool chooses = key.starts_with("volume.") || key == "mesh.time";
        if (chooses && document.contains(source) && document[source].is_string())
            document[source] = {{"path", document[source]}};
        set_key(document, key, value);
        keys.push_back(key);
    };
    // Throws if the document is no object, in which no keys could be set.
    (void)JsonReader(document, file);
    std::vector<std::string> settings = more;
    settings.insert(settings.end(), options.settings.begin(), options.settings.end());
    for (const std::string& setting : settings) {
        const std::size_t equals = setting.find('=');
        if (equals == std::string::npos) {
            throw UsageError(fmt::format("--set {}: expected KEY=VALUE, as in render.target=fixed8",
                                         shortened(setting)));
        }
        apply(setting.substr(0, equals), setting.substr(equals + 1));
    }
    if (!options.method.empty()) apply("render.method", options.method);
    if (edit) edit(document);
    try {
        return read_scene(document, file);
    } catch (const KeyError& error) {
        for (const std::string& key : keys) {
            if (error.key == key || key.starts_with(error.key + ".") ||
                error.key.starts_with(key + ".")) {
                throw UsageError(error.what());
            }
        }
        throw;
    }
}

nlohmann::ordered_json document_of(const Scene& scene, const nlohmann::json& document) {
    nlohmann::ordered_json result = scene_json(scene);
    result["render"] = document.value("render", nlohmann::json::object());
    result["render"]["method"] = name_of(scene.method);
    return result;
}

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
    verb.add_flag("--transparent", options.transparent,
                  "No background: PNG files and films with straight alpha (image.transparent)")
        ->group(group);
}

Adjustments adjustments_of(const ViewOptions& options, ImageColorSpace space) {
    Adjustments adjustments;
    if (!options.colormap.empty()) {
        Colormap colormap = colormap_of(options.colormap, space);
        // Positions in a colour map's file are rarely values of the data, so the map is stretched
        // over them.
        if (!is_colormap_name(options.colormap)) colormap.own_range = false;
        adjustments.transfer.colormap = std::move(colormap);
    }
    if (!options.range.empty()) adjustments.transfer.range = range_of(options.range);
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
    adjustments.density = options.density;
    adjustments.turn = options.turn;
    adjustments.zoom = options.zoom;
    return adjustments;
}

std::pair<int, int> pixels_of(const char* option, const std::string& text) {
    constexpr int most_pixels = 16'384;
    const std::string expected = fmt::format("WxH, 1 to {} each, for example 128x128", most_pixels);
    const auto size = pair_of<int>(option, text, 'x', expected.c_str());
    if (std::min(size.first, size.second) < 1 || std::max(size.first, size.second) > most_pixels)
        throw UsageError(fmt::format("{} {}: expected {}", option, shortened(text), expected));
    return size;
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
    if (options.transparent) settings.emplace_back("image.transparent=true");
    return settings;
}

Choices chosen_by_volume(const Scene& scene) {
    Scene of_volume = scene;
    of_volume.method = Method::slice;
    Pipeline pipeline(std::move(of_volume));
    Choices result{pipeline.scene(), pipeline.reasons()};
    result.scene.method = scene.method;
    return result;
}

}  // namespace lamina
