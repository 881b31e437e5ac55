// SPDX-License-Identifier: Apache-2.0
#include "icet_compositor.h"

#include <IceT.h>
#include <IceTMPI.h>

#include <algorithm>
#include <cmath>

namespace lamina {

struct IcetCompositor::Contexts {
    IceTCommunicator communicator;
    IceTContext context;
};

IcetCompositor::IcetCompositor(Format format, int width, int height)
    : format_(format), contexts_(new Contexts) {
    contexts_->communicator = icetCreateMPICommunicator(MPI_COMM_WORLD);
    contexts_->context = icetCreateContext(contexts_->communicator);
    icetDiagnostics(ICET_DIAG_ROOT_NODE | ICET_DIAG_WARNINGS);
    icetAddTile(0, 0, width, height, 0);
    icetStrategy(ICET_STRATEGY_SEQUENTIAL);
    icetSingleImageStrategy(ICET_SINGLE_IMAGE_STRATEGY_AUTOMATIC);
    icetCompositeMode(ICET_COMPOSITE_MODE_BLEND);
    icetEnable(ICET_ORDERED_COMPOSITE);
    icetSetColorFormat(format == Format::float32 ? ICET_IMAGE_COLOR_RGBA_FLOAT
                                                 : ICET_IMAGE_COLOR_RGBA_UBYTE);
    icetSetDepthFormat(ICET_IMAGE_DEPTH_NONE);
}

IcetCompositor::~IcetCompositor() {
    icetDestroyContext(contexts_->context);
    icetDestroyMPICommunicator(contexts_->communicator);
    delete contexts_;
}

void IcetCompositor::compose(const std::vector<int>& order, Image& picture) {
    icetSetContext(contexts_->context);
    icetCompositeOrder(order.data());
    const float background[4] = {0, 0, 0, 0};
    const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const void* pixels = picture.rgba.data();
    if (format_ == Format::bytes) {
        bytes_.resize(picture.rgba.size());
        std::ranges::transform(picture.rgba, bytes_.begin(), [](float v) {
            return static_cast<std::uint8_t>(255 * std::clamp(v, 0.0f, 1.0f) + 0.5f);
        });
        pixels = bytes_.data();
    }
    const IceTImage image =
        icetCompositeImage(pixels, nullptr, nullptr, identity, identity, background);
    IceTInt sent = 0;
    icetGetIntegerv(ICET_BYTES_SENT, &sent);
    bytes_sent_ = sent;
    if (!icetImageIsNull(image) && icetImageGetNumPixels(image) > 0)
        icetImageCopyColorf(image, picture.rgba.data(), ICET_IMAGE_COLOR_RGBA_FLOAT);
}

}  // namespace lamina
