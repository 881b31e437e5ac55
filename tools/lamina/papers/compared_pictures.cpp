// SPDX-License-Identifier: Apache-2.0
#include "papers/compared_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <utility>

#include "base/client.h"
#include "image/difference.h"
#include "mesh/mesh_shape.h"
#include "meshing/volume_mesh.h"
#include "papers/figure_files.h"
#include "papers/paper_item.h"
#include "study/report_files.h"

namespace lamina::papers {
namespace {

// Returns the Kuhn mesh of a grid with `cells` cells. Point `index` lies at place(index) and has
// the scalar field(index).
template <typename Place, typename Field>
SceneMesh split_grid(const std::array<std::int32_t, 3>& cells, const Place& place,
                     const Field& field) {
    Grid grid;
    grid.centering = {Centering::node, Centering::node, Centering::node};
    for (std::size_t axis = 0; axis < 3; ++axis) grid.size[axis] = cells[axis] + 1;
    const auto samples =
        std::make_shared<std::vector<std::uint8_t>>(static_cast<std::size_t>(grid.sample_count()));
    const Volume volume(grid, SampleType::uint8,
                        std::shared_ptr<const void>(samples, samples->data()));
    MeshData data =
        make_kuhn_mesh(TrilinearField(volume), std::numeric_limits<std::int32_t>::max());
    MeshScalar scalar = std::move(data.point_scalars.front());
    data.point_scalars.clear();
    for (std::size_t i = 0; i < data.points.size(); ++i) {
        scalar.values[i] = field(data.points[i]);
        data.points[i] = place(data.points[i]);
    }
    return {TetMesh(std::move(data), "generated mesh"), std::move(scalar), false, {}};
}

double blobs(const glm::dvec3& p) {
    const auto blob = [&](const glm::dvec3& center, double radius) {
        const glm::dvec3 d = (p - center) / radius;
        return std::exp(-glm::dot(d, d));
    };
    return 0.9 * blob({.4, .45, .5}, .28) + 0.6 * blob({.68, .62, .35}, .15) +
           0.5 * blob({.35, .75, .7}, .12);
}

// Returns the heights of layers 0..count above the body. Thicknesses are first, first * growth,
// ..., last.
std::vector<double> layer_heights(std::int32_t count, double first, double last) {
    const double growth = std::pow(last / first, 1.0 / (count - 1));
    std::vector<double> heights{0};
    double thickness = first;
    for (std::int32_t layer = 0; layer < count; ++layer) {
        heights.push_back(heights.back() + thickness);
        thickness *= growth;
    }
    return heights;
}

// Returns the height of the body's bump over (x, y), 1 in its middle.
double bump_at(double x, double y) {
    return std::exp(-10 * ((x - .5) * (x - .5) + (y - .5) * (y - .5)));
}

double layer_depth(double x, double y) {
    return 0.001 * (2 + std::sin(11 * x + 4 * y) * std::cos(9 * y - 3 * x));
}

using Json = nlohmann::ordered_json;

constexpr int magnification = 12;  // of an inset to the size of the picture
// An inset's contrast is enlarged as if its range were at least this.
constexpr double least_range = 16.0 / 255;
constexpr double inset_mean = 0.35;  // mean of an inset as shown, in linear light
// The colour scale of differences ends at the value that this share of the first variant's
// components does not exceed.
constexpr double shown_share = 0.995;

struct Inset {
    int column = 0, row = 0, width = 1, height = 1;
};

using Rgb = std::array<double, 3>;

// Returns the factor by which an inset's contrast is enlarged: the exact picture then fills two
// thirds of the range.
double gain_of(const Image& exact, const Inset& inset) {
    double range = least_range;
    for (std::size_t channel = 0; channel < 3; ++channel) {
        double low = INFINITY, high = -INFINITY;
        for (int y = inset.row; y < inset.row + inset.height; ++y) {
            for (int x = inset.column; x < inset.column + inset.width; ++x) {
                low = std::min<double>(low, exact.pixel(x, y)[channel]);
                high = std::max<double>(high, exact.pixel(x, y)[channel]);
            }
        }
        range = std::max(range, 1.5 * (high - low));
    }
    return 1 / range;
}

// Tells whether the mesh covers the whole inset: a silhouette inside would not be an artifact.
bool covered(const Image& exact, const Inset& inset) {
    for (int y = inset.row; y < inset.row + inset.height; ++y) {
        for (int x = inset.column; x < inset.column + inset.width; ++x) {
            if (exact.pixel(x, y)[3] <= 0) return false;
        }
    }
    return true;
}

Rgb mean_within(const Image& image, const Inset& inset) {
    Rgb mean{};
    for (int y = inset.row; y < inset.row + inset.height; ++y) {
        for (int x = inset.column; x < inset.column + inset.width; ++x) {
            for (std::size_t channel = 0; channel < 3; ++channel)
                mean[channel] += image.pixel(x, y)[channel];
        }
    }
    for (double& value : mean) value /= inset.width * inset.height;
    return mean;
}

// Returns the variance of the error in the inset, with the inset's gain.
double structure_within(const Image& image, const Image& exact, const Inset& inset) {
    const Rgb mean = mean_within(image, inset), exact_mean = mean_within(exact, inset);
    double sum = 0;
    for (int y = inset.row; y < inset.row + inset.height; ++y) {
        for (int x = inset.column; x < inset.column + inset.width; ++x) {
            for (std::size_t channel = 0; channel < 3; ++channel) {
                const double e = image.pixel(x, y)[channel] - mean[channel] -
                                 (exact.pixel(x, y)[channel] - exact_mean[channel]);
                sum += e * e;
            }
        }
    }
    const double gain = gain_of(exact, inset);
    return sum * gain * gain;
}

Inset worst_inset(const Image& image, const Image& exact) {
    Inset inset, worst;
    inset.width = std::max(1, image.width / magnification);
    inset.height = std::max(1, image.height / magnification);
    double most = -1;
    const int step_x = std::max(1, inset.width / 4), step_y = std::max(1, inset.height / 4);
    for (inset.row = 0; inset.row + inset.height <= image.height; inset.row += step_y) {
        for (inset.column = 0; inset.column + inset.width <= image.width; inset.column += step_x) {
            const double sum = covered(exact, inset) ? structure_within(image, exact, inset) : 0;
            if (sum > most) {
                most = sum;
                worst = inset;
            }
        }
    }
    return worst;
}

// Magnifies the inset to the picture's size by repeating pixels, and enlarges its contrast about
// its mean.
CodedImage magnified(const Image& image, const Inset& inset, double gain) {
    const Rgb mean = mean_within(image, inset);
    Image large(image.width, image.height);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const float* const from =
                image.pixel(inset.column + std::min(x / magnification, inset.width - 1),
                            inset.row + std::min(y / magnification, inset.height - 1));
            for (std::size_t channel = 0; channel < 3; ++channel) {
                large.pixel(x, y)[channel] =
                    static_cast<float>(inset_mean + gain * (from[channel] - mean[channel]));
            }
        }
    }
    return study::shown(large);
}

