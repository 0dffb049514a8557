#pragma once

#include <string>

namespace simwright::workflows {

// Escapes the characters of `text` that are special in HTML and SVG.
std::string MarkupSafe(const std::string& text);

// Returns the head of a self-contained page, up to <body> and its heading; `style` is CSS. Together
// with PageEnd it is well-formed XML if the content between them is.
std::string PageStart(const std::string& title, const std::string& style);
std::string PageEnd();

// Returns an <img> with its data embedded. `type`: "image/png", "image/svg+xml". `description` is
// the alternative text.
std::string InlinePicture(const std::string& bytes, const std::string& type,
                          const std::string& description);

}  // namespace simwright::workflows
