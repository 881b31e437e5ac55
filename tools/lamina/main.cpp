// SPDX-License-Identifier: Apache-2.0
#include "program.h"
#include "verbs.h"

int main(int argc, char** argv) {
    return lamina::run_command_line(
        {"lamina", "lamina: volume rendering by slicing, with the error of each picture",
         "A first picture: lamina example head && lamina render head.nrrd -o head.png\n"
         "What a verb takes: lamina VERB --help",
         lamina::add_verbs},
        argc, argv);
}
