// What servers answer and transcripts hold: an answer or core::Error, nothing else; what is read is
// read the same when written again. The first byte picks the reader.
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "llm/json_text.h"
#include "llm/redaction.h"
#include "llm/response_reader.h"
#include "llm/retry_schedule.h"
#include "llm/transcript.h"

namespace {

using namespace simwright::llm;

void ReadAsResponse(std::string_view text) {
  const ReadResponse read = ReadChatResponse(text);
  if (read.answer.tokens.input < 0 || read.answer.tokens.output < 0) std::abort();
  if (read.kind != ReadResponse::Kind::kAnswer && read.message.empty()) std::abort();
}

void ReadAsTranscript(std::string_view text) {
  try {
    std::string again = TranscriptHead();
    const std::vector<TranscriptEntry> entries = ReadTranscript(text, "input");
    for (const TranscriptEntry& entry : entries) again += TranscriptLine(entry);
    if (ReadTranscript(again, "again").size() != entries.size()) std::abort();
  } catch (const simwright::core::Error&) {
  }
}

void ReadTheRest(std::string_view text) {
  for (const nlohmann::json& json : JsonInText(text)) {
    if (!json.is_structured()) std::abort();
  }
  const auto wait = RetryAfterSeconds(std::string(text), 1e9);
  if (wait && !(*wait >= 0.0)) std::abort();
  const std::string secret = "0123456789abcdef";
  if (Redact(text, {secret}).find(secret) != std::string::npos) std::abort();
  if (Shortened(text, 20).size() > 23) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0] % 3) {
    case 0:
      ReadAsResponse(text);
      break;
    case 1:
      ReadAsTranscript(text);
      break;
    default:
      ReadTheRest(text);
  }
  return 0;
}
