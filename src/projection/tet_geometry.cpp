// SPDX-License-Identifier: Apache-2.0
#include "projection/tet_geometry.h"

#include <cstring>

namespace lamina {

TetGeometry::Size SilhouetteGeometry::largest_size(bool lit) {
    constexpr std::size_t corners = ScreenPolygon::most_corners;
    return {sizeof(SilhouetteVertex), corners, 3 * (corners - 2), true, lit};
}

TetGeometry::Written SilhouetteGeometry::write(const TetPart& part, const Place& place) const {
    ScreenOutline outline;
    SilhouetteRecord record;  // not written in place: that memory may be slow to read
    GradientRecord gradient;
    GradientRecord* const lit = place.gradient != nullptr ? &gradient : nullptr;
    const std::optional<FragmentKind> kind = projector_.project(part, record, outline, lit);
    if (!kind) return {};
    const ScreenPolygon polygon = surround(outline.points(), projector_.margin(),
                                           projector_.view().width, projector_.view().height);
    if (polygon.count == 0) return {};
    std::memcpy(place.record, &record, sizeof(record));
    if (lit != nullptr) std::memcpy(place.gradient, &gradient, sizeof(gradient));
    Written written;
    written.kind = *kind;
    for (int i = 0; i < polygon.count; ++i) {
        const SilhouetteVertex vertex{polygon.corners[static_cast<std::size_t>(i)],
                                      place.record_number};
        std::memcpy(place.vertices + written.vertices++ * sizeof(vertex), &vertex, sizeof(vertex));
    }
    for (std::uint32_t i = 2; i < written.vertices; ++i) {
        place.indices[written.indices++] = place.first_vertex;
        place.indices[written.indices++] = place.first_vertex + i - 1;
        place.indices[written.indices++] = place.first_vertex + i;
    }
    return written;
}

}  // namespace lamina
