#include "workflows/lift/capture_report.h"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "capture/coverage.h"
#include "core/files.h"
#include "core/json.h"
#include "core/text_template.h"
#include "workflows/tasks/page_markup.h"

namespace simwright::workflows {
namespace {

constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;
constexpr int kSheetWidth = 320;  // pixels of a photo on the sheet

std::string Decimal(double value, int digits) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

core::OrderedJson LensJson(const capture::Lens& lens) {
  return {{"width", lens.width}, {"height", lens.height}, {"fx", lens.fx}, {"fy", lens.fy},
          {"cx", lens.cx},       {"cy", lens.cy},         {"k1", lens.k1}, {"k2", lens.k2},
          {"p1", lens.p1},       {"p2", lens.p2},         {"k3", lens.k3}};
}

core::OrderedJson MatrixJson(const Eigen::Isometry3d& pose) {
  core::OrderedJson rows = core::OrderedJson::array();
  for (int row = 0; row < 4; ++row) {
    core::OrderedJson values = core::OrderedJson::array();
    for (int column = 0; column < 4; ++column) values.push_back(pose.matrix()(row, column));
    rows.push_back(values);
  }
  return rows;
}

core::OrderedJson CaptureJson(const capture::CaptureSource& source,
                              const capture::Capture& capture) {
  core::OrderedJson json = {
      {"format", 1}, {"mat", core::OrderedJson()}, {"error_pixels", capture.calibration.error}};
  if (capture.paper) json["mat"] = capture::CaptureMatOf(*capture.paper).name;
  json["lenses"] = core::OrderedJson::array();
  for (const capture::Lens& lens : capture.calibration.lenses) {
    json["lenses"].push_back(LensJson(lens));
  }
  json["photos"] = core::OrderedJson::array();
  for (std::size_t i = 0; i < capture.views.size(); ++i) {
    const capture::MatCalibration::View& view = capture.calibration.views[i];
    json["photos"].push_back(
        {{"photo", source.photos[static_cast<std::size_t>(capture.views[i].index)].name},
         {"lens", view.lens},
         {"world_from_camera", MatrixJson(view.world_from_camera)},
         {"error_pixels", view.error}});
  }
  return json;
}

// Returns where cameras and size come from, and how well they fit.
std::string CamerasSentence(const capture::Capture& capture) {
  const std::string error = Decimal(capture.calibration.error, 2) + " pixels (root mean square).";
  if (capture.paper) {
    return "The object stands on the " + capture::CaptureMatOf(*capture.paper).name +
           " mat; its size comes from the mat. The corners of the mat fit with " + error;
  }
  return "There is no mat: the cameras come from details that several photos show, which fit "
         "with " +
         error + " The size comes from the stated height or from the category.";
}

// Returns the photo with its background in green.
core::Image MaskedPhoto(const capture::CaptureView& view) {
  core::Image masked = view.photo;
  for (int y = 0; y < masked.height; ++y) {
    for (int x = 0; x < masked.width; ++x) {
      if (*view.opacity.At(x, y) >= 0.5f) continue;
      std::uint8_t* pixel = masked.At(x, y);
      pixel[0] = static_cast<std::uint8_t>(pixel[0] / 4);
      pixel[1] = static_cast<std::uint8_t>(128 + pixel[1] / 4);
      pixel[2] = static_cast<std::uint8_t>(pixel[2] / 4);
    }
  }
  const int height = std::max(1, masked.height * kSheetWidth / masked.width);
  return core::Resize(masked, kSheetWidth, height);
}

std::string Row(const std::string& photo, double error, const capture::ViewDirection& direction,
                double distance) {
  return "<tr><td>" + core::EscapedMarkup(photo) + "</td><td class=\"n\">" + Decimal(error, 2) +
         "</td><td class=\"n\">" + Decimal(kDegreesPerRadian * direction.azimuth, 0) +
         "</td><td class=\"n\">" + Decimal(kDegreesPerRadian * direction.elevation, 0) +
         "</td><td class=\"n\">" + Decimal(distance, 2) + "</td></tr>\n";
}

}  // namespace

void WriteCaptureReport(const capture::CaptureSource& source, const capture::Capture& capture,
                        const std::filesystem::path& folder) {
  const Eigen::Vector3d object = core::Bounds(capture.hull).center();
  std::vector<core::Image> pictures;
  std::vector<capture::ViewDirection> directions;
  std::string rows, advice;
  for (std::size_t i = 0; i < capture.views.size(); ++i) {
    const capture::CaptureView& view = capture.views[i];
    const Eigen::Vector3d eye = view.camera.position();
    directions.push_back(capture::DirectionTo(object, eye));
    rows += Row(source.photos[static_cast<std::size_t>(view.index)].name,
                capture.calibration.views[i].error, directions.back(), (eye - object).norm());
    pictures.push_back(MaskedPhoto(view));
  }
  for (const core::Finding& finding : capture.findings) {
    advice +=
        "<li>" +
        core::EscapedMarkup((finding.place.empty() ? "" : finding.place + ": ") + finding.sentence +
                            (finding.remedy.empty() ? "" : ". Remedy: " + finding.remedy)) +
        "</li>\n";
  }
  if (capture.findings.empty()) advice = "<li>Nothing: the photos cover the object.</li>";
  core::WritePng(folder / "capture.png", core::ContactSheet(pictures, 4));
  core::WriteFile(folder / "capture.json", core::JsonText(CaptureJson(source, capture)));
  const std::string body = core::FillTemplate(data::capture_page_html(),
                                              {{"used", std::to_string(capture.views.size())},
                                               {"count", std::to_string(source.photos.size())},
                                               {"cameras", CamerasSentence(capture)},
                                               {"advice", core::Markup{advice}},
                                               {"rows", core::Markup{rows}}});
  core::WriteFile(folder / "capture.html", Page("Capture", data::photo_run_css(), body));
}

}  // namespace simwright::workflows
