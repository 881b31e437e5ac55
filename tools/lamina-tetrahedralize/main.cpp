// SPDX-License-Identifier: Apache-2.0
// Computes the Delaunay tetrahedra of points with TetGen. This is a separate program for two
// reasons: TetGen's licence (AGPL) covers this program only, and TetGen may print, throw numbers or
// end the process without harm to the program that started it.
#include <signal.h>
#include <sys/prctl.h>
#include <tetgen.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "base/large_stack.h"
#include "meshing/tetrahedralize_protocol.h"

namespace {

using namespace lamina;

constexpr const char* help =
    "lamina-tetrahedralize: the Delaunay tetrahedralisation of points, by TetGen.\n"
    "\n"
    "Usage: lamina-tetrahedralize < POINTS > TETS\n"
    "\n"
    "  POINTS  int64 count, then count * 3 doubles; native byte order\n"
    "  TETS    int64 count, then count * 4 int32 corners (from 0, det(b-a, c-a, d-a) > 0), then\n"
    "          count * 4 int32 neighbours (opposite each corner, -1: none)\n"
    "\n"
    "`lamina mesh` starts it; nobody needs to run it by hand. This program, and no other of\n"
    "lamina, is linked with TetGen (https://www.tetgen.org, Hang Si, WIAS Berlin), and is\n"
    "therefore under the GNU Affero General Public License, version 3 or later. The source of\n"
    "lamina itself is under the Apache License 2.0.\n";

constexpr const char* version =
    "lamina-tetrahedralize " LAMINA_VERSION " (with TetGen 1.5; AGPL-3.0-or-later)\n";

std::vector<char> read_all(std::FILE* stream) {
    std::vector<char> bytes;
    std::vector<char> block(std::size_t{1} << 20);
    while (const std::size_t count = std::fread(block.data(), 1, block.size(), stream)) {
        bytes.insert(bytes.end(), block.data(), block.data() + count);
    }
    if (std::ferror(stream)) throw std::runtime_error("cannot read stdin");
    return bytes;
}

// Throws if x, y or z is equal for all points: TetGen would fail an assertion.
void check_extent(const REAL* points, std::size_t count) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        bool differ = false;
        for (std::size_t i = 1; i < count && !differ; ++i) {
            differ = points[3 * i + axis] != points[axis];
        }
        if (!differ) throw std::runtime_error("all points lie in one plane");
    }
}

// Reads the points from stdin into an array that tetgenio owns.
void read_points(tetgenio& io) {
    const std::vector<char> bytes = read_all(stdin);
    TetrahedralizeCount count = 0;
    if (bytes.size() < sizeof count) throw std::runtime_error("stdin: no count of points");
    std::memcpy(&count, bytes.data(), sizeof count);
    const std::size_t points = (bytes.size() - sizeof count) / sizeof(TetrahedralizePoint);
    if (count < 0 || static_cast<std::size_t>(count) != points ||
        bytes.size() != sizeof count + points * sizeof(TetrahedralizePoint)) {
        throw std::runtime_error("stdin: " + std::to_string(bytes.size()) + " bytes are not " +
                                 std::to_string(count) + " points");
    }
    if (count < 4 || count > std::numeric_limits<int>::max() / 16) {
        throw std::runtime_error(std::to_string(count) + " points: expected 4 to " +
                                 std::to_string(std::numeric_limits<int>::max() / 16));
    }
    io.numberofpoints = static_cast<int>(count);
    io.pointlist = new REAL[3 * points];
    std::memcpy(io.pointlist, bytes.data() + sizeof count, points * sizeof(TetrahedralizePoint));
    for (std::size_t i = 0; i < 3 * points; ++i) {
        if (!std::isfinite(io.pointlist[i])) {
            throw std::runtime_error("point " + std::to_string(i / 3) + " is no finite number");
        }
    }
    check_extent(io.pointlist, points);
}

// Returns the meaning of a number that TetGen's terminatetetgen() throws.
const char* meaning_of(int failure) {
    switch (failure) {
        case 1:
            return "out of memory";
        case 2:
            return "internal error";
        case 3:
            return "the input intersects itself";
        case 4:
            return "the input has a very small feature";
        case 5:
            return "two facets are very close to each other";
        case 10:
            return "input error (are all points in one plane?)";
        default:
            return "unknown failure";
    }
}

