#include "workflows/tasks/page_markup.h"

#include "core/base64.h"

namespace simwright::workflows {

std::string Page(const std::string& title, std::string_view css, const std::string& body) {
  return core::FillTemplate(
      data::page_html(),
      {{"title", title}, {"style", core::Markup{std::string(css)}}, {"body", core::Markup{body}}});
}

std::string InlinePicture(const std::string& bytes, const std::string& type,
                          const std::string& description) {
  return "<img alt=\"" + core::EscapedMarkup(description) + "\" src=\"data:" + type + ";base64," +
         core::Base64(bytes) + "\"/>";
}

}  // namespace simwright::workflows
