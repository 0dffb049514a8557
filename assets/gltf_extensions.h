#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace simwright::assets {

// Throws core::Error, naming the extension and what to do, where a glTF requires one without which
// its geometry cannot be read. Extensions of looks alone are no reason to refuse a file.
void RequireReadableExtensions(const nlohmann::json& root, const std::string& where);

// Extensions that the file uses and that are not read, by name.
std::vector<std::string> UnreadExtensions(const nlohmann::json& root);

}  // namespace simwright::assets
