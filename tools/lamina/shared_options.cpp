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

#include "annotation/font.h"
#include "base/client.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/memory.h"
#include "base/value_type.h"
#include "choice/words.h"
#include "output_files.h"
#include "render/pipeline.h"
#include "scene_files/keys.h"
#include "scene_files/scene_keys.h"
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

namespace {

// Sets a key of an annotation that the document has already, as `true`, a text or an object: the
// object's other keys stay. Returns false if there is none.
bool set_annotation(nlohmann::json& document, const std::string& key, const std::string& value) {
    constexpr std::string_view above = "image.annotations.";
    if (!key.starts_with(above)) return false;
    const std::string name = key.substr(above.size(), key.find('.', above.size()) - above.size());
    const bool whole = above.size() + name.size() == key.size();
    const nlohmann::json::json_pointer place("/image/annotations/" + name);
    if (!document.contains(place)) return false;
    nlohmann::json& annotation = document[place];
    if (whole && annotation.is_object() && value == "true") return true;
    if (whole && annotation.is_object() && name == "title") {
        set_key(document, key + ".text", value);
        return true;
    }
    if (!whole && annotation == true) annotation = nlohmann::json::object();
    if (!whole && annotation.is_string()) annotation = {{"text", annotation}};
    return false;
}

}  // namespace

Scene load_scene(const SceneOptions& options, const std::vector<std::string>& more,
                 nlohmann::json& document, const std::function<void(nlohmann::json&)>& edit) {
    const bool piped = options.file == standard_stream;
    const std::string file = piped ? stdin_name : options.file;
    const VolumeRequest request = request_of(options.raw);
    if (piped && request.raw) throw UsageError("--raw: found -, expected a volume's file");
    document = piped ? load_json_from_stdin() : scene_document(file, request);
    std::vector<std::string> keys;
    const auto apply = [&](const std::string& key, const std::string& value) {
        if (!set_annotation(document, key, value)) set_key(document, key, value);
        keys.push_back(key);
    };
    // Throws if the document is no object, in which no keys could be set.
    (void)JsonReader(document, file);
    const bool open_camera = !document.contains("camera") || document["camera"] == "auto";
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
            if (key.starts_with("camera.") && open_camera && error.key.starts_with("camera.") &&
                std::ranges::find(keys, error.key) == keys.end()) {
                throw UsageError(fmt::format(
                    "--set {}: the camera of {} is automatic, and one that is given needs its eye "
                    "and center, too: \"lamina scene\" writes it into a scene, to be changed there",
                    key, file));
            }
            if (error.key == key || key.starts_with(error.key + ".") ||
                error.key.starts_with(key + ".")) {
                const std::string inner = dynamic_cast<const UnknownKeyError*>(&error) != nullptr &&
                                                  key.find('.') == key.npos
                                              ? scene_key_named(key)
                                              : "";
                throw UsageError(
                    inner.empty()
                        ? error.what()
                        : fmt::format("--set {}: unknown key, did you mean \"{}\"?", key, inner));
            }
        }
        throw;
    }
}

std::string scene_key_named(const std::string& word) {
    std::vector<std::pair<std::string, nlohmann::json>> level{
        {"", parse_json(scene_schema_text())}};
    while (!level.empty()) {
        decltype(level) below;
        for (const auto& [path, schema] : level) {
            for (const char* const choice : {"anyOf", "oneOf"}) {
                for (const auto& one : schema.value(choice, nlohmann::json::array()))
                    below.emplace_back(path, one);
            }
            if (!schema.contains("properties")) continue;
            for (const auto& [key, inner] : schema["properties"].items()) {
                const std::string whole = path.empty() ? key : path + "." + key;
                if (key == word || whole == word) return whole;
                below.emplace_back(whole, inner);
            }
        }
        level = std::move(below);
    }
    return "";
}

nlohmann::ordered_json document_of(const Scene& scene, const nlohmann::json& document) {
    nlohmann::ordered_json result = scene_json(scene);
    result["render"] = document.value("render", nlohmann::json::object());
    result["render"]["method"] = name_of(scene.method);
    return result;
}

