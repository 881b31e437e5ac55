/* SPDX-License-Identifier: Apache-2.0
 * bin/NAME of the portable tarball: starts libexec/NAME. The dynamic linker finds the libraries by that program's own place
 * ($ORIGIN), which it asks /proc for; where no /proc is mounted, as in a bare chroot, it takes LD_ORIGIN_PATH instead.
 * Linked statically: it must run before any library is found. */
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/auxv.h>
#include <unistd.h>

int main(int argc, char** argv) {
    (void)argc;
    char self[PATH_MAX], folder[PATH_MAX + 16], program[2 * PATH_MAX];
    const char* const started = (const char*)getauxval(AT_EXECFN);
    if (!started || !realpath(started, self)) {
        fprintf(stderr, "%s: cannot find its own place: %s\n", argv[0], strerror(errno));
        return 1;
    }
    char* const name = strrchr(self, '/');
    *name = 0;
    char* const above = strrchr(self, '/');
    if (above) *above = 0;
    snprintf(folder, sizeof folder, "%s/libexec", self);
    snprintf(program, sizeof program, "%s/%s", folder, name + 1);
    setenv("LD_ORIGIN_PATH", folder, 1);
    execv(program, argv);
    fprintf(stderr, "%s: cannot start %s: %s\n", argv[0], program, strerror(errno));
    return 1;
}
