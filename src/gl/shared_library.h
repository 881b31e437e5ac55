// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>

namespace lamina::gl {

// A library loaded at run time. It is never unloaded, because Mesa and LLVM leave threads and exit
// handlers behind.
class SharedLibrary {
  public:
    // Loads the first of `names` that the dynamic linker finds. Throws Error, which says why each
    // could not be loaded.
    explicit SharedLibrary(std::initializer_list<const char*> names);

    // The function `name`. Throws Error, which names the library, where it has no such function.
    template <typename Function>
    Function function(const char* name) const {
        return reinterpret_cast<Function>(symbol(name));
    }

  private:
    void* symbol(const char* name) const;

    std::string name_;
    void* handle_ = nullptr;
};

}  // namespace lamina::gl
