#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace simwright::llm {

// Replaces every secret in `text` by "[redacted]": the whole secret, and any run of 12 or more of
// its characters, since servers quote keys in part.
std::string Redact(std::string_view text, const std::vector<std::string>& secrets);

// Returns the first `limit` bytes of `text` on one line, cut between UTF-8 characters, with "..."
// if truncated. Call it after Redact, so that no half of a key stays.
std::string Shortened(std::string_view text, std::size_t limit);

}  // namespace simwright::llm
