#include "reward/frontend/lexer.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>

namespace simwright::reward {
namespace {

bool IsNameStart(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) || c == '_';
}
bool IsDigit(char c) {
  return c >= '0' && c <= '9';
}
bool IsNamePart(char c) {
  return IsNameStart(c) || IsDigit(c);
}

// Sorted by length, longest first.
constexpr std::string_view kOperators[] = {
    "**=", "//=", ">>=", "<<=", "...", "**", "//", "->", "<=", ">=", "==", "!=",
    "+=",  "-=",  "*=",  "/=",  "%=",  "&=", "|=", "^=", "@=", ":=", "<<", ">>",
    "+",   "-",   "*",   "/",   "%",   "@",  "&",  "|",  "^",  "~",  "<",  ">",
    "(",   ")",   "[",   "]",   "{",   "}",  ",",  ":",  ".",  ";",  "=",  "!"};

class Lexer {
 public:
  Lexer(std::string_view source, Position start, const RewardOptions& options)
      : source_(source), position_(start), options_(options) {}

  std::vector<Token> Lines();
  std::vector<Token> Expression();

 private:
  bool AtEnd() const { return at_ >= source_.size(); }
  char Peek(std::size_t ahead = 0) const {
    return at_ + ahead < source_.size() ? source_[at_ + ahead] : '\0';
  }
  void Advance();
  void Push(TokenKind kind, Position position, std::string text = "");
  void Indentation();
  void SkipBlanks();
  void EndLine();
  void OneToken();
  void Name();
  void Number();
  void Integer(const std::string& digits, int base, Position position);
  void String(const std::string& prefix, Position position);
  void Escape(std::string* text);
  void CodePoint(int digits, std::string* text);
  void Operator();

