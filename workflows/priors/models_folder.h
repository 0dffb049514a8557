#pragma once

#include <filesystem>

namespace simwright::workflows {

// Returns the folder of the shipped weights: $SIMWRIGHT_MODELS if it is set, else the one beside
// the program (../share/simwright/models of an installation, ../../models of a build); empty if
// there is none.
std::filesystem::path ModelsFolder();

}  // namespace simwright::workflows
