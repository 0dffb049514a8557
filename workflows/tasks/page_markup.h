#pragma once

#include <string>
#include <string_view>

#include "core/finding.h"
#include "core/text_template.h"

namespace simwright::workflows {

// The files of workflows/templates/, embedded.
namespace data {

std::string_view page_html();
std::string_view task_page_html();
std::string_view task_page_css();
std::string_view task_section_html();
std::string_view task_drawing_svg();
std::string_view photo_run_html();
std::string_view photo_run_css();
std::string_view capture_page_html();
std::string_view import_page_html();
std::string_view photo_run_trajectory_html();
std::string_view twin_page_html();

}  // namespace data

// Returns a self-contained page. It is well-formed XML if its body is.
std::string Page(const std::string& title, std::string_view css, const std::string& body);

// Returns the findings as items of a list.
std::string FindingsList(const core::Findings& findings);

// Returns an <img> with its data embedded. `type`: "image/png", "image/svg+xml". `description` is
// the alternative text.
std::string InlinePicture(const std::string& bytes, const std::string& type,
                          const std::string& description);

}  // namespace simwright::workflows
