#pragma once

#include <string_view>
#include <vector>

#include "tasks/reward/lexer.h"
#include "tasks/reward/reward_options.h"
#include "tasks/reward/syntax.h"

namespace simwright::tasks::reward {

// Reads a whole file. Throws Fault where it is no program of the language; what Python knows and
// the language leaves out (while, class, lambda ...) is named as such.
Module Parse(std::string_view source, const RewardOptions& options);

// Tokens to expressions; the statements' parser stands on it.
class ExpressionParser {
 public:
  ExpressionParser(std::vector<Token> tokens, const RewardOptions& options)
      : options_(options), tokens_(std::move(tokens)) {}

  // A whole expression, and nothing after it.
  ExpressionPtr Only();

 protected:
  const Token& Peek(std::size_t ahead = 0) const;
  bool At(std::string_view text) const;  // a name or operator
  bool AtKind(TokenKind kind) const { return Peek().kind == kind; }
  Token Take();
  bool Accept(std::string_view text);
  void Expect(std::string_view text, const std::string& where);
  [[noreturn]] void Unexpected(const std::string& wanted) const;
  std::string TakeName(const std::string& what);

  ExpressionPtr Make(ExpressionKind kind, Position position) const;
  // Adds a child and keeps the depth within bounds.
  void Add(Expression* parent, ExpressionPtr child) const;

  ExpressionPtr ParseExpression();      // no bare tuple
  ExpressionPtr ParseExpressionList();  // a tuple where there is a comma
  ExpressionPtr ParseItem();            // of a list: an expression, or *expression
  ExpressionPtr ParseTarget();          // of a loop
  ExpressionPtr ParseBinary(int level);

  const RewardOptions& options_;

 private:
  // Counts how deep the parser calls itself.
  class Nesting {
   public:
    explicit Nesting(ExpressionParser* parser);
    ~Nesting() { --parser_->nesting_; }

   private:
    ExpressionParser* parser_;
  };

  ExpressionPtr ParseBoolean(Operator operation, std::string_view word);
  ExpressionPtr ParseNot();
  ExpressionPtr ParseComparison();
  bool AcceptComparison(Operator* operation);
  ExpressionPtr ParseUnary();
  ExpressionPtr ParsePower();
  ExpressionPtr ParsePostfix();
  ExpressionPtr ParseCall(ExpressionPtr callee);
  void ParseArgument(Expression* call);
  ExpressionPtr ParseSubscript(ExpressionPtr base);
  ExpressionPtr ParseSubscriptItem();
  ExpressionPtr ParseAtom();
  ExpressionPtr ParseNameOrConstant();
  ExpressionPtr ParseStrings();
  ExpressionPtr ParseFormatString(const Token& token);
  ExpressionPtr ParseReplacement(const Token& token, std::size_t* at);
  ExpressionPtr ParseParenthesised();
  ExpressionPtr ParseListDisplay();
  ExpressionPtr ParseDictDisplay();
  ExpressionPtr ParseComprehension(ExpressionKind kind, ExpressionPtr element, ExpressionPtr value);
  bool AtExpressionEnd() const;

  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  int nesting_ = 0;
};

}  // namespace simwright::tasks::reward
