// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "study/study_folder.h"

namespace lamina {

// Copies the journals, references and pictures of shards of one study into a folder. Throws Error
// where they are of different studies, two of them are the same shard, or the folder holds another
// study.
void merge_studies(const std::vector<std::filesystem::path>& from, const StudyFolder& into);

}  // namespace lamina
