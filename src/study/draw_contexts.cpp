// SPDX-License-Identifier: Apache-2.0
#include "study/draw_contexts.h"

namespace lamina::study {

const Capabilities& DrawContexts::use(const std::string& word) {
    const auto found = contexts_.find(word);
    if (found != contexts_.end()) return found->second.capabilities();
    const ContextChoice choice = context_choice(word);
    if (choice != ContextChoice::cpu) {
        before_switch_();
        std::erase_if(contexts_,
                      [](const auto& context) { return !context.second.capabilities().tiles; });
    }
    return contexts_.try_emplace(word, choice).first->second.capabilities();
}

}  // namespace lamina::study
