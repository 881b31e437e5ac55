// SPDX-License-Identifier: Apache-2.0
#include "volume_files/isolated_read.h"

namespace lamina {
namespace {

// Of fixed size, between processes of one program.
struct ReadHead {
    Grid grid;
    ValueType type;
    double scale, offset;
};

}  // namespace

ReadSamples read_isolated(const std::string& name, const char* library,
                          const std::function<ReadSamples(IsolatedLine&)>& read) {
    IsolatedProcess process(name, library, [&](IsolatedLine& line) {
        const ReadSamples found = read(line);
        const ReadHead head{found.grid, found.samples.type, found.samples.scale,
                            found.samples.offset};
        line.answer(&head, sizeof head);
    });
    ReadHead head;
    process.receive(&head, sizeof head);
    const std::size_t bytes =
        static_cast<std::size_t>(head.grid.sample_count()) * bytes_of(head.type);
    return {head.grid, {name, head.type, process.shared_memory(bytes), head.scale, head.offset}};
}

}  // namespace lamina
