#pragma once

#include <filesystem>

namespace simwright::pipeline {

// The folder of the shipped weights: $SIMWRIGHT_MODELS where it is set, else beside the program
// (../share/simwright/models of an installation, ../../models of a build); empty where none is.
std::filesystem::path ModelsFolder();

}  // namespace simwright::pipeline
