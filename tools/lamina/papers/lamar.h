// SPDX-License-Identifier: Apache-2.0
#pragma once

// Reproduces tables and figures of LaMar, "On Issues of Precision for Hardware Texture-based Volume
// Visualization", 2004.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compositing/codes.h"
#include "compositing/fixed_ray.h"
#include "gl/api.h"
#include "gl/framebuffer.h"
#include "gl/program.h"
#include "image/difference.h"
#include "lamina/image.h"
#include "lamina/scene.h"
#include "lamina/volume.h"
#include "papers/paper_item.h"
#include "render/pipeline.h"

namespace lamina::papers {

class LamarStage;

using LamarItem = PaperItem<LamarStage>;

// Returns the items in the paper's order, followed by items on questions that it leaves open.
const std::vector<LamarItem>& lamar_items();

nlohmann::ordered_json reproduce_table1(const std::filesystem::path& folder);
nlohmann::ordered_json reproduce_table2(const std::filesystem::path& folder);
nlohmann::ordered_json reproduce_table3(const std::filesystem::path& folder);
nlohmann::ordered_json reproduce_figure2(const std::filesystem::path& folder);
nlohmann::ordered_json reproduce_figure3(const std::filesystem::path& folder);
nlohmann::ordered_json reproduce_figure4(const std::filesystem::path& folder);
nlohmann::ordered_json reproduce_figure5(const std::filesystem::path& folder);
nlohmann::ordered_json reproduce_figure9(const std::filesystem::path& folder);

// Compares front to back with back to front (section 4.2), with random rays of small to large
// optical depth and with equal fragments.
nlohmann::ordered_json reproduce_order(const std::filesystem::path& folder);

// Measures dithering (section 5): the period and the smallest opacity, increments, colour, thin
// structures, boundaries.
nlohmann::ordered_json reproduce_dithering(const std::filesystem::path& folder);

// Draw the paper's pictures. Figure 1 needs the bonsai of LAMINA_DATA; without it nothing can be
// tested. The Richtmyer-Meshkov data are not available; mixing_volume() replaces them.
nlohmann::ordered_json draw_figure1(const std::filesystem::path& folder, LamarStage& stage);
nlohmann::ordered_json draw_table4(const std::filesystem::path& folder, LamarStage& stage);
nlohmann::ordered_json draw_figure6(const std::filesystem::path& folder, LamarStage& stage);
nlohmann::ordered_json draw_figure10(const std::filesystem::path& folder, LamarStage& stage);

// Compares both compositing orders on mixing_volume().
nlohmann::ordered_json draw_order_mixing(const std::filesystem::path& folder, LamarStage& stage);

// Measures run times, which the paper does not give.
nlohmann::ordered_json draw_times(const std::filesystem::path& folder, LamarStage& stage);

// Returns the scene with target `emulated` of 8 bits, which composites as LaMar's hardware (2004,
// section 4).
Scene with_paper_hardware(Scene scene);

// Generates the volume `mixing`, which replaces LaMar's Richtmyer-Meshkov data (2004, section 5.2).
// Heavy liquid, at large x, flows into light liquid.
Volume mixing_volume();

// Returns a square orthographic picture of 1024 slabs along z, with x to the right. Density is .023
// in the light liquid, which then shows 4 of 255 as in the paper, and 1 in the heavy liquid. Colour
// goes from green at density 0 to red at 1. The intended opacity of a ray is .765 times its
// density. Then the largest red is 195, and green cannot exceed 48.8, as in the paper (Table 4,
// period 1: nothing is drawn, so that the largest errors, 195 and 47, are the largest values).
// `white`: for techniques that carry no colour.
Scene mixing_scene(int pixels, bool white = false);

// Pictures of mixing_volume(): exact (float32), and as the paper's hardware dithers them.
struct DitheredMixing {
    Image exact;
    std::vector<int> periods;  // 1 stands for no dithering
    std::vector<Image> dithered;
};

// Holds what the paper's items share: the current context, pre-integration tables and pictures.
class LamarStage {
  public:
    // Pictures of mixing_volume() get `pixels` x `pixels` pixels.
    explicit LamarStage(const Capabilities& capabilities, int pixels = 160)
        : capabilities_(capabilities), pixels_(pixels) {}

