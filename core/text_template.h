#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace simwright::core {

// Escapes the characters of `text` that are special in HTML and SVG, and removes the control
// characters that XML forbids.
std::string EscapedMarkup(std::string_view text);

// Markup that a template takes unchanged. All other values are escaped.
struct Markup {
  std::string text;
};

// The value of a placeholder, in the form in which it is inserted.
class TemplateValue {
 public:
  // Implicit, so that values are written as texts.
  TemplateValue(const std::string& text) : inserted_(EscapedMarkup(text)) {}
  TemplateValue(const char* text) : inserted_(EscapedMarkup(text)) {}
  TemplateValue(Markup markup) : inserted_(std::move(markup.text)) {}

  const std::string& inserted() const { return inserted_; }

 private:
  std::string inserted_;
};

// Returns `text` with each placeholder, such as {{title}}, replaced by its value. Values are not
// searched for placeholders. Throws core::Error if a placeholder is not closed or has no value, and
// if the text has no placeholder for a value.
std::string FillTemplate(std::string_view text, const std::map<std::string, TemplateValue>& values);

}  // namespace simwright::core
