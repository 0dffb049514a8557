#include "workflows/generator/generator_request.h"

#include "core/base64.h"
#include "core/json.h"

namespace simwright::workflows {

GeneratorRequest JsonGeneratorRequest(std::string_view png, const GeneratorOptions& options) {
  core::OrderedJson json;
  json[options.field] = core::Base64(png);
  for (const auto& [name, value] : options.parameters) {
    const std::optional<core::Json> parsed = core::TryParseJson(value);
    if (parsed) {
      json[name] = *parsed;
    } else {
      json[name] = value;
    }
  }
  return {"application/json", core::JsonLine(json, core::InvalidUtf8::kReplace)};
}

GeneratorRequest MultipartGeneratorRequest(std::string_view png, const GeneratorOptions& options) {
  // The boundary must not occur in the content; it is extended until it does not.
  std::string boundary = "simwright-boundary";
  const auto occurs = [&] {
    if (png.find(boundary) != std::string_view::npos) return true;
    for (const auto& [name, value] : options.parameters) {
      if (value.find(boundary) != std::string::npos) return true;
    }
    return false;
  };
  while (occurs()) boundary += "-0";
  std::string body;
  for (const auto& [name, value] : options.parameters) {
    body += "--" + boundary + "\r\nContent-Disposition: form-data; name=\"" + name + "\"\r\n\r\n" +
            value + "\r\n";
  }
  body += "--" + boundary + "\r\nContent-Disposition: form-data; name=\"" + options.field +
          "\"; filename=\"photo.png\"\r\nContent-Type: image/png\r\n\r\n";
  body += png;
  body += "\r\n--" + boundary + "--\r\n";
  return {"multipart/form-data; boundary=" + boundary, std::move(body)};
}

}  // namespace simwright::workflows
