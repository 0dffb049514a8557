#include "workflows/generator/generator_answer.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include "core/base64.h"
#include "core/json.h"
#include "llm/redaction.h"

namespace simwright::workflows {
namespace {

using core::Json;

constexpr int kMostLevels = 4;
constexpr std::size_t kShortestMesh = 20;  // bytes of Base64; shorter texts are not decoded
constexpr std::array<const char*, 5> kTaskMembers = {"task_id", "job_id", "uid", "request_id",
                                                     "id"};
constexpr std::array<const char*, 7> kAddressMembers = {
    "model_url", "mesh_url", "glb_url", "download_url", "file_url", "url", "response_url"};
constexpr std::array<const char*, 3> kStateAddressMembers = {"status_url", "task_url", "poll_url"};

std::string LowerCaseText(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool IsOneOf(const std::string& text, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(), [&](const char* word) { return text == word; });
}

// Returns true if the lines begin as those of an OBJ file do and one of them is a vertex.
bool LooksLikeObj(std::string_view bytes) {
  bool vertex = false;
  for (int lines = 0; lines < 200 && !bytes.empty(); ++lines) {
    const std::size_t end = std::min(bytes.find('\n'), bytes.size());
    std::string_view line = bytes.substr(0, end);
    bytes.remove_prefix(std::min(end + 1, bytes.size()));
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
    if (line.empty() || line.front() == '#') continue;
    const std::string word(line.substr(0, line.find_first_of(" \t")));
    if (!IsOneOf(word, {"v", "vn", "vt", "vp", "f", "g", "o", "s", "l", "mtllib", "usemtl"})) {
      return false;
    }
    vertex = vertex || word == "v";
  }
  return vertex;
}

// Decodes a text that is the Base64 of a mesh.
bool DecodeMesh(std::string_view text, GeneratorAnswer* answer) {
  if (text.starts_with("data:")) {
    const std::size_t comma = text.find(',');
    if (comma == std::string_view::npos) return false;
    text.remove_prefix(comma + 1);
  }
  if (text.size() < kShortestMesh) return false;
  std::optional<std::string> bytes = core::FromBase64(text);
  if (!bytes) return false;
  answer->extension = MeshExtensionOf(*bytes);
  if (answer->extension.empty()) return false;
  answer->kind = GeneratorAnswer::Kind::kMesh;
  answer->mesh = std::move(*bytes);
  return true;
}

bool IsMeshAddress(const std::string& text) {
  if (!text.starts_with("http://") && !text.starts_with("https://") && !text.starts_with("/")) {
    return false;
  }
  const std::string path = LowerCaseText(text.substr(0, text.find_first_of("?#")));
  return path.ends_with(".glb") || path.ends_with(".obj") || path.ends_with(".ply") ||
         path.ends_with(".zip");
}

// Calls `visit` for every object in `json`, at most kMostLevels deep, until it returns true.
template <typename Visit>
bool VisitObjects(const Json& json, const Visit& visit, int level = 0) {
  if (level > kMostLevels || !json.is_structured()) return false;
  if (json.is_object() && visit(json)) return true;
  return std::any_of(json.begin(), json.end(),
                     [&](const Json& member) { return VisitObjects(member, visit, level + 1); });
}

bool FindMesh(const Json& json, GeneratorAnswer* answer, int level = 0) {
  if (json.is_string()) return DecodeMesh(json.get_ref<const std::string&>(), answer);
  if (level > kMostLevels || !json.is_structured()) return false;
  return std::any_of(json.begin(), json.end(),
                     [&](const Json& member) { return FindMesh(member, answer, level + 1); });
}

std::string FindAddress(const Json& json, int level = 0) {
  if (json.is_string() && IsMeshAddress(json.get_ref<const std::string&>())) {
    return json.get<std::string>();
  }
  if (level > kMostLevels || !json.is_structured()) return "";
  for (const Json& member : json) {
    const std::string found = FindAddress(member, level + 1);
    if (!found.empty()) return found;
  }
  return "";
}

template <typename Names>
std::string FirstText(const Json& json, const Names& names) {
  std::string found;
  VisitObjects(json, [&](const Json& object) {
    for (const char* name : names) {
      const Json* member = core::FindMember(object, name);
      if (member == nullptr) continue;
      if (member->is_string()) found = member->template get<std::string>();
      if (member->is_number_integer()) found = core::JsonLine(*member);
      if (!found.empty()) return true;
    }
    return false;
  });
  return found;
}

// Returns the server's reason for a failure; "" if `json` reports none.
std::string FailureOf(const Json& json, const std::string& state) {
  const Json* error = core::FindMember(json, "error");
  const bool stated = error != nullptr && !error->is_null() && *error != Json(false) &&
                      *error != Json("") && *error != Json(0);
  const bool coded = core::NumberMember(json, "error_code", 0.0) != 0.0;
  const bool failed = IsOneOf(state, {"failed", "failure", "error", "cancelled", "canceled",
                                      "expired", "aborted", "banned"});
  if (!stated && !coded && !failed) return "";
  if (stated && error->is_string()) return error->get<std::string>();
  if (stated && !core::TextMember(*error, "message").empty()) {
    return core::TextMember(*error, "message");
  }
  for (const char* name : {"message", "error_message", "detail", "text", "reason"}) {
    const std::string text = core::TextMember(json, name);
    if (!text.empty()) return text;
  }
  return core::JsonLine(json, core::InvalidUtf8::kReplace);
}

bool IsComplete(const std::string& state) {
  return IsOneOf(state, {"completed", "complete", "succeeded", "success", "successful", "done",
                         "finished", "ok", "ready"});
}

GeneratorAnswer FromJson(const Json& json) {
  GeneratorAnswer answer;
  constexpr std::array<const char*, 3> kStateMembers = {"status", "state", "task_status"};
  answer.state = LowerCaseText(FirstText(json, kStateMembers));
  answer.message = FailureOf(json, answer.state);
  if (!answer.message.empty()) {
    answer.kind = GeneratorAnswer::Kind::kFailed;
    return answer;
  }
  if (FindMesh(json, &answer)) return answer;
  answer.task = FirstText(json, kTaskMembers);
  const bool pending = !answer.state.empty() && !IsComplete(answer.state);
  if (!pending) answer.address = FindAddress(json);
  if (!pending && answer.address.empty()) answer.address = FirstText(json, kAddressMembers);
  if (!answer.address.empty()) {
    answer.kind = GeneratorAnswer::Kind::kAddress;
    return answer;
  }
  if (pending || (!answer.task.empty() && answer.state.empty())) {
    answer.kind = GeneratorAnswer::Kind::kTask;
    answer.address = FirstText(json, kStateAddressMembers);
    return answer;
  }
  answer.message = "JSON without a mesh, an address or a task";
  return answer;
}

}  // namespace

std::string MeshExtensionOf(std::string_view bytes) {
  if (bytes.starts_with("glTF")) return ".glb";
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return ".ply";
  if (bytes.starts_with("PK\x03\x04")) return ".zip";
  return LooksLikeObj(bytes) ? ".obj" : "";
}

std::string DescribeContent(std::string_view bytes) {
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return "empty";
  const std::string start = LowerCaseText(std::string(bytes.substr(first, 14)));
  if (start.starts_with("<!doctype html") || start.starts_with("<html")) {
    return "a web page (HTML)";
  }
  const bool text = std::all_of(bytes.begin(),
                                bytes.begin() + std::min<long>(60, static_cast<long>(bytes.size())),
                                [](unsigned char c) { return c >= 0x20 || std::isspace(c); });
  if (!text) return "of an unknown binary format";
  const std::size_t last = bytes.find_last_not_of(" \t\r\n");
  return "no mesh but \"" + llm::Shortened(bytes.substr(first, last + 1 - first), 60) + "\"";
}

GeneratorAnswer ReadGeneratorAnswer(std::string body) {
  GeneratorAnswer answer;
  answer.extension = MeshExtensionOf(body);
  if (!answer.extension.empty()) {
    answer.kind = GeneratorAnswer::Kind::kMesh;
    answer.mesh = std::move(body);
    return answer;
  }
  const std::size_t first = body.find_first_not_of(" \t\r\n");
  if (first != std::string::npos && (body[first] == '{' || body[first] == '[')) {
    if (const std::optional<Json> json = core::TryParseJson(body)) return FromJson(*json);
    answer.message = "damaged JSON";
    return answer;
  }
  answer.message = DescribeContent(body);
  return answer;
}

}  // namespace simwright::workflows
