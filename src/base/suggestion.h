// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>

namespace lamina {

// The end of a message about a word that is none of the known ones: ", did you mean "..."?" where
// one of them is near, else ", expected one of ...". Empty where there are none.
std::string suggestion(const std::set<std::string>& words, const std::string& word);

}  // namespace lamina
