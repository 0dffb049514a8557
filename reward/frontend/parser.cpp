#include "reward/frontend/parser.h"

#include <algorithm>

#include "reward/frontend/local_names.h"

namespace simwright::reward {
namespace {

struct Refusal {
  std::string_view word;
  const char* code;
  const char* sentence;
};

// Python constructs that the language excludes.
constexpr Refusal kRefused[] = {
    {"while", "no-while",
     "while-loops are not part of the language, since nothing bounds them; loop over range(...)"},
    {"class", "no-class", "classes are not part of the language; write functions"},
    {"async", "syntax", "async is not part of the language"},
    {"global", "no-global", "global is not part of the language; pass values and return them"},
    {"nonlocal", "no-global", "nonlocal is not part of the language; pass values and return them"},
    {"try", "no-exceptions", "try is not part of the language; nothing here raises"},
    {"raise", "no-exceptions", "raise is not part of the language; return a reward instead"},
    {"yield", "syntax", "yield is not part of the language; return the reward"},
    {"lambda", "no-lambda", "lambda is not part of the language; write a named function with def"},
};

std::string DottedName(const Expression& expression) {
  if (expression.kind == ExpressionKind::kName) return expression.text;
  if (expression.kind == ExpressionKind::kCall) return DottedName(*expression.children[0]);
  if (expression.kind != ExpressionKind::kAttribute) return "";
  return DottedName(*expression.children[0]) + "." + expression.text;
}

class StatementParser : public ExpressionParser {
 public:
  using ExpressionParser::ExpressionParser;

  Module ParseModule();

 private:
  using Line = std::unique_ptr<Statement>;

