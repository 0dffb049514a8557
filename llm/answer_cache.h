#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "llm/chat_model.h"

namespace simwright::llm {

// Keeps the answers of another model in a folder, one file a request, so that an equal request of
// the same model (ChatModel::name, `identity`) is sent once. Files are written beside and renamed
// in; several programs may share a folder. A damaged entry is asked anew and replaced, with the
// finding "llm-cache-damaged". Answers that are empty or were cut off by max_tokens are not kept.
class CachingChatModel final : public ChatModel {
 public:
  // `identity` tells models of the same name apart, e.g. the address of a server whose only model
  // has none; no secret. Throws core::Error when the folder cannot be made.
  CachingChatModel(std::unique_ptr<ChatModel> inner, const std::filesystem::path& folder,
                   const std::string& identity);

  ChatAnswer Ask(const ChatRequest& request, core::Progress* progress = nullptr) override;
  std::string name() const override { return inner_->name(); }
  Usage usage() const override;
  core::Findings TakeFindings() override;

 private:
  bool Read(const std::filesystem::path& file, const std::string& content, ChatAnswer* answer);
  void Write(const std::filesystem::path& file, const std::string& content,
             const ChatAnswer& answer);

  std::unique_ptr<ChatModel> inner_;
  std::filesystem::path folder_;
  std::string identity_;
  std::int64_t hits_ = 0;
  core::Findings findings_;
};

}  // namespace simwright::llm
