#include <algorithm>
#include <array>

#include "reward/frontend/parser.h"

namespace simwright::reward {
namespace {

struct BinaryLevel {
  std::string_view sign;
  Operator operation;
  int level;
};

// Sorted from loosest to tightest binding, as in Python.
constexpr BinaryLevel kBinary[] = {
    {"|", Operator::kOr, 0},        {"^", Operator::kExclusiveOr, 1},
    {"&", Operator::kAnd, 2},       {"+", Operator::kAdd, 4},
    {"-", Operator::kSubtract, 4},  {"*", Operator::kMultiply, 5},
    {"/", Operator::kDivide, 5},    {"//", Operator::kFloorDivide, 5},
    {"%", Operator::kRemainder, 5}, {"@", Operator::kMatrixMultiply, 5},
};
constexpr int kTightest = 5;

constexpr std::string_view kReserved[] = {
    "False", "None",     "True",  "and",    "as",   "assert", "async",  "await",    "break",
    "class", "continue", "def",   "del",    "elif", "else",   "except", "finally",  "for",
    "from",  "global",   "if",    "import", "in",   "is",     "lambda", "nonlocal", "not",
    "or",    "pass",     "raise", "return", "try",  "while",  "with",   "yield"};

bool IsReserved(std::string_view name) {
  return std::find(std::begin(kReserved), std::end(kReserved), name) != std::end(kReserved);
}

std::string Shown(const Token& token) {
  switch (token.kind) {
    case TokenKind::kNewline:
      return "the end of the line";
    case TokenKind::kEnd:
      return "the end of the program";
    case TokenKind::kIndent:
      return "a deeper indentation";
    case TokenKind::kDedent:
      return "the end of the block";
    case TokenKind::kString:
    case TokenKind::kFormatString:
      return "a string";
    default:
      return "'" + token.text.substr(0, 40) + "'";
  }
}

}  // namespace

ExpressionParser::RecursionGuard::RecursionGuard(ExpressionParser* parser) : parser_(parser) {
  if (++parser_->nesting_ > parser_->options_.max_depth) {
    Fail("too-deep", parser_->Peek().position,
         "the expression is nested deeper than " + std::to_string(parser_->options_.max_depth) +
             "; split it into named steps");
  }
}

const Token& ExpressionParser::Peek(std::size_t ahead) const {
  return tokens_[std::min(at_ + ahead, tokens_.size() - 1)];
}

bool ExpressionParser::At(std::string_view text) const {
  const Token& token = Peek();
  return (token.kind == TokenKind::kName || token.kind == TokenKind::kOperator) &&
         token.text == text;
}

Token ExpressionParser::Take() {
  Token token = Peek();
  if (at_ + 1 < tokens_.size()) ++at_;
  return token;
}

bool ExpressionParser::Accept(std::string_view text) {
  if (!At(text)) return false;
  Take();
  return true;
}

void ExpressionParser::Expect(std::string_view text, const std::string& where) {
  if (!Accept(text)) Unexpected("'" + std::string(text) + "' " + where);
}

void ExpressionParser::Unexpected(const std::string& wanted) const {
  const Token& token = Peek();
  Fail("syntax", token.position, "expected " + wanted + ", found " + Shown(token));
}

std::string ExpressionParser::TakeName(const std::string& what) {
  if (!AtKind(TokenKind::kName)) Unexpected(what);
  if (IsReserved(Peek().text)) Unexpected(what + " (a Python keyword is none)");
  return Take().text;
}

ExpressionPtr ExpressionParser::Make(ExpressionKind kind, Position position) const {
  auto expression = std::make_unique<Expression>();
  expression->kind = kind;
  expression->position = position;
  return expression;
}

void ExpressionParser::Add(Expression* parent, ExpressionPtr child) const {
  if (child != nullptr) {
    parent->depth = std::max(parent->depth, child->depth + 1);
    if (parent->depth > options_.max_depth) {
      Fail("too-deep", child->position,
           "the expression is nested deeper than " + std::to_string(options_.max_depth) +
               "; split it into named steps");
    }
  }
  parent->children.push_back(std::move(child));
}

ExpressionPtr ExpressionParser::Only() {
  ExpressionPtr expression = ParseExpressionList();
  if (!AtKind(TokenKind::kEnd)) Unexpected("the end of the expression");
  return expression;
}

bool ExpressionParser::AtExpressionEnd() const {
  const TokenKind kind = Peek().kind;
  if (kind == TokenKind::kNewline || kind == TokenKind::kEnd || kind == TokenKind::kDedent) {
    return true;
  }
  static constexpr std::string_view kClosing[] = {")", "]", "}", "=", ":", ";", "for", "in"};
  return std::any_of(std::begin(kClosing), std::end(kClosing),
                     [&](std::string_view text) { return At(text); });
}

ExpressionPtr ExpressionParser::ParseExpressionList() {
  const Position start = Peek().position;
  ExpressionPtr first = ParseItem();
  if (!At(",")) return first;
  ExpressionPtr tuple = Make(ExpressionKind::kTuple, start);
  Add(tuple.get(), std::move(first));
  while (Accept(",")) {
    if (AtExpressionEnd()) break;
    Add(tuple.get(), ParseItem());
  }
  return tuple;
}

ExpressionPtr ExpressionParser::ParseItem() {
  if (!At("*")) return ParseExpression();
  ExpressionPtr starred = Make(ExpressionKind::kStarred, Take().position);
  Add(starred.get(), ParseBinary(0));
  return starred;
}

ExpressionPtr ExpressionParser::ParseTarget() {
  const Position start = Peek().position;
  ExpressionPtr first = ParsePostfix();
  if (!At(",")) return first;
  ExpressionPtr tuple = Make(ExpressionKind::kTuple, start);
  Add(tuple.get(), std::move(first));
  while (Accept(",") && !At("in")) Add(tuple.get(), ParsePostfix());
  return tuple;
}

ExpressionPtr ExpressionParser::ParseExpression() {
  const RecursionGuard nesting(this);
  if (At("lambda")) {
    Fail("no-lambda", Peek().position,
         "lambda is not part of the language; write a named function with def");
  }
  ExpressionPtr value = ParseBoolean(Operator::kBooleanOr, "or");
  if (At(":=")) {
    Fail("no-walrus", Peek().position, "':=' is not part of the language; assign on its own line");
  }
  if (!At("if")) return value;
  ExpressionPtr conditional = Make(ExpressionKind::kConditional, Take().position);
  ExpressionPtr condition = ParseBoolean(Operator::kBooleanOr, "or");
  Expect("else", "and a value for the other case");
  ExpressionPtr otherwise = ParseExpression();
  Add(conditional.get(), std::move(condition));
  Add(conditional.get(), std::move(value));
  Add(conditional.get(), std::move(otherwise));
  return conditional;
}

ExpressionPtr ExpressionParser::ParseBoolean(Operator operation, std::string_view word) {
  const auto operand = [&] {
    return operation == Operator::kBooleanOr ? ParseBoolean(Operator::kBooleanAnd, "and")
                                             : ParseNot();
  };
  ExpressionPtr first = operand();
  if (!At(word)) return first;
  ExpressionPtr all = Make(ExpressionKind::kBoolean, Peek().position);
  all->operation = operation;
  Add(all.get(), std::move(first));
  while (Accept(word)) Add(all.get(), operand());
  return all;
}

ExpressionPtr ExpressionParser::ParseNot() {
  if (!At("not")) return ParseComparison();
  const RecursionGuard nesting(this);
  ExpressionPtr expression = Make(ExpressionKind::kUnary, Take().position);
  expression->operation = Operator::kNot;
  Add(expression.get(), ParseNot());
  return expression;
}

bool ExpressionParser::AcceptComparison(Operator* operation) {
  static constexpr std::pair<std::string_view, Operator> kSigns[] = {
      {"<", Operator::kLess},   {"<=", Operator::kLessEqual},    {">", Operator::kGreater},
      {"==", Operator::kEqual}, {">=", Operator::kGreaterEqual}, {"!=", Operator::kNotEqual},
      {"in", Operator::kIn}};
  for (const auto& [sign, meaning] : kSigns) {
    if (!At(sign)) continue;
    Take();
    *operation = meaning;
    return true;
  }
  if (Accept("is")) {
    *operation = Accept("not") ? Operator::kIsNot : Operator::kIs;
    return true;
  }
  if (At("not") && Peek(1).kind == TokenKind::kName && Peek(1).text == "in") {
    Take();
    Take();
    *operation = Operator::kNotIn;
    return true;
  }
  return false;
}

ExpressionPtr ExpressionParser::ParseComparison() {
  ExpressionPtr first = ParseBinary(0);
  const Position sign = Peek().position;
  Operator operation;
  if (!AcceptComparison(&operation)) return first;
  ExpressionPtr comparison = Make(ExpressionKind::kCompare, sign);
  Add(comparison.get(), std::move(first));
  do {
    comparison->operations.push_back(operation);
    Add(comparison.get(), ParseBinary(0));
  } while (AcceptComparison(&operation));
  return comparison;
}

ExpressionPtr ExpressionParser::ParseBinary(int level) {
  if (level > kTightest) return ParseUnary();
  ExpressionPtr left = ParseBinary(level + 1);
  while (AtKind(TokenKind::kOperator)) {
    if (At("<<") || At(">>")) {
      Fail("syntax", Peek().position, "shifts of bits are not part of the language");
    }
    const auto* found = std::find_if(
        std::begin(kBinary), std::end(kBinary),
        [&](const BinaryLevel& binary) { return binary.level == level && At(binary.sign); });
    if (found == std::end(kBinary)) break;
    ExpressionPtr both = Make(ExpressionKind::kBinary, Take().position);
    both->operation = found->operation;
    Add(both.get(), std::move(left));
    Add(both.get(), ParseBinary(level + 1));
    left = std::move(both);
  }
  return left;
}

ExpressionPtr ExpressionParser::ParseUnary() {
  const RecursionGuard nesting(this);
  const Operator operation = At("-")   ? Operator::kNegate
                             : At("+") ? Operator::kPlus
                             : At("~") ? Operator::kInvert
                                       : Operator::kNone;
  if (operation == Operator::kNone) return ParsePower();
  ExpressionPtr expression = Make(ExpressionKind::kUnary, Take().position);
  expression->operation = operation;
  Add(expression.get(), ParseUnary());
  return expression;
}

ExpressionPtr ExpressionParser::ParsePower() {
  ExpressionPtr base = ParsePostfix();
  if (!At("**")) return base;
  ExpressionPtr power = Make(ExpressionKind::kBinary, Take().position);
  power->operation = Operator::kPower;
  Add(power.get(), std::move(base));
  Add(power.get(), ParseUnary());
  return power;
}

ExpressionPtr ExpressionParser::ParsePostfix() {
  ExpressionPtr value = ParseAtom();
  while (true) {
    if (At("(")) {
      value = ParseCall(std::move(value));
    } else if (At("[")) {
      value = ParseSubscript(std::move(value));
    } else if (Accept(".")) {
      const Position position = Peek().position;
      ExpressionPtr attribute = Make(ExpressionKind::kAttribute, position);
      attribute->text = TakeName("a name after '.'");
      if (attribute->text.starts_with("__")) {
        Fail("forbidden", position,
             "'" + attribute->text + "' reaches into Python itself, which a reward never needs");
      }
      Add(attribute.get(), std::move(value));
      value = std::move(attribute);
    } else {
      return value;
    }
  }
}

ExpressionPtr ExpressionParser::ParseCall(ExpressionPtr callee) {
  ExpressionPtr call = Make(ExpressionKind::kCall, callee->position);
  Add(call.get(), std::move(callee));
  Take();
  while (!At(")")) {
    ParseArgument(call.get());
    if (!Accept(",")) break;
  }
  Expect(")", "or ',' in the arguments");
  return call;
}

void ExpressionParser::ParseArgument(Expression* call) {
  std::string keyword;
  const Position position = Peek().position;
  if (At("*") || At("**")) {
    keyword = Take().text;
  } else if (AtKind(TokenKind::kName) && Peek(1).kind == TokenKind::kOperator &&
             Peek(1).text == "=") {
    keyword = TakeName("the argument's name");
    Take();
    for (const std::string& earlier : call->keywords) {
      if (earlier == keyword) {
        Fail("syntax", position, "the argument '" + keyword + "' is given twice");
      }
    }
  } else if (!call->keywords.empty() && !call->keywords.back().empty() &&
             call->keywords.back() != "*" && call->keywords.back() != "**") {
    Fail("syntax", position, "an argument without a name follows one with a name");
  }
  ExpressionPtr value = ParseExpression();
  if (At("for"))
    value = ParseComprehension(ExpressionKind::kListComprehension, std::move(value), nullptr);
  call->keywords.push_back(keyword);
  Add(call, std::move(value));
}

ExpressionPtr ExpressionParser::ParseSubscriptItem() {
  const Position start = Peek().position;
  ExpressionPtr first;
  if (!At(":")) first = ParseExpression();
  if (!At(":")) return first;
  ExpressionPtr slice = Make(ExpressionKind::kSlice, start);
  Add(slice.get(), std::move(first));
  for (int part = 1; part < 3; ++part) {
    ExpressionPtr value;
    if (Accept(":") && !At(":") && !At("]") && !At(",")) value = ParseExpression();
    Add(slice.get(), std::move(value));
  }
  return slice;
}

ExpressionPtr ExpressionParser::ParseSubscript(ExpressionPtr base) {
  const RecursionGuard nesting(this);
  ExpressionPtr subscript = Make(ExpressionKind::kSubscript, Take().position);
  Add(subscript.get(), std::move(base));
  const Position start = Peek().position;
  if (At("]")) Unexpected("an index");
  ExpressionPtr first = ParseSubscriptItem();
  if (At(",")) {
    ExpressionPtr tuple = Make(ExpressionKind::kTuple, start);
    Add(tuple.get(), std::move(first));
    while (Accept(",") && !At("]")) Add(tuple.get(), ParseSubscriptItem());
    first = std::move(tuple);
  }
  Add(subscript.get(), std::move(first));
  Expect("]", "after the index");
  return subscript;
}

ExpressionPtr ExpressionParser::ParseAtom() {
  const Token& token = Peek();
  switch (token.kind) {
    case TokenKind::kName:
      return ParseNameOrConstant();
    case TokenKind::kInteger:
    case TokenKind::kFloat: {
      const bool whole = token.kind == TokenKind::kInteger;
      ExpressionPtr number =
          Make(whole ? ExpressionKind::kInteger : ExpressionKind::kFloat, token.position);
      number->integer = token.integer;
      number->number = token.number;
      Take();
      return number;
    }
    case TokenKind::kString:
    case TokenKind::kFormatString:
      return ParseStrings();
    default:
      break;
  }
  if (At("(")) return ParseParenthesised();
  if (At("[")) return ParseListDisplay();
  if (At("{")) return ParseDictDisplay();
  if (At("...")) return Make(ExpressionKind::kEllipsis, Take().position);
  Unexpected("a value");
}

ExpressionPtr ExpressionParser::ParseNameOrConstant() {
  static constexpr std::pair<std::string_view, ExpressionKind> kConstants[] = {
      {"None", ExpressionKind::kNone},
      {"True", ExpressionKind::kTrue},
      {"False", ExpressionKind::kFalse}};
  for (const auto& [word, kind] : kConstants) {
    if (At(word)) return Make(kind, Take().position);
  }
  if (At("lambda") || At("yield") || At("await")) {
    Fail("syntax", Peek().position, "'" + Peek().text + "' is not part of the language");
  }
  ExpressionPtr name = Make(ExpressionKind::kName, Peek().position);
  name->text = TakeName("a value");
  if (name->text.starts_with("__")) {
    Fail("forbidden", name->position,
         "'" + name->text + "' reaches into Python itself, which a reward never needs");
  }
  return name;
}

}  // namespace simwright::reward