    const Capabilities& capabilities() const { return capabilities_; }
    int pixels() const { return pixels_; }
    const std::shared_ptr<TableCache>& tables() const { return tables_; }
    Image draw_mixing(const Scene& scene);    // the volume is made when first needed
    const DitheredMixing& dithered_mixing();  // for Table 4 and Figure 6; made when first needed

  private:
    Capabilities capabilities_;
    int pixels_;
    std::shared_ptr<TableCache> tables_ = std::make_shared<TableCache>();
    std::shared_ptr<const VolumeData> mixing_;
    std::optional<DitheredMixing> dithered_mixing_;
};

// The ramp of LaMar 2004, section 4: 256 rays side by side, each homogeneous and one unit long. Ray
// x has the opacity x/255.

inline constexpr int ramp_width = 256;

// The associated colour that each ray shows, in units of 1/255.
using Curve = std::vector<double>;

struct RampSetting {
    int samples = 64;  // N
    double color = 1;
    Emulation emulation = {};
    std::optional<Dither> dither = {};
    Order order = Order::back_to_front;
};

// Returns the exact ramp: color * x.
Curve exact_ramp(double color);

Curve composite_ramp(const RampSetting& setting);

// Returns the opacity (colour 1) by exponent-factoring. `factors`: as in TreeShape.
Curve composite_ramp_tree(const RampSetting& setting, const std::vector<int>& factors);

// Returns the norms of e = measured - exact. Both have the same size, at least 1.
ErrorNorms error_of(const Curve& measured, const Curve& exact);

// Returns the number of places at which a curve is lower than one place before.
int decreases(const Curve& curve);

// Returns the largest such decrease; 0 if the curve never decreases.
double largest_drop(const Curve& curve);

// Returns the number of different values of a curve.
int levels(const Curve& curve);

// Returns the first column that is not 0, or ramp_width if there is none.
int first_shown(const Curve& curve);

// Measures how dithering along depth shows a structure that fills only some of a ray's slabs (LaMar
// 2004, section 5.2).

struct SpanSetting {
    double code = 0.1;  // opacity of the structure in one slab, in codes of 8 bits, 0 < code < 1
    int slabs = 9;      // number of slabs that it fills, >= 1
    Dither dither;
};

// Statistics over all positions of the structure relative to the dithering pattern.
struct SpanLoss {
    double lost = 0;  // share of positions at which the structure does not show
    // Mean number of slabs from the structure's boundary to the first slab that shows, over
    // positions at which one does.
    double mean_shift = 0;
    int largest_shift = 0;
    double sum_error = 0;  // RMS difference between the sum of its codes and slabs * code, in codes
};

SpanLoss span_loss(const SpanSetting& setting);

struct NamedCurve {
    std::string name;
    Curve curve;
};

// Returns the names of the files that write_ramp_figure() writes: NAME.csv and NAME.svg.
std::vector<std::string> ramp_figure_files(const std::string& name);

// Writes a figure of ramps into `folder`; `curves[0]` is the exact one. NAME.csv has a column for
// each curve, and NAME.svg is their plot. Returns {files, curves: {name: [...]}, errors: {name:
// {linf, l1, l2}}, panels}, in units of 1/255. The panels are one grey strip for each curve, as in
// the paper.
nlohmann::ordered_json write_ramp_figure(const std::filesystem::path& folder,
                                         const std::string& name, const std::string& title,
                                         const std::vector<NamedCurve>& curves);

// Two ways to give every slice its own dithered palette, a question that LaMar 2004, section 5,
// leaves open. Full-screen slices of an 8-bit texture are blended in 8 bits. The palette of 256
// entries repeats after `period` slices.
class PaletteSlices {
  public:
    enum class Source {
        upload,  // the palette is uploaded before each slice
        lookup,  // all palettes are in one texture, with one dependent lookup
    };
    PaletteSlices(Source source, int pixels, int slices, int period);

    Image draw();  // draws a frame, which is complete on return

  private:
    Source source_;
    int slices_, period_;
    std::vector<std::uint8_t> palettes_;  // 256 RGBA entries each
    gl::Texture indices_, palette_;
    gl::Framebuffer target_;
    gl::Program program_;
    gl::VertexArray no_attributes_;
};

}  // namespace lamina::papers