namespace {

constexpr const char* look = "Look";

CLI::Option* add_word(CLI::App& verb, const char* name, auto& value, const char* text,
                      const char* help) {
    return verb.add_option(name, value, help)->option_text(text)->group(look);
}

void add_camera_words(CLI::App& verb, Words& words) {
    add_word(verb, "--azimuth", words.azimuth, "DEGREES",
             "Go around what shows, this many degrees to the right of the automatic "
             "view, or of a scene's camera");
    add_word(verb, "--elevation", words.elevation, "DEGREES", "The same, upwards");
    add_word(verb, "--zoom", words.zoom, "FACTOR", "Show things this many times as large");
    add_word(verb, "--up", words.up, "+x|-x|+y|-y|+z|-z",
             "The axis that is up, in place of the one that is chosen; also of a scene with a "
             "camera, which is then chosen anew");
    add_word(verb, "--view", words.view, "SIDE",
             "Look from this side: front, back, left, right, top, bottom, or iso (a three-quarter "
             "view); --azimuth and --elevation start there");
}

void add_color_words(CLI::App& verb, Words& words) {
    add_word(verb, "--colormap", words.colormap, "NAME|FILE",
             "Colours: viridis, inferno, cividis, cool-warm, greys, ct-bone, ct-soft-tissue, "
             "ct-lung or ct-angio, or a ParaView preset (JSON), spread over the values that show");
    add_word(verb, "--range", words.range, "LO,HI",
             "Values that show: nothing below LO; colours and density are spread from LO to HI")
        ->allow_extra_args(false);
    add_word(verb, "--opacity", words.opacity, "NAME",
             "How opacity grows over the values that show: linear, geom, sigmoid, sigmoid_1 to "
             "sigmoid_20, foreground; linear_r and geom_r fall; or numbers from 0 to 1, as 0,.2,.9 "
             "spread evenly or 10:0,20:.5 at values");
    add_word(verb, "--preset", words.preset, "NAME",
             "Colours, opacity and light for a kind of data: ct-bone, ct-soft-tissue, ct-lung, "
             "ct-angio (all in HU), mr, microscopy");
    add_word(verb, "--density", words.density, "FACTOR", "Factor on the extinction");
}

void add_light_and_clip_words(CLI::App& verb, Words& words) {
    add_word(verb, "--light", words.light, "headlight|left|right|two",
             "Light surfaces, from the eye (also if no word follows), from the left or right and "
             "above, or by two lights")
        ->expected(0, 1)
        ->default_str("headlight");
    add_word(verb, "--clip", words.clip, "PLANE",
             "Cut away all but x:10: (from 10 on), x::10 (up to 10), x:10:20, \"x>10\" or "
             "\"x<10\"; world units; x, y or z; may be repeated")
        ->allow_extra_args(false);
    add_word(verb, "--crop", words.crop, "X0:X1,Y0:Y1,Z0:Z1",
             "Cut away all but this box; an end that is left out is open; an automatic camera "
             "shows what is left")
        ->allow_extra_args(false);
}

}  // namespace

void add_view_options(CLI::App& verb, ViewOptions& options) {
    add_camera_words(verb, options.words);
    add_word(verb, "--size", options.size, "WxH", "Pixels of the picture (800x600)");
    add_color_words(verb, options.words);
    add_light_and_clip_words(verb, options.words);
    add_word(verb, "--background", options.background, "COLOR",
             "Colour behind the picture: a CSS name, #rrggbb, or linear light [r, g, b]");
    verb.add_flag("--transparent", options.transparent,
                  "No background: PNG files and films with straight alpha (image.transparent)")
        ->group(look);
    verb.add_flag("--legend", options.legend,
                  "Draw a colour bar with the opacities beside the picture; of labels, a legend")
        ->group(look);
    verb.add_flag("--scale-bar", options.scale_bar, "Draw a length beside the picture")
        ->group(look);
    verb.add_flag("--axes", options.axes, "Draw arrows along the world's axes")->group(look);
    add_word(verb, "--title", options.title, "TEXT", "Write this above the picture");
}

Adjustments adjustments_of(const ViewOptions& options, ImageColorSpace space) {
    try {
        return adjustments_of(options.words, space);
    } catch (const WordError& mistake) {
        throw UsageError(fmt::format("--{}", mistake.what()));
    }
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
        if (width < 1 || height < 1) {
            throw UsageError(fmt::format("--size {}: expected 1 pixel or more each, as in 800x600",
                                         options.size));
        }
        settings.push_back(fmt::format("image.width={}", width));
        settings.push_back(fmt::format("image.height={}", height));
    }
    if (!options.background.empty()) settings.push_back("image.background=" + options.background);
    if (options.transparent) settings.emplace_back("image.transparent=true");
    if (options.transparent && !options.background.empty()) {
        warn(
            "--transparent: there is no background; --background only says whether annotations are "
            "dark or light");
    }
    const auto add = [&](const char* key, const std::string& value) {
        settings.push_back(fmt::format("image.annotations.{}={}", key, value));
    };
    if (options.legend) {
        add("colorbar", "true");
        add("labels", "true");
    }
    if (options.scale_bar) add("scale_bar", "true");
    if (options.axes) add("axes", "true");
    if (options.title.empty()) return settings;
    try {
        check_text("--title", options.title);
    } catch (const Error& error) {
        throw UsageError(error.what());
    }
    add("title", json_text(nlohmann::json(options.title)));
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
