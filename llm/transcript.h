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

// One question and its answer in a transcript (docs/llm.md has the format).
struct TranscriptEntry {
  int line = 0;         // in the file, from 1
  std::string task;     // ChatRequest::task
  std::string model;    // that answered
  std::string request;  // CanonicalRequest
  ChatAnswer answer;
};

// The entries in order. Throws core::Error, naming `where` and the line, where a line is damaged,
// the first one is no transcript's, or a request does not fit its hash.
std::vector<TranscriptEntry> ReadTranscript(std::string_view text, const std::string& where);

// The first line of a transcript, and one line for one entry; each ends in a line break.
std::string TranscriptHead();
std::string TranscriptLine(const TranscriptEntry& entry);

// Writes down what another model answers. The file is whole after each answer; it appears with the
// first, so that a run that got none leaves nothing.
class RecordingChatModel final : public ChatModel {
 public:
  // Throws core::Error when `file` exists and may not be replaced, or has no folder.
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

// Answers from a transcript, without network. Several answers to one request come in the order
// they were recorded. A request that the transcript lacks, or asks for once more than it was
// recorded, is a core::Error that names it and the nearest recorded one.
class ReplayChatModel final : public ChatModel {
 public:
  // Throws core::Error where the file cannot be read (see ReadTranscript).
  explicit ReplayChatModel(const std::filesystem::path& file);

  ChatAnswer Ask(const ChatRequest& request, core::Progress* progress = nullptr) override;
  // That of the first entry; empty where there is none.
  std::string name() const override { return entries_.empty() ? "" : entries_[0].model; }
  Usage usage() const override { return usage_; }
  core::Findings TakeFindings() override { return {}; }

 private:
  // For a request without an answer: what else there is.
  std::string Nearest(const ChatRequest& request) const;

  std::filesystem::path file_;
  std::vector<TranscriptEntry> entries_;
  std::map<std::string, std::vector<std::size_t>> of_request_;  // canonical -> entries in order
  std::map<std::string, std::size_t> given_;                    // canonical -> answers handed out
  Usage usage_;
};

}  // namespace simwright::llm
