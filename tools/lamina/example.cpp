// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/client.h"
#include "base/error.h"
#include "base/output_file.h"
#include "base/process.h"
#include "mesh/flow_example.h"
#include "mesh_files/mesh_file.h"
#include "verbs.h"
#include "volume/examples.h"
#include "volume/nrrd_writer.h"

namespace lamina {
namespace {

struct ExampleOptions {
    std::string name, output;
    bool quiet = false;
};

struct Example {
    const char* name;
    const char* file;    // to which it is written if no name is given
    const char* suffix;  // of any name for it
    const char* sentence;
    void (*write)(AtomicFile& file);
};

void write_head(AtomicFile& file) {
    write_nrrd(file, head_ct());
}

void write_labels(AtomicFile& file) {
    write_nrrd(file, head_labels());
}

void write_jet(AtomicFile& file) {
    write_nrrd_header(file, jet_grid(), SampleType::uint8, {jet_times, jet_time_step, "s"});
    const std::vector<std::uint8_t> samples = jet_samples();
    file.write(samples.data(), samples.size());
}

const Example examples[] = {
    {"head", "head.nrrd", ".nrrd", "A head in a CT, in Hounsfield units and a patient's axes",
     write_head},
    {"labels", "labels.seg.nrrd", ".nrrd", "The tissues of that head, as labels with names",
     write_labels},
    {"jet", "jet.nrrd", ".nrrd", "A turbulent jet that rises from a nozzle, at ten times",
     write_jet},
    {"flow", "flow.vtu", ".vtu", "The flow past a cylinder, on a mesh of tetrahedra",
     [](AtomicFile& file) { write_vtu(file, flow_mesh()); }},
    {"cells", "cells.nrrd", ".nrrd", "A ball of cells in a fluorescence microscope",
     [](AtomicFile& file) { write_nrrd(file, cells_volume()); }}};

std::string example_names() {
    std::string names;
    for (const Example& example : examples)
        names += (names.empty() ? "" : ", ") + std::string(example.name);
    return names;
}

void list_examples() {
    for (const Example& example : examples)
        print_result("{:8}{} ({})\n", example.name, example.sentence, example.file);
}

const Example& example_of(const std::string& name) {
    for (const Example& example : examples)
        if (name == example.name) return example;
    throw UsageError(fmt::format("NAME: found '{}', expected one of {}", name, example_names()));
}

void run_example(const ExampleOptions& options) {
    if (options.name.empty()) {
        if (!options.output.empty())
            throw UsageError(fmt::format("-o {}: expected a NAME before it, one of {}",
                                         options.output, example_names()));
        return list_examples();
    }
    Progress::set_quiet(options.quiet);
    const Example& example = example_of(options.name);
    const std::filesystem::path path = options.output.empty() ? example.file : options.output;
    if (path.extension() != example.suffix)
        throw UsageError(
            fmt::format("-o {}: expected a name that ends in {}", path.string(), example.suffix));
    AtomicFile file(path);
    example.write(file);
    file.commit();
    if (!options.quiet) print_message("lamina: wrote {}\n", path.string());
}

}  // namespace

void add_example(CLI::App& app, int& exit_code) {
    (void)exit_code;
    auto* const verb =
        app.add_subcommand("example", "Write generated data to try lamina with, or list them");
    const auto options = std::make_shared<ExampleOptions>();
    verb->add_option("NAME", options->name,
                     fmt::format("One of {}; without it, they are listed", example_names()));
    verb->add_option("-o,--output", options->output,
                     "File to write (.nrrd, flow: .vtu; NAME's own, in this folder)")
        ->type_name("FILE");
    verb->add_flag("--quiet", options->quiet, "No progress and no messages");
    verb->callback([options] { run_example(*options); });
}

}  // namespace lamina
