#pragma once

#include <string>
#include <vector>

#include "core/json.h"

namespace simwright::assets {

// Throws core::Error, naming the extension and a remedy, if a glTF requires an extension without
// which its geometry cannot be read. Extensions that affect only appearance do not cause an error.
void RequireReadableExtensions(const core::Json& root, const std::string& where);

// Returns the names of the extensions that the file uses and the reader ignores.
std::vector<std::string> UnreadExtensions(const core::Json& root);

}  // namespace simwright::assets