void tetrahedralize(tetgenio& in, tetgenio& out) {
    // Q: quiet; n: list neighbours; J: keep point indices; N, F: list no points and no faces.
    std::string switches = "QnJNF";
    try {
        ::tetrahedralize(switches.data(), &in, &out);
    } catch (int failure) {
        throw std::runtime_error("TetGen: " + std::string(meaning_of(failure)) + " (" +
                                 std::to_string(failure) + ")");
    }
    if (out.numberoftetrahedra <= 0 || !out.tetrahedronlist || !out.neighborlist) {
        throw std::runtime_error("TetGen found no tetrahedra (are all points in one plane?)");
    }
}

// Thrown if the answer cannot be written.
class NoRoom : public std::runtime_error {
  public:
    NoRoom() : std::runtime_error("cannot write to stdout: " + std::string(std::strerror(errno))) {}
};

void write_all(std::FILE* stream, const void* bytes, std::size_t count) {
    if (std::fwrite(bytes, 1, count, stream) != count) throw NoRoom();
}

// Writes tets and neighbours. TetGen's order of corners is lamina's: det(b - a, c - a, d - a) > 0.
void write_tets(std::FILE* stream, const tetgenio& io) {
    const auto count = static_cast<std::size_t>(io.numberoftetrahedra);
    const TetrahedralizeCount header = io.numberoftetrahedra;
    static_assert(sizeof(int) == sizeof(std::int32_t));
    write_all(stream, &header, sizeof header);
    write_all(stream, io.tetrahedronlist, count * sizeof(TetrahedralizeTet));
    write_all(stream, io.neighborlist, count * sizeof(TetrahedralizeTet));
    if (std::fflush(stream) != 0) throw NoRoom();
}

// Returns a stream for the answer. Text that TetGen prints on stdout goes to stderr from now on.
std::FILE* take_stdout() {
    std::fflush(stdout);
    const int answer = dup(STDOUT_FILENO);
    std::FILE* const stream = answer < 0 ? nullptr : fdopen(answer, "wb");
    if (!stream || dup2(STDERR_FILENO, STDOUT_FILENO) < 0) {
        throw std::runtime_error("cannot use stdout");
    }
    return stream;
}

// Signal handler for crashes: near its limits TetGen may fail an assertion or access invalid
// memory. Prints one line and exits with code 1; makes only async-signal-safe calls.
extern "C" void report_crash(int) {
    constexpr char message[] =
        "lamina-tetrahedralize: TetGen broke down (are all points nearly in one plane, or "
        "coordinates extreme?)\n";
    if (write(STDERR_FILENO, message, sizeof message - 1) < 0) _exit(1);
    _exit(1);
}

void catch_crashes() {
    static std::array<char, 1 << 16> stack;  // the crash may be a stack overflow
    stack_t place{};
    place.ss_sp = stack.data();
    place.ss_size = stack.size();
    sigaltstack(&place, nullptr);
    struct sigaction action {};
    action.sa_handler = report_crash;
    action.sa_flags = SA_ONSTACK;
    for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGABRT}) sigaction(signal, &action, nullptr);
}

// Lets the kernel end this process when the parent ends. Returns false if the parent has ended.
bool end_with_parent(const char* parent) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    return std::to_string(getppid()) == parent;
}

int fail(const char* message, int exit_code = 1) {
    std::fflush(stdout);
    std::fprintf(stderr, "lamina-tetrahedralize: %s\n", message);
    return exit_code;
}

// Reads the points, writes the answer and returns the exit code. Does not throw.
int answer_question() {
    catch_crashes();
    try {
        std::FILE* const answer = take_stdout();
        tetgenio in, out;
        read_points(in);
        tetrahedralize(in, out);
        write_tets(answer, out);
    } catch (const std::bad_alloc&) {
        return fail("out of memory");
    } catch (const NoRoom& error) {
        return fail(error.what(), tetrahedralize_no_room);
    } catch (const std::exception& error) {
        return fail(error.what());
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc == 3 && std::string(argv[1]) == tetrahedralize_parent_option) {
        if (!end_with_parent(argv[2])) return fail("the program that started this has ended");
    } else if (argc > 1) {
        const std::string option = argv[1];
        const bool known = argc == 2 && (option == "--help" || option == "--version");
        if (!known) {
            std::fprintf(stderr, "lamina-tetrahedralize: %s: unexpected argument (--help)\n",
                         argv[argc - 1]);
            return 2;
        }
        std::fputs(option == "--help" ? help : version, stdout);
        return std::fflush(stdout) == 0 ? 0 : 1;
    }
    try {
        return with_large_stack(answer_question);
    } catch (const std::system_error& error) {
        return fail(error.what());
    }
}
