#include "workflows/tasks/page_markup.h"

#include "core/base64.h"

namespace simwright::workflows {

std::string MarkupSafe(const std::string& text) {
  std::string safe;
  for (char c : text) {
    switch (c) {
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '&':
        safe += "&amp;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      default:
        if (static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t') safe += c;
    }
  }
  return safe;
}

std::string PageStart(const std::string& title, const std::string& style) {
  const std::string safe = MarkupSafe(title);
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/><title>" +
         safe + "</title><style>" + style + "</style></head><body>\n<h1>" + safe + "</h1>\n";
}

std::string PageEnd() {
  return "</body></html>\n";
}

std::string InlinePicture(const std::string& bytes, const std::string& type,
                          const std::string& description) {
  return "<img alt=\"" + MarkupSafe(description) + "\" src=\"data:" + type + ";base64," +
         core::Base64(bytes) + "\"/>";
}

}  // namespace simwright::workflows
