#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace simwright::llm {

// `text` with every secret replaced by "[redacted]": the whole of it, and any run of 12 or more of
// its characters, since servers quote keys in part.
std::string Redact(std::string_view text, const std::vector<std::string>& secrets);

// The first `limit` bytes of `text` on one line, cut between UTF-8 characters, with "..." where
// something is left out. To be called after Redact, so that no half of a key stays.
std::string Shortened(std::string_view text, std::size_t limit);

}  // namespace simwright::llm
