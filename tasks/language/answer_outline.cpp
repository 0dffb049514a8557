#include "tasks/language/answer_outline.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>

#include "tasks/language/answer_text.h"
#include "tasks/language/program_blocks.h"

namespace simwright::tasks {
namespace {

bool IsBlank(std::string_view line) {
  return Trimmed(line).empty();
}

// Returns the text after ``` or ~~~ at the start of a line; nullopt if the line is not a fence.
std::optional<std::string> FenceInfo(std::string_view line) {
  std::string_view text = Trimmed(line);
  if (text.starts_with("- ") || text.starts_with("* ")) text = Trimmed(text.substr(2));
  for (const char mark : {'`', '~'}) {
    std::size_t count = 0;
    while (count < text.size() && text[count] == mark) ++count;
    if (count < 3) continue;
    const std::string_view info = text.substr(count);
    if (info.find("```") != std::string_view::npos) return std::nullopt;  // inline code
    return std::string(Trimmed(info));
  }
  return std::nullopt;
}

// Returns true for a statement at the outer level, which occurs where a function has lost its
// indentation.
bool LooksLikeStatement(std::string_view line) {
  const std::string_view text = Trimmed(line);
  if (text == "return" || text.starts_with("return ")) return true;
  const bool block = text.starts_with("if ") || text.starts_with("for ") ||
                     text.starts_with("else") || text.starts_with("elif ");
  if (block && text.ends_with(':')) return true;
  std::size_t end = 0;
  const auto in_target = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == ',' || c == ' ' || c == '.';
  };
  while (end < text.size() && in_target(text[end])) ++end;
  std::string_view rest = text.substr(end);
  if (end > 0 && rest.size() > 1 && std::string_view("+-*/").find(rest[0]) != std::string::npos) {
    rest.remove_prefix(1);
  }
  // A sentence has more words than a list of targets.
  const auto words = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), ' ');
  return end > 0 && words <= 4 && rest.starts_with('=') && !rest.starts_with("==");
}

// Returns true for text after an unclosed fence: a sentence, a list item, bold words.
bool LooksLikeProse(std::string_view line) {
  const std::string_view text = Trimmed(line);
  const LabelledLine labelled = ReadLabel(line);
  if ((labelled.item && labelled.number > 0) || text.starts_with("**")) return true;
  return std::count(text.begin(), text.end(), ' ') >= 3 &&
         text.find_first_of("=([{") == std::string_view::npos;
}

// Returns the number of brackets that `line` leaves open, ignoring strings and comments.
int OpenBrackets(std::string_view line) {
  int depth = 0;
  char quote = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quote != 0) {
      if (c == '\\') ++i;
      if (c == quote) quote = 0;
      continue;
    }
    if (c == '#') break;
    if (c == '"' || c == '\'') quote = c;
    if (c == '(' || c == '[' || c == '{') ++depth;
    if (c == ')' || c == ']' || c == '}') --depth;
  }
  return depth;
}

bool IsMark(Label label) {
  return label != Label::kNone && label != Label::kName && label != Label::kCode;
}

std::string Dedented(std::string_view line, int columns) {
  int column = 0;
  std::size_t at = 0;
  while (at < line.size() && column < columns && (line[at] == ' ' || line[at] == '\t')) {
    column = line[at] == '\t' ? (column / 8 + 1) * 8 : column + 1;
    ++at;
  }
  return std::string(line.substr(at));
}

// A single-pass reader of an answer's lines.
class OutlineReader {
 public:
  explicit OutlineReader(std::string_view answer) : lines_(LinesOf(answer)) {
    for (std::string& line : lines_) {  // quote marks of e-mail
      while (line.starts_with(">")) line.erase(0, line.starts_with("> ") ? 2 : 1);
    }
  }

  std::vector<OutlineEntry> Read() {
    while (at_ < lines_.size()) {
      const std::string& line = lines_[at_];
      if (const std::optional<std::string> info = FenceInfo(line)) {
        TakeFence(*info);
      } else if (BeginsCode()) {
        TakeBlock();
      } else {
        if (!IsBlank(line)) entries_.push_back({ReadLabel(line), "", "", ""});
        ++at_;
      }
    }
    for (OutlineEntry& entry : entries_) {
      if (!entry.program.empty()) entry.program = WithHelpers(entry.program, helpers_);
    }
    return std::move(entries_);
  }

 private:
  // Handles a fence. A fence with a language always opens a block, even if the previous one was
  // never closed.
  void TakeFence(const std::string& info) {
    const std::string lower = Lower(info);
    const std::size_t word = std::min(lower.find_first_of(" \t"), lower.size());
    const std::string code(Trimmed(std::string_view(info).substr(word)));
    if (BeginsFunction(info) || BeginsFunction(code)) {  // "```python def compute_reward(env):"
      lines_[at_] = BeginsFunction(info) ? info : code;
      fenced_ = true;
      return;
    }
    fenced_ = info.empty() ? !fenced_ : true;
    ++at_;
    if (fenced_ && (info.empty() || lower.starts_with("py"))) TakeBareStatements();
  }

