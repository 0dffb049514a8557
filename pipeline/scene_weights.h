#pragma once

#include <filesystem>
#include <string>

namespace simwright::pipeline {

// The shipped weights of a scene type's model. Throws core::Error where there are none.
std::filesystem::path ShippedSceneWeights(const std::string& type);

}  // namespace simwright::pipeline
