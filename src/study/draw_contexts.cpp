// SPDX-License-Identifier: Apache-2.0
#include "study/draw_contexts.h"

namespace lamina::study {

const Capabilities& DrawContexts::use(const std::string& word) {
    const auto found = contexts_.find(word);
    if (found != contexts_.end()) return found->second.capabilities();
    const Auto<ContextChoice> choice = context_choice(word);
    if (choice != ContextChoice::cpu) {
        before_switch_();
        current_.reset();
        std::erase_if(contexts_,
                      [](const auto& context) { return !context.second.capabilities().tiles; });
    }
    const DrawContext& context = contexts_.try_emplace(word, choice).first->second;
    if (!context.capabilities().tiles) current_ = context.make_current();
    return context.capabilities();
}

}  // namespace lamina::study