  std::unique_ptr<Function> ParseFunction();
  void ParseParameters(Function* function);
  void SkipDecorator();
  Block ParseBlock();
  void ParseLine(Block* block);
  Line ParseStatement();
  Line ParseSimple();
  Line ParseImport();
  Line ParseFromImport();
  Line ParseReturn();
  Line ParseIf();
  Line ParseFor();
  Line ParseWith();
  Line ParseNestedFunction();
  Line ParseDelete();
  Line ParseAssert();
  Line ParseAssignment();
  std::string ParseModuleName();
  Line New(StatementKind kind) const;
  void EndOfLine();
  void RefuseIfUnknown() const;
};

StatementParser::Line StatementParser::New(StatementKind kind) const {
  auto statement = std::make_unique<Statement>();
  statement->kind = kind;
  statement->position = Peek().position;
  return statement;
}

void StatementParser::RefuseIfUnknown() const {
  if (!AtKind(TokenKind::kName)) return;
  for (const Refusal& refusal : kRefused) {
    if (At(refusal.word)) Fail(refusal.code, Peek().position, refusal.sentence);
  }
}

Module StatementParser::ParseModule() {
  Module module;
  while (!AtKind(TokenKind::kEnd)) {
    if (AtKind(TokenKind::kIndent)) {
      Fail("bad-indentation", Peek().position, "this line is indented, but no block begins above");
    }
    if (At("@")) {
      SkipDecorator();
    } else if (At("def")) {
      module.functions.push_back(ParseFunction());
    } else {
      ParseLine(&module.statements);
    }
  }
  return module;
}

void StatementParser::SkipDecorator() {
  const Position position = Take().position;
  const ExpressionPtr decorator = ParseExpression();
  const std::string name = DottedName(*decorator);
  static constexpr std::string_view kHarmless[] = {
      "torch.jit.script", "torch.no_grad",        "torch.jit.export", "staticmethod",
      "jit.script",       "torch.inference_mode", "torch.compile"};
  if (std::find(std::begin(kHarmless), std::end(kHarmless), name) == std::end(kHarmless)) {
    Fail("bad-decorator", position,
         "the decorator '@" + name +
             "' is not known; of decorators only those that change no "
             "result, such as @torch.jit.script, are read");
  }
  EndOfLine();
}

std::unique_ptr<Function> StatementParser::ParseFunction() {
  Take();
  auto function = std::make_unique<Function>();
  function->position = Peek().position;
  function->name = TakeName("the function's name");
  ParseParameters(function.get());
  if (Accept("->")) ParseExpression();
  function->body = ParseBlock();
  function->locals = LocalNames(function->body);
  return function;
}

void StatementParser::ParseParameters(Function* function) {
  Expect("(", "after the function's name");
  while (!At(")")) {
    const bool separator = At("*") && Peek(1).kind == TokenKind::kOperator && Peek(1).text == ",";
    if ((At("*") && !separator) || At("**") || At("/")) {
      Fail("syntax", Peek().position,
           "parameters with '*' or '/' are not part of the language; name each one");
    }
    if (separator) {  // the parameters after it are keyword-only
      Take();
      Take();
      continue;
    }
    Parameter parameter;
    parameter.position = Peek().position;
    parameter.name = TakeName("a parameter");
    for (const Parameter& earlier : function->parameters) {
      if (earlier.name == parameter.name) {
        Fail("syntax", parameter.position, "the parameter '" + parameter.name + "' stands twice");
      }
    }
    if (Accept(":")) parameter.annotation = ParseExpression();
    if (Accept("=")) parameter.initial = ParseExpression();
    function->parameters.push_back(std::move(parameter));
    if (!Accept(",")) break;
  }
  Expect(")", "or ',' in the parameters");
}

Block StatementParser::ParseBlock() {
  Expect(":", "before the block");
  Block block;
  if (!AtKind(TokenKind::kNewline)) {
    for (const std::string_view word : {"if", "for", "with", "def", "@"}) {
      if (At(word)) Unexpected("a simple statement, or a new line,");
    }
    ParseLine(&block);
    return block;
  }
  Take();
  if (!AtKind(TokenKind::kIndent)) Unexpected("an indented block");
  Take();
  while (!AtKind(TokenKind::kDedent) && !AtKind(TokenKind::kEnd)) {
    ParseLine(&block);
  }
  if (AtKind(TokenKind::kDedent)) Take();
  return block;
}

void StatementParser::ParseLine(Block* block) {
  RefuseIfUnknown();
  while (At("@")) SkipDecorator();
  if (At("if") || At("for") || At("with") || At("def")) {
    block->push_back(ParseStatement());
    return;
  }
  do {
    if (AtKind(TokenKind::kNewline) || AtKind(TokenKind::kEnd)) break;  // after a last ';'
    block->push_back(ParseSimple());
  } while (Accept(";"));
  EndOfLine();
}

void StatementParser::EndOfLine() {
  if (AtKind(TokenKind::kEnd) || AtKind(TokenKind::kDedent)) return;
  if (!AtKind(TokenKind::kNewline)) Unexpected("the end of the line");
  Take();
  // An unexpected indent after a simple statement.
  if (AtKind(TokenKind::kIndent)) {
    Fail("bad-indentation", Peek().position, "this line is indented, but no block begins above");
  }
}

StatementParser::Line StatementParser::ParseStatement() {
  if (At("if")) return ParseIf();
  if (At("def")) return ParseNestedFunction();
  return At("for") ? ParseFor() : ParseWith();
}

StatementParser::Line StatementParser::ParseSimple() {
  RefuseIfUnknown();
  if (At("import")) return ParseImport();
  if (At("from")) return ParseFromImport();
  if (At("return")) return ParseReturn();
  if (At("assert")) return ParseAssert();
  if (At("del")) return ParseDelete();
  static constexpr std::pair<std::string_view, StatementKind> kWords[] = {
      {"pass", StatementKind::kPass},
      {"break", StatementKind::kBreak},
      {"continue", StatementKind::kContinue}};
  for (const auto& [word, kind] : kWords) {
    if (!At(word)) continue;
    Line statement = New(kind);
    Take();
    return statement;
  }
  return ParseAssignment();
}

std::string StatementParser::ParseModuleName() {
  std::string name;
  while (Accept(".")) name += '.';
  if (!name.empty() && At("import")) return name;
  name += TakeName("a module's name");
  while (Accept(".")) name += "." + TakeName("a module's name");
  return name;
}

StatementParser::Line StatementParser::ParseImport() {
  Line statement = New(StatementKind::kImport);
  Take();
  do {
    Import import;
    import.position = Peek().position;
    import.module = ParseModuleName();
    if (Accept("as")) import.alias = TakeName("a name after 'as'");
    statement->imports.push_back(std::move(import));
  } while (Accept(","));
  return statement;
}

StatementParser::Line StatementParser::ParseFromImport() {
  Line statement = New(StatementKind::kImport);
  Take();
  const Position position = Peek().position;
  const std::string module = ParseModuleName();
  Expect("import", "after the module's name");
  const bool brackets = Accept("(");
  do {
    if (brackets && At(")")) break;
    Import import{module, "*", "", position};
    if (!Accept("*")) {
      import.position = Peek().position;
      import.name = TakeName("a name to import");
      import.alias = Accept("as") ? TakeName("a name after 'as'") : import.name;
    }
    statement->imports.push_back(std::move(import));
  } while (Accept(","));
  if (brackets) Expect(")", "to close the '('");
  return statement;
}

StatementParser::Line StatementParser::ParseReturn() {
  Line statement = New(StatementKind::kReturn);
  Take();
  if (!AtKind(TokenKind::kNewline) && !AtKind(TokenKind::kEnd) && !At(";")) {
    statement->value = ParseExpressionList();
  }
  return statement;
}

StatementParser::Line StatementParser::ParseIf() {
  Line statement = New(StatementKind::kIf);
  do {
    Take();
    statement->targets.push_back(ParseExpression());
    statement->blocks.push_back(ParseBlock());
  } while (At("elif"));
  if (Accept("else")) statement->blocks.push_back(ParseBlock());
  return statement;
}

StatementParser::Line StatementParser::ParseFor() {
  Line statement = New(StatementKind::kFor);
  Take();
  statement->targets.push_back(ParseTarget());
  Expect("in", "after the loop's name");
  statement->value = ParseExpressionList();
  statement->blocks.push_back(ParseBlock());
  if (At("else")) {
    Fail("syntax", Peek().position, "'else' after a loop is not part of the language");
  }
  return statement;
}

StatementParser::Line StatementParser::ParseWith() {
  Line statement = New(StatementKind::kBlock);
  Take();
  const Position position = Peek().position;
  const std::string name = DottedName(*ParseExpression());
  if (name != "torch.no_grad" && name != "torch.inference_mode") {
    Fail("syntax", position, "'with' is read for torch.no_grad() alone");
  }
  statement->blocks.push_back(ParseBlock());
  return statement;
}

StatementParser::Line StatementParser::ParseNestedFunction() {
  Line statement = New(StatementKind::kFunction);
  statement->function = ParseFunction();
  return statement;
}

StatementParser::Line StatementParser::ParseDelete() {
  Line statement = New(StatementKind::kDelete);
  Take();
  do {
    statement->targets.push_back(ParseBinary(0));
  } while (Accept(","));
  return statement;
}

// Parses an assertion, which has no effect: it holds in every environment or stops the training,
// and changes no reward.
StatementParser::Line StatementParser::ParseAssert() {
  Line statement = New(StatementKind::kPass);
  Take();
  ParseExpressionList();
  return statement;
}

StatementParser::Line StatementParser::ParseAssignment() {
  Line statement = New(StatementKind::kExpression);
  ExpressionPtr first = ParseExpressionList();
  static constexpr std::pair<std::string_view, Operator> kAugmented[] = {
      {"+=", Operator::kAdd},        {"-=", Operator::kSubtract},     {"*=", Operator::kMultiply},
      {"/=", Operator::kDivide},     {"//=", Operator::kFloorDivide}, {"%=", Operator::kRemainder},
      {"**=", Operator::kPower},     {"&=", Operator::kAnd},          {"|=", Operator::kOr},
      {"^=", Operator::kExclusiveOr}};
  for (const auto& [sign, operation] : kAugmented) {
    if (!At(sign)) continue;
    statement->kind = StatementKind::kAugmented;
    statement->position = Take().position;
    statement->operation = operation;
    statement->targets.push_back(std::move(first));
    statement->value = ParseExpressionList();
    return statement;
  }
  if (Accept(":")) {  // an annotation
    ParseExpression();
    if (!At("=")) {
      statement->kind = StatementKind::kPass;
      return statement;
    }
  }
  while (Accept("=")) {
    statement->kind = StatementKind::kAssign;
    statement->targets.push_back(std::move(first));
    first = ParseExpressionList();
  }
  statement->value = std::move(first);
  return statement;
}

}  // namespace

Module Parse(std::string_view source, const RewardOptions& options) {
  return StatementParser(Tokenise(source, options), options).ParseModule();
}

}  // namespace simwright::reward
