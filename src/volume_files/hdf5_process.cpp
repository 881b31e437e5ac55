// SPDX-License-Identifier: Apache-2.0
#include "volume_files/hdf5_process.h"

#include <algorithm>
#include <cstring>

namespace lamina {
namespace {

struct Question {
    SampleBox box;
    bool is_all;
};

std::size_t bytes_in(const SampleBox& box, ValueType type) {
    return static_cast<std::size_t>(box.count()) * bytes_of(type);
}

}  // namespace

Hdf5Process::Hdf5Process(const Hdf5Place& place)
    : process_(place.file, "libhdf5", [&](IsolatedLine& line) { serve(line, place); }) {
    process_.receive(&head_, sizeof head_);
}

void Hdf5Process::serve(IsolatedLine& line, const Hdf5Place& place) {
    const Hdf5Volume volume(place.file, place.array, place.request);
    line.answer(&volume.head(), sizeof(Hdf5Head));
    Shared shared;
    for (Question question; line.next(&question, sizeof question);) {
        const std::size_t bytes = bytes_in(question.box, volume.head().type);
        line.allow_bytes(std::max(bytes, volume.chunk_bytes()));
        volume.read(question.box, question.is_all, shared.room(bytes, line));
        line.answer(nullptr, 0);
    }
}

void* Hdf5Process::read_shared(const SampleBox& box, bool is_all) {
    void* const samples = shared_.room(bytes_in(box, head_.type), process_);
    const Question question{box, is_all};
    process_.ask(&question, sizeof question);
    process_.receive(nullptr, 0);
    return samples;
}

std::shared_ptr<void> Hdf5Process::read_all() {
    read_shared({{0, 0, 0}, head_.grid.size}, true);
    return shared_.memory;
}

void Hdf5Process::read(const SampleBox& box, void* to) {
    std::memcpy(to, read_shared(box, false), bytes_in(box, head_.type));
}

}  // namespace lamina
