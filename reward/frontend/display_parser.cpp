// The parser of strings, tuples, lists, dictionaries and comprehensions.
#include <algorithm>

#include "reward/frontend/parser.h"

namespace simwright::reward {

ExpressionPtr ExpressionParser::ParseStrings() {
  ExpressionPtr joined = Make(ExpressionKind::kFormatString, Peek().position);
  while (AtKind(TokenKind::kString) || AtKind(TokenKind::kFormatString)) {
    const Token token = Take();
    if (token.kind == TokenKind::kFormatString) {
      Add(joined.get(), ParseFormatString(token));
    } else {
      ExpressionPtr part = Make(ExpressionKind::kString, token.position);
      part->text = token.text;
      Add(joined.get(), std::move(part));
    }
  }
  if (joined->children.size() == 1) return std::move(joined->children[0]);
  return joined;
}

// Parses {expression!r:format}; text in brackets or quotes belongs to the expression.
ExpressionPtr ExpressionParser::ParseReplacement(const Token& token, std::size_t* at) {
  const std::string& text = token.text;
  const std::size_t begin = *at;
  int open = 0;
  char quote = '\0';
  for (; *at < text.size(); ++*at) {
    const char c = text[*at];
    const bool unequal = c == '!' && *at + 1 < text.size() && text[*at + 1] == '=';
    if (quote == '\0' && open == 0 && (c == '}' || c == ':' || (c == '!' && !unequal))) break;
    if (quote != '\0') {
      if (c == quote) quote = '\0';
    } else if (c == '\'' || c == '"') {
      quote = c;
    } else if (c == '[' || c == '(' || c == '{') {
      ++open;
    } else if (c == ']' || c == ')' || c == '}') {
      --open;
    }
  }
  const std::string inside = text.substr(begin, *at - begin);
  ExpressionPtr formatted = Make(ExpressionKind::kFormatted, token.position);
  if (*at + 1 < text.size() && text[*at] == '!') {
    formatted->integer = text[*at + 1];
    *at += 2;
  }
  if (*at < text.size() && text[*at] == ':') {
    const std::size_t end = std::min(text.find('}', *at), text.size());
    formatted->text = text.substr(*at + 1, end - *at - 1);
    *at = end;
    if (formatted->text.find('{') != std::string::npos) {
      Fail("bad-string", token.position,
           "a format that holds a '{' itself is not part of the language; write it out");
    }
  }
  if (*at >= text.size() || text[*at] != '}') {
    Fail("bad-string", token.position, "a '{' of this string is not closed");
  }
  ++*at;
  const RecursionGuard nesting(this);
  RewardOptions inner = options_;
  inner.max_depth = std::max(1, options_.max_depth - nesting_);
  ExpressionParser parser(TokeniseExpression(inside, token.position, inner), inner);
  Add(formatted.get(), parser.Only());
  return formatted;
}

ExpressionPtr ExpressionParser::ParseFormatString(const Token& token) {
  ExpressionPtr joined = Make(ExpressionKind::kFormatString, token.position);
  std::string literal;
  const auto flush = [&] {
    if (literal.empty()) return;
    ExpressionPtr part = Make(ExpressionKind::kString, token.position);
    part->text = std::move(literal);
    literal.clear();
    Add(joined.get(), std::move(part));
  };
  for (std::size_t at = 0; at < token.text.size();) {
    const char c = token.text[at++];
    const bool doubled = at < token.text.size() && token.text[at] == c;
    if ((c == '{' || c == '}') && doubled) {
      literal += c;
      ++at;
    } else if (c == '{') {
      flush();
      Add(joined.get(), ParseReplacement(token, &at));
    } else {
      literal += c;
    }
  }
  flush();
  return joined;
}

ExpressionPtr ExpressionParser::ParseParenthesised() {
  const Position start = Take().position;
  if (Accept(")")) return Make(ExpressionKind::kTuple, start);
  ExpressionPtr inside = ParseExpressionList();
  if (At("for")) {
    inside = ParseComprehension(ExpressionKind::kListComprehension, std::move(inside), nullptr);
  }
  Expect(")", "to close the '('");
  return inside;
}

ExpressionPtr ExpressionParser::ParseListDisplay() {
  ExpressionPtr list = Make(ExpressionKind::kList, Take().position);
  while (!At("]")) {
    ExpressionPtr item = ParseItem();
    if (At("for") && list->children.empty()) {
      list = ParseComprehension(ExpressionKind::kListComprehension, std::move(item), nullptr);
      break;
    }
    Add(list.get(), std::move(item));
    if (!Accept(",")) break;
  }
  Expect("]", "to close the '['");
  return list;
}

ExpressionPtr ExpressionParser::ParseDictDisplay() {
  ExpressionPtr dict = Make(ExpressionKind::kDict, Take().position);
  while (!At("}")) {
    if (Accept("**")) {
      Add(dict.get(), nullptr);
      Add(dict.get(), ParseBinary(0));
      if (!Accept(",")) break;
      continue;
    }
    ExpressionPtr key = ParseExpression();
    Expect(":", "after the key (sets are not part of the language)");
    ExpressionPtr value = ParseExpression();
    if (At("for") && dict->children.empty()) {
      dict =
          ParseComprehension(ExpressionKind::kDictComprehension, std::move(key), std::move(value));
      break;
    }
    Add(dict.get(), std::move(key));
    Add(dict.get(), std::move(value));
    if (!Accept(",")) break;
  }
  Expect("}", "to close the '{'");
  return dict;
}

ExpressionPtr ExpressionParser::ParseComprehension(ExpressionKind kind, ExpressionPtr element,
                                                   ExpressionPtr value) {
  ExpressionPtr comprehension = Make(kind, Take().position);
  Add(comprehension.get(), std::move(element));
  Add(comprehension.get(), ParseTarget());
  Expect("in", "after the loop's name");
  Add(comprehension.get(), ParseBoolean(Operator::kBooleanOr, "or"));
  ExpressionPtr condition;
  if (Accept("if")) condition = ParseBoolean(Operator::kBooleanOr, "or");
  if (At("for") || At("if")) {
    Fail("syntax", Peek().position, "one 'for' and one 'if' are read in a comprehension");
  }
  Add(comprehension.get(), std::move(condition));
  Add(comprehension.get(), std::move(value));
  return comprehension;
}

}  // namespace simwright::reward
