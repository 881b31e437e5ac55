// SPDX-License-Identifier: Apache-2.0
#include "gl/program_cache.h"

#include <algorithm>

namespace lamina::gl {

ProgramCache::~ProgramCache() {
    for (const auto& program : programs_) program->abandon();
}

std::shared_ptr<LinkedProgram> ProgramCache::get(const ShaderSource& vertex,
                                                 const ShaderSource& fragment) {
    const auto found = std::ranges::find_if(
        programs_, [&](const auto& program) { return program->is_of(vertex, fragment); });
    if (found != programs_.end()) {
        programs_.splice(programs_.begin(), programs_, found);
        return programs_.front();
    }
    programs_.push_front(std::make_shared<LinkedProgram>(vertex, fragment));
    ++compiled_;
    if (programs_.size() > most_programs) programs_.pop_back();
    return programs_.front();
}

}  // namespace lamina::gl
