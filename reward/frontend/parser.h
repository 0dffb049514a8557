#pragma once

#include <string_view>
#include <vector>

#include "reward/frontend/lexer.h"
#include "reward/frontend/syntax.h"
#include "reward/reward_options.h"

namespace simwright::reward {

// Parses a whole file. Throws Fault if it is not a program of the language; Python constructs that
// the language excludes (while, class, lambda ...) are named as such.
Module Parse(std::string_view source, const RewardOptions& options);

// A recursive-descent parser from tokens to expressions; the base of the statement parser.
class ExpressionParser {
 public:
  ExpressionParser(std::vector<Token> tokens, const RewardOptions& options)
      : options_(options), tokens_(std::move(tokens)) {}

  // Parses a single expression; throws Fault if anything follows it.
  ExpressionPtr Only();

 protected:
  const Token& Peek(std::size_t ahead = 0) const;
  bool At(std::string_view text) const;  // `text`: a name or an operator
  bool AtKind(TokenKind kind) const { return Peek().kind == kind; }
  Token Take();
  bool Accept(std::string_view text);
  void Expect(std::string_view text, const std::string& where);
  [[noreturn]] void Unexpected(const std::string& wanted) const;
  std::string TakeName(const std::string& what);

  ExpressionPtr Make(ExpressionKind kind, Position position) const;
  // Adds a child and enforces the depth limit.
  void Add(Expression* parent, ExpressionPtr child) const;

  ExpressionPtr ParseExpression();      // without a bare tuple
  ExpressionPtr ParseExpressionList();  // a tuple if there is a comma
  ExpressionPtr ParseItem();            // item of a list: an expression, or *expression
  ExpressionPtr ParseTarget();          // target of a loop
  ExpressionPtr ParseBinary(int level);

  const RewardOptions& options_;

 private:
  // Limits the recursion depth of the parser.
  class RecursionGuard {
   public:
    explicit RecursionGuard(ExpressionParser* parser);
    ~RecursionGuard() { --parser_->nesting_; }

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

}  // namespace simwright::reward
