// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "bindings.h"
#include "drawn.h"
#include "shared_array.h"
#include "vectors.h"
#include "waiting.h"

namespace lamina::python {
namespace {

using Pixels = py::array_t<double, py::array::c_style | py::array::forcecast>;
using FloatPixels = py::array_t<float, py::array::c_style | py::array::forcecast>;

// A copy. The package's Python code has checked the shape (height, width, 4).
template <typename Real, typename Array>
RgbaImage<Real> image_of(const Array& array, ImageColorSpace space = {}) {
    RgbaImage<Real> image(static_cast<int>(array.shape(1)), static_cast<int>(array.shape(0)));
    std::copy_n(array.data(), array.size(), image.rgba.begin());
    image.space = space;
    return image;
}

ImageColorSpace space_of(const std::string& word) {
    return word == name_of(ImageColorSpace::display) ? ImageColorSpace::display
                                                     : ImageColorSpace::linear;
}

using Attributes = std::map<std::string, std::string>;

// Pixels are those of `drawn`, or what its user made of them; its annotations are added.
void save(const Drawn& drawn, const py::array& pixels, const std::filesystem::path& file,
          const Vector& background, bool transparent, int bits, const std::string& space,
          const Attributes& attributes) {
    const auto write = [&](auto image) {
        image.annotations = drawn.annotations();
        const py::gil_scoped_release released;
        save_picture(image, file, {to_glm(background), transparent, bits}, attributes);
    };
    if (pixels.dtype().itemsize() == sizeof(double))
        write(image_of<double>(Pixels(pixels), space_of(space)));
    else
        write(image_of<float>(FloatPixels(pixels), space_of(space)));
}

py::bytes png_of(const Drawn& drawn, const FloatPixels& pixels, const Vector& background,
                 bool transparent, int bits, const std::string& space) {
    Image image = image_of<float>(pixels, space_of(space));
    image.annotations = drawn.annotations();
    std::string bytes;
    {
        const py::gil_scoped_release released;
        bytes = picture_png(image, {to_glm(background), transparent, bits});
    }
    return bytes;
}

py::tuple norms_of(const ErrorNorms& norms) {
    return py::make_tuple(norms.linf, norms.mean, norms.l2);
}

// (all, {channel: norms}, (column, row, channel))
py::tuple found(const PictureComparison& comparison) {
    py::dict channels;
    for (std::size_t i = 0; i < comparison.channels.size(); ++i)
        channels[py::str(comparison.channels[i])] = norms_of(comparison.of_channel[i]);
    return py::make_tuple(
        norms_of(comparison.all), channels,
        py::make_tuple(comparison.column, comparison.row, comparison.channels[comparison.channel]));
}

py::tuple compared(const Pixels& a, const Pixels& b) {
    return found(compare(image_of<double>(a), image_of<double>(b)));
}

py::tuple files_compared(const std::filesystem::path& a, const std::filesystem::path& b) {
    PictureComparison comparison;
    {
        const py::gil_scoped_release released;
        comparison = compare_files(a, b);
    }
    return found(comparison);
}

py::bytes difference(const Pixels& a, const Pixels& b, double range) {
    return difference_png(image_of<double>(a), image_of<double>(b), range);
}

std::vector<std::string> texts_of(const std::vector<py::bytes>& frames) {
    return {frames.begin(), frames.end()};
}

void film_saved(const std::vector<py::bytes>& frames, const std::filesystem::path& file, int rate,
                const py::object& progress) {
    const std::vector<std::string> pngs = texts_of(frames);
    run_waiting(
        [&](std::stop_token stop, const ProgressCallback& said) {
            save_film(pngs, file, rate, std::move(stop), said);
        },
        progress);
}

py::bytes animated(const std::vector<py::bytes>& frames, int rate) {
    return animated_png(texts_of(frames), rate);
}

// (pixels, color space or None)
py::tuple loaded(const std::filesystem::path& file) {
    LoadedPicture picture;
    {
        const py::gil_scoped_release released;
        picture = load_picture(file);
    }
    const auto image = std::make_shared<PreciseImage>(std::move(picture.image));
    const double* const first = image->rgba.data();
    return py::make_tuple(
        array_over(first, {image->height, image->width, 4}, image),
        picture.space ? py::object(py::str(name_of(*picture.space))) : py::object(py::none()));
}

}  // namespace

void bind_pictures(py::module_& module) {
    module.def("colormap_names", &colormap_names);
    module.def("save_picture", &save, py::arg("drawn"), py::arg("pixels"), py::arg("file"),
               py::arg("background"), py::arg("transparent"), py::arg("bits"), py::arg("space"),
               py::arg("attributes"));
    module.def("picture_png", &png_of, py::arg("drawn"), py::arg("pixels"), py::arg("background"),
               py::arg("transparent"), py::arg("bits"), py::arg("space"));
    module.def("compare", &compared, py::arg("a"), py::arg("b"));
    module.def("compare_files", &files_compared, py::arg("a"), py::arg("b"));
    module.def("difference_png", &difference, py::arg("a"), py::arg("b"), py::arg("range"));
    module.def("save_film", &film_saved, py::arg("frames"), py::arg("file"), py::arg("rate"),
               py::arg("progress"));
    module.def("animated_png", &animated, py::arg("frames"), py::arg("rate"));
    module.def("load_picture", &loaded, py::arg("file"));
}

}  // namespace lamina::python
