#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "reward/fault.h"
#include "reward/reward_options.h"

namespace simwright::reward {

enum class TokenKind {
  kName,  // includes keywords
  kInteger,
  kFloat,
  kString,
  kFormatString,  // text as written between the quotes
  kOperator,
  kNewline,
  kIndent,
  kDedent,
  kEnd,
};

struct Token {
  TokenKind kind = TokenKind::kEnd;
  std::string text;  // contents of a string with escapes resolved
  Position position;
  std::int64_t integer = 0;
  double number = 0.0;
};

// Splits a source into tokens; the last one is kEnd. Throws Fault on an invalid token, on bad
// indentation, and beyond the bounds of `options`.
std::vector<Token> Tokenise(std::string_view source, const RewardOptions& options);

// Tokenises one expression of a format string, which begins at `start`.
std::vector<Token> TokeniseExpression(std::string_view source, Position start,
                                      const RewardOptions& options);

}  // namespace simwright::reward
