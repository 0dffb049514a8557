#include "scene/prompt/prompt_words.h"

#include <cstdint>

#include "core/error.h"
#include "core/finding_text.h"
#include "scene/prompt/prompt_reading.h"

namespace simwright::scene {
namespace {

constexpr size_t kLongestWord = 100;  // bytes

bool IsDigit(char c) {
  return c >= '0' && c <= '9';
}

// Returns the length of the UTF-8 character at `at`, 0 for an invalid one; `code` is its code
// point.
size_t CharacterAt(std::string_view text, size_t at, std::uint32_t* code) {
  const auto byte = [&](size_t i) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i]));
  };
  const std::uint32_t first = byte(at);
  *code = first;
  if (first < 0x80) return 1;
  const size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || at + length > text.size()) return 0;
  *code = first & (0x7fu >> length);
  for (size_t i = 1; i < length; ++i) {
    if ((byte(at + i) & 0xc0) != 0x80) return 0;
    *code = (*code << 6) | (byte(at + i) & 0x3f);
  }
  constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = *code >= 0xd800 && *code < 0xe000;
  return *code < kLeast[length] || *code > 0x10ffff || surrogate ? 0 : length;
}

// Collects the words of a text.
class WordSplitter {
 public:
  void Add(std::string_view character, std::uint32_t code, bool digit_follows) {
    const char c = code < 0x80 ? static_cast<char>(code) : '\0';
    if (code == '\'' || code == 0x2019) {
      word_ += '\'';
    } else if ((c == '.' || c == ',') && !word_.empty() && IsDigit(word_.back()) && digit_follows) {
      word_ += c;
    } else if (c == '-' && word_.empty() && digit_follows) {
      word_ = "-";
    } else if (c == '_') {
      End(true);
    } else if (IsMark(code)) {
      End(false);
      const bool comma = c == ',' || c == ':' || c == '(' || c == ')' || c == '[' || c == ']' ||
                         c == '/' || code == 0x2013 || code == 0x2014;
      words_.push_back({comma ? "," : "."});
    } else if (c == '&' || c == '+') {
      End(false);
      words_.push_back({"and"});
    } else if (IsBlank(code)) {
      End(false);
    } else if (c >= 'A' && c <= 'Z') {
      word_ += static_cast<char>(c - 'A' + 'a');
    } else {
      word_ += character;
    }
    if (word_.size() > kLongestWord) {
      throw core::Error("a word has more than " + std::to_string(kLongestWord) + " bytes",
                        core::Truncated(word_, 40), "write words of a language");
    }
  }

  std::vector<PromptWord> Finish() {
    End(false);
    return std::move(words_);
  }

 private:
  static bool IsMark(std::uint32_t code) {
    static constexpr std::string_view kMarks = ".,;:!?()[]/";
    return (code < 0x80 && kMarks.find(static_cast<char>(code)) != std::string_view::npos) ||
           code == 0x2013 || code == 0x2014;
  }

  // Returns true for blanks, quotes and all other ASCII characters that are no letter or digit.
  static bool IsBlank(std::uint32_t code) {
    if (code >= 0x80) {
      return code == 0xa0 || code == 0xab || code == 0xbb || code == 0xfeff ||
             (code >= 0x2000 && code <= 0x206f);
    }
    const char c = static_cast<char>(code);
    return !IsDigit(c) && !(c >= 'a' && c <= 'z') && !(c >= 'A' && c <= 'Z');
  }

  void End(bool before_suffix) {
    std::string word = std::move(word_);
    word_.clear();
    const bool number = !word.empty() && word.find_first_not_of("0123456789") == std::string::npos;
    if (number && after_underscore_) word.clear();  // of "apple_2"
    after_underscore_ = before_suffix;
    if (word.ends_with("n't")) word = "not";
    for (const char* ending : {"'s", "'d", "'ll", "'ve", "'re", "'m"}) {
      if (word.ends_with(ending)) word.resize(word.rfind('\''));
    }
    std::erase(word, '\'');
    if (word.empty()) return;
    words_.push_back({word});
    if (++count_ > kMostPromptWords) {
      throw core::Error("the prompt has more than " + std::to_string(kMostPromptWords) + " words",
                        "", "name the objects in a few sentences");
    }
  }

  std::vector<PromptWord> words_;
  std::string word_;
  bool after_underscore_ = false;
  int count_ = 0;
};

}  // namespace

std::vector<PromptWord> SplitPrompt(std::string_view text) {
  WordSplitter splitter;
  for (size_t at = 0; at < text.size();) {
    std::uint32_t code = 0;
    const size_t length = CharacterAt(text, at, &code);
    if (length == 0) {
      throw core::Error("the prompt is not valid UTF-8 at byte " + std::to_string(at), "",
                        "save it as UTF-8");
    }
    const bool blank = code == '\t' || code == '\n' || code == '\r';
    if ((code < 0x20 && !blank) || (code >= 0x7f && code < 0xa0)) {
      throw core::Error("the prompt has a control character at byte " + std::to_string(at), "",
                        "write plain text");
    }
    const bool digit_follows = at + length < text.size() && IsDigit(text[at + length]);
    splitter.Add(text.substr(at, length), code, digit_follows);
    at += length;
  }
  return splitter.Finish();
}

std::string JoinWords(const std::vector<PromptWord>& words, size_t first, size_t last) {
  std::string joined;
  for (size_t i = first; i < last; ++i) joined += (i > first ? " " : "") + words[i].text;
  return joined;
}

}  // namespace simwright::scene
