#include "tasks/language/program_blocks.h"

#include <algorithm>
#include <set>

#include "tasks/language/answer_text.h"

namespace simwright::tasks {
namespace {

constexpr std::size_t kLongestBlockTitle = 80;     // bytes; a longer text is an explanation
constexpr std::size_t kMostFunctions = 200;        // per block; later functions stay with the last
                                                   // chunk
constexpr std::size_t kLongestProgram = 64 << 10;  // bytes; the compiler rejects longer ones

bool IsNameByte(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

// Returns the name that "def name(" defines; empty if the line defines none.
std::string DefinedName(std::string_view line) {
  line = Trimmed(line);
  if (line.starts_with("async ")) line = Trimmed(line.substr(6));
  if (!line.starts_with("def ")) return "";
  line = Trimmed(line.substr(4));
  std::size_t end = 0;
  while (end < line.size() && IsNameByte(line[end])) ++end;
  const std::string_view rest = Trimmed(line.substr(end));
  return end > 0 && rest.starts_with('(') ? std::string(line.substr(0, end)) : "";
}

struct Chunk {
  std::string title, function, text;
};

// The lines split into functions at the outer level; the lines before the first one are the
// preamble.
struct CutProgram {
  std::string preamble;
  std::vector<Chunk> chunks;
};

std::string TitleIn(const std::vector<std::string>& comments) {
  for (const std::string& comment : comments) {
    std::string_view text = Trimmed(comment);
    while (text.starts_with('#') || text.starts_with('=') || text.starts_with('-')) {
      text = Trimmed(text.substr(1));
    }
    while (text.ends_with('#') || text.ends_with('=') || text.ends_with('-') ||
           text.ends_with(':')) {
      text.remove_suffix(1);
      text = Trimmed(text);
    }
    if (!text.empty() && text.size() <= kLongestBlockTitle) return std::string(text);
  }
  return "";
}

CutProgram CutIntoFunctions(const std::vector<std::string>& lines) {
  CutProgram cut;
  std::vector<std::string> waiting;  // comments and decorators that may belong to the next function
  std::vector<std::string> comments;
  const auto flush = [&](std::string* to) {
    for (const std::string& line : waiting) *to += line + "\n";
    waiting.clear();
    comments.clear();
  };
  for (const std::string& line : lines) {
    const bool outer = Indentation(line) == 0 && !line.empty();
    const bool room = cut.chunks.size() < kMostFunctions;
    const std::string name = outer && room ? DefinedName(line) : "";
    if (!name.empty()) {
      Chunk chunk{TitleIn(comments), name, ""};
      flush(&chunk.text);
      chunk.text += line + "\n";
      cut.chunks.push_back(std::move(chunk));
    } else if (outer && (line[0] == '#' || line[0] == '@')) {
      waiting.push_back(line);
      if (line[0] == '#') comments.push_back(line);
    } else {
      std::string* open = cut.chunks.empty() ? &cut.preamble : &cut.chunks.back().text;
      flush(open);
      *open += line + "\n";
    }
  }
  flush(cut.chunks.empty() ? &cut.preamble : &cut.chunks.back().text);
  return cut;
}

std::string WithoutBlankEnd(std::string text) {
  while (text.ends_with("\n\n")) text.pop_back();
  return text;
}

// Returns the end of the expression that begins at `at`: the end of its line, continued by open
// brackets and backslashes.
std::size_t ExpressionEnd(std::string_view text, std::size_t at) {
  int depth = 0;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '(' || c == '[' || c == '{') ++depth;
    if (c == ')' || c == ']' || c == '}') --depth;
    const bool joined = at > 0 && text[at - 1] == '\\';
    if (c == '#' || (c == '\n' && depth <= 0 && !joined)) break;
  }
  return at;
}

// Returns `text` on one line with runs of white space joined.
std::string OneLine(std::string_view text) {
  std::string line;
  for (const char c : Trimmed(text)) {
    const bool blank = c == ' ' || c == '\t' || c == '\n' || c == '\\';
    if (!blank) {
      line += c;
    } else if (!line.empty() && line.back() != ' ') {
      line += ' ';
    }
  }
  return line;
}

// Returns the text after the outer-level comma of "reward, success"; empty if there is none.
std::string_view SecondOf(std::string_view returned) {
  returned = Trimmed(returned);
  if (returned.starts_with('(') && returned.ends_with(')')) {
    returned = returned.substr(1, returned.size() - 2);
  }
  int depth = 0;
  for (std::size_t i = 0; i < returned.size(); ++i) {
    const char c = returned[i];
    if (c == '(' || c == '[' || c == '{') ++depth;
    if (c == ')' || c == ']' || c == '}') --depth;
    if (c == ',' && depth == 0) return Trimmed(returned.substr(i + 1));
  }
  return {};
}

}  // namespace