  // Reads a fence of statements without a function; if they compute a reward, they are taken as a
  // program.
  void TakeBareStatements() {
    std::vector<std::string> block;
    bool reward = false;
    std::size_t end = at_;
    for (; end < lines_.size() && !FenceInfo(lines_[end]); ++end) {
      if (BeginsFunction(lines_[end]) || IsMark(ReadLabel(lines_[end]).label)) return;
      reward =
          reward || (LooksLikeStatement(lines_[end]) && Trimmed(lines_[end]).starts_with("reward"));
      block.push_back(lines_[end]);
    }
    if (!reward) return;
    AddPrograms(block);
    at_ = end;
  }

  bool BeginsCode() const {
    const std::string& line = lines_[at_];
    if (BeginsFunction(line)) return true;
    const bool before = IsImport(line) || (fenced_ && (line.starts_with("#") || IsConstant(line)));
    if (!before || IsMark(ReadLabel(line).label)) return false;
    for (std::size_t next = at_ + 1; next < lines_.size(); ++next) {
      const std::string& follows = lines_[next];
      if (BeginsFunction(follows)) return true;
      if (next > at_ + kMaxPreamble) return false;
      if (IsBlank(follows) || IsImport(follows)) continue;
      const bool part =
          follows.starts_with("#") || IsConstant(follows) || (fenced_ && Indentation(follows) > 0);
      if (!part || IsMark(ReadLabel(follows).label)) return false;
    }
    return false;
  }

  static bool IsConstant(std::string_view line) {
    return Indentation(line) == 0 && LooksLikeStatement(line) && !line.starts_with("return");
  }

  // Returns true if the line at `at` continues a block of code that begins at column `base`.
  bool ContinuesBlock(std::size_t at, int base, int open_brackets) const {
    const std::string& line = lines_[at];
    if (IsBlank(line) || BeginsFunction(line)) return true;
    const int indentation = Indentation(line);
    if (indentation > base) return true;
    if (IsMark(ReadLabel(line).label)) return false;
    if (open_brackets > 0) return true;
    if (indentation < base) return false;
    if (Trimmed(line).starts_with("#")) return fenced_;
    return IsImport(line) || LooksLikeStatement(line) || (fenced_ && !LooksLikeProse(line));
  }

  void TakeBlock() {
    const int base = Indentation(lines_[at_]);
    std::vector<std::string> block;
    int open_brackets = 0;
    bool closed = false;
    while (at_ < lines_.size() && !closed && !FenceInfo(lines_[at_])) {
      std::string line = lines_[at_];
      if (!ContinuesBlock(at_, base, open_brackets)) break;
      if (BeginsFunction(line)) open_brackets = 0;
      const std::size_t fence = line.rfind("```");
      if (fence != std::string::npos && IsBlank(std::string_view(line).substr(fence + 3))) {
        line.erase(fence);  // "return reward, success```"
        closed = true;
        fenced_ = false;
      }
      open_brackets = std::max(0, open_brackets + OpenBrackets(line));
      block.push_back(Dedented(line, base));
      ++at_;
    }
    if (fenced_ && at_ < lines_.size() && !FenceInfo(lines_[at_]).value_or("").empty()) {
      RestoreHeadings(&block);
    }
    while (!block.empty() && IsBlank(block.back())) block.pop_back();
    AddPrograms(block);
  }

  // Handles a fence that opens before this one was closed: comment-like lines right above it are
  // headings of the text, so they leave the block.
  void RestoreHeadings(std::vector<std::string>* block) {
    while (block->size() > 1 && (IsBlank(block->back()) || block->back().starts_with("#"))) {
      block->pop_back();
      --at_;
    }
    fenced_ = false;
  }

  void AddPrograms(const std::vector<std::string>& block) {
    BlockPrograms programs = SplitProgramBlock(block);
    for (ProgramPiece& piece : programs.programs) {
      entries_.push_back({{}, std::move(piece.text), piece.function, piece.title});
    }
    if (helpers_.size() < kMostHelpers) helpers_.merge(programs.helpers);
  }

  static constexpr std::size_t kMaxPreamble = 20;  // lines of preamble before a function
  static constexpr std::size_t kMostHelpers = 200;

  std::vector<std::string> lines_;
  std::size_t at_ = 0;
  bool fenced_ = false;
  std::vector<OutlineEntry> entries_;
  std::map<std::string, std::string> helpers_;
};

}  // namespace

std::vector<OutlineEntry> ReadOutline(std::string_view answer) {
  return OutlineReader(answer).Read();
}

}  // namespace simwright::tasks