CodedImage framed(CodedImage picture, const Inset& inset) {
    const auto mark = [&](int x, int y) {
        if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) return;
        std::fill_n(picture.codes.begin() + 3 * (y * picture.width + x), 3, std::uint16_t{255});
    };
    for (int x = inset.column - 1; x <= inset.column + inset.width; ++x) {
        mark(x, inset.row - 1);
        mark(x, inset.row + inset.height);
    }
    for (int y = inset.row - 1; y <= inset.row + inset.height; ++y) {
        mark(inset.column - 1, y);
        mark(inset.column + inset.width, y);
    }
    return picture;
}

double shown_scale(const Difference& difference) {
    std::vector<double> sizes;
    for (const double e : difference.e) {
        if (e != 0) sizes.push_back(std::abs(e));
    }
    if (sizes.empty()) return 1;
    const auto at = sizes.begin() + static_cast<std::ptrdiff_t>(
                                        shown_share * static_cast<double>(sizes.size() - 1));
    std::nth_element(sizes.begin(), at, sizes.end());
    return *at;
}

// Returns panels like the paper's figures; the exact picture is the last.
Json panels_of(const std::string& name, const std::vector<Variant>& variants,
               const std::vector<Image>& pictures, const Image& exact,
               const std::vector<Difference>& differences, const Inset& inset, double scale) {
    const double gain = gain_of(exact, inset);
    Panels panels;
    for (std::size_t i = 0; i < pictures.size(); ++i)
        panels.add(name, variants[i].name, framed(study::shown(pictures[i]), inset));
    panels.add(name, "exact", framed(study::shown(exact), inset));
    const std::string insets = fmt::format(
        "{}: the frame {} times as large, with {:.3g} times the contrast about its mean", name,
        magnification, gain);
    for (std::size_t i = 0; i < pictures.size(); ++i)
        panels.add(insets, variants[i].name, magnified(pictures[i], inset, gain));
    panels.add(insets, "exact", magnified(exact, inset, gain));
    const std::string group = name + ": difference from the exact picture";
    for (std::size_t i = 0; i < differences.size(); ++i) {
        panels.add_difference(group, variants[i].name, differences[i], scale,
                              framed(false_color(differences[i], scale), inset));
    }
    return panels.json();
}

}  // namespace