  std::string_view source_;
  std::size_t at_ = 0;
  Position position_;
  const RewardOptions& options_;
  std::vector<Token> tokens_;
  std::vector<Token> open_;  // brackets
  std::vector<int> indents_ = {0};
  char indent_with_ = '\0';
};

void Lexer::Advance() {
  const char c = source_[at_++];
  if (c == '\n') {
    ++position_.line;
    position_.column = 1;
  } else if ((static_cast<unsigned char>(c) & 0xC0) != 0x80) {  // not inside a UTF-8 character
    ++position_.column;
  }
}

void Lexer::Push(TokenKind kind, Position position, std::string text) {
  if (static_cast<int>(tokens_.size()) >= options_.max_tokens) {
    Fail("too-long", position,
         "the program has more than " + std::to_string(options_.max_tokens) +
             " words and signs; a reward function is far shorter");
  }
  tokens_.push_back({kind, std::move(text), position, 0, 0.0});
}

// Handles the start of a line; blank lines and comments do not count.
void Lexer::Indentation() {
  int width = 0;
  std::size_t end = at_;
  while (end < source_.size() && (source_[end] == ' ' || source_[end] == '\t')) {
    ++width;
    ++end;
  }
  const char next = end < source_.size() ? source_[end] : '\n';
  const bool blank = next == '\n' || next == '\r' || next == '#';
  while (at_ < end) {
    const char c = Peek();
    if (!blank && indent_with_ != '\0' && c != indent_with_) {
      Fail("mixed-indentation", position_,
           "tabs and spaces are mixed in the indentation; indent with four spaces throughout");
    }
    if (!blank) indent_with_ = c;
    Advance();
  }
  if (blank || AtEnd()) return;
  if (width > indents_.back()) {
    if (static_cast<int>(indents_.size()) > options_.max_depth) {
      Fail("too-deep", position_,
           "blocks are nested deeper than " + std::to_string(options_.max_depth));
    }
    indents_.push_back(width);
    Push(TokenKind::kIndent, position_);
  }
  while (width < indents_.back()) {
    indents_.pop_back();
    Push(TokenKind::kDedent, position_);
  }
  if (width != indents_.back()) {
    Fail("bad-indentation", position_,
         "this line is indented like none of the blocks above; align it with one of them");
  }
}

void Lexer::SkipBlanks() {
  while (!AtEnd()) {
    const char c = Peek();
    if (c == '#') {
      while (!AtEnd() && Peek() != '\n') Advance();
    } else if (c == '\\' && (Peek(1) == '\n' || (Peek(1) == '\r' && Peek(2) == '\n'))) {
      Advance();
      if (Peek() == '\r') Advance();
      Advance();
    } else if (c == ' ' || c == '\t' || c == '\f' || c == '\r' || (c == '\n' && !open_.empty())) {
      Advance();
    } else {
      return;
    }
  }
}

void Lexer::EndLine() {
  if (!tokens_.empty() && tokens_.back().kind != TokenKind::kNewline &&
      tokens_.back().kind != TokenKind::kIndent && tokens_.back().kind != TokenKind::kDedent) {
    Push(TokenKind::kNewline, position_);
  }
}

std::vector<Token> Lexer::Lines() {
  if (source_.starts_with("\xEF\xBB\xBF")) at_ = 3;  // a byte order mark
  while (!AtEnd()) {
    Indentation();
    SkipBlanks();
    while (!AtEnd() && Peek() != '\n') {
      OneToken();
      SkipBlanks();
    }
    EndLine();
    if (!AtEnd()) Advance();
  }
  if (!open_.empty()) {
    Fail("open-bracket", open_.back().position, "this '" + open_.back().text + "' is never closed");
  }
  EndLine();
  for (; indents_.size() > 1; indents_.pop_back()) Push(TokenKind::kDedent, position_);
  Push(TokenKind::kEnd, position_);
  return std::move(tokens_);
}

std::vector<Token> Lexer::Expression() {
  open_.push_back({TokenKind::kOperator, "{", position_, 0, 0.0});  // line breaks do not matter
  for (SkipBlanks(); !AtEnd(); SkipBlanks()) OneToken();
  Push(TokenKind::kEnd, position_);
  return std::move(tokens_);
}

void Lexer::OneToken() {
  const char c = Peek();
  if (IsNameStart(c)) {
    Name();
  } else if (IsDigit(c) || (c == '.' && IsDigit(Peek(1)))) {
    Number();
  } else if (c == '"' || c == '\'') {
    String("", position_);
  } else if (static_cast<unsigned char>(c) >= 0x80) {
    Fail("not-ascii", position_,
         "a character outside plain ASCII stands here; names and operators are ASCII (look for a "
         "curly quote, a long dash or a look-alike letter)");
  } else {
    Operator();
  }
}

void Lexer::Name() {
  const Position start = position_;
  const std::size_t begin = at_;
  while (IsNamePart(Peek())) Advance();
  std::string text(source_.substr(begin, at_ - begin));
  if ((Peek() == '"' || Peek() == '\'') && text.size() <= 2) {
    String(text, start);
    return;
  }
  Push(TokenKind::kName, start, std::move(text));
}

void Lexer::Integer(const std::string& digits, int base, Position position) {
  Push(TokenKind::kInteger, position, digits);
  std::int64_t value = 0;
  const auto [end, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), value, base);
  if (error != std::errc() || end != digits.data() + digits.size()) {
    Fail("bad-number", position, "'" + digits.substr(0, 40) + "' is no number that fits 64 bits");
  }
  tokens_.back().integer = value;
}

void Lexer::Number() {
  const Position start = position_;
  std::string digits;
  bool is_float = false;
  const char second = static_cast<char>(std::tolower(static_cast<unsigned char>(Peek(1))));
  const bool based = Peek() == '0' && (second == 'x' || second == 'b' || second == 'o');
  const auto take = [&] {
    if (Peek() != '_') digits += Peek();
    Advance();
  };
  if (based) {
    Advance();
    Advance();
    while (IsNamePart(Peek())) take();
    Integer(digits, second == 'x' ? 16 : second == 'b' ? 2 : 8, start);
    return;
  }
  while (IsDigit(Peek()) || (Peek() == '_' && IsDigit(Peek(1)))) take();
  if (Peek() == '.' && Peek(1) != '.') {
    is_float = true;
    take();
    while (IsDigit(Peek()) || (Peek() == '_' && IsDigit(Peek(1)))) take();
  }
  const bool sign = Peek(1) == '+' || Peek(1) == '-';
  if ((Peek() == 'e' || Peek() == 'E') && (IsDigit(Peek(1)) || (sign && IsDigit(Peek(2))))) {
    is_float = true;
    take();
    take();
    while (IsDigit(Peek())) take();
  }
  if (IsNamePart(Peek())) {
    Fail("bad-number", start, "'" + digits.substr(0, 40) + Peek() + "' is no number");
  }
  if (!is_float) {
    Integer(digits, 10, start);
    return;
  }
  Push(TokenKind::kFloat, start, digits);
  tokens_.back().number = std::strtod(digits.c_str(), nullptr);
}

