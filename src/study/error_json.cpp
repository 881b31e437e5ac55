// SPDX-License-Identifier: Apache-2.0
#include "study/error_json.h"

namespace lamina::study {

nlohmann::ordered_json to_json(const ErrorNorms& norms) {
    return {{"linf", norms.linf}, {"l1", norms.mean}, {"l2", norms.l2}};
}

nlohmann::ordered_json to_json(const ImageError& error) {
    nlohmann::ordered_json channels;
    for (std::size_t i = 0; i < error.channels.size(); ++i)
        channels[error.channels[i]] = to_json(error.of_channel[i]);
    return {{"channels", channels}, {"all", to_json(error.all)}};
}

}  // namespace lamina::study
