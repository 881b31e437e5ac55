// SPDX-License-Identifier: Apache-2.0
// Composites random pictures of several ranks and prints the largest difference, in 1/255, from
// compositing them in double precision on one rank. Arguments: wire, most ranks in a group, seed.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>

#include "parallel/shared_renderer.h"
#include "random_picture.h"
#include "support/put_behind.h"

namespace {

using namespace lamina;

constexpr int width = 120, height = 50;

Image picture_of(int rank, std::uint32_t seed) {
    return random_picture(width, height, 1000 * seed + static_cast<std::uint32_t>(rank));
}

PreciseImage composited(const std::vector<int>& order, std::uint32_t seed) {
    PreciseImage sum(width, height);
    for (const int rank : order) put_behind(picture_of(rank, seed), sum);
    return sum;
}

}  // namespace

int main(int argc, char** argv) {
    MPI_Init(&argc, &argv);
    {
        const Ranks ranks(MPI_COMM_WORLD);
        const auto seed = static_cast<std::uint32_t>(std::atoi(argv[3]));
        std::vector<int> order(static_cast<std::size_t>(ranks.count()));
        std::iota(order.begin(), order.end(), 0);
        std::shuffle(order.begin(), order.end(), std::mt19937(seed));
        PictureComposer composer(ranks, wire_of(argv[1]), std::atoi(argv[2]));
        double largest = 0;
        // The second frame reuses the memory of the first.
        for (int frame = 0; frame < 2; ++frame) {
            Image picture = picture_of(ranks.number(), seed);
            composer.compose(order, picture);
            if (!ranks.leads()) continue;
            const PreciseImage expected = composited(order, seed);
            for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
                largest =
                    std::max(largest, 255 * std::abs(double{picture.rgba[i]} - expected.rgba[i]));
            }
        }
        if (ranks.leads()) std::printf("%g\n", largest);
    }
    MPI_Finalize();
    return 0;
}
