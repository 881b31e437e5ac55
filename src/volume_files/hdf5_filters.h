// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace lamina {

// Lets libhdf5 read LZF, h5py's own compression, unless it can already: h5py in this process
// registers a filter that writes, too.
void add_lzf_filter();

// Returns the number of bytes that a filter's values promise of each chunk if the filter is LZF,
// else nothing. Values that are missing promise 0.
std::optional<std::size_t> lzf_chunk_bytes(H5Z_filter_t filter, std::span<const unsigned> values);

// Returns the name of a filter that libhdf5 lacks; empty if it is not known.
std::string filter_name(H5Z_filter_t filter);

}  // namespace lamina
