#include "workflows/tasks/page_markup.h"

#include "core/base64.h"
#include "core/finding_text.h"

namespace simwright::workflows {

std::string Page(const std::string& title, std::string_view css, const std::string& body) {
  return core::FillTemplate(
      data::page_html(),
      {{"title", title}, {"style", core::Markup{std::string(css)}}, {"body", core::Markup{body}}});
}

std::string FindingsList(const core::Findings& findings) {
  std::string list;
  for (const core::Finding& finding : findings) {
    std::string line = std::string(core::SeverityName(finding.severity)) + ": ";
    if (!finding.place.empty()) line += finding.place + ": ";
    line += finding.sentence;
    if (!finding.remedy.empty()) line += " (" + finding.remedy + ")";
    list += "<li>" + core::EscapedMarkup(line + " [" + finding.code + "]") + "</li>\n";
  }
  return list;
}

std::string InlinePicture(const std::string& bytes, const std::string& type,
                          const std::string& description) {
  return "<img alt=\"" + core::EscapedMarkup(description) + "\" src=\"data:" + type + ";base64," +
         core::Base64(bytes) + "\"/>";
}

}  // namespace simwright::workflows
