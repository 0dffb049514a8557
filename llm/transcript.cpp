#include "llm/transcript.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "core/content_hash.h"
#include "core/error.h"
#include "core/files.h"
#include "core/json.h"
#include "llm/answer_json.h"
#include "llm/redaction.h"
#include "llm/request_key.h"

namespace simwright::llm {
namespace {
namespace fs = std::filesystem;
using core::Json;

constexpr const char* kFormat = "simwright-llm";
constexpr int kVersion = 1;
constexpr std::uint64_t kLargestTranscript = 256u << 20;  // bytes
constexpr std::size_t kShortHash = 8;                     // digits shown to a person

void ReadHead(const Json& json, const std::string& where) {
  if (!json.is_object() || core::TextMember(json, "transcript") != kFormat) {
    throw core::Error("is not a transcript: its first line is different", where,
                      "make one with --record");
  }
  if (core::NumberMember(json, "version", 0.0) != kVersion) {
    throw core::Error("is a transcript of another version of the program", where,
                      "record it again");
  }
}

TranscriptEntry ReadEntry(const Json& json, const std::string& where) {
  if (!json.is_object()) throw core::Error("the line is truncated or damaged", where);
  TranscriptEntry entry;
  entry.task = core::TextMember(json, "task");
  entry.model = core::TextMember(json, "model");
  const Json* request = core::FindMember(json, "request");
  if (request == nullptr || !request->is_object()) {
    throw core::Error("the line has no request", where);
  }
  entry.request = core::JsonLine(*request, core::InvalidUtf8::kReplace);
  const Json* hash = core::FindMember(json, "hash");  // a hand-written transcript need not have it
  if (hash != nullptr && *hash != core::ContentHash(entry.request)) {
    throw core::Error("the request was changed after it was recorded", where,
                      "remove its hash if that was intended");
  }
  const Json* answer = core::FindMember(json, "answer");
  if (answer == nullptr || !AnswerFromJson(*answer, &entry.answer)) {
    throw core::Error("the line has no answer with a text", where);
  }
  return entry;
}

// Returns all texts of a canonical request, concatenated.
std::string TextOf(const std::string& canonical) {
  const std::optional<Json> json = core::TryParseJson(canonical);
  const Json* messages = json ? core::FindMember(*json, "messages") : nullptr;
  std::string text;
  if (messages == nullptr || !messages->is_array()) return text;
  for (const Json& message : *messages) {
    if (message.is_object()) text += core::TextMember(message, "text") + "\n";
  }
  return text;
}

std::set<std::string> WordsOf(const std::string& text) {
  std::istringstream in(text);
  std::set<std::string> words;
  for (std::string word; in >> word;) words.insert(word);
  return words;
}

// Returns the number of common words over that of all words, in [0, 1].
double Similarity(const std::set<std::string>& a, const std::set<std::string>& b) {
  const auto common =
      std::count_if(a.begin(), a.end(), [&](const std::string& word) { return b.contains(word); });
  const double all = static_cast<double>(a.size() + b.size()) - static_cast<double>(common);
  return all == 0.0 ? 1.0 : static_cast<double>(common) / all;
}

// Describes where two texts diverge, with a few words of each.
std::string Divergence(const std::string& asked, const std::string& recorded) {
  if (asked == recorded) return "its text is the same, its settings or images differ";
  const auto parting = std::mismatch(asked.begin(), asked.end(), recorded.begin(), recorded.end());
  std::size_t at = static_cast<std::size_t>(parting.second - recorded.begin());
  while (at > 0 && !std::isspace(static_cast<unsigned char>(recorded[at - 1]))) --at;
  return "it reads '" + Shortened(std::string_view(recorded).substr(at), 40) +
         "' where the request reads '" + Shortened(std::string_view(asked).substr(at), 40) + "'";
}

}  // namespace

std::string TranscriptHead() {
  return core::JsonLine(core::OrderedJson{{"transcript", kFormat}, {"version", kVersion}}) + "\n";
}

std::string TranscriptLine(const TranscriptEntry& entry) {
  const core::OrderedJson json = {{"hash", core::ContentHash(entry.request)},
                                  {"task", entry.task},
                                  {"model", entry.model},
                                  {"request", core::ParseJson(entry.request, "the request")},
                                  {"answer", AnswerToJson(entry.answer)}};
  return core::JsonLine(json, core::InvalidUtf8::kReplace) + "\n";
}

std::vector<TranscriptEntry> ReadTranscript(std::string_view text, const std::string& where) {
  std::vector<TranscriptEntry> entries;
  bool head = true;
  int number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++number;
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    const Json json = core::TryParseJson(line).value_or(Json());
    const std::string place = where + " line " + std::to_string(number);
    if (head) {
      ReadHead(json, place);
      head = false;
      continue;
    }
    entries.push_back(ReadEntry(json, place));
    entries.back().line = number;
  }
  if (head) throw core::Error("the transcript is empty", where, "make one with --record");
  return entries;
}

