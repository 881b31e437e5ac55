// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "base/client.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/output_file.h"
#include "base/process.h"
#include "image/difference.h"
#include "image/exr.h"
#include "image/picture.h"
#include "image/png.h"
#include "output_files.h"
#include "study/report_files.h"
#include "verbs.h"

namespace lamina {
namespace {

struct CompareOptions {
    std::string a, b;
    bool json = false;
    std::string diff;
    std::optional<double> max_linf, range;
};

std::string table_row(const std::string& label, const ErrorNorms& norms) {
    return fmt::format("{:<8}{:>12.6g}{:>14.6g}{:>12.6g}\n", label, norms.linf, norms.mean,
                       norms.l2);
}

std::string table_text(const ImageError& error) {
    std::string text = fmt::format("{:<8}{:>12}{:>14}{:>12}\n", "A-B", "Linf", "L1 (signed)", "L2");
    for (std::size_t i = 0; i < error.channels.size(); ++i) {
        text += table_row(error.channels[i], error.of_channel[i]);
    }
    text += table_row("all", error.all);
    text += "in units of 1/255; ";
    const ImageError::Worst& worst = error.worst;
    if (error.all.linf == 0) return text + "the images are equal\n";
    return text + fmt::format("largest at pixel ({}, {}), channel {}: {:.6g}\n", worst.column,
                              worst.row, error.channels[worst.channel], worst.e);
}

void check(const CompareOptions& options) {
    if (options.max_linf && !(*options.max_linf >= 0)) {
        throw UsageError(fmt::format("--max-linf {}: expected 0 or more", *options.max_linf));
    }
    if (options.range && !(*options.range > 0 && std::isfinite(*options.range)))
        throw UsageError(fmt::format("--range {}: expected a number above 0", *options.range));
    if (options.range && options.diff.empty()) throw UsageError("--range: expected --diff, too");
    if (!options.diff.empty() && std::filesystem::path(options.diff).extension() != ".png") {
        throw UsageError(fmt::format("--diff {}: expected a name that ends in .png", options.diff));
    }
}

// Returns the camera of the scene that an EXR file of lamina carries; null if there is none.
nlohmann::json camera_of(const std::string& file) {
    if (std::filesystem::path(file).extension() != ".exr") return nullptr;
    const auto scene = attribute_of_exr(file, "scene");
    if (!scene) return nullptr;
    try {
        const nlohmann::json document = parse_json(*scene);
        const auto found = document.is_object() ? document.find("camera") : document.end();
        return found == document.end() || !found->is_object() ? nlohmann::json() : *found;
    } catch (const Error&) {
        return nullptr;  // a damaged scene says nothing of the picture
    }
}

// Warns of pictures with different cameras: an automatic camera fits what shows, so that another
// transfer function may move it.
void warn_of_cameras(const CompareOptions& options) {
    const nlohmann::json a = camera_of(options.a), b = camera_of(options.b);
    if (a.is_null() || b.is_null() || a == b) return;
    say("{}, {}: were drawn with different cameras, so that edges differ; a scene with a camera, "
        "as lamina scene writes it, draws both with one",
        options.a, options.b);
}

int compare(const CompareOptions& options) {
    check(options);
    expect_different_files({options.a, options.b}, {options.diff});
    std::unique_ptr<AtomicFile> diff;
    if (!options.diff.empty()) diff = std::make_unique<AtomicFile>(options.diff);
    const Difference e = difference(load_image(options.a), load_image(options.b));
    warn_of_cameras(options);
    const ImageError error = measure(e);
    if (diff) {
        const double range = options.range.value_or(error.all.linf);
        write_png(*diff, difference_picture(e, range));
        diff->commit();
        const char* const beyond = range < error.all.linf ? " and beyond" : "";
        print_message(
            "{}: A-B from -{:.6g} (dark blue){} over 0 (white) to +{:.6g} (dark red){}, in 1/255\n",
            options.diff, range, beyond, range, beyond);
    }
    write_result(options.json ? json_text(study::to_json(error), 2) + "\n" : table_text(error));
    if (options.max_linf && error.all.linf > *options.max_linf) {
        print_message("lamina: Linf {:.6g} is over --max-linf {:.6g}\n", error.all.linf,
                      *options.max_linf);
        return 3;
    }
    return 0;
}

}  // namespace

void add_compare(CLI::App& app, int& exit_code) {
    auto* const verb = app.add_subcommand(
        "compare", "How A differs from B: e = A-B in 1/255, per channel and over all");
    const auto options = std::make_shared<CompareOptions>();
    verb->add_option("A", options->a, "Picture (.exr, .npy, or .png against .png)")->required();
    verb->add_option("B", options->b, "Picture to measure against, of the same size")->required();
    verb->add_flag("--json", options->json, "Print JSON instead of a table");
    verb->add_option("--diff", options->diff,
                     "Write the signed difference in false colour, with its colour bar (.png)")
        ->option_text("FILE");
    verb->add_option("--range", options->range,
                     "With --diff: darkest at this difference, in 1/255, instead of at the largest")
        ->option_text("DIFFERENCE");
    verb->add_option("--max-linf", options->max_linf,
                     "Exit with code 3 if Linf, the largest difference of any channel in any "
                     "pixel, in 1/255, is larger")
        ->option_text("LINF")
        ->check([](const std::string& text) { return text.empty() ? "expected a number" : ""; });
    verb->footer(
        "Linf is the largest difference, L1 the mean one with its sign, L2 the root of the "
        "mean square, all in 1/255, of A minus B. A pixel is (column, row), from the top left.");
    verb->callback([options, &exit_code] { exit_code = compare(*options); });
}

}  // namespace lamina
