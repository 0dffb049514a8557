#include "scene/model/word_pieces.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "core/error.h"
#include "core/files.h"

namespace simwright::scene {
namespace {

constexpr char kPad[] = "[PAD]", kUnknown[] = "[UNK]", kFirst[] = "[CLS]", kLast[] = "[SEP]";
constexpr char kContinues[] = "##";
constexpr size_t kLongestWord = 100;  // bytes, as in BERT's tokenizer

bool IsSpace(char c) {
  return std::isspace(static_cast<unsigned char>(c)) || std::iscntrl(static_cast<unsigned char>(c));
}

std::vector<std::string> WordsOf(std::string_view text) {
  std::vector<std::string> words;
  std::string word;
  const auto finish = [&] {
    if (!word.empty()) words.push_back(std::move(word));
    word.clear();
  };
  for (const char c : text) {
    if (IsSpace(c)) {
      finish();
    } else if (std::ispunct(static_cast<unsigned char>(c))) {
      finish();
      words.emplace_back(1, c);
    } else {
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  finish();
  return words;
}

// Returns the UTF-8 characters of a word.
std::vector<std::string> CharactersOf(const std::string& word) {
  std::vector<std::string> characters;
  for (const char c : word) {
    const bool continues = (static_cast<unsigned char>(c) & 0xC0) == 0x80;
    if (continues && !characters.empty()) {
      characters.back() += c;
    } else {
      characters.emplace_back(1, c);
    }
  }
  return characters;
}

// A distinct word of a corpus as its current pieces.
struct SplitWord {
  std::vector<std::string> pieces;
  long count = 0;
};

std::vector<SplitWord> SplitWordsOf(const std::vector<std::string>& texts) {
  std::map<std::string, long> counts;
  for (const std::string& text : texts) {
    for (std::string& word : WordsOf(text)) ++counts[std::move(word)];
  }
  std::vector<SplitWord> words;
  for (const auto& [word, count] : counts) {
    SplitWord split{CharactersOf(word), count};
    for (size_t i = 1; i < split.pieces.size(); ++i) {
      split.pieces[i].insert(0, kContinues);
    }
    words.push_back(std::move(split));
  }
  return words;
}

std::string Merged(const std::string& left, const std::string& right) {
  return left + right.substr(sizeof kContinues - 1);
}

// Merges the most frequent pair of neighbours everywhere; returns its piece, or none if no word has
// two pieces.
std::string MergeMostFrequent(std::vector<SplitWord>* words) {
  std::map<std::pair<std::string, std::string>, long> counts;
  for (const SplitWord& word : *words) {
    for (size_t i = 0; i + 1 < word.pieces.size(); ++i) {
      counts[{word.pieces[i], word.pieces[i + 1]}] += word.count;
    }
  }
  if (counts.empty()) return "";
  const auto best =
      std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) {
        return a.second < b.second;
      })->first;
  const std::string merged = Merged(best.first, best.second);
  for (SplitWord& word : *words) {
    std::vector<std::string> pieces;
    for (size_t i = 0; i < word.pieces.size(); ++i) {
      const bool here = i + 1 < word.pieces.size() && word.pieces[i] == best.first &&
                        word.pieces[i + 1] == best.second;
      pieces.push_back(here ? merged : word.pieces[i]);
      if (here) ++i;
    }
    word.pieces = std::move(pieces);
  }
  return merged;
}

}  // namespace

WordPieces::WordPieces(std::vector<std::string> pieces) : pieces_(std::move(pieces)) {
  for (size_t i = 0; i < pieces_.size(); ++i) {
    if (pieces_[i].empty())
      throw core::Error("a word piece is empty", "piece " + std::to_string(i));
    if (!ids_.emplace(pieces_[i], static_cast<int>(i)).second) {
      throw core::Error("a word piece occurs twice", pieces_[i]);
    }
  }
  const auto special = [&](const char* piece) {
    const int id = IdOf(piece);
    if (id < 0) throw core::Error("the vocabulary lacks a special piece", piece);
    return id;
  };
  pad_ = special(kPad);
  unknown_ = special(kUnknown);
  first_ = special(kFirst);
  last_ = special(kLast);
}

WordPieces WordPieces::Learn(const std::vector<std::string>& texts, int size) {
  std::vector<SplitWord> words = SplitWordsOf(texts);
  std::set<std::string> characters;
  for (const SplitWord& word : words) characters.insert(word.pieces.begin(), word.pieces.end());
  std::vector<std::string> pieces = {kPad, kUnknown, kFirst, kLast};
  pieces.insert(pieces.end(), characters.begin(), characters.end());
  if (pieces.size() > static_cast<size_t>(std::max(0, size))) {
    throw core::Error("the texts have more characters than the vocabulary has pieces",
                      std::to_string(size), "at least " + std::to_string(pieces.size()));
  }
  std::set<std::string> known(pieces.begin(), pieces.end());
  while (pieces.size() < static_cast<size_t>(size)) {
    const std::string merged = MergeMostFrequent(&words);
    if (merged.empty()) break;
    if (known.insert(merged).second) pieces.push_back(merged);
  }
  return WordPieces(std::move(pieces));
}

WordPieces WordPieces::Read(const std::filesystem::path& file) {
  const std::string text = core::ReadFile(file);
  std::vector<std::string> pieces;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size());
    std::string piece = text.substr(at, end - at);
    if (!piece.empty() && piece.back() == '\r') piece.pop_back();
    pieces.push_back(std::move(piece));
    at = end + 1;
  }
  try {
    return WordPieces(std::move(pieces));
  } catch (const core::Error& error) {
    throw core::Error(std::string("this is no vocabulary of word pieces: ") + error.what(),
                      file.string(), "write one piece per line, as BERT's vocab.txt");
  }
}

int WordPieces::IdOf(const std::string& piece) const {
  const auto found = ids_.find(piece);
  return found == ids_.end() ? -1 : found->second;
}

void WordPieces::EncodeWord(std::string_view word, std::vector<int>* ids) const {
  const size_t before = ids->size();
  std::string piece;
  for (size_t at = 0; at < word.size() && word.size() <= kLongestWord;) {
    int id = -1;
    size_t length = word.size() - at;
    for (; length > 0 && id < 0; --length) {
      piece.assign(at > 0 ? kContinues : "").append(word.substr(at, length));
      id = IdOf(piece);
      if (id >= 0) break;
    }
    if (id < 0) break;
    ids->push_back(id);
    at += length;
    if (at == word.size()) return;
  }
  ids->resize(before);
  ids->push_back(unknown_);
}

std::vector<int> WordPieces::Encode(std::string_view text, int most) const {
  std::vector<int> ids = {first_};
  const size_t room = static_cast<size_t>(std::max(2, most)) - 1;
  for (const std::string& word : WordsOf(text)) {
    EncodeWord(word, &ids);
    if (ids.size() >= room) break;
  }
  ids.resize(std::min(ids.size(), room));
  ids.push_back(last_);
  return ids;
}

}  // namespace simwright::scene
