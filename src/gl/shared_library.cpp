// SPDX-License-Identifier: Apache-2.0
#include "gl/shared_library.h"

#include <dlfcn.h>

#include "base/error.h"

namespace lamina::gl {

SharedLibrary::SharedLibrary(std::initializer_list<const char*> names) {
    std::string reasons;
    for (const char* name : names) {
        handle_ = dlopen(name, RTLD_NOW | RTLD_LOCAL);
        if (handle_) {
            name_ = name;
            return;
        }
        const char* reason = dlerror();  // begins with the library's name
        reasons += (reasons.empty() ? "" : "; ") + std::string(reason ? reason : name);
    }
    fail("{}", one_line(reasons));
}

bool SharedLibrary::is_loaded(const char* name) {
    void* const handle = dlopen(name, RTLD_NOW | RTLD_NOLOAD);
    if (handle != nullptr) dlclose(handle);
    return handle != nullptr;
}

void* SharedLibrary::symbol(const char* name) const {
    void* address = dlsym(handle_, name);
    if (!address) fail("{} has no function {}", name_, name);
    return address;
}

}  // namespace lamina::gl
