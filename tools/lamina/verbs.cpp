// SPDX-License-Identifier: Apache-2.0
#include "verbs.h"

namespace lamina {

void add_verbs(CLI::App& app, int& exit_code) {
    add_render(app, exit_code);
    add_view(app, exit_code);
    add_scene(app, exit_code);
    add_compare(app, exit_code);
    add_mesh(app, exit_code);
    add_generate(app, exit_code);
    add_info(app, exit_code);
    add_index(app, exit_code);
    add_integrate(app, exit_code);
    add_order(app, exit_code);
    add_reproduce(app, exit_code);
    add_study(app, exit_code);
    add_crosscheck(app, exit_code);
    add_selftest(app, exit_code);
    add_completion(app, exit_code);
    add_man(app, exit_code);
}

}  // namespace lamina
