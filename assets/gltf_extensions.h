#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace simwright::assets {

// Throws core::Error, naming the extension and a remedy, if a glTF requires an extension without
// which its geometry cannot be read. Extensions that affect only appearance do not cause an error.
void RequireReadableExtensions(const nlohmann::json& root, const std::string& where);

// Returns the names of the extensions that the file uses and the reader ignores.
std::vector<std::string> UnreadExtensions(const nlohmann::json& root);

}  // namespace simwright::assets