bool BeginsFunction(std::string_view line) {
  line = Trimmed(line);
  if (line.size() > 1 && line[0] == '@' && IsNameByte(line[1])) {
    return line.find(' ') == std::string_view::npos;
  }
  return !DefinedName(line).empty();
}

bool IsImport(std::string_view line) {
  line = Trimmed(line);
  const bool from = line.starts_with("from ") && line.find(" import ") != std::string_view::npos;
  return from || (line.starts_with("import ") && line.size() > 7 && IsNameByte(line[7]));
}

BlockPrograms SplitProgramBlock(const std::vector<std::string>& lines) {
  const CutProgram cut = CutIntoFunctions(lines);
  BlockPrograms block;
  std::vector<const Chunk*> rewards;
  for (const Chunk& chunk : cut.chunks) {
    const bool called = std::any_of(cut.chunks.begin(), cut.chunks.end(), [&](const Chunk& other) {
      return other.function != chunk.function && Calls(other.text, chunk.function);
    });
    if (called) {
      block.helpers[chunk.function] = WithoutBlankEnd(chunk.text);
    } else {
      rewards.push_back(&chunk);
    }
  }
  if (rewards.size() <= 1) {
    std::string whole;
    for (const std::string& line : lines) whole += line + "\n";
    whole = WithoutBlankEnd(std::move(whole));
    std::string name = rewards.empty() ? "" : rewards[0]->function;
    for (std::size_t i = 0; name.empty() && i < lines.size(); ++i) name = DefinedName(lines[i]);
    const std::string title = rewards.empty() ? "" : rewards[0]->title;
    block.programs.push_back({title, name, std::move(whole)});
    return block;
  }
  for (const Chunk* chunk : rewards) {
    const std::string own = WithHelpers(WithoutBlankEnd(chunk->text), block.helpers);
    block.programs.push_back({chunk->title, chunk->function, cut.preamble + own});
  }
  return block;
}

std::string WithHelpers(const std::string& program,
                        const std::map<std::string, std::string>& helpers) {
  std::string whole = program;
  std::set<std::string> added;
  for (bool again = true; again;) {  // helpers may call further helpers
    again = false;
    for (const auto& [name, text] : helpers) {
      if (whole.size() + text.size() > kLongestProgram) continue;
      if (added.contains(name) || !Calls(whole, name)) continue;
      if (whole.find("def " + name + "(") != std::string::npos) continue;
      whole = text + "\n" + whole;
      again = added.insert(name).second;
    }
  }
  return whole;
}

std::string SuccessExpression(std::string_view program) {
  const std::size_t at = program.rfind("return ");
  if (at == std::string_view::npos) return "";
  const std::size_t begin = at + 7;
  const std::string_view second =
      SecondOf(program.substr(begin, ExpressionEnd(program, begin) - begin));
  const bool name = !second.empty() && std::all_of(second.begin(), second.end(), IsNameByte);
  if (!name) return second.starts_with('{') ? "" : OneLine(second);
  std::string_view before = program.substr(0, at);
  for (std::size_t found = before.rfind(second); found != std::string_view::npos && found > 0;
       found = before.substr(0, found).rfind(second)) {
    const std::size_t line = before.rfind('\n', found);
    const std::size_t start = line == std::string_view::npos ? 0 : line + 1;
    const std::string_view rest = Trimmed(before.substr(found + second.size()));
    const bool assigned = rest.starts_with('=') && !rest.starts_with("==");
    if (assigned && Trimmed(before.substr(start, found - start)).empty()) {
      const std::size_t from = before.find('=', found) + 1;
      return OneLine(before.substr(from, ExpressionEnd(before, from) - from));
    }
  }
  return "";
}

}  // namespace simwright::tasks
