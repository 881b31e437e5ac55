// SPDX-License-Identifier: Apache-2.0
#include "selftest/one_gradient_light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace lamina::selftest {

OneGradientLight::OneGradientLight(const Lighting& lighting, const LayeredBox& box,
                                   const View::Ray& ray) {
    const glm::dvec3& edge = box.edges[2];
    const double slope = (box.samples.at(1) - box.samples.at(0)) *
                         static_cast<double>(box.layers()) / glm::length(edge);
    const double ratio = *lighting.smallest_gradient / std::abs(slope);
    const double weight = 1 / (1 + ratio * ratio);
    const glm::dvec3 along = glm::normalize(edge), to_eye = -glm::normalize(ray.direction);
    glm::dvec3 light(lighting.ambient);
    terms_ = 1 + lighting.ambient;
    for (const Light& each : lighting.lights) {
        const glm::dvec3 to_light = each.direction ? glm::normalize(*each.direction) : to_eye;
        const glm::dvec3 sum = to_light + to_eye;
        const double size = glm::length(sum);
        const double shine = size > 1e-6 ? std::abs(glm::dot(along, sum)) / size : 0;
        light += lighting.diffuse * std::abs(glm::dot(along, to_light)) * each.color;
        highlight_ += weight * lighting.specular * std::pow(shine, lighting.power) * each.color;
        terms_ += (lighting.diffuse + lighting.power * lighting.specular) *
                  std::max({each.color.x, each.color.y, each.color.z});
    }
    factor_ = 1 - weight + weight * light;
}

void OneGradientLight::shine_on(std::array<double, 4>& pixel) const {
    for (int c = 0; c < 3; ++c) {
        double& channel = pixel[static_cast<std::size_t>(c)];
        channel = factor_[c] * channel + highlight_[c] * pixel[3];
    }
}

void OneGradientLight::shine_on(PixelBounds& pixel, double error) const {
    const double off = error * terms_;
    for (int c = 0; c < 3; ++c) {
        Interval& channel = pixel[static_cast<std::size_t>(c)];
        channel = {std::max(factor_[c] - off, 0.0) * channel.lo +
                       std::max(highlight_[c] - off, 0.0) * pixel[3].lo,
                   (factor_[c] + off) * channel.hi + (highlight_[c] + off) * pixel[3].hi};
    }
}

}  // namespace lamina::selftest
