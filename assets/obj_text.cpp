#include "assets/obj_text.h"

#include <algorithm>
#include <cstdlib>
#include <map>

namespace simwright::assets {
namespace {

bool IsObjSpace(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v';
}

std::string_view TakeObjWord(std::string_view* rest) {
  while (!rest->empty() && IsObjSpace(rest->front())) rest->remove_prefix(1);
  size_t end = 0;
  while (end < rest->size() && !IsObjSpace((*rest)[end])) ++end;
  const std::string_view word = rest->substr(0, end);
  rest->remove_prefix(end);
  return word;
}

std::string TrimmedObjLine(std::string_view text) {
  while (!text.empty() && IsObjSpace(text.front())) text.remove_prefix(1);
  while (!text.empty() && IsObjSpace(text.back())) text.remove_suffix(1);
  return std::string(text);
}

// Reads the next statement: a line, joined with the following lines while it ends in a backslash.
class Statements {
 public:
  explicit Statements(std::string_view text) : rest_(text) {}
  bool Next(std::string_view* statement) {
    if (rest_.empty()) return false;
    joined_.clear();
    for (;;) {
      const size_t end = std::min(rest_.find('\n'), rest_.size());
      std::string_view line = rest_.substr(0, end);
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      while (!line.empty() && line.back() == '\r') line.remove_suffix(1);
      const bool continues = !line.empty() && line.back() == '\\' && !rest_.empty();
      if (!continues && joined_.empty()) {
        *statement = line;
        return true;
      }
      if (continues) line.remove_suffix(1);
      joined_.append(line);
      joined_.push_back(' ');
      if (!continues) break;
    }
    *statement = joined_;
    return true;
  }

 private:
  std::string_view rest_;
  std::string joined_;
};

std::vector<std::string_view> Words(std::string_view rest, size_t most) {
  std::vector<std::string_view> words;
  while (words.size() < most) {
    const std::string_view word = TakeObjWord(&rest);
    if (word.empty() || word.starts_with('#')) break;
    words.push_back(word);
  }
  return words;
}

bool IsSurfaceKeyword(std::string_view keyword) {
  static constexpr std::string_view kKeywords[] = {"cstype", "curv", "curv2", "surf", "vp"};
  return std::find(std::begin(kKeywords), std::end(kKeywords), keyword) != std::end(kKeywords);
}

class Rewriter {
 public:
  explicit Rewriter(std::string_view text) : text_(text) {
    if (text_.starts_with("\xef\xbb\xbf")) text_.remove_prefix(3);
  }

  PreparedObj Rewrite() {
    FindColors();
    result_.text.reserve(text_.size() + 64);
    // Assimp reads this name through the caller, who provides it.
    result_.text += "mtllib materials.mtl\n";
    Statements statements(text_);
    for (std::string_view statement; statements.Next(&statement);) Add(statement);
    return std::move(result_);
  }

 private:
  void FindColors();
  void Add(std::string_view statement);
  void AddVertex(std::string_view rest);
  void Append(std::string_view keyword, std::string_view rest) {
    result_.text.append(keyword).push_back(' ');
    result_.text.append(rest).push_back('\n');
  }

  std::string_view text_;
  PreparedObj result_;
  std::map<std::string, int, std::less<>> material_index_;
};

void Rewriter::FindColors() {
  Statements statements(text_);
  for (std::string_view statement; statements.Next(&statement);) {
    if (TakeObjWord(&statement) != "v") continue;
    const std::vector<std::string_view> words = Words(statement, 7);
    if (words.size() < 6) continue;
    result_.has_colors = true;
    for (size_t k = 3; k < 6; ++k) {
      if (std::strtod(std::string(words[k]).c_str(), nullptr) > 1.0) result_.colors_in_bytes = true;
    }
    if (result_.colors_in_bytes) return;
  }
}

void Rewriter::AddVertex(std::string_view rest) {
  const std::vector<std::string_view> words = Words(rest, 7);
  result_.text += "v";
  // A fourth number alone is a rational curve's weight, not part of the position.
  const size_t positions = std::min<size_t>(3, words.size());
  for (size_t k = 0; k < positions; ++k) result_.text.append(" ").append(words[k]);
  if (result_.has_colors) {
    for (size_t k = 3; k < 6; ++k) {
      result_.text += ' ';
      if (words.size() < 6) {
        result_.text += result_.colors_in_bytes ? "255" : "1";
      } else {
        result_.text.append(words[k]);
      }
    }
  }
  result_.text += '\n';
}

void Rewriter::Add(std::string_view statement) {
  std::string_view rest = statement;
  const std::string_view keyword = TakeObjWord(&rest);
  if (keyword.empty() || keyword.starts_with('#')) return;
  if (keyword == "v") {
    AddVertex(rest);
  } else if (keyword == "mtllib") {
    result_.libraries.push_back(TrimmedObjLine(rest));
  } else if (keyword == "usemtl") {
    const std::string name = TrimmedObjLine(rest);
    const auto [entry, fresh] =
        material_index_.try_emplace(name, static_cast<int>(result_.materials.size()));
    if (fresh) result_.materials.push_back(name);
    Append("usemtl", "m" + std::to_string(entry->second));
  } else if (keyword == "f" || keyword == "fo") {
    if (Words(rest, 3).size() >= 3) Append("f", rest.substr(0, rest.find('#')));
  } else if (keyword == "vt" || keyword == "vn" || keyword == "o" || keyword == "g" ||
             keyword == "s") {
    Append(keyword, TrimmedObjLine(rest));
  } else if (IsSurfaceKeyword(keyword)) {
    result_.has_surfaces = true;
  }
  // Points, lines and statements that affect only rendering are dropped.
}

}  // namespace

PreparedObj PrepareObj(std::string_view text) {
  return Rewriter(text).Rewrite();
}

}  // namespace simwright::assets
