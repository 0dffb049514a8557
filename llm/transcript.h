#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "llm/chat_model.h"

namespace simwright::llm {

// A question and its answer in a transcript (format: docs/llm.md).
struct TranscriptEntry {
  int line = 0;         // line in the file, from 1
  std::string task;     // ChatRequest::task
  std::string model;    // the model that answered
  std::string request;  // CanonicalRequest
  ChatAnswer answer;
};

// Reads the entries in order. Throws core::Error, naming `where` and the line, if a line is
// damaged, the first line is not a transcript's, or a request does not match its hash.
std::vector<TranscriptEntry> ReadTranscript(std::string_view text, const std::string& where);

// Return the first line of a transcript, and the line of one entry; each ends in a line break.
std::string TranscriptHead();
std::string TranscriptLine(const TranscriptEntry& entry);

// Records another model's answers. The file is complete after each answer; it is created with the
// first one, so that a run without answers leaves nothing.
class RecordingChatModel final : public ChatModel {
 public:
  // Throws core::Error if `file` exists and must not be replaced, or its folder is missing.
  RecordingChatModel(std::unique_ptr<ChatModel> inner, const std::filesystem::path& file,
                     bool replace);

  ChatAnswer Ask(const ChatRequest& request, core::Progress* progress = nullptr) override;
  std::string name() const override { return inner_->name(); }
  Usage usage() const override { return inner_->usage(); }
  core::Findings TakeFindings() override { return inner_->TakeFindings(); }

 private:
  std::unique_ptr<ChatModel> inner_;
  std::filesystem::path file_;
  std::string text_;
};

// Replays a transcript, without network. Several answers to one request are returned in the order
// of recording. For a request that the transcript lacks, or that is repeated more often than
// recorded, throws a core::Error that names it and the nearest recorded one.
class ReplayChatModel final : public ChatModel {
 public:
  // Throws core::Error if the file cannot be read (see ReadTranscript).
  explicit ReplayChatModel(const std::filesystem::path& file);

  ChatAnswer Ask(const ChatRequest& request, core::Progress* progress = nullptr) override;
  // Returns the first entry's model; empty if there is none.
  std::string name() const override { return entries_.empty() ? "" : entries_[0].model; }
  Usage usage() const override { return usage_; }
  core::Findings TakeFindings() override { return {}; }

 private:
  // Describes the nearest recorded request, for a request without an answer.
  std::string Nearest(const ChatRequest& request) const;

  std::filesystem::path file_;
  std::vector<TranscriptEntry> entries_;
  std::map<std::string, std::vector<std::size_t>> of_request_;  // canonical -> entries in order
  std::map<std::string, std::size_t> given_;                    // canonical -> number of answers
                                                                // returned
  Usage usage_;
};

}  // namespace simwright::llm
