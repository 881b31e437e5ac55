// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hdf5.h>

#include <string>

namespace lamina {

// Lets libhdf5 read LZF, h5py's own compression, unless it can already: h5py in this process
// registers a filter that writes, too.
void add_lzf_filter();

// Returns the name of a filter that libhdf5 lacks; empty if it is not known.
std::string filter_name(H5Z_filter_t filter);

}  // namespace lamina
