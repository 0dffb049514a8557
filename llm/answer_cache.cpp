#include "llm/answer_cache.h"

#include <cstdint>
#include <utility>

#include "core/content_hash.h"
#include "core/error.h"
#include "core/files.h"
#include "core/json.h"
#include "llm/answer_json.h"
#include "llm/request_key.h"

namespace simwright::llm {
namespace {
namespace fs = std::filesystem;

constexpr std::uint64_t kLargestEntry = 64u << 20;  // bytes

}  // namespace

CachingChatModel::CachingChatModel(std::unique_ptr<ChatModel> inner, const fs::path& folder,
                                   const std::string& identity)
    : inner_(std::move(inner)), folder_(folder), identity_(identity) {
  std::error_code code;
  fs::create_directories(folder_, code);
  if (!fs::is_directory(folder_, code)) {
    throw core::Error("the cache folder cannot be created", folder_.string(),
                      "check that the place exists and may be written");
  }
}

ChatAnswer CachingChatModel::Ask(const ChatRequest& request, core::Progress* progress) {
  RequireValid(request);
  const core::Json content = {
      {"model", inner_->name()}, {"server", identity_}, {"request", CanonicalRequest(request)}};
  const std::string text = core::JsonLine(content, core::InvalidUtf8::kReplace);
  const fs::path file = folder_ / (core::ContentHash(text) + ".json");
  ChatAnswer answer;
  if (Read(file, text, &answer)) {
    ++hits_;
    return answer;
  }
  answer = inner_->Ask(request, progress);
  if (!answer.text.empty() && answer.finish_reason != "length") Write(file, text, answer);
  return answer;
}

bool CachingChatModel::Read(const fs::path& file, const std::string& content, ChatAnswer* answer) {
  std::error_code code;
  if (!fs::exists(file, code)) return false;
  std::string fault = "is not a cache entry";
  try {
    const core::Json json = core::ParseJson(core::ReadFile(file, kLargestEntry), "the entry");
    const core::Json* entry = core::FindMember(json, "answer");
    if (entry != nullptr && json.contains("content")) {
      // Another request has the same hash: ask again and replace this entry.
      if (json["content"] != content) return false;
      if (AnswerFromJson(*entry, answer)) return true;
    }
  } catch (const core::Error& error) {
    fault = error.what();
  }
  findings_.push_back({"llm-cache-damaged", core::Severity::kWarning, file.string(),
                       "a cached answer cannot be read and is requested again: " + fault, 0.0});
  return false;
}

void CachingChatModel::Write(const fs::path& file, const std::string& content,
                             const ChatAnswer& answer) {
  const core::OrderedJson json = {{"content", content}, {"answer", AnswerToJson(answer)}};
  try {
    core::WriteFile(file, core::JsonText(json, core::InvalidUtf8::kReplace, 1));
  } catch (const core::Error& error) {
    // The answer exists and may have cost money: do not lose it.
    findings_.push_back({"llm-cache-not-written", core::Severity::kWarning, file.string(),
                         std::string("the answer could not be cached: ") + error.what(), 0.0});
  }
}

Usage CachingChatModel::usage() const {
  Usage usage = inner_->usage();
  usage.answers += hits_;
  usage.from_cache += hits_;
  return usage;
}

core::Findings CachingChatModel::TakeFindings() {
  core::Findings findings = inner_->TakeFindings();
  findings.insert(findings.end(), findings_.begin(), findings_.end());
  findings_.clear();
  return findings;
}

}  // namespace simwright::llm
