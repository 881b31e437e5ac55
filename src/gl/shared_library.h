// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>

namespace lamina::gl {

// A library that is loaded at run time. It is never unloaded, because Mesa and LLVM leave threads
// and exit handlers behind.
class SharedLibrary {
  public:
    // Loads the first of `names` that the dynamic linker finds. Throws Error, which says why each
    // could not be loaded.
    explicit SharedLibrary(std::initializer_list<const char*> names);

    // Tells whether this process has loaded the library already.
    static bool is_loaded(const char* name);

    // Returns the function `name`. Throws Error, which names the library, if it has none.
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
