#pragma once

#include <string>

namespace simwright::pipeline {

// `text` with what HTML and SVG would read as marks replaced.
std::string MarkupSafe(const std::string& text);

// The head of a page that needs nothing but itself, up to <body> and its heading; `style` is CSS.
// With PageEnd well-formed as XML, where what stands between is.
std::string PageStart(const std::string& title, const std::string& style);
std::string PageEnd();

// An <img> that carries its picture with it. `type`: "image/png", "image/svg+xml". `description`
// is read out to who cannot see it.
std::string InlinePicture(const std::string& bytes, const std::string& type,
                          const std::string& description);

}  // namespace simwright::pipeline
