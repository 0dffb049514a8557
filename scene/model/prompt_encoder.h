#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "scene/model/text_encoder.h"
#include "scene/model/word_pieces.h"

namespace simwright::scene {

// A frozen text encoder of the user's: a TorchScript module with the method
//   forward(pieces: int64 (B x L), mask: int64 (B x L), 1 for pieces, 0 for padding)
//     -> float (B x L x D), or a tuple or dict ("last_hidden_state") that begins with it,
// such as a traced BERT, and FILE.vocab.txt or vocab.txt beside it, its word pieces line by line.
// Thread-safe.
class ExternalTextEncoder {
 public:
  // Throws core::Error if the module or its vocabulary is missing or malformed, or its output for a
  // short text has another shape or is not finite.
  explicit ExternalTextEncoder(const std::filesystem::path& file);
  ~ExternalTextEncoder();

  const WordPieces& pieces() const { return pieces_; }
  int features() const { return features_; }         // D
  const std::string& hash() const { return hash_; }  // of the module's file

  // Returns the features (B x L x D) of word pieces (B x L) on the CPU. Throws core::Error as the
  // constructor does.
  torch::Tensor Features(const torch::Tensor& pieces, const torch::Tensor& mask) const;

 private:
  struct Script;
  std::filesystem::path file_;
  std::unique_ptr<Script> script_;
  WordPieces pieces_;
  std::string hash_;
  int features_ = 0;
};

// Returns the prompts as word pieces, padded to the longest of them: at most `most` pieces each.
TextInput PiecesOf(const std::vector<std::string>& prompts, const WordPieces& pieces, int most);

// Returns the prompts as the input of a denoiser: word pieces, or, if `encoder` is not null, its
// features.
TextInput TextInputOf(const std::vector<std::string>& prompts, const WordPieces& pieces, int most,
                      const ExternalTextEncoder* encoder);

}  // namespace simwright::scene
