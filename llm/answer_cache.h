#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "llm/chat_model.h"

namespace simwright::llm {

// Caches another model's answers in a folder, one file per request, so that equal requests to the
// same model (ChatModel::name, `identity`) are sent once. Files are written beside and renamed into
// place; several programs may share a folder. A damaged entry is requested again and replaced, with
// the finding "llm-cache-damaged". Empty answers and those cut off by max_tokens are not cached.
class CachingChatModel final : public ChatModel {
 public:
  // `identity` distinguishes models of the same name, e.g. by the address of a server whose only
  // model has no name; it holds no secret. Throws core::Error if the folder cannot be created.
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
