// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "study/reference_store.h"
#include "study/study_folder.h"

namespace lamina::study {

// Copies the journals, references and pictures of shards of one study into a folder. Throws Error
// where they belong to different studies or drew different data, where two of them are the same
// shard, or where the folder holds another study. `say`: gets messages about damaged references.
void merge_studies(const std::vector<std::filesystem::path>& from, const StudyFolder& into,
                   const ReferenceStore::Say& say);

}  // namespace lamina::study
