#include "core/text_template.h"

#include <set>

#include "core/error.h"

namespace simwright::core {
namespace {

constexpr std::string_view kOpening = "{{", kClosing = "}}";

}  // namespace

std::string EscapedMarkup(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '&':
        escaped += "&amp;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        if (static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t') escaped += c;
    }
  }
  return escaped;
}

std::string FillTemplate(std::string_view text,
                         const std::map<std::string, TemplateValue>& values) {
  std::string filled;
  std::set<std::string> used;
  for (std::size_t at = 0;;) {
    const std::size_t opening = text.find(kOpening, at);
    filled += text.substr(at, opening - at);
    if (opening == std::string_view::npos) break;
    const std::size_t begin = opening + kOpening.size();
    const std::size_t end = text.find(kClosing, begin);
    if (end == std::string_view::npos) {
      throw Error("a placeholder of the template is not closed",
                  std::string(text.substr(opening, 40)));
    }
    const std::string name(text.substr(begin, end - begin));
    const auto value = values.find(name);
    if (value == values.end()) throw Error("the placeholder of the template has no value", name);
    filled += value->second.inserted();
    used.insert(name);
    at = end + kClosing.size();
  }
  for (const auto& [name, value] : values) {
    if (!used.contains(name)) throw Error("the template has no such placeholder", name);
  }
  return filled;
}

}  // namespace simwright::core
