#include "workflows/twin/twin_page.h"

#include <cmath>
#include <cstdio>

#include "core/text_template.h"
#include "workflows/tasks/page_markup.h"

namespace simwright::workflows {
namespace {

constexpr double kRadian = 180.0 / M_PI;

std::string RowOf(const TwinObject& object) {
  const Eigen::Vector3d at = object.world_from_object.translation();
  char numbers[420];
  std::snprintf(numbers, sizeof numbers,
                "<td class=\"n\">%.2f</td><td class=\"n\">%.2f</td><td class=\"n\">%.3f, %.3f</td>"
                "<td class=\"n\">%.1f</td><td class=\"n\">%.0f</td>"
                "<td class=\"n\">%.1f x %.1f x %.1f</td><td class=\"n\">%.1f</td>",
                object.confidence, object.outline_iou, at.x(), at.y(),
                100.0 * object.position_error, kRadian * object.yaw_error, 100.0 * object.size.x(),
                100.0 * object.size.y(), 100.0 * object.size.z(), 1000.0 * object.settled);
  return "<tr><td><a href=\"assets/" + core::EscapedMarkup(object.name) + "/preview.png\">" +
         core::EscapedMarkup(object.name) + "</a></td><td>" + core::EscapedMarkup(object.category) +
         (object.source == TwinSource::kRetrieved ? " (your asset)" : "") +
         (object.source == TwinSource::kLifted ? " (free form)" : "") + "</td>" + numbers +
         "</tr>\n";
}

}  // namespace

std::string TwinPage(const TwinRecord& record, const core::Findings& findings, double seconds) {
  std::string rows;
  for (const TwinObject& object : record.objects) rows += RowOf(object);
  const Eigen::Vector3d eye = record.camera.position();
  char summary[320];
  std::snprintf(summary, sizeof summary,
                "%zu objects on a table, made in %.0f s. The camera stands %.2f m above the table; "
                "all lengths together may be off by %.0f %%. %s",
                record.objects.size(), seconds, eye.z(),
                100.0 * (std::exp(record.log_scale_error) - 1.0),
                record.stands ? "The scene stands still in physics."
                              : "Not all objects stand in physics; see the findings.");
  const std::string body = core::FillTemplate(data::twin_page_html(),
                                              {{"summary", summary},
                                               {"rows", core::Markup{rows}},
                                               {"findings", core::Markup{FindingsList(findings)}}});
  return Page("Twin of " + record.photo, data::photo_run_css(), body);
}

}  // namespace simwright::workflows
