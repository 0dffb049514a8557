#pragma once

#include <filesystem>
#include <string>

namespace simwright::workflows {

// Returns the path of the shipped weights of a scene type's model. Throws core::Error if there are
// none.
std::filesystem::path ShippedSceneWeights(const std::string& type);

// Returns the path of the shipped weights of the model of all scene types, which reads prompts. It
// has to be loaded with a type. Throws core::Error if it is missing.
std::filesystem::path ShippedTextWeights();

// Returns the shipped weights of the type's own model or, if there are none and the model of all
// types knows it, of that one. Throws core::Error if neither does.
std::filesystem::path ShippedWeightsForType(const std::string& type);

}  // namespace simwright::workflows