RecordingChatModel::RecordingChatModel(std::unique_ptr<ChatModel> inner, const fs::path& file,
                                       bool replace)
    : inner_(std::move(inner)), file_(file), text_(TranscriptHead()) {
  std::error_code code;
  if (!replace && fs::exists(file_, code)) {
    throw core::Error("the transcript exists already", file_.string(),
                      "choose another name or replace it with --force");
  }
  if (fs::is_directory(file_, code)) throw core::Error("this is a folder", file_.string());
  if (!fs::is_directory(fs::absolute(file_).parent_path(), code)) {
    throw core::Error("there is no folder to write the transcript into", file_.string());
  }
}

ChatAnswer RecordingChatModel::Ask(const ChatRequest& request, core::Progress* progress) {
  const ChatAnswer answer = inner_->Ask(request, progress);
  text_ += TranscriptLine({0, request.task, inner_->name(), CanonicalRequest(request), answer});
  core::WriteFile(file_, text_);
  return answer;
}

ReplayChatModel::ReplayChatModel(const fs::path& file)
    : file_(file),
      entries_(ReadTranscript(core::ReadFile(file, kLargestTranscript), file.string())) {
  for (std::size_t i = 0; i < entries_.size(); ++i) of_request_[entries_[i].request].push_back(i);
}

ChatAnswer ReplayChatModel::Ask(const ChatRequest& request, core::Progress* progress) {
  RequireValid(request);
  if (progress != nullptr) progress->Stage("reading " + file_.filename().string());
  const std::string key = CanonicalRequest(request);
  const std::string asked = (request.task.empty() ? "" : request.task + ", ") + "'" +
                            FirstWords(request) + "', request " +
                            core::ContentHash(key).substr(0, kShortHash);
  const auto found = of_request_.find(key);
  if (found == of_request_.end()) {
    throw core::Error("has no answer to " + asked + "; " + Nearest(request), file_.string(),
                      "record it again with --record");
  }
  std::size_t& given = given_[key];
  if (given == found->second.size()) {
    throw core::Error(
        "holds " + std::to_string(given) + " answers to " + asked + ", and one more was requested",
        file_.string(), "record it again with --record");
  }
  const ChatAnswer& answer = entries_[found->second[given++]].answer;
  ++usage_.answers;
  ++usage_.from_cache;
  return answer;
}

std::string ReplayChatModel::Nearest(const ChatRequest& request) const {
  const std::string asked = TextOf(CanonicalRequest(request));
  const std::set<std::string> words = WordsOf(asked);
  const TranscriptEntry* nearest = nullptr;
  double likeness = -1.0;
  std::string text;
  for (const TranscriptEntry& entry : entries_) {
    const std::string recorded = TextOf(entry.request);
    const double like = Similarity(words, WordsOf(recorded));
    if (like > likeness) {
      likeness = like;
      nearest = &entry;
      text = recorded;
    }
  }
  if (nearest == nullptr) return "it has no answers at all";
  return "the nearest recorded one is line " + std::to_string(nearest->line) + " (" +
         nearest->task + ", request " + core::ContentHash(nearest->request).substr(0, kShortHash) +
         "): " + Divergence(asked, text);
}

}  // namespace simwright::llm
