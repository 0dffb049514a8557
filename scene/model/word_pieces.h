#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace simwright::scene {

// A vocabulary of word pieces and the tokenizer of BERT (Devlin et al. 2019, uncased): a text is
// lower-cased and split at spaces and around punctuation; each word is the sequence of the longest
// pieces that match from its beginning, where "##" marks a piece that continues a word. A word that
// no pieces spell is "[UNK]".
class WordPieces {
 public:
  // Takes the pieces in the order of their ids. Throws core::Error if one is empty or occurs twice,
  // or "[PAD]", "[UNK]", "[CLS]" or "[SEP]" is missing.
  explicit WordPieces(std::vector<std::string> pieces);

  // Learns at most `size` pieces: the special ones, the characters of the texts, and merged pieces
  // in the order of their frequency (byte-pair encoding, Sennrich et al. 2016). Deterministic.
  // Throws core::Error if the characters alone exceed `size`.
  static WordPieces Learn(const std::vector<std::string>& texts, int size);
  // Reads a vocabulary with one piece per line, as BERT's vocab.txt. Throws core::Error if the file
  // is missing or is no vocabulary.
  static WordPieces Read(const std::filesystem::path& file);

  const std::vector<std::string>& pieces() const { return pieces_; }
  int size() const { return static_cast<int>(pieces_.size()); }
  int pad() const { return pad_; }

  // Returns "[CLS]", the ids of the text's pieces, "[SEP]": at most `most` ids, >= 2; pieces beyond
  // are cut off.
  std::vector<int> Encode(std::string_view text, int most) const;

 private:
  int IdOf(const std::string& piece) const;  // -1: there is none
  void EncodeWord(std::string_view word, std::vector<int>* ids) const;

  std::vector<std::string> pieces_;
  std::unordered_map<std::string, int> ids_;
  int pad_ = 0, unknown_ = 0, first_ = 0, last_ = 0;
};

}  // namespace simwright::scene
