#pragma once

#include <filesystem>
#include <string>

namespace simwright::workflows {

// Returns the path of the shipped weights of a scene type's model. Throws core::Error if there are
// none.
std::filesystem::path ShippedSceneWeights(const std::string& type);

}  // namespace simwright::workflows
