// Strings, tuples, lists, dictionaries and comprehensions.
#include <algorithm>

#include "tasks/reward/parser.h"

namespace simwright::tasks::reward {

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

ExpressionPtr ExpressionParser::ParseReplacement(const Token& token, std::size_t* at) {
  const std::string& text = token.text;
  const std::size_t begin = *at;
  int open = 0;
  while (*at < text.size() && (open > 0 || (text[*at] != '}' && text[*at] != ':'))) {
    if (text[*at] == '[' || text[*at] == '(' || text[*at] == '{') ++open;
    if (text[*at] == ']' || text[*at] == ')' || text[*at] == '}') --open;
    ++*at;
  }
  if (*at >= text.size()) Fail("bad-string", token.position, "a '{' of this string is not closed");
  if (text[*at] == ':') {
    Fail("bad-string", token.position,
         "formats after ':' are not part of the language; write {name} alone");
  }
  const Nesting nesting(this);
  RewardOptions inner = options_;
  inner.max_depth = std::max(1, options_.max_depth - nesting_);
  ExpressionParser parser(
      TokeniseExpression(text.substr(begin, *at - begin), token.position, inner), inner);
  ++*at;
  return parser.Only();
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
    ExpressionPtr item = ParseExpression();
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
    if (At("**")) {
      Fail("syntax", Peek().position, "'**' in a dictionary is not part of the language");
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

}  // namespace simwright::tasks::reward