SceneMesh make_box_mesh(const std::array<std::int32_t, 3>& cells) {
    const glm::dvec3 size(cells[0], cells[1], cells[2]);
    return split_grid(
        cells, [&](const glm::dvec3& index) { return index / size; },
        [&](const glm::dvec3& index) { return blobs(index / size); });
}

SceneMesh make_graded_mesh(std::int32_t cells, std::int32_t layers, double ratio, double bump) {
    // The longest edge is a diagonal of an outermost cell, which hardly depends on the first
    // layer's thickness.
    const double width = 1.0 / cells;
    const auto made = [&](double first) {
        const std::vector<double> heights = layer_heights(layers, first, width);
        const auto height = [&](const glm::dvec3& index) {
            return heights[static_cast<std::size_t>(std::lround(index.z))];
        };
        return split_grid(
            {cells, cells, layers},
            [&](const glm::dvec3& index) {
                const double x = width * index.x, y = width * index.y;
                return glm::dvec3(x, y, bump * bump_at(x, y) + height(index));
            },
            [&](const glm::dvec3& index) {
                const double h = height(index) / layer_depth(width * index.x, width * index.y);
                return 1 / (1 + h * h);
            });
    };
    const double longest = edge_lengths(made(width / ratio).mesh).longest;
    return made(longest / ratio);
}

VariantErrors errors_of(const std::string& variant, const Difference& difference) {
    const ImageError error = measure(difference);
    return {variant, error.all, error.of_channel[3]};
}

Json error_row(const KrausSubject& subject, const VariantErrors& errors) {
    return {{"mesh", subject.name},
            {"tets", subject.mesh.tets().tets().size()},
            {"picture", errors.name},
            {"linf", errors.all.linf},
            {"l1", errors.all.mean},
            {"l2", errors.all.l2},
            {"opacity_l1", errors.opacity.mean},
            {"opacity_l2", errors.opacity.l2}};
}

std::vector<VariantErrors> variant_errors(const std::string& label, KrausSubject& subject,
                                          const std::vector<Variant>& variants,
                                          const Capabilities& capabilities) {
    Progress progress(label, static_cast<std::int64_t>(variants.size()));
    std::vector<VariantErrors> errors;
    for (const Variant& variant : variants) {
        const Image picture =
            plain_picture(variant.scene, subject.mesh.data(), capabilities, subject.tables);
        errors.push_back(
            errors_of(variant.name, difference(picture, subject.mesh.exact(variant.scene))));
        progress.advance();
    }
    return errors;
}

ComparedPictures write_compared_pictures(const std::filesystem::path& folder,
                                         const std::string& name, KrausSubject& subject,
                                         const std::vector<Variant>& variants,
                                         const Capabilities& capabilities) {
    const Scene& scene = variants.front().scene;
    const PreciseImage& exact = subject.mesh.exact(scene);
    Progress progress(name, static_cast<std::int64_t>(variants.size()));
    std::vector<Image> pictures;
    std::vector<Difference> differences;
    ComparedPictures made;
    Json rows = Json::array();
    for (const Variant& variant : variants) {
        pictures.push_back(
            plain_picture(variant.scene, subject.mesh.data(), capabilities, subject.tables));
        differences.push_back(difference(pictures.back(), exact));
        made.errors.push_back(errors_of(variant.name, differences.back()));
        rows.push_back(error_row(subject, made.errors.back()));
        progress.advance();
    }
    const Image exact_picture = to_float(exact);
    const Inset inset = worst_inset(pictures.front(), exact_picture);
    const double scale = shown_scale(differences.front());
    study::write_text(folder / (name + ".csv"), csv_of_rows(rows));
    made.values = {
        {"files", {name + ".csv"}},
        {"mesh", subject.name},
        {"pixels", {scene.width, scene.height}},
        {"inset", {inset.column, inset.row, inset.width, inset.height}},
        {"difference_scale", scale},
        {"rows", rows},
        {"panels", panels_of(name, variants, pictures, exact_picture, differences, inset, scale)}};
    return made;
}

}  // namespace lamina::papers