void Lexer::CodePoint(int digits, std::string* text) {
  unsigned value = 0;
  for (int i = 0; i < digits; ++i) {
    const char c = Peek();
    if (!std::isxdigit(static_cast<unsigned char>(c))) {
      Fail("bad-string", position_, "this escape needs " + std::to_string(digits) + " hex digits");
    }
    value = value * 16 + static_cast<unsigned>(IsDigit(c) ? c - '0' : (c | 32) - 'a' + 10);
    Advance();
  }
  // Asset names are compared byte by byte and contain no non-ASCII characters.
  *text += value < 0x80 ? static_cast<char>(value) : '?';
}

void Lexer::Escape(std::string* text) {
  Advance();
  const char c = Peek();
  if (AtEnd()) return;
  Advance();
  switch (c) {
    case 'n':
      *text += '\n';
      break;
    case 't':
      *text += '\t';
      break;
    case 'r':
      *text += '\r';
      break;
    case '0':
      *text += '\0';
      break;
    case 'x':
      CodePoint(2, text);
      break;
    case 'u':
      CodePoint(4, text);
      break;
    case 'U':
      CodePoint(8, text);
      break;
    case '\n':
      break;
    case '\\':
    case '\'':
    case '"':
      *text += c;
      break;
    default:
      (*text += '\\') += c;
  }
}

void Lexer::String(const std::string& prefix, Position start) {
  bool raw = false, format = false;
  for (const char c : prefix) {
    const char lower = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (lower == 'r') raw = true;
    if (lower == 'f') format = true;
    if (lower != 'r' && lower != 'f' && lower != 'u') {
      Fail("bad-string", start, "a string with the prefix '" + prefix + "' has no use here");
    }
  }
  const char quote = Peek();
  const bool triple = Peek(1) == quote && Peek(2) == quote;
  for (int i = 0; i < (triple ? 3 : 1); ++i) Advance();
  std::string text;
  while (true) {
    if (AtEnd() || (!triple && Peek() == '\n')) {
      Fail("open-string", start, "this string is not closed; it needs a closing quote");
    }
    if (Peek() == quote && (!triple || (Peek(1) == quote && Peek(2) == quote))) break;
    if (Peek() == '\\' && !raw) {
      Escape(&text);
    } else {
      text += Peek();
      Advance();
      if (raw && text.back() == '\\' && !AtEnd() && Peek() != '\n') {
        text += Peek();
        Advance();
      }
    }
  }
  for (int i = 0; i < (triple ? 3 : 1); ++i) Advance();
  Push(format ? TokenKind::kFormatString : TokenKind::kString, start, std::move(text));
}

void Lexer::Operator() {
  const Position start = position_;
  const std::string_view rest = source_.substr(at_);
  const auto* found = std::find_if(std::begin(kOperators), std::end(kOperators),
                                   [&](std::string_view op) { return rest.starts_with(op); });
  if (found == std::end(kOperators)) {
    const char c = Peek();
    Fail("bad-character", start,
         std::isprint(static_cast<unsigned char>(c))
             ? std::string("'") + c + "' has no meaning here"
             : "a control character stands here; remove it");
  }
  for (std::size_t i = 0; i < found->size(); ++i) Advance();
  Push(TokenKind::kOperator, start, std::string(*found));
  const char c = (*found)[0];
  if (c == '(' || c == '[' || c == '{') {
    if (static_cast<int>(open_.size()) >= options_.max_depth) {
      Fail("too-deep", start,
           "brackets are nested deeper than " + std::to_string(options_.max_depth));
    }
    open_.push_back(tokens_.back());
  } else if (c == ')' || c == ']' || c == '}') {
    const char wanted = c == ')' ? '(' : c == ']' ? '[' : '{';
    if (open_.empty() || open_.back().text[0] != wanted) {
      Fail("open-bracket", start, std::string("this '") + c + "' closes no '" + wanted + "'");
    }
    open_.pop_back();
  }
}

}  // namespace

std::vector<Token> Tokenise(std::string_view source, const RewardOptions& options) {
  if (source.size() > options.max_source_bytes) {
    Fail("too-long", {},
         "the program has " + std::to_string(source.size()) + " bytes, at most " +
             std::to_string(options.max_source_bytes) + " are read");
  }
  return Lexer(source, {}, options).Lines();
}

std::vector<Token> TokeniseExpression(std::string_view source, Position start,
                                      const RewardOptions& options) {
  return Lexer(source, start, options).Expression();
}

}  // namespace simwright::reward
